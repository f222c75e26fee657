//! What a program and its conversion do in the telling scenarios with one thing otherwise.
//!
//! The switches that skip blocks are set in each of their ways, and something stands in every common variable: what one
//! side alone clears, or skips, shows then.

use super::verifier::{Pair, Verifier};
use crate::control::{ProgramRef, Scenario};
use crate::verify::compare::is_cut;
use crate::verify::sides::Side;
use std::collections::{BTreeMap, BTreeSet};

impl Verifier<'_, '_> {
    /// Tries the telling scenarios so. What callers leave in registers of the target alone is theirs to see to.
    pub(super) fn otherwise(&mut self, there: ProgramRef) {
        if self.witness.is_some() || self.telling.is_empty() {
            return;
        }
        let switches: BTreeSet<u32> = self.skips.iter().copied().collect();
        let [ours, theirs] = [commons(self.job.source), self.registers()].map(|all| self.may_be_meant(all));
        for (scenario, registers) in self.telling.clone() {
            if self.is_out_of_time() {
                break;
            }
            self.theirs = registers;
            for block_skip in switches.iter().copied().filter(|setting| *setting != scenario.block_skip) {
                self.once_more(&Scenario { block_skip, ..scenario.clone() }, there);
            }
            self.theirs = filled(&theirs, &self.theirs);
            let variables = filled(&ours, &scenario.variables);
            self.once_more(&Scenario { variables, ..scenario }, there);
        }
        self.theirs.clear();
    }

    /// Runs both sides; only what differs is kept, and the ways that they go while they do the same.
    pub(super) fn once_more(&mut self, scenario: &Scenario, there: ProgramRef) {
        if self.witness.is_some() {
            return;
        }
        let target = self.job.target;
        let run = self.run_source(scenario);
        let circumstances = self.circumstances(scenario, &run);
        let other = target.run(there, &circumstances);
        if is_cut(&run) || is_cut(&other) {
            return;
        }
        let pair = Pair { scenario, run: &run, there, circumstances: &circumstances, other: &other };
        match self.fault(&pair) {
            Ok(()) => self.went_alike(&pair),
            Err(Some(difference)) => self.witnessed(&pair, &difference),
            Err(None) => {}
        }
    }

    /// The common registers of the target that hold no variable of the source and that the conversion did not name.
    fn registers(&self) -> Vec<(String, u32)> {
        let (source, target, names) = (self.job.source.control, self.job.target.control, self.job.names);
        if self.called {
            return Vec::new();
        }
        let mut all = commons(self.job.target);
        all.retain(|(name, _)| {
            !names.is_named(name, target) && names.of_source(name, source, target).is_none()
        });
        all
    }

    /// Those of some variables that a text of either side may mean, with a value of its own for each. Where nobody can, it
    /// makes no difference what they hold.
    fn may_be_meant(&self, all: Vec<(String, u32)>) -> Vec<(String, f64)> {
        let sides = [self.job.source, self.job.target].map(Side::numbers);
        let all = all.into_iter().enumerate();
        let meant = all.filter(|(at, (_, number))| sides.iter().any(|side| side.may_mean(*number, *at)));
        meant.map(|(at, (name, _))| (name, 1.5 + 0.25 * at as f64)).collect()
    }
}

/// The names of the variables that outlive a program and may hold what another one left.
pub(super) fn commons(side: &Side<'_>) -> Vec<(String, u32)> {
    let classes = side.control.classes().iter();
    let shared = classes.filter(|row| matches!(row.class.as_str(), "common" | "retained"));
    let all = shared.flat_map(|row| (row.first..=row.last).map(move |number| (&row.name, number)));
    all.map(|(name, number)| (format!("{name}{number}"), number)).collect()
}

/// These values in these variables, but for those that hold something already.
pub(super) fn filled(values: &[(String, f64)], held: &BTreeMap<String, f64>) -> BTreeMap<String, f64> {
    values.iter().cloned().chain(held.iter().map(|(name, value)| (name.clone(), *value))).collect()
}
