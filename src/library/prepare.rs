//! A library as the passes get it: all files lowered into one module, with what was found in them.

use super::Input;
use super::names::both_nameless;
use super::understood::{Understood, lowered};
use crate::diag::Diagnostic;
use crate::dialect::Control;
use crate::ir::Module;
use crate::syntax::ProgramName;

/// A library, lowered.
pub(super) struct Prepared {
    pub module: Module,
    /// What was found, by program.
    pub found: Vec<Vec<Diagnostic>>,
    /// The files in their order.
    pub files: Vec<File>,
    /// The name of each program as it is written on the source; none for one without.
    pub written: Vec<Option<String>>,
}

/// A file of the source, lowered.
pub(super) struct File {
    pub tape: bool,
    /// Indexes of its programs in the module.
    pub programs: std::ops::Range<usize>,
}

/// Reads and lowers all files.
pub(super) fn prepare(inputs: &[Input], source: &Control, target: &Control) -> Prepared {
    let (mut made, written) = lowered(inputs, source);
    name_the_nameless(&mut made.module, inputs, source, target);
    made.report(inputs, source);
    let Understood { module, found, files } = made;
    Prepared { module, found, files, written }
}

/// On a control that knows programs by number each needs one. Programs without a name get that of their
/// file, and a number by it; where both controls have programs without a number, it stays what it is.
fn name_the_nameless(module: &mut Module, inputs: &[Input], source: &Control, target: &Control) {
    if both_nameless(source, target) {
        return;
    }
    for program in module.programs.iter_mut().filter(|program| program.name.is_none()) {
        let file = inputs.get(program.file).map(|input| input.name.clone());
        program.name = file.map(ProgramName::Name);
    }
}
