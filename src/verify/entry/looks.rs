//! A few runs of programs, which show what they call.

use crate::control::{ProgramRef, Run, Scenario};
use crate::verify::explore::{Proposals, inputs, unit};
use crate::verify::sides::{EntryState, Job};
use std::collections::BTreeSet;

/// Runs in which a program shows what it calls.
pub const LOOKS: usize = 3;

/// Whether a program is one that no other enters, as far as a few runs show.
pub fn is_root(job: &Job<'_>, program: &ProgramRef) -> bool {
    let all = job.source.links().programs().iter();
    let entered =
        job.source.entered.get_or_init(|| all.flat_map(|caller| entered_by(job, *caller)).collect());
    !entered.contains(program)
}

/// The other programs that a few runs of a program enter.
pub fn entered_by(job: &Job<'_>, caller: ProgramRef) -> BTreeSet<ProgramRef> {
    let mut entered = BTreeSet::new();
    // Most programs of a shop call nothing.
    if !job.source.links().may_call(caller) {
        return entered;
    }
    let runs = scenarios(job, caller, LOOKS);
    runs.for_each(|(_, run)| entered.extend(job.source.links().entries(&run).into_keys()));
    entered.remove(&caller);
    entered
}

/// Circumstances of a program, and its runs in them.
pub fn scenarios<'j>(
    job: &'j Job<'_>,
    program: ProgramRef,
    runs: usize,
) -> impl Iterator<Item = (Scenario, Run)> + 'j {
    scenarios_in(job, program, runs, None)
}

/// The same, begun as its own callers let it begin.
pub fn scenarios_in<'j>(
    job: &'j Job<'_>,
    program: ProgramRef,
    runs: usize,
    given: Option<&'j EntryState>,
) -> impl Iterator<Item = (Scenario, Run)> + 'j {
    let inputs = inputs(job.source, program, job.target);
    let inch = unit(job.source, job.target).or(inputs.inch);
    let mut proposals = Proposals::new(&inputs, job.effort);
    std::iter::from_fn(move || proposals.next()).take(runs).map(move |mut scenario| {
        scenario.inch = inch;
        given.into_iter().for_each(|given| given.start(&mut scenario));
        scenario.as_stated = job.as_stated(program);
        let run = (job.source.execute)(&job.source.library, program, job.source.control, &scenario);
        (scenario, run)
    })
}
