//! When a search may end with ways left: no circumstances that it can make send a run there.

use super::verifier::Verifier;
use crate::control::{ProgramRef, Run, Scenario};
use crate::ir::flag_of;
use crate::verify::explore::{Inputs, is_settled};
use crate::verify::sides::Job;
use std::collections::BTreeSet;

/// Runs that are looked at: where one is stopped by its control, another may come to its end.
const LOOKS: usize = 3;

/// What is known of a search so far.
#[derive(Debug, Default)]
pub(super) struct Settled {
    looks: usize,
    is_known: bool,
}

impl Settled {
    /// True if all runs of the search take one way.
    pub(super) fn is_known(&self) -> bool {
        self.is_known
    }
}

impl Verifier<'_, '_> {
    /// True if every run of this search, on either side, takes the way that this one came to its end by.
    pub(super) fn is_settled(
        &self,
        settled: &mut Settled,
        (scenario, run): (&Scenario, &Run),
        there: ProgramRef,
        found: &Inputs,
    ) -> bool {
        if settled.is_known || settled.looks >= LOOKS {
            return settled.is_known;
        }
        settled.looks += 1;
        let Job { source, target, names, .. } = *self.job;
        let started = |theirs: bool| found.variables.iter().filter(move |input| input.theirs == theirs);
        let ours: BTreeSet<&str> = started(false).map(|input| input.name.as_str()).collect();
        if !is_settled(source, run, &|name| ours.contains(name)) {
            return false;
        }
        let circumstances = self.circumstances(scenario, run);
        let named = |name: &str| names.variable(name, source.control, target.control);
        let mut free: BTreeSet<String> = ours.iter().filter_map(|name| named(name)).collect();
        free.extend(ours.iter().filter_map(|name| named(&flag_of(name))));
        free.extend(started(true).map(|input| input.name.clone()));
        let other = target.run(there, &circumstances);
        settled.is_known = is_settled(target, &other, &|name| free.contains(name));
        settled.is_known
    }
}
