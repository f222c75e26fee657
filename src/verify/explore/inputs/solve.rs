//! What a variable must be for an expression to have a value.

use crate::canon::Func;
use crate::syntax::{BinaryOp, Expr, ExprKind, VarRef};

/// The one variable of an expression and the number that gives the expression a value: `#1*10+100` is 120 for
/// `#1` 2. None where more than one variable stands in it, or something that this does not turn round.
pub fn solve(e: &Expr, wanted: f64) -> Option<(&VarRef, f64)> {
    use BinaryOp::{Add, Divide, Multiply, Subtract};
    // Parsers limit how deep expressions nest.
    match &e.kind {
        ExprKind::Variable(variable) => Some((variable, wanted)),
        ExprKind::Group(inner) | ExprKind::Plus(inner) => solve(inner, wanted),
        ExprKind::Negate(inner) => solve(inner, -wanted),
        ExprKind::Call { function, arguments, .. } => match (function, arguments.as_slice()) {
            (Func::Abs | Func::Fix | Func::Fup | Func::Round, [inner]) => solve(inner, wanted),
            (Func::Sqrt, [inner]) => solve(inner, wanted * wanted),
            (function, [inner]) => solve(inner, argument(*function, wanted)?),
            _ => None,
        },
        ExprKind::Binary(op, operands) => {
            let [a, b] = &**operands;
            match (op, constant(a), constant(b)) {
                (Add, None, Some(c)) => solve(a, wanted - c),
                (Add, Some(c), None) => solve(b, wanted - c),
                (Subtract, None, Some(c)) => solve(a, wanted + c),
                (Subtract, Some(c), None) => solve(b, c - wanted),
                (Multiply, None, Some(c)) if c != 0.0 => solve(a, wanted / c),
                (Multiply, Some(c), None) if c != 0.0 => solve(b, wanted / c),
                (Divide, None, Some(c)) => solve(a, wanted * c),
                (Divide, Some(c), None) if wanted != 0.0 => solve(b, c / wanted),
                _ => None,
            }
        }
        _ => None,
    }
}

/// An argument for which a function of angles has a value, to four places: enough to come near what is wanted.
fn argument(function: Func, wanted: f64) -> Option<f64> {
    let argument = match function {
        Func::Asin => wanted.to_radians().sin(),
        Func::Acos => wanted.to_radians().cos(),
        Func::Atan => wanted.to_radians().tan(),
        Func::Sin => wanted.asin().to_degrees(),
        Func::Cos => wanted.acos().to_degrees(),
        Func::Tan => wanted.atan().to_degrees(),
        _ => return None,
    };
    argument.is_finite().then(|| (argument * 1e4).round() / 1e4)
}

/// The value of an expression without variables: numbers, and the four operations on them.
pub fn constant(e: &Expr) -> Option<f64> {
    use BinaryOp::{Add, Divide, Multiply, Subtract};
    match &e.kind {
        ExprKind::Number(number) => Some(number.value),
        ExprKind::Group(inner) | ExprKind::Plus(inner) => constant(inner),
        ExprKind::Negate(inner) => constant(inner).map(|value| -value),
        ExprKind::Binary(op, operands) => {
            let [a, b] = &**operands;
            let (a, b) = (constant(a)?, constant(b)?);
            match op {
                Add => Some(a + b),
                Subtract => Some(a - b),
                Multiply => Some(a * b),
                Divide if b != 0.0 => Some(a / b),
                _ => None,
            }
        }
        _ => None,
    }
}
