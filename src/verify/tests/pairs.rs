//! Pairs of files, verified between two machines.

use super::verified;
use crate::assume::Assumption;
use crate::control::{LoadedFile, ProgramRef};
use crate::dialect::Control;
use crate::syntax::parse_file;
use crate::verify::{Assumptions, ProgramCertificate, Side, SymbolMap};

/// Verifies a pair of files between two machines, with what a conversion supposes of the programs, by their places in the file.
pub(super) fn between(
    controls: &[Control; 2],
    [source, target]: [&str; 2],
    names: &SymbolMap,
    supposed: &[(usize, Assumption)],
) -> Vec<ProgramCertificate> {
    let execute = [0, 1].map(|at: usize| controls[at].entry().execute.unwrap());
    let parsed = [(source, &controls[0]), (target, &controls[1])]
        .map(|(text, control)| parse_file(text.as_bytes(), control.entry().parse));
    // As subprograms are named where the file's name says what they are.
    let ours = [LoadedFile { name: "cycle1.nc", parsed: &parsed[0] }];
    let theirs = [LoadedFile { name: "cycle2.nc", parsed: &parsed[1] }];
    let source = Side::new(&controls[0], execute[0], &ours);
    let target = Side::new(&controls[1], execute[1], &theirs);
    let mut assumptions = Assumptions::new();
    for (program, assumption) in supposed.iter().cloned() {
        assumptions.entry(ProgramRef { file: 0, program }).or_default().push(assumption);
    }
    verified([&source, &target], names, &assumptions)
}
