//! Variables and machine state, as they are written.

use crate::canon::{Func, Sys};
use crate::dialect::{Question, SystemVariable};
use crate::ir::{Bank, BinOp, Class, Cond, Expr, Place, Relation, Var};
use crate::lower::fadal::build::Lowering;
use crate::syntax::{Index, VarRef};

impl<'b> Lowering<'b> {
    /// The place that a variable is.
    pub fn place(&mut self, var: &VarRef) -> Option<Place> {
        let class = self.control.classes().iter().find(|row| row.name == var.name);
        if let Some(row) = class {
            let (class, bank) = match row.class.as_str() {
                "parametric" => (Class::Parametric, Bank::Parametric),
                _ => (Class::Global, Bank::Global),
            };
            return match &var.index {
                Index::Number(number) => {
                    let Some(row) = self.control.variable_class(&var.name, *number) else {
                        return self.refuse(var.span, format!("there is no variable {}{number}", var.name));
                    };
                    self.findings.rest_on(row, var.span);
                    Some(Place::Var(Var { class, number: *number }))
                }
                Index::Computed(index) => {
                    let index = self.subscript(index)?;
                    Some(match index.constant() {
                        Some(number) if number >= 0.0 && number.fract() == 0.0 => {
                            let number = number as u32;
                            if self.control.variable_class(&var.name, number).is_none() {
                                let message = format!("there is no variable {}{number}", var.name);
                                return self.refuse(var.span, message);
                            }
                            Place::Var(Var { class, number })
                        }
                        _ => Place::Indirect(bank, Box::new(index)),
                    })
                }
                _ => self.refuse(var.span, format!("{} needs a number", var.name)),
            };
        }
        self.system(var)
    }

    /// The value that a variable holds, with what reading it rests on.
    pub fn read(&mut self, var: &VarRef) -> Option<Expr> {
        let mut place = self.place(var)?;
        if let Place::System(state, _) = &mut place {
            if *state == Sys::ModalMotionPlus1 {
                self.reads_motion.get_or_insert(var.span);
            }
            if state.is_changed_by_moves() && self.state.moved {
                let message = format!("{} may be read before earlier moves are done", var.name);
                self.early(&var.name, var.span, message);
            }
            if *state == Sys::AxisPosition {
                match self.rely(Question::PositionFrame, var.span) {
                    Some("work") => *state = Sys::WorkPosition,
                    Some("machine") => *state = Sys::MachinePosition,
                    _ => {}
                }
            }
        }
        Some(place.read())
    }

    fn system(&mut self, var: &VarRef) -> Option<Place> {
        let control = self.control;
        let number = match &var.index {
            Index::None => None,
            Index::Number(number) => Some(*number),
            Index::Computed(index) => {
                let index = self.subscript(index)?;
                match index.constant() {
                    Some(number) if number >= 0.0 && number.fract() == 0.0 => Some(number as u32),
                    _ => return self.computed(var, index),
                }
            }
            _ => return self.refuse(var.span, format!("{} takes a number only", var.name)),
        };
        let Some((state, subscripts, row)) = control.read_system(&var.name, number) else {
            let number = number.map(|number| number.to_string()).unwrap_or_default();
            let message = format!("the table has no meaning for {}{number}", var.name);
            return self.refuse(var.span, message);
        };
        self.findings.rest_on(row, var.span);
        Some(Place::System(state, subscripts.into_iter().map(|n| Expr::Number(f64::from(n))).collect()))
    }

    /// State with a computed number: `FX(V2)`. A name whose numbers run in pieces
    /// adds to the number what its piece does.
    fn computed(&mut self, var: &VarRef, index: Expr) -> Option<Place> {
        let rows = self.control.dialect().system.iter().filter(|row| row.name == var.name);
        let mut rows: Vec<&SystemVariable> = rows.collect();
        rows.sort_by_key(|row| row.first);
        let Some(first) = rows.first().copied() else {
            return self.refuse(var.span, format!("the table has no meaning for {}", var.name));
        };
        let alike = rows.iter().all(|row| {
            let counted = matches!(row.subscripts.as_slice(), [subscript] if subscript.step == 1);
            counted && (row.state, &row.fixed, &row.after) == (first.state, &first.fixed, &first.after)
        });
        if !alike {
            let message = format!(
                "{} with a computed number may be different kinds of state: write the \
                                   number",
                var.name
            );
            return self.refuse(var.span, message);
        }
        rows.iter().for_each(|row| self.findings.rest_on(*row, var.span));
        // A fraction is rounded before it is looked up in which piece the number lies.
        let index =
            if rows.len() > 1 && !index.is_whole() { Expr::Call(Func::Round, [index].into()) } else { index };
        let shifts = rows.iter().filter_map(|row| {
            let from = row.subscripts.first()?.from;
            Some((f64::from(row.first?), f64::from(from) - f64::from(row.first?)))
        });
        let subscript = piecewise(index, shifts);
        let constant = |numbers: &[u32]| -> Vec<Expr> {
            numbers.iter().map(|number| Expr::Number(f64::from(*number))).collect()
        };
        let mut subscripts = constant(&first.fixed);
        subscripts.push(subscript);
        subscripts.extend(constant(&first.after));
        Some(Place::System(first.state, subscripts.into()))
    }

    fn subscript(&mut self, index: &crate::syntax::Expr) -> Option<Expr> {
        let value = self.expr(index)?;
        if matches!(value, Expr::Binary(BinOp::Div, ..) | Expr::Call(..)) {
            let _ = self.rely(Question::IndexOfFraction, index.span);
        }
        Some(value)
    }
}

/// `value` plus the shift of its piece; pieces are (first value, shift), in order.
pub fn piecewise(value: Expr, pieces: impl Iterator<Item = (f64, f64)>) -> Expr {
    let mut out = value.clone();
    let mut present = 0.0;
    for (at, (first, shift)) in pieces.enumerate() {
        let step = shift - present;
        present = shift;
        if step == 0.0 {
            continue;
        }
        let step = Expr::Number(step);
        let term = if at == 0 {
            step
        } else {
            let here = Cond::Compare(Relation::GreaterEqual, value.clone(), Expr::Number(first));
            Expr::binary(BinOp::Mul, step, Expr::Truth(Box::new(here)))
        };
        out = Expr::binary(BinOp::Add, out, term);
    }
    out
}
