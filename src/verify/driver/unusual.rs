//! Ways that a program goes only in circumstances that its library never shows: an input that changes between two looks at
//! it, or a mode that the program asks for and that none of its callers leaves in force.
//!
//! What both sides do alike then is compared as anything else is. A difference is not held against the conversion, for it
//! was made for a machine that is never so: the way stays one that was not reached.

use super::verifier::{Pair, Verifier};
use crate::canon::{Group, Sys};
use crate::control::{ProgramRef, Run, Scenario};
use crate::verify::compare::is_cut;
use crate::verify::entry::{Start, starts};
use crate::verify::explore::{Circumstances, Inputs};
use crate::verify::sides::EntryState;

/// Circumstances from which it is tried, at the most.
const STARTS: usize = 24;

/// How many such things may be so at once.
const TOGETHER: usize = 2;

/// Looks at inputs before which they change.
const LOOKS: std::ops::RangeInclusive<u32> = 2..=4;

/// Something that the library never shows.
enum Unusual {
    /// Inputs change before this look at them.
    InputsChange(u32),
    /// The other unit is in force.
    Unit,
    /// Another mode is in force.
    Mode(&'static Start),
}

impl Verifier<'_, '_> {
    /// Tries circumstances once more with each of these, as long as ways are left, and goes on from those that lead further.
    pub(super) fn try_unusual(&mut self, there: ProgramRef, found: &Inputs, tried: &[Circumstances]) {
        self.is_unusual = true;
        let mut tried = tried.to_vec();
        let all = self.unusual(found);
        // One may show only where another one is so too.
        for unusual in (0..TOGETHER).flat_map(|_| &all) {
            let given = self.given.clone();
            let mut came = Vec::new();
            // Those that came last went ways that the first did not.
            for start in tried.iter().rev().take(STARTS) {
                if self.went_every_way() || self.witness.is_some() || self.is_spent() {
                    break;
                }
                let mut start = start.clone();
                start.scenario.nearness = false;
                self.theirs = start.theirs.clone();
                self.put(unusual, &given, &mut start.scenario);
                let run = self.run_source(&start.scenario);
                self.steps += run.steps;
                let new = self.coverage.has_new(&run);
                if self.goes_alike(&start.scenario, &run, there) && new {
                    came.push(start);
                }
            }
            if !came.is_empty() && !self.went_every_way() {
                came = self.steer(there, found, came);
            }
            tried.extend(came);
            self.given = given;
        }
        self.is_unusual = false;
    }

    /// What the program asks for that may be so.
    fn unusual(&self, found: &Inputs) -> Vec<Unusual> {
        let reads = |wanted: &dyn Fn(Sys) -> bool| found.cells.keys().any(|(state, _)| wanted(*state));
        let asks = |group: Group| {
            let of_group = |subscripts: &[u32]| group.number().is_some_and(|number| *subscripts == [number]);
            found.cells.keys().any(|(state, subscripts)| *state == Sys::Modal && of_group(subscripts))
        };
        let changes = LOOKS.filter(|_| reads(&|state| matches!(state, Sys::Input | Sys::InputInverted)));
        let unit = asks(Group::Units).then_some(Unusual::Unit);
        let modes =
            if reads(&|state| state == Sys::Modal) { starts(self.job, self.program) } else { Vec::new() };
        let asked = modes.into_iter().filter(|start| start.group().is_some_and(asks));
        changes.map(Unusual::InputsChange).chain(unit).chain(asked.map(Unusual::Mode)).collect()
    }

    /// Puts one of these into a scenario.
    fn put(&mut self, unusual: &Unusual, given: &EntryState, scenario: &mut Scenario) {
        match unusual {
            Unusual::InputsChange(look) => scenario.inputs_change_at = Some(*look),
            Unusual::Unit => {
                let inch = !given.inch().or(scenario.inch).unwrap_or(false);
                scenario.inch = Some(inch);
                self.given = given.in_unit(inch);
            }
            Unusual::Mode(start) => {
                start.put(scenario);
                scenario.as_stated.retain(|group| Some(*group) != start.group());
            }
        }
    }

    /// Runs the target too. The ways that both go count if they do the same.
    pub(super) fn goes_alike(&mut self, scenario: &Scenario, run: &Run, there: ProgramRef) -> bool {
        let circumstances = self.circumstances(scenario, run);
        let other = self.job.target.run(there, &circumstances);
        self.steps += other.steps;
        let pair = Pair { scenario, run, there, circumstances: &circumstances, other: &other };
        let is_alike = !is_cut(run) && !is_cut(&other) && self.fault(&pair).is_ok();
        if is_alike {
            self.went_alike(&pair);
        }
        is_alike
    }
}
