//! A library as one control understands it: all files lowered into one module, with what was found in them, before
//! anything is made of it for another control.

use super::chunks::lower::lower;
use super::names::report_duplicates;
use super::prepare::File;
use super::{Input, code_system, machine_kind, two_paths};
use crate::diag::Diagnostic;
use crate::dialect::Control;
use crate::ir::Module;
use crate::lower::Lowered;
use rayon::prelude::*;

/// A library, lowered.
pub struct Understood {
    /// All programs; their `file` is the index of their input.
    pub module: Module,
    /// What was found, by program.
    pub found: Vec<Vec<Diagnostic>>,
    /// The files in their order.
    pub(super) files: Vec<File>,
}

/// Reads and lowers all files.
pub fn understood(inputs: &[Input], control: &Control) -> Understood {
    let (mut made, _) = lowered(inputs, control);
    made.report(inputs, control);
    made
}

/// Reads and lowers all files, with the name of each program as it is written; none for one without.
pub(super) fn lowered(inputs: &[Input], control: &Control) -> (Understood, Vec<Option<String>>) {
    let lowered: Vec<Lowered> =
        inputs.par_iter().enumerate().map(|(at, input)| lower(at, input, control)).collect();
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
    (Understood { module, found, files }, written)
}

impl Understood {
    /// Reports what only all files together show.
    pub(super) fn report(&mut self, inputs: &[Input], control: &Control) {
        report_duplicates(&self.module, inputs, &mut self.found);
        machine_kind::report(&self.module, inputs, control, &mut self.found);
        code_system::report(&self.module, inputs, control, &mut self.found);
        two_paths::report(&self.module, inputs, control, &mut self.found);
    }
}
