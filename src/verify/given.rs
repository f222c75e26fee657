//! What a called program finds in force at its start.

use super::callers::{LOOKS, entry, roots, scenarios_in};
use super::inputs::calls;
use super::program::Job;
use crate::canon::{Group, Op};
use crate::control::{ProgramRef, Scenario};
use std::collections::{BTreeMap, BTreeSet};

/// The most runs of a caller, where fewer do not come to all that its text calls.
const MORE_LOOKS: usize = 24;

/// What the callers of a program give it, as far as their runs show.
#[derive(Clone, Debug, Default)]
pub struct Given {
    /// What is in force at its start whoever calls it: of each group of [`crate::control::machine::GIVEN`] at the most
    /// one.
    pub modes: Vec<Op>,
    /// The units that they come in, true for inch.
    units: BTreeSet<bool>,
    /// True once anything is known of it.
    any: bool,
    /// True where no run came to it: then it is what was in force where the runs of its callers ended.
    pub never_come_to: bool,
}

impl Given {
    /// Takes in what another run gives.
    fn add(&mut self, modes: &[Op]) {
        if !std::mem::replace(&mut self.any, true) {
            self.modes = modes.to_vec();
        }
        self.modes.retain(|op| modes.contains(op));
        self.units.extend(modes.iter().filter(|op| op.group() == Group::Units).map(|op| *op == Op::Inch));
    }

    /// The unit, true for inch; none where callers come in both.
    pub fn inch(&self) -> Option<bool> {
        self.modes.iter().find(|op| op.group() == Group::Units).map(|op| *op == Op::Inch)
    }

    /// The units that callers come in, where they come in both.
    pub fn both_units(&self) -> impl Iterator<Item = bool> + '_ {
        self.units.iter().copied().filter(|_| self.units.len() > 1)
    }

    /// The same in one unit.
    pub fn in_unit(&self, inch: bool) -> Self {
        let others = self.modes.iter().copied().filter(|op| op.group() != Group::Units);
        let unit = if inch { Op::Inch } else { Op::Metric };
        Self { modes: std::iter::once(unit).chain(others).collect(), ..self.clone() }
    }

    /// The unit alone, all else as after power-on.
    pub fn unit_alone(&self) -> Self {
        let units = self.modes.iter().copied().filter(|op| op.group() == Group::Units);
        Self { modes: units.collect(), ..self.clone() }
    }

    /// The modes that are not those of power-on, the unit left out.
    pub fn unlike_power_on(&self) -> Vec<Op> {
        let usual = [Op::Rapid, Op::Absolute, Op::PlaneXy, Op::FeedPerMinute];
        let other = |op: &&Op| op.group() != Group::Units && !usual.contains(op);
        self.modes.iter().filter(other).copied().collect()
    }

    /// Lets a scenario start so.
    pub fn start(&self, scenario: &mut Scenario) {
        scenario.inch = self.inch().or(scenario.inch);
        scenario.modes = self.unlike_power_on();
    }
}

/// By program, what its callers' runs give it when they come to it first.
///
/// Programs that none calls give first; then, in what they are given themselves, those that these enter give to what
/// was not come to yet. One that no run comes to begins in what was in force where the runs of its callers ended.
pub fn given(job: &Job<'_>) -> BTreeMap<ProgramRef, Given> {
    let all = job.source.programs();
    let callees = |program| {
        let blocks = job.source.text(program).iter();
        let to = blocks.flat_map(|block| calls(job.source, &block.items));
        to.filter(|to| *to != program).collect::<BTreeSet<_>>()
    };
    let callees: BTreeMap<ProgramRef, BTreeSet<ProgramRef>> =
        all.iter().map(|program| (*program, callees(*program))).collect();
    let called: BTreeSet<ProgramRef> = callees.values().flatten().copied().collect();
    let is_root = roots(job, &all);
    let mut found: BTreeMap<ProgramRef, Given> = BTreeMap::new();
    let mut ended: BTreeMap<ProgramRef, Given> = BTreeMap::new();
    let mut gone: BTreeSet<ProgramRef> = BTreeSet::new();
    let mut callers: Vec<ProgramRef> =
        all.iter().filter(|program| is_root(program) && !called.contains(program)).copied().collect();
    loop {
        let mut came: BTreeMap<ProgramRef, Given> = BTreeMap::new();
        for caller in &callers {
            let shown = gives(job, &all, *caller, &callees[caller], found.get(caller));
            for (to, modes) in shown.met {
                if !found.contains_key(&to) {
                    came.entry(to).or_default().add(&modes);
                }
            }
            for to in shown.missed {
                let given =
                    ended.entry(to).or_insert_with(|| Given { never_come_to: true, ..Given::default() });
                shown.ends.iter().for_each(|modes| given.add(modes));
            }
        }
        gone.extend(callers);
        found.extend(came);
        let next = |found: &BTreeMap<ProgramRef, Given>| -> Vec<ProgramRef> {
            found.keys().filter(|program| !gone.contains(program)).copied().collect()
        };
        callers = next(&found);
        if callers.is_empty() {
            ended.retain(|program, _| !found.contains_key(program) && !gone.contains(program));
            found.append(&mut ended);
            callers = next(&found);
        }
        if callers.is_empty() {
            // They call each other in a circle, or a number that is no call has been taken for one.
            callers =
                all.iter().filter(|program| !gone.contains(*program) && is_root(program)).copied().collect();
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
    met: Vec<(ProgramRef, Vec<Op>)>,
    /// Those that its text calls and no run comes to.
    missed: BTreeSet<ProgramRef>,
    /// What is in force where they end.
    ends: Vec<Vec<Op>>,
}

/// Runs a caller, more often where some that its text calls are not come to.
fn gives(
    job: &Job<'_>,
    all: &[ProgramRef],
    caller: ProgramRef,
    callees: &BTreeSet<ProgramRef>,
    given: Option<&Given>,
) -> Shown {
    let mut shown = Shown { missed: callees.clone(), ..Shown::default() };
    for (at, (_, run)) in scenarios_in(job, caller, MORE_LOOKS, given).enumerate() {
        if at >= LOOKS && shown.missed.is_empty() {
            break;
        }
        for to in all.iter().filter(|program| **program != caller) {
            if let Some(entered) = entry(job, &run, *to) {
                shown.missed.remove(to);
                shown.met.push((*to, entered.modes.clone()));
            }
        }
        shown.ends.push(run.modes);
    }
    shown
}
