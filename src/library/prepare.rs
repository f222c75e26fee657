//! A library as the passes get it: all files lowered into one module, with what was found in them.

use super::chunks::lower::lower;
use super::names::{both_nameless, report_duplicates};
use super::{Input, machine_kind};
use crate::diag::Diagnostic;
use crate::dialect::Control;
use crate::ir::Module;
use crate::lower::Lowered;
use crate::syntax::ProgramName;
use rayon::prelude::*;

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
    let lowered: Vec<Lowered> =
        inputs.par_iter().enumerate().map(|(at, input)| lower(at, input, source)).collect();
    let mut module = Module::default();
    let mut found: Vec<Vec<Diagnostic>> = Vec::new();
    let mut files = Vec::with_capacity(inputs.len());
    for file in lowered {
        let first = module.programs.len();
        for (program, diagnostics) in file.programs {
            module.programs.push(program);
            found.push(diagnostics);
        }
        module.names.extend(file.names);
        files.push(File { tape: file.tape, programs: first..module.programs.len() });
    }
    let written = module.programs.iter().map(|p| p.name.as_ref().map(ToString::to_string)).collect();
    name_the_nameless(&mut module, inputs, source, target);
    report_duplicates(&module, inputs, &mut found);
    machine_kind::report(&module, inputs, source, &mut found);
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
