//! Differences of programs that others show.

use super::library::Certificate;
use super::outcome::Outcome;
use super::program::ProgramCertificate;
use crate::syntax::ProgramName;
use std::collections::{BTreeMap, BTreeSet};

/// Lets what showed itself in a called program count for that program too: it may be the same by itself, and differ in
/// the circumstances that a caller makes.
pub fn implicate<'c>(certificates: impl Iterator<Item = &'c mut Certificate>) {
    let mut all: Vec<&mut Certificate> = certificates.collect();
    let number = |name: &str| ProgramName::digits(name).to_owned();
    let place = |program: &ProgramCertificate| {
        let named = program.program.as_deref().unwrap_or_default();
        (program.source.clone(), number(named))
    };
    let named = |program: &ProgramCertificate| number(program.program.as_deref().unwrap_or_default());
    let names: BTreeSet<String> = all.iter().flat_map(|c| &c.programs).map(named).collect();
    let mut shown = BTreeMap::new();
    for program in all.iter().flat_map(|certificate| &certificate.programs) {
        let moment = program.witness.as_ref().filter(|_| program.outcome == Outcome::Different);
        let Some((witness, moment)) = moment.and_then(|witness| Some((witness, witness.source.as_ref()?)))
        else {
            continue;
        };
        // Where the target runs another program of the library, the call is at fault. Nobody calls a program without a
        // name, and a file may have several.
        let there = witness.target.as_ref().map_or_else(String::new, |moment| number(&moment.program));
        let another = there != number(&moment.program) && names.contains(&there) && !there.is_empty();
        if moment.program.is_empty() || another {
            continue;
        }
        let place = (moment.file.clone(), number(&moment.program));
        shown.entry(place).or_insert_with(|| (witness.clone(), program.run_alone));
    }
    for certificate in &mut all {
        for program in certificate.programs.iter_mut().filter(|p| p.outcome != Outcome::Different) {
            if let Some((witness, run_alone)) = shown.get(&place(program)) {
                program.outcome = Outcome::Different;
                (program.witness, program.run_alone) = (Some(witness.clone()), *run_alone);
            }
        }
        certificate.sum_up();
    }
}
