//! What the callers of a program give it, as their runs show.

use super::looks::{LOOKS, entered_by, is_root, scenarios_in};
use crate::canon::Op;
use crate::control::entry::Entry;
use crate::control::{ProgramRef, trace};
use crate::verify::sides::{EntryState, Job};
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};

/// The most runs of a caller, where fewer do not come to all that its text calls.
const MORE_LOOKS: usize = 24;

/// By program, what its callers' runs give it when they come to it first.
///
/// Programs that none calls give first; then, in what they are given themselves, those that these enter give to what
/// was not come to yet. One that no run comes to begins in what was in force where the runs of its callers ended.
pub fn given(job: &Job<'_>) -> BTreeMap<ProgramRef, EntryState> {
    given_by(job, |callers, gives| callers.iter().map(gives).collect())
}

/// Works out on all cores what callers give, if any of these programs is called. Programs that are verified side by side
/// would wait for the first of them to do it.
pub fn look_at_callers(job: &Job<'_>, programs: &[ProgramRef]) {
    let links = job.source.links();
    if job.source.given.get().is_some() || !programs.iter().any(|program| links.is_called(*program)) {
        return;
    }
    let entered = links.programs().par_iter().flat_map_iter(|caller| entered_by(job, *caller)).collect();
    let _ = job.source.entered.set(entered);
    let on_all_cores = |callers: &[ProgramRef], gives: &Gives<'_>| callers.par_iter().map(gives).collect();
    let _ = job.source.given.set(given_by(job, on_all_cores));
}

/// What runs of a caller show.
type Gives<'g> = dyn Fn(&ProgramRef) -> Shown + Sync + 'g;

/// The same where `all` says of callers, in their order, what their runs show.
fn given_by(
    job: &Job<'_>,
    all: impl Fn(&[ProgramRef], &Gives<'_>) -> Vec<Shown>,
) -> BTreeMap<ProgramRef, EntryState> {
    let links = job.source.links();
    let roots = || links.programs().iter().copied().filter(|program| is_root(job, program));
    let mut found: BTreeMap<ProgramRef, EntryState> = BTreeMap::new();
    let mut ended: BTreeMap<ProgramRef, EntryState> = BTreeMap::new();
    let mut gone: BTreeSet<ProgramRef> = BTreeSet::new();
    let mut callers: Vec<ProgramRef> = roots().filter(|program| !links.is_called(*program)).collect();
    loop {
        let mut came: BTreeMap<ProgramRef, EntryState> = BTreeMap::new();
        for shown in all(&callers, &|caller| gives(job, *caller, found.get(caller))) {
            for (to, ran) in shown.met {
                if !found.contains_key(&to) {
                    came.entry(to).or_default().add(&ran.modes, &ran.entry);
                }
            }
            for to in shown.missed {
                let given = ended.entry(to).or_insert_with(EntryState::not_come_to);
                shown.ends.iter().for_each(|modes| given.add(modes, &Entry::default()));
            }
        }
        gone.extend(callers);
        callers = came.keys().filter(|program| !gone.contains(program)).copied().collect();
        found.extend(came);
        if callers.is_empty() {
            ended.retain(|program, _| !found.contains_key(program) && !gone.contains(program));
            callers = ended.keys().copied().collect();
            found.append(&mut ended);
        }
        if callers.is_empty() {
            // They call each other in a circle, or a number that is no call has been taken for one.
            callers = roots().filter(|program| !gone.contains(program)).collect();
        }
        if callers.is_empty() {
            return found;
        }
    }
}

/// What the runs of a caller show of what it calls.
#[derive(Default)]
struct Shown {
    /// The programs that they come to, and what is in force there.
    met: Vec<(ProgramRef, trace::Program)>,
    /// Those that its text calls and no run comes to.
    missed: BTreeSet<ProgramRef>,
    /// What is in force where they end.
    ends: Vec<Vec<Op>>,
}

/// Runs a caller, more often where some that its text calls are not come to.
fn gives(job: &Job<'_>, caller: ProgramRef, given: Option<&EntryState>) -> Shown {
    let links = job.source.links();
    let callees = links.callees(caller).iter().copied().filter(|callee| *callee != caller);
    let mut shown = Shown { missed: callees.collect(), ..Shown::default() };
    if !links.may_call(caller) {
        return shown;
    }
    for (at, (_, run)) in scenarios_in(job, caller, MORE_LOOKS, given).enumerate() {
        if at >= LOOKS && shown.missed.is_empty() {
            break;
        }
        for (to, ran) in links.entries(&run).into_iter().filter(|(to, _)| *to != caller) {
            shown.missed.remove(&to);
            shown.met.push((to, ran.clone()));
        }
        shown.ends.push(run.modes);
    }
    shown
}
