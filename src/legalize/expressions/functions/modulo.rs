//! The remainder, where the target's is another one or not known.
//!
//! Law: with a and b rounded to whole numbers, `a - FIX[a/b]*b` has the dividend's sign and is the remainder. Exact for
//! whole numbers up to 2^53; a divisor of 0 stops the machine in the quotient as it does in MOD.

use super::emulated::{Emulated, apply, missing, number};
use super::rounding;
use crate::canon::Func;
use crate::dialect::{Control, Question};
use crate::ir::{BinOp, Expr};
use crate::legalize::Rewriter;

/// True where the target's MOD is the one of the intermediate form for these operands.
pub fn is_native(operands: &[Expr; 2], target: &Control) -> bool {
    let answer = |question: Question, value: &str| {
        target.behaviour(question).is_some_and(|row| row.value == value && row.origin.is_settled())
    };
    let whole = |e: &Expr| e.constant().is_some_and(|v| v >= 0.0 && v.fract() == 0.0);
    target.operator("modulo").is_some()
        && (operands.iter().all(whole)
            || answer(Question::ModRoundsOperands, "true") && answer(Question::ModSign, "dividend"))
}

/// The remainder by division.
pub fn by_division(a: Expr, b: Expr, rewriter: &mut Rewriter<'_>, target: &Control) -> Emulated {
    if target.function(Func::Fix, 1).is_none() {
        return missing("mod", target);
    }
    let mut whole = |e: Expr| match e.constant() {
        Some(value) => number(value.round()),
        None => rounding::nearest(e, rewriter, target),
    };
    let (a, b) = (whole(a), whole(b));
    let times = apply(Func::Fix, Expr::binary(BinOp::Div, a.clone(), b.clone()));
    Emulated::Exact(Expr::binary(BinOp::Sub, a, Expr::binary(BinOp::Mul, times, b)))
}
