//! Fanuc Custom Macro B.

use super::macro_b::{self, Style};
use super::{Naming, Writer};
use crate::dialect::Control;

/// M98 may stand after words, which act first (seed 001, table of macro calls and
/// subprogram calls).
const STYLE: Style = Style { words_beside_call: true };

/// Writes programs; see [`super::Emit`].
pub fn emit<'a>(names: &'a Naming, control: &'a Control) -> Writer<'a> {
    macro_b::emit(names, control, &STYLE)
}
