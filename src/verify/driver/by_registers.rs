//! A difference of a program that is given arguments, on a target whose calls give none, where no caller can be run.
//!
//! Its callers write the arguments into registers, and which ones their conversions alone know. A caller that was refused
//! has none: run by itself, the program finds nothing in them. What it does otherwise than the source is its callers' matter if
//! it would do something else with something in them; else it is a fault of its own.

use super::otherwise::{commons, filled};
use super::summary::lacks_locals;
use super::verifier::{Pair, Verifier};
use crate::control::trace::Event;
use crate::control::{ProgramRef, Run, Scenario};
use crate::verify::certificate::Witness;
use crate::verify::compare::compare;
use crate::verify::sides::SymbolMap;
use crate::verify::triage::Through;
use std::collections::BTreeMap;

impl Verifier<'_, '_> {
    /// Why a difference is no fault, in words, where registers that no caller has set decide it; none if they do not.
    pub(super) fn by_registers(
        &mut self,
        witness: &Witness,
        through: &Through,
        there: ProgramRef,
    ) -> Option<String> {
        if !lacks_locals(self.job) || !through.is_absent() || !self.takes_arguments() {
            return None;
        }
        self.theirs = witness.target_variables.clone();
        let rests = self.rests_on_registers(&witness.scenario, there);
        let absent = through.absent.iter().cloned().collect::<Vec<_>>().join(", ");
        rests.then(|| {
            format!(
                "what its callers give it stands in registers there, and {absent}, which calls it, has no conversion \
                 that could be run"
            )
        })
    }

    /// True if the target does something else, where it differs or before, with other values in registers that nothing
    /// has set.
    fn rests_on_registers(&self, scenario: &Scenario, there: ProgramRef) -> bool {
        let target = self.job.target;
        let run = self.run_source(scenario);
        let circumstances = self.circumstances(scenario, &run);
        let other = target.run(there, &circumstances);
        let pair = Pair { scenario, run: &run, there, circumstances: &circumstances, other: &other };
        let Err(Some(difference)) = self.fault(&pair) else { return false };
        let values = commons(target).into_iter().enumerate();
        let values: Vec<(String, f64)> =
            values.map(|(at, (name, _))| (name, 1.5 + 0.25 * at as f64)).collect();
        let variables = filled(&values, &circumstances.variables);
        let mut begun = target.run(there, &Scenario { variables, ..circumstances.clone() });
        // What it leaves alone is nothing that it did.
        let left: BTreeMap<&str, f64> = values.iter().map(|(name, value)| (name.as_str(), *value)).collect();
        begun.variables.retain(|name, value| left.get(name.as_str()) != Some(value));
        let found = compare((target, &other), (target, &begun), &SymbolMap::default(), self.tolerance);
        let apart = found.hair.or(found.difference);
        apart.is_some_and(|apart| place(&other, apart.source) <= place(&other, difference.target))
    }
}

/// The place of an event in a run; its end for none.
fn place(run: &Run, event: Option<&Event>) -> usize {
    let is = |other: &Event| event.is_some_and(|event| std::ptr::eq(event, other));
    run.events.iter().position(is).unwrap_or(run.events.len())
}
