//! Macro lines: statements, conditions, expressions and variables.

mod condition;
mod expr;
mod statement;
mod variable;

pub use expr::negate;
pub use variable::piecewise;
