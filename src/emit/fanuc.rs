//! Fanuc Custom Macro B.

use super::macro_b::{self, Style};
use super::{Emitted, Naming};
use crate::diag::Diagnostic;
use crate::dialect::Control;
use crate::ir::Program;

/// M98 may stand behind words, which act first (seed 001, table of macro calls and
/// subprogram calls).
const STYLE: Style = Style { words_beside_call: true };

/// Writes a program; see [`super::Emit`].
pub fn emit(program: &Program, names: &Naming, control: &Control) -> Result<Emitted, Vec<Diagnostic>> {
    macro_b::emit(program, names, control, &STYLE)
}
