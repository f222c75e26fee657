//! A program as those of its library call it.
//!
//! Its callers give a program its arguments and the modes it runs in, and a conversion may rest on that. Run by
//! itself, in circumstances that no caller makes, it may then do something else.

use super::compare::{Tolerance, compare};
use super::inputs::inputs;
use super::program::Job;
use super::scenarios::{Proposals, on_target, unit};
use crate::control::{End, ProgramRef, Run, Scenario};
use crate::syntax::ProgramName;
use std::collections::BTreeSet;

/// Runs of each caller.
const RUNS: usize = 12;
/// Runs in which a program shows what it calls.
const LOOKS: usize = 3;

/// Whether the runs that come through a program do the same on the target where they begin in programs
/// that nothing calls; none where no such run comes through it.
pub fn do_the_same(job: &Job<'_>, program: ProgramRef, tolerance: Tolerance) -> Option<bool> {
    let all = job.source.programs();
    let called = |run: &Run| all.iter().copied().filter(|other| enters(job, run, *other)).collect::<Vec<_>>();
    let mut entered = BTreeSet::new();
    for caller in &all {
        let runs = scenarios(job, *caller).take(LOOKS).flat_map(|(_, run)| called(&run));
        entered.extend(runs.filter(|other| other != caller));
    }
    let mut found = None;
    for caller in all.iter().filter(|caller| **caller != program && !entered.contains(caller)) {
        let Some(there) = job.names.program(job.source, *caller, job.target) else { continue };
        for (scenario, run) in scenarios(job, *caller).take(RUNS) {
            if run.end != End::Ended || !enters(job, &run, program) {
                continue;
            }
            let circumstances = on_target(&scenario, job.names, (job.source, job.target), false);
            let other = (job.target.execute)(job.target.files, there, job.target.control, &circumstances);
            let compared = compare((job.source, &run), (job.target, &other), job.names, tolerance);
            if compared.difference.or(compared.hair).is_some() {
                return Some(false);
            }
            found = Some(true);
        }
    }
    found
}

/// Circumstances of a program, and its runs in them.
fn scenarios<'j>(job: &'j Job<'_>, program: ProgramRef) -> impl Iterator<Item = (Scenario, Run)> + 'j {
    let inputs = inputs(job.source, program);
    let mut proposals: Vec<Scenario> = Vec::new();
    let mut proposed = Proposals::new(&inputs, job.effort);
    while proposals.len() < RUNS
        && let Some(mut scenario) = proposed.next()
    {
        scenario.inch = unit(job.source, job.target).or(inputs.inch);
        proposals.push(scenario);
    }
    proposals.into_iter().map(move |scenario| {
        let run = (job.source.execute)(job.source.files, program, job.source.control, &scenario);
        (scenario, run)
    })
}

/// True where a run came through a program.
fn enters(job: &Job<'_>, run: &Run, program: ProgramRef) -> bool {
    let Some(ProgramName::Number(number)) = job.source.name(program) else { return false };
    let name = format!("O{number}");
    run.programs.iter().any(|other| other.file == program.file && other.name == name)
}
