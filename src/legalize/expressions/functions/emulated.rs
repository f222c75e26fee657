//! What becomes of a function, and what emulations are put together from.

use crate::assume::Domain;
use crate::canon::Func;
use crate::dialect::Control;
use crate::ir::Expr;

/// What became of a function.
pub(super) enum Emulated {
    /// The same value, to the last digit of the arithmetic.
    Exact(Expr),
    /// The same value within a bound, or inside a domain: the text says which.
    Near(Expr, String),
    /// As near, for such arguments only.
    Inside(Expr, String, Domain),
    /// Not to be had: why.
    Missing(String),
}

/// There is none.
pub(super) fn missing(function: &str, target: &Control) -> Emulated {
    let title = &target.dialect().title;
    Emulated::Missing(format!("{title} has no function '{function}', and no arithmetic gives it"))
}

/// The function of one argument.
pub(super) fn apply(function: Func, a: Expr) -> Expr {
    Expr::Call(function, [a].into())
}

/// A constant.
pub(super) fn number(value: f64) -> Expr {
    Expr::Number(value)
}
