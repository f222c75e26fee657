//! What is known of the retract planes of a program's drilling cycles.

use crate::ir::{Class, Var};
use crate::text::Span;

/// R0, which holds the plane.
pub const PLANE: Var = Var { class: Class::Parametric, number: 0 };

/// What is known of the planes of a program's cycles.
#[derive(Clone, Debug, Default)]
pub struct Planes {
    /// True once a word R, and not R0, gave a cycle its plane.
    pub by_word: bool,
    /// Where R0 first gets another value while a cycle may be in force.
    pub moved: Option<Span>,
    /// Blocks that drill by the cycle in force and name no plane.
    pub holes: Vec<Span>,
    /// The first of them that may count in increments.
    pub incremental: Option<Span>,
}
