//! What a called program finds in force at its start.

use super::callers::{LOOKS, is_root, scenarios_in};
use super::program::Job;
use crate::canon::{Group, Op};
use crate::control::entry::Entry;
use crate::control::{ProgramRef, Scenario, trace};
use std::collections::{BTreeMap, BTreeSet};

/// The most runs of a caller, where fewer do not come to all that its text calls.
const MORE_LOOKS: usize = 24;

/// What the callers of a program give it, as far as their runs show.
#[derive(Clone, Debug, Default)]
pub struct EntryState {
    /// What is in force at its start whoever calls it: of each group of [`crate::control::machine::GIVEN`] at the most
    /// one.
    pub modes: Vec<Op>,
    /// What else all of them come in with each time: no work offset, a tool length, a spindle that runs.
    pub entry: Entry,
    /// The units that they come in, true for inch.
    units: BTreeSet<bool>,
    /// True once anything is known of it.
    any: bool,
    /// True where no run came to it: then it is what was in force where the runs of its callers ended.
    pub never_come_to: bool,
}

impl EntryState {
    /// Takes in what another run gives.
    fn add(&mut self, modes: &[Op], entry: &Entry) {
        if !std::mem::replace(&mut self.any, true) {
            (self.modes, self.entry) = (modes.to_vec(), entry.clone());
        }
        self.entry.keep_common(entry);
        self.modes.retain(|op| modes.contains(op));
        self.units.extend(modes.iter().filter(|op| op.group() == Group::Units).map(|op| *op == Op::Inch));
    }

    /// The unit, true for inch; none if callers come in both.
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

    /// The same where moves are straight cuts.
    pub fn in_straight_cut(&self) -> Self {
        let others = self.modes.iter().copied().filter(|op| op.group() != Group::Motion);
        Self { modes: others.chain([Op::Linear]).collect(), ..self.clone() }
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
        scenario.entry = self.entry.clone();
    }

    /// What is in force on a machine that nobody has started. A work offset that is cancelled, and a tool length that may
    /// be, stay so: no machine is switched on like that.
    pub fn unstarted(&self) -> Entry {
        let Entry { work, length, length_minus, length_lost, length_moved, length_across, .. } = self.entry;
        let kept = Entry { work, ..Entry::default() };
        if length_lost || length_moved {
            return Entry { length, length_minus, length_lost, length_moved, length_across, ..kept };
        }
        kept
    }

    /// What of it such a machine has not, in words; the feed, which every program has, left out.
    pub fn started(&self) -> Vec<&'static str> {
        let (given, entry) = (&self.entry, self.unstarted());
        let all = [
            (given.length != entry.length, "a tool length in force"),
            (given.cutter.is_some(), "cutter compensation in force"),
            (given.spindle.is_some(), "the spindle running"),
            (given.coolant, "the coolant on"),
        ];
        all.into_iter().filter(|(is_given, _)| *is_given).map(|(_, words)| words).collect()
    }
}

/// By program, what its callers' runs give it when they come to it first.
///
/// Programs that none calls give first; then, in what they are given themselves, those that these enter give to what
/// was not come to yet. One that no run comes to begins in what was in force where the runs of its callers ended.
pub fn given(job: &Job<'_>) -> BTreeMap<ProgramRef, EntryState> {
    given_by(job, |callers, gives| callers.iter().map(gives).collect())
}

/// What runs of a caller show.
pub(super) type Gives<'g> = dyn Fn(&ProgramRef) -> Shown + Sync + 'g;

/// The same where `all` says of callers, in their order, what their runs show.
pub(super) fn given_by(
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
                let given = ended
                    .entry(to)
                    .or_insert_with(|| EntryState { never_come_to: true, ..EntryState::default() });
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
pub(super) struct Shown {
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
