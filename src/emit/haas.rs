//! Haas macros.

use super::macro_b::{self, Style};
use super::{Naming, Writer};
use crate::dialect::Control;

/// No source shows other words in the block of a call, so it stands alone.
const STYLE: Style = Style { words_beside_call: false };

/// Writes programs; see [`super::Emit`].
pub fn emit<'a>(names: &'a Naming, control: &'a Control) -> Writer<'a> {
    macro_b::emit(names, control, &STYLE)
}
