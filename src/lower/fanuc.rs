//! Lowering of Fanuc Custom Macro B: all of it is the family's.

pub use super::macro_b::cuts;
use super::{Lowered, macro_b};
use crate::dialect::Control;
use crate::syntax::ParsedFile;

/// Lowers all programs of a file.
pub fn lower(parsed: &ParsedFile<'_>, file: usize, _name: &str, control: &Control) -> Lowered {
    macro_b::lower(parsed, file, control)
}
