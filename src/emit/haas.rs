//! Haas macros.

use super::macro_b::{self, Style};
use super::{Emitted, Naming};
use crate::diag::Diagnostic;
use crate::dialect::Control;
use crate::ir::Program;

/// No source shows other words in the block of a call, so it stands alone.
const STYLE: Style = Style { words_beside_call: false };

/// Writes a program; see [`super::Emit`].
pub fn emit(program: &Program, names: &Naming, control: &Control) -> Result<Emitted, Vec<Diagnostic>> {
    macro_b::emit(program, names, control, &STYLE)
}
