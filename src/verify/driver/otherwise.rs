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
        let (ours, theirs) = (commons(self.job.source), self.registers());
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
            Ok(()) => {
                self.coverage.add(&run);
                self.target_coverage.add(&other);
            }
            Err(Some(difference)) => self.witnessed(&pair, &difference),
            Err(None) => {}
        }
    }

    /// The common registers of the target that hold no variable of the source and that the conversion did not name.
    fn registers(&self) -> Vec<String> {
        let (source, target, names) = (self.job.source.control, self.job.target.control, self.job.names);
        if self.called {
            return Vec::new();
        }
        let mut all = commons(self.job.target);
        all.retain(|name| !names.is_named(name, target) && names.of_source(name, source, target).is_none());
        all
    }
}

/// The names of the variables that outlive a program and may hold what another one left.
fn commons(side: &Side<'_>) -> Vec<String> {
    let classes = side.control.classes().iter();
    let shared = classes.filter(|row| matches!(row.class.as_str(), "common" | "retained"));
    shared.flat_map(|row| (row.first..=row.last).map(|number| format!("{}{number}", row.name))).collect()
}

/// Something in each of these variables, a value of its own, but for those that hold something already.
fn filled(names: &[String], held: &BTreeMap<String, f64>) -> BTreeMap<String, f64> {
    let values = names.iter().enumerate().map(|(at, name)| (name.clone(), 1.5 + 0.25 * at as f64));
    values.chain(held.iter().map(|(name, value)| (name.clone(), *value))).collect()
}
