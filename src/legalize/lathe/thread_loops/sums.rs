//! Sums and products of values, worked out where they are numbers.

use super::super::counts::counted;
use crate::canon::{Func, Role};
use crate::dialect::Control;
use crate::ir::{BinOp, Expr};

/// A depth that was told as a count of increments, of which the source takes whole ones: `ROUND[#1]/1000`.
pub(in crate::legalize::lathe) fn whole(value: Expr, role: Role, source: &Control) -> Expr {
    match value {
        Expr::Binary(BinOp::Div, parts) if counted(source, role) => {
            let [count, parts] = *parts;
            Expr::binary(BinOp::Div, Expr::Call(Func::Round, [count].into()), parts)
        }
        value => value,
    }
}

/// True for a count of increments.
pub(in crate::legalize::lathe) fn counts(value: &Expr) -> bool {
    match value {
        Expr::Increments(_) => true,
        Expr::Negate(inner) => counts(inner),
        value => value.count().is_some(),
    }
}

/// A place, so many times a length farther.
pub(in crate::legalize::lathe) fn moved(from: Expr, times: Expr, length: Expr) -> Expr {
    match times.constant() {
        Some(times) if times < 0.0 => difference(from, product(number(-times), length)),
        _ => sum(from, product(times, length)),
    }
}

pub(in crate::legalize::lathe) fn difference(a: Expr, b: Expr) -> Expr {
    match (a.constant(), b.constant()) {
        _ if a == b => Expr::Number(0.0),
        (Some(a), Some(b)) => number(a - b),
        (_, Some(0.0)) if !a.may_be_vacant() => a,
        _ => Expr::binary(BinOp::Sub, a, b),
    }
}

pub(in crate::legalize::lathe) fn sum(a: Expr, b: Expr) -> Expr {
    match (a.constant(), b.constant()) {
        (Some(a), Some(b)) => number(a + b),
        (_, Some(0.0)) if !a.may_be_vacant() => a,
        _ => Expr::binary(BinOp::Add, a, b),
    }
}

pub(in crate::legalize::lathe) fn product(a: Expr, b: Expr) -> Expr {
    match (a.constant(), b.constant()) {
        (Some(a), Some(b)) => number(a * b),
        (Some(0.0), _) | (_, Some(0.0)) => Expr::Number(0.0),
        (Some(1.0), _) => b,
        _ => Expr::binary(BinOp::Mul, a, b),
    }
}

pub(in crate::legalize::lathe) fn quotient(a: Expr, b: Expr) -> Expr {
    match (a.constant(), b.constant()) {
        (Some(a), Some(b)) if b != 0.0 => number(a / b),
        _ => Expr::binary(BinOp::Div, a, b),
    }
}

/// A number without the digits that only arithmetic leaves.
fn number(value: f64) -> Expr {
    Expr::Number((value * 1e6).round() / 1e6)
}
