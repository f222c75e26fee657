//! What a called program finds in force at its start.

use crate::canon::{Group, Op};
use crate::control::Scenario;
use crate::control::entry::{Drilling, Entry};
use std::collections::BTreeSet;

/// What the callers of a program give it, as far as their runs show.
#[derive(Clone, Debug, Default)]
pub struct EntryState {
    /// What is in force at its start whoever calls it: of each group of [`crate::control::machine::GIVEN`] at the most
    /// one.
    pub modes: Vec<Op>,
    /// What else all of them come in with each time: no work offset, a tool length, a spindle that runs.
    pub entry: Entry,
    /// A drilling cycle that is in force each time, if there is one: it is begun in one only if that makes a difference.
    pub cycle: Option<Drilling>,
    /// The units that they come in, true for inch.
    units: BTreeSet<bool>,
    /// True once anything is known of it.
    any: bool,
    /// True where no run came to it: then it is what was in force where the runs of its callers ended.
    pub never_come_to: bool,
}

impl EntryState {
    /// Of a program that no run came to.
    pub fn not_come_to() -> Self {
        Self { never_come_to: true, ..Self::default() }
    }

    /// True where callers are known.
    pub fn is_known(&self) -> bool {
        self.any
    }

    /// Takes in what another run gives.
    pub fn add(&mut self, modes: &[Op], entry: &Entry) {
        if !std::mem::replace(&mut self.any, true) {
            (self.modes, self.entry) = (modes.to_vec(), entry.clone());
            self.cycle = entry.cycle;
        }
        self.entry.keep_common(entry);
        self.entry.cycle = None;
        self.cycle = self.cycle.filter(|_| entry.cycle.is_some());
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

    /// The same with a drilling cycle in force, if there is one each time.
    pub fn in_cycle(&self) -> Option<Self> {
        let cycle = self.cycle?;
        Some(Self { entry: Entry { cycle: Some(cycle), ..self.entry.clone() }, ..self.clone() })
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
        let length_changed = self.entry.length_changed;
        let kept = Entry { work, ..Entry::default() };
        if length_lost || length_moved || length_changed {
            let lost = Entry { length_lost, length_moved, length_changed, length_across, ..kept };
            return Entry { length, length_minus, ..lost };
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
