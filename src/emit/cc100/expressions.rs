//! Assignments: one step each, whose first operand is a variable (seed 004:190, 1631 to 1659).

use super::Emitter;
use crate::canon::Sys;
use crate::emit::Index;
use crate::ir::{BinOp, Expr, Place, Var};

impl Emitter<'_> {
    /// Writes an assignment.
    pub(super) fn assign(&mut self, target: &Place, value: &Expr) {
        match (target, value) {
            (Place::Var(var), Expr::System(state, subscripts)) => self.read(*var, *state, subscripts),
            (Place::Var(var), value) => {
                self.variable(*var);
                self.out.push('=');
                self.value(value);
            }
            (Place::System(state, subscripts), Expr::Var(value)) => self.store(*state, subscripts, *value),
            (Place::System(state, _), _) => {
                self.out.unmapped(format_args!("the state '{state}' set to this"));
            }
            (Place::Indirect(..), _) => self.out.unmapped("a variable with a computed number"),
        }
    }

    fn value(&mut self, value: &Expr) {
        match value {
            Expr::Var(var) => self.variable(*var),
            Expr::Binary(op, operands) => self.step(*op, operands),
            Expr::Call(function, arguments) => {
                match (self.spellings.function(*function, arguments.len()), arguments.as_slice()) {
                    (Some(row), [Expr::Var(argument)]) => {
                        self.out.push_str(&row.spelling);
                        self.out.push(' ');
                        self.variable(*argument);
                    }
                    _ => self.out.unmapped(format_args!("the function '{function}' of this")),
                }
            }
            value => match value.constant() {
                Some(number) => self.out.number(number, false),
                None => self.out.unmapped("such a value"),
            },
        }
    }

    /// `V31+V32`, `V31* -1`.
    fn step(&mut self, op: BinOp, [a, b]: &[Expr; 2]) {
        let Expr::Var(a) = a else { return self.out.unmapped("a step that does not begin with a variable") };
        // A negative constant is added by taking its opposite away, which rounds alike.
        let (op, constant) = match (op, b.constant()) {
            (BinOp::Add, Some(number)) if number.is_sign_negative() => (BinOp::Sub, Some(-number)),
            (BinOp::Sub, Some(number)) if number.is_sign_negative() => (BinOp::Add, Some(-number)),
            (op, constant) => (op, constant),
        };
        let text = self.spellings.binary(op).text;
        if text.is_empty() {
            return self.out.unmapped(format_args!("the operator {op:?}"));
        }
        self.variable(*a);
        self.out.push_str(text);
        match (constant, b) {
            (Some(number), _) => {
                if number.is_sign_negative() {
                    self.out.push(' ');
                }
                self.out.number(number, false);
            }
            (None, Expr::Var(b)) => self.variable(*b),
            _ => self.out.unmapped("a step of more than two operands"),
        }
    }

    /// Writes a variable.
    pub(super) fn variable(&mut self, var: Var) {
        match self.names.variable(var) {
            Some(register) => {
                if matches!(register.index, Index::Number(number) if self.control.is_in_use(&register.name, number))
                {
                    self.page.crowded = true;
                }
                self.out.push_str(&register.name);
                match register.index {
                    Index::Number(number) => self.out.integer(number),
                    Index::Letter(letter) => self.out.push(letter),
                }
            }
            None => {
                self.out.lacks_register();
            }
        }
    }

    /// `TRF=G54 V30=X`, `COR=T01 V30=R`, `TIM V30`, `V30=T`.
    fn read(&mut self, var: Var, state: Sys, subscripts: &[Expr]) {
        let Some(name) = self.place(state, subscripts, 'r') else { return };
        match name.split_once(' ') {
            Some((table, cell)) => {
                self.out.push_str(table);
                self.out.push(' ');
                self.variable(var);
                self.out.push('=');
                self.out.push_str(cell);
            }
            None if name.starts_with('=') => {
                self.variable(var);
                self.out.push_str(&name);
            }
            None => {
                self.out.push_str(&name);
                self.out.push(' ');
                self.variable(var);
            }
        }
    }

    /// `TRF=G54 X=V30`.
    fn store(&mut self, state: Sys, subscripts: &[Expr], value: Var) {
        let Some(name) = self.place(state, subscripts, 'w') else { return };
        match name.split_once(' ') {
            Some(_) => {
                self.out.push_str(&name);
                self.out.push('=');
                self.variable(value);
            }
            None => self.out.unmapped(format_args!("the state '{state}' where it is written")),
        }
    }

    /// The row and the cell of a state: `TRF=G54 X`, `COR=T01 R`; without a cell where it has none.
    pub(super) fn place(&mut self, state: Sys, subscripts: &[Expr], mode: char) -> Option<String> {
        let whole =
            |value: &Expr| value.constant().filter(|v| *v >= 0.0 && v.fract() == 0.0).map(|v| v as u32);
        let constants: Option<Vec<u32>> = subscripts.iter().map(whole).collect();
        let control = self.control;
        let mut rows = control.system_runs(state).filter(|row| row.access.contains(mode));
        let found = constants
            .as_deref()
            .and_then(|numbers| rows.find_map(|row| Some((row, row.number_of(numbers)?))));
        match found {
            // The row of a tool has its number before the cell.
            Some((row, Some(number))) => {
                let (table, cell) = row.name.split_once(' ').unwrap_or((&row.name, ""));
                Some(format!("{table}=T{number:02} {cell}"))
            }
            Some((row, None)) => Some(row.name.clone()),
            None if let Some(name) = self.computed_row(state, subscripts, mode) => Some(name),
            None => {
                let verb = if mode == 'w' { "written" } else { "read" };
                self.out.unmapped(format_args!("the state '{state}' where it is {verb}"));
                None
            }
        }
    }

    /// `COR=V30 R`: the row of a tool by a variable (seed 004:1653).
    fn computed_row(&self, state: Sys, subscripts: &[Expr], mode: char) -> Option<String> {
        let [Expr::Var(number)] = subscripts else { return None };
        let mut rows = self.control.system_runs(state).filter(|row| row.access.contains(mode));
        let row = rows.find(|row| row.first.is_some() && row.subscripts.len() == 1)?;
        let (table, cell) = row.name.split_once(' ')?;
        let register = self.names.variable(*number)?;
        let Index::Number(index) = register.index else { return None };
        Some(format!("{table}={}{index} {cell}", register.name))
    }
}
