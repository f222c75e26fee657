//! Lowering of Haas macros: the family's, and the two numberings of its variables.

pub use super::macro_b::cuts;
use super::{Lowered, macro_b};
use crate::dialect::Control;
use crate::syntax::ParsedFile;

/// Lowers all programs of a file.
pub fn lower(parsed: &ParsedFile<'_>, file: usize, _name: &str, control: &Control) -> Lowered {
    macro_b::lower(parsed, file, control, macro_b::Family { twin })
}

/// The newer control numbers the older one's globals 10000 higher: #10100 is #100
/// (facts/haas.md 4, reported).
fn twin(number: u32) -> Option<u32> {
    number.checked_sub(10_000).filter(|older| (100..=999).contains(older))
}
