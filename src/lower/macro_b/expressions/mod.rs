//! Expressions, conditions and variables.

mod cond;
mod expr;
mod place;
mod variable;

pub use expr::is_constant;
pub use place::At;
pub use variable::names;
