//! What a verification is asked: two sides, what is known of the conversion, and how much may be done.

use super::clock::Spent;
use super::side::Side;
use super::symbol_map::SymbolMap;
use crate::assume::{Assumption, Predicate};
use crate::canon::Group;
use crate::control::ProgramRef;
use std::collections::BTreeMap;
use std::sync::Arc;

/// What a conversion supposes, by program of the source.
pub type Assumptions = BTreeMap<ProgramRef, Vec<Assumption>>;

/// What is to be compared.
pub struct Job<'j> {
    /// The source.
    pub source: &'j Side<'j>,
    /// The target.
    pub target: &'j Side<'j>,
    /// What is called what.
    pub names: &'j SymbolMap,
    /// What the conversion supposes: a person looks at that whatever is found here.
    pub assumptions: &'j Assumptions,
    /// How much may be done.
    pub effort: Effort,
    /// What was done for other programs.
    pub spent: &'j Spent,
}

impl Job<'_> {
    /// The groups of which a program begins in what the profiles of the machines say.
    pub fn as_stated(&self, program: ProgramRef) -> Vec<Group> {
        let all = self.assumptions.get(&program).into_iter().flatten();
        let ops = all.filter_map(|one| match &one.predicate {
            Predicate::Start(ops) => Some(ops.iter().map(|op| op.group())),
            _ => None,
        });
        ops.flatten().collect()
    }
}

/// How much a verification may do.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Scenarios that are compared, at the most.
    pub scenarios: usize,
    /// Scenarios that are compared even if nothing is left to be reached.
    pub fewest: usize,
    /// Scenarios that are compared in all while the telling ones come, if nothing is left to be reached.
    pub telling: usize,
    /// Of the scenarios that go no new way, those that are also run with errors of the last digits that are drawn.
    pub drawn: usize,
    /// Scenarios that the source is tried with in search of new branches, at the most.
    pub tries: usize,
    /// Blocks that a run executes, at the most.
    pub steps: u64,
    /// Blocks that all runs of a program's source execute together, at the most.
    pub all_steps: u64,
    /// Seed of the scenarios that are drawn.
    pub seed: u64,
    /// Seconds of processor time for one program, at the most.
    pub program_seconds: f64,
    /// Seconds of processor time for all programs of a library together, at the most.
    pub library_seconds: f64,
    /// Millimetres that places may lie apart and count as the same, whatever words round.
    pub allowed_mm: f64,
}

impl Default for Effort {
    fn default() -> Self {
        Self {
            scenarios: 160,
            fewest: 16,
            telling: usize::MAX,
            drawn: usize::MAX,
            tries: 400,
            steps: 50_000,
            all_steps: 1_000_000,
            seed: 0x6d67_0001,
            program_seconds: 60.0,
            library_seconds: 3600.0,
            allowed_mm: 0.0,
        }
    }
}

/// The programs of the target that a program of the source became: its own, and those that this calls and that no
/// program of the source became.
pub fn of_target(job: &Job<'_>, program: ProgramRef) -> Vec<ProgramRef> {
    let Job { source, target, names, .. } = *job;
    let became = |program: ProgramRef| names.program(source, program, target);
    let all = || source.links().programs().iter().copied();
    let others = || target.became.get_or_init(|| Arc::new(all().filter_map(became).collect()));
    let own = became(program).map(|own| target.links().called_from(own, |called| !others().contains(called)));
    own.unwrap_or_default()
}
