//! Sums with constants in them, as computed numbers of variables are.

use super::{BinOp, Expr};

/// The sum of the constants that are added up in a number.
pub fn constant_part(number: &Expr) -> Option<f64> {
    match number {
        Expr::Number(value) => Some(*value),
        Expr::Binary(op @ (BinOp::Add | BinOp::Sub), operands) => {
            let [a, b] = [0, 1].map(|at| constant_part(&operands[at]));
            let b = if *op == BinOp::Sub { b.map(|b| -b) } else { b };
            if let (Some(a), Some(b)) = (a, b) { Some(a + b) } else { a.or(b) }
        }
        _ => None,
    }
}

/// A number and so much more, added to the first constant of a sum.
pub fn shifted(number: Expr, by: f64) -> Expr {
    match number {
        Expr::Number(value) => Expr::Number(value + by),
        Expr::Binary(op @ (BinOp::Add | BinOp::Sub), operands) if constant_part(&operands[0]).is_some() => {
            let [a, b] = *operands;
            Expr::binary(op, shifted(a, by), b)
        }
        Expr::Binary(BinOp::Add, operands) if constant_part(&operands[1]).is_some() => {
            let [a, b] = *operands;
            Expr::binary(BinOp::Add, a, shifted(b, by))
        }
        number => Expr::binary(BinOp::Add, number, Expr::Number(by)),
    }
}
