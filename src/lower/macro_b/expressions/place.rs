//! Where an expression stands.

use crate::canon::Role;

/// Where an expression stands: ROUND means another thing in a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum At {
    /// In a statement, a condition, a subscript.
    Value,
    /// In a word of this role.
    Word(Role),
    /// In an argument of a macro call.
    Argument,
}

/// How deep expressions may nest: more than any control takes, and half of what the common form allows, since
/// emulations nest deeper.
pub const MAX_DEPTH: u32 = 128;
