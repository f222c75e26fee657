//! One run of a program and of its counterpart, to be looked at.
//!
//! The circumstances in which a difference was found come first; else the first scenarios of the search are tried. The
//! machine's zero is the part's, and tools have no size: positions then are those that the program says. Kept is the run that
//! shows most. Runs are bounded in steps and events, not in
//! time, so that the same programs give the same picture.

use super::listed::{Places, without_sizes};
use super::verifier::Verifier;
use crate::control::scenario::Scenario;
use crate::control::trace::EventKind;
use crate::control::{End, ProgramRef, Run};
use crate::verify::certificate::{Listing, Witness};
use crate::verify::explore::{Proposals, inputs, inputs_of_both, unit};
use crate::verify::sides::Job;
use std::collections::BTreeMap;

/// Scenarios that are tried.
const TRIES: usize = 6;

/// Blocks that a run executes at the most, and events that it records.
const STEPS: u64 = 20_000;
const EVENTS: usize = 20_000;

/// A run of a program beside one of its counterpart.
#[derive(Clone, Debug)]
pub struct Picture {
    /// What the source met.
    pub scenario: Scenario,
    /// What the source did.
    pub source: Run,
    /// What the target did; none where the program has no counterpart.
    pub target: Option<Run>,
    /// The places at which the two differ in that run, whatever excuses them.
    pub apart: Listing,
}

/// Runs a program of the source and its counterpart in the scenario that shows most; if they differ in that of the `witness`,
/// in that one. `most` places are listed at which they differ.
pub fn pictured(
    job: &Job<'_>,
    program: ProgramRef,
    witness: Option<&Witness>,
    most: usize,
) -> Option<Picture> {
    let mut verifier = Verifier::new(job, program);
    let there = job.names.program(job.source, program, job.target);
    if let (Some(there), Some(witness)) = (there, witness) {
        verifier.theirs = witness.target_variables.clone();
        // Sizes of tools and offsets may be what makes the difference.
        for scenario in [without_sizes(&witness.scenario), witness.scenario.clone()] {
            let scenario = bounded(scenario);
            let source = verifier.run_source(&scenario);
            let picture = verifier.beside(there, scenario, source, most);
            if picture.apart.differing > 0 {
                return Some(picture);
            }
        }
    }
    let (scenario, source) = verifier.most_telling(there)?;
    Some(match there {
        Some(there) => verifier.beside(there, scenario, source, most),
        None => Picture { scenario, source, target: None, apart: Listing::default() },
    })
}

/// No more than a picture needs.
fn bounded(mut scenario: Scenario) -> Scenario {
    (scenario.steps, scenario.events, scenario.milliseconds) = (STEPS, EVENTS, None);
    scenario
}

impl Verifier<'_, '_> {
    /// Runs the counterpart beside a run of the program.
    fn beside(&mut self, there: ProgramRef, scenario: Scenario, source: Run, most: usize) -> Picture {
        let circumstances = self.circumstances(&scenario, &source);
        let target = self.job.target.run(there, &circumstances);
        let mut places = Places::new(most);
        places.listing.scenarios = 1;
        let differs = self.list_pair(&source, &target, &mut places, true);
        places.listing.differing = usize::from(differs);
        Picture { scenario, source, target: Some(target), apart: places.end() }
    }

    /// Of the first scenarios the one in which the source does most, and what it does there.
    fn most_telling(&mut self, there: Option<ProgramRef>) -> Option<(Scenario, Run)> {
        let (source, target) = (self.job.source, self.job.target);
        let found = match there {
            Some(there) => inputs_of_both(
                (source, self.program),
                (target, there),
                self.job.names,
                (self.called, self.arguments.as_ref()),
            ),
            None => inputs(source, self.program, target),
        };
        let inch = unit(source, target).or(found.inch);
        let mut proposals = Proposals::new(&found, self.job.effort);
        let supposed = self.supposed();
        type Best = ((bool, usize), Scenario, Run, BTreeMap<String, f64>);
        let mut best: Option<Best> = None;
        for _ in 0..TRIES {
            let Some(mut scenario) = proposals.next() else { break };
            scenario.inch = inch;
            self.given.start(&mut scenario);
            supposed.of_machine(&mut scenario);
            let scenario = bounded(without_sizes(&scenario));
            let run = self.run_source(&scenario);
            let shows = (run.end == End::Ended, moves(&run));
            if best.as_ref().is_none_or(|(before, ..)| *before < shows) {
                best = Some((shows, scenario, run, proposals.theirs().clone()));
            }
        }
        let (_, scenario, run, theirs) = best?;
        self.theirs = theirs;
        Some((scenario, run))
    }
}

/// How many moves a run has.
fn moves(run: &Run) -> usize {
    let is_move = |what: &EventKind| {
        use EventKind::{Arc, Feed, Probe, Rapid, Thread};
        matches!(what, Rapid { .. } | Feed { .. } | Arc { .. } | Thread { .. } | Probe { .. })
    };
    run.events.iter().filter(|event| is_move(&event.what)).count()
}
