//! Variables and the right-hand sides of assignments.

use super::Lowering;
use super::register::Source;
use crate::canon::Func;
use crate::dialect::Question;
use crate::ir::{BinOp, Class, Expr, Var};
use crate::lower::common::constant;
use crate::syntax::{BinaryOp, Expr as Written, ExprKind, Index, VarRef};
use thin_vec::ThinVec;

impl Lowering<'_> {
    /// The variable that is written. Letters count from 101: VA.
    pub(super) fn variable(&mut self, written: &VarRef) -> Option<Var> {
        let found = match written.index {
            Index::Number(number) => {
                self.control.variable_class(&written.name, number).map(|row| (row, number, None))
            }
            Index::Letter(letter) => {
                let number = u32::from(letter.to_ascii_uppercase()).saturating_sub(u32::from('A')) + 101;
                self.control.letter_class(&written.name, letter).map(|row| (row, number, Some(letter)))
            }
            _ => None,
        };
        let Some((row, number, letter)) = found else {
            self.findings.not_understood(written.span, "this control has no such variable");
            return None;
        };
        self.findings.rest_on(row, written.span);
        let var = Var { class: Class::Global, number };
        if let Some(letter) = letter {
            self.names.entry(var).or_insert_with(|| format!("{}{letter}", written.name));
        }
        Some(var)
    }

    /// The right-hand side of an assignment: one operation at most. Tells as well what
    /// it does to the condition register.
    pub(super) fn value(&mut self, written: &Written) -> Option<(Expr, Source)> {
        if let Some(number) = constant(written) {
            return Some((Expr::Number(number), self.load));
        }
        match &written.kind {
            ExprKind::Variable(variable) if variable.index == Index::None => {
                Some((self.active(variable)?, self.load))
            }
            ExprKind::Variable(_) | ExprKind::Number(_) => Some((self.operand(written)?, self.load)),
            ExprKind::Binary(op, operands) => {
                let [a, b] = &**operands;
                let (op, name) = match op {
                    BinaryOp::Add => (BinOp::Add, "add"),
                    BinaryOp::Subtract => (BinOp::Sub, "subtract"),
                    BinaryOp::Multiply => (BinOp::Mul, "multiply"),
                    BinaryOp::Divide => (BinOp::Div, "divide"),
                    _ => return self.unknown(written, "this control has no such operator"),
                };
                let Some(row) = self.control.operator(name) else {
                    return self.unknown(written, "this control has no such operator");
                };
                self.findings.rest_on(row, written.span);
                let (a, b) = (self.operand(a), self.operand(b));
                Some((binary(op, a?, b?), Source::Arithmetic))
            }
            ExprKind::Call { function, arguments, .. } => {
                let Some(row) = self.control.function(*function, arguments.len()) else {
                    return self.unknown(written, "this control has no such function");
                };
                self.findings.rest_on(row, written.span);
                if *function == Func::Atan
                    && self.findings.behaviour(Question::AtanRange, written.span).is_none()
                {
                    let why = "no source says which of the angles with this tangent it gives";
                    self.findings.unconfirmed(Question::AtanRange.fact().into(), Some(why), written.span);
                }
                let arguments: Option<ThinVec<Expr>> = arguments.iter().map(|a| self.operand(a)).collect();
                Some((Expr::Call(*function, arguments?), self.load))
            }
            _ => self.unknown(written, "an assignment has one operation on this control"),
        }
    }

    /// An operand: a constant or a variable.
    pub(super) fn operand(&mut self, written: &Written) -> Option<Expr> {
        if let Some(number) = constant(written) {
            return Some(Expr::Number(number));
        }
        match &written.kind {
            ExprKind::Variable(variable) if variable.index != Index::None => {
                self.variable(variable).map(Expr::Var)
            }
            ExprKind::Variable(_) => self.unknown(
                written,
                "an active value can only be copied: copy it to a \
                                                            variable first",
            ),
            ExprKind::Number(_) => self.unknown(written, "the number is too large for any control"),
            ExprKind::Negate(_) => self.unknown(written, "a variable takes no sign on this control"),
            _ => self.unknown(written, "an assignment has one operation on this control"),
        }
    }

    /// The active value of an address: `V1=X`.
    fn active(&mut self, written: &VarRef) -> Option<Expr> {
        let Some((state, subscripts, row)) = self.control.read_system(&format!("={}", written.name), None)
        else {
            self.findings.not_understood(written.span, "no active value of this name can be read");
            return None;
        };
        self.findings.rest_on(row, written.span);
        Some(Expr::System(state, subscripts.into_iter().map(|n| Expr::Number(f64::from(n))).collect()))
    }

    fn unknown<T>(&mut self, written: &Written, message: &str) -> Option<T> {
        self.findings.not_understood(written.span, message);
        None
    }
}

/// One step of arithmetic. No variable takes a sign here, so `V1 * -1` is how programs negate.
fn binary(op: BinOp, a: Expr, b: Expr) -> Expr {
    match (op, &a, &b) {
        (BinOp::Mul, Expr::Var(_), Expr::Number(n)) if *n == -1.0 => Expr::Negate(Box::new(a)),
        (BinOp::Mul, Expr::Number(n), Expr::Var(_)) if *n == -1.0 => Expr::Negate(Box::new(b)),
        _ => Expr::binary(op, a, b),
    }
}
