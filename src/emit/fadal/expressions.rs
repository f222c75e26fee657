//! Expressions and conditions.
//!
//! The manual ranks functions, the minus, `* /` and `+ -`; how operators of one rank group it does not say, so they are
//! bracketed but for sums and products of one sign alone. Constants have a point: without one they are integers, and
//! nobody says how those divide (seed 000:205 to 221; facts/fadal-target.md 2).

use super::Emitter;
use crate::canon::Sys;
use crate::emit::Index;
use crate::emit::common::spellings::Operator;
use crate::ir::{Bank, BinOp, Cond, Expr, Place, Relation, Var};

/// Expressions inside one another before the writer gives up; no line is as long.
const DEEPEST: u32 = 60;

/// Where an operand stands.
#[derive(Clone, Copy)]
struct Spot {
    /// Operators that bind less tightly than this are bracketed.
    rank: u32,
    /// True if a minus may stand at its start.
    sign: bool,
}

impl Spot {
    const FREE: Spot = Spot { rank: 0, sign: true };
    const CLOSED: Spot = Spot { rank: u32::MAX, sign: false };
}

impl Emitter<'_> {
    /// Writes a value to which nothing else is joined.
    pub(super) fn value(&mut self, value: &Expr) {
        self.expression(value, Spot::FREE);
    }

    fn expression(&mut self, value: &Expr, spot: Spot) {
        if self.nested >= DEEPEST {
            return self.out.unmapped("an expression of so many operations");
        }
        self.nested += 1;
        match value {
            Expr::Number(number) if number.is_sign_negative() && !spot.sign => self.grouped(value),
            Expr::Number(number) => self.out.number(*number, true),
            Expr::Var(var) => self.variable(*var),
            Expr::Indirect(bank, number) => self.indirect(*bank, number),
            Expr::System(state, subscripts) => self.state(*state, subscripts, false),
            Expr::Negate(_) if !spot.sign => self.grouped(value),
            Expr::Negate(inner) => {
                self.out.push('-');
                self.expression(inner, Spot::CLOSED);
            }
            Expr::Binary(op, operands) => self.binary(*op, operands, spot),
            Expr::Call(function, arguments) => match self.spellings.function(*function, arguments.len()) {
                Some(row) => {
                    self.out.push_str(&row.spelling);
                    self.out.push('(');
                    arguments.iter().for_each(|argument| self.value(argument));
                    self.out.push(')');
                }
                None => {
                    let n = arguments.len();
                    self.out.unmapped(format_args!("the function '{function}' of {n} operands"));
                }
            },
            Expr::Increments(_) => self.out.unmapped("a count of increments in an expression"),
            Expr::Vacant => self.out.unmapped("a vacant value"),
            Expr::Truth(_) => self.out.unmapped("a comparison as a value"),
        }
        self.nested -= 1;
    }

    fn grouped(&mut self, value: &Expr) {
        self.out.push('(');
        self.value(value);
        self.out.push(')');
    }

    fn binary(&mut self, op: BinOp, [a, b]: &[Expr; 2], spot: Spot) {
        // A negative constant is added by taking its opposite away, which rounds alike.
        if let (BinOp::Add | BinOp::Sub, Expr::Number(number)) = (op, b)
            && number.is_sign_negative()
        {
            let op = if op == BinOp::Add { BinOp::Sub } else { BinOp::Add };
            return self.joined(op, a, &Expr::Number(-number), spot);
        }
        self.joined(op, a, b, spot);
    }

    fn joined(&mut self, op: BinOp, a: &Expr, b: &Expr, spot: Spot) {
        let Operator { text, rank } = self.spellings.binary(op);
        if text.is_empty() || rank == 0 {
            return self.out.unmapped(format_args!("the operator {op:?}"));
        }
        let bracket = spot.rank > rank;
        if bracket {
            self.out.push('(');
        }
        let chains =
            matches!(op, BinOp::Add | BinOp::Mul) && matches!(a, Expr::Binary(inner, _) if *inner == op);
        let left = if chains { rank } else { rank.saturating_add(1) };
        self.expression(a, Spot { rank: left, sign: spot.sign || bracket });
        self.out.push_str(text);
        self.expression(b, Spot { rank: rank.saturating_add(1), sign: false });
        if bracket {
            self.out.push(')');
        }
    }

    /// Writes a variable.
    pub(super) fn variable(&mut self, var: Var) {
        match self.names.variable(var) {
            Some(register) => {
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

    /// Writes the variable with a computed number: `V(V1+2.)`.
    fn indirect(&mut self, bank: Bank, number: &Expr) {
        let bank = match bank {
            Bank::Numbered => self.control.numbered().map(str::to_owned),
            _ => None,
        };
        match bank {
            Some(name) => {
                self.out.push_str(&name);
                self.grouped(number);
            }
            None => self.out.unmapped("a computed variable of another control's numbering"),
        }
    }

    /// Writes a place that is assigned to.
    pub(super) fn place(&mut self, place: &Place) {
        match place {
            Place::Var(var) => self.variable(*var),
            Place::Indirect(bank, number) => self.indirect(*bank, number),
            Place::System(state, subscripts) => self.state(*state, subscripts, true),
        }
    }

    /// Writes a state of the machine: `FX1`, `H(V1)`.
    fn state(&mut self, state: Sys, subscripts: &[Expr], written: bool) {
        let verb = if written { "written" } else { "read" };
        let control = self.control;
        let mode = if written { 'w' } else { 'r' };
        let rows = || control.system_runs(state).filter(|row| row.access.contains(mode));
        let whole =
            |value: &Expr| value.constant().filter(|v| *v >= 0.0 && v.fract() == 0.0).map(|v| v as u32);
        let constants: Option<Vec<u32>> = subscripts.iter().map(whole).collect();
        if let Some(constants) = constants {
            let found = rows().find_map(|row| Some((row, row.number_of(&constants)?)));
            return match found {
                Some((row, number)) => {
                    self.out.push_str(&row.name);
                    let (open, close) = if row.array { ("(", ")") } else { ("", "") };
                    self.out.push_str(open);
                    number.into_iter().for_each(|number| self.out.integer(number));
                    self.out.push_str(close);
                }
                None => {
                    self.out.unmapped(format_args!("the state '{state}' {constants:?} where it is {verb}"))
                }
            };
        }
        // One subscript is computed; the others are those of the row.
        let fits = |row: &&crate::dialect::SystemVariable| {
            let (before, after) = (row.fixed.len(), row.after.len());
            let alike = |exprs: &[Expr], values: &[u32]| {
                exprs.iter().map(whole).eq(values.iter().map(|value| Some(*value)))
            };
            row.subscripts.len() == 1
                && row.subscripts.iter().all(|counted| counted.step == 1)
                && subscripts.len() == before + 1 + after
                && alike(&subscripts[..before], &row.fixed)
                && alike(&subscripts[before + 1..], &row.after)
        };
        let Some(row) = rows().find(fits) else {
            return self
                .out
                .unmapped(format_args!("the state '{state}' with computed subscripts where it is {verb}"));
        };
        let from = row.subscripts.first().map_or(1, |counted| counted.from);
        let offset = f64::from(row.first.unwrap_or(1)) - f64::from(from);
        let subscript = subscripts[row.fixed.len()].clone();
        let number = match offset {
            0.0 => subscript,
            _ => Expr::binary(BinOp::Add, subscript, Expr::Number(offset)),
        };
        self.out.push_str(&row.name);
        self.grouped(&number);
    }

    /// Writes a condition, or its opposite.
    pub(super) fn condition(&mut self, condition: &Cond, negated: bool) {
        if self.nested >= DEEPEST {
            return self.out.unmapped("a condition of so many parts");
        }
        self.nested += 1;
        match condition {
            Cond::Compare(relation, a, b) => {
                self.compare(if negated { relation.negated() } else { *relation }, a, b);
            }
            Cond::Not(inner) => self.condition(inner, !negated),
            Cond::And(parts) => self.parts(parts, if negated { "or" } else { "and" }, negated),
            Cond::Or(parts) => self.parts(parts, if negated { "and" } else { "or" }, negated),
            Cond::Switch(_) => self.out.unmapped("the block-skip switch in a condition"),
        }
        self.nested -= 1;
    }

    fn compare(&mut self, relation: Relation, a: &Expr, b: &Expr) {
        let text = self.spellings.relation(relation).text;
        if text.is_empty() {
            self.out.unmapped(format_args!("the comparison {relation:?}"));
        }
        self.value(a);
        self.out.push(' ');
        self.out.push_str(text);
        self.out.push(' ');
        self.value(b);
    }

    /// Each part has brackets: the order of AND and OR is not stated (seed 000:726).
    fn parts(&mut self, parts: &[Cond], meaning: &str, negated: bool) {
        let Some(row) = self.control.operator(meaning) else {
            return self.out.unmapped(format_args!("the operator '{meaning}' between conditions"));
        };
        let spelling = row.spelling.clone();
        for (at, part) in parts.iter().enumerate() {
            if at > 0 {
                self.out.push(' ');
                self.out.push_str(&spelling);
                self.out.push(' ');
            }
            self.out.push('(');
            self.condition(part, negated);
            self.out.push(')');
        }
    }
}
