//! The search for scenarios: in which both sides go every way that they can.

use super::settled::Settled;
use super::verifier::Verifier;
use crate::canon::{Role, Sys};
use crate::control::{End, ProgramRef, Run, Scenario};
use crate::dialect::{Axis, Machine};
use crate::verify::certificate::Why;
use crate::verify::compare::{is_cut, returns};
use crate::verify::explore::{Circumstances, Proposals, inputs_of_both, unit};
use crate::verify::sides::{Effort, Job, Side};
use crate::verify::triage::telling_numbers;

/// How much longer the first run may be where it comes to no end, and how much shorter the others are while none does.
const LONGER: u64 = 5;
const SHORTER: u64 = 5;

/// Runs of which none can be compared to its end before a program with no ways left is given up.
const BARREN: usize = 48;

/// How often a run may execute each block of a long program, on the average.
const EACH_BLOCK: u64 = 4;

/// Runs that come to no end before a program is given up: one that has no ways left, and one that has; and how long the later
/// ones may be.
const ENDLESS: usize = 4;
const ENDLESS_WITH_WAYS: usize = 40;
const ENDLESS_STEPS: u64 = 1_000;

/// Runs of both sides for ways that the target alone has left, after the source has gone all of its own.
const FOR_THE_TARGET: usize = 48;

/// Scenarios from which others are steered: the first ones, and those that went a new way.
const STARTS: usize = 8;
const NEW_STARTS: usize = 40;

/// Telling scenarios that are kept, at the most, and those that are, whether they go new ways or not.
const TELLING: usize = 4;
const ANYWAY: usize = 2;

impl Verifier<'_, '_> {
    /// Tries the source in scenario after scenario, and compares in those that reach anything new. While the target has
    /// ways left, each is run on both sides.
    pub(super) fn search(&mut self, there: ProgramRef) {
        let Job { source, target, names, effort, .. } = *self.job;
        let mut found = inputs_of_both(
            (source, self.program),
            (target, there),
            names,
            (self.called, self.arguments.as_ref()),
        );
        found.try_also(&telling_numbers(self.job.assumptions, self.program, names));
        let blocks = source.blocks(self.program).len() as u64;
        let steps = effort.steps.max(blocks.saturating_mul(EACH_BLOCK));
        let inch = unit(source, target).or(found.inch);
        let supposed = self.supposed();
        let is_input = |(state, _): &(Sys, Vec<u32>)| matches!(state, Sys::Input | Sys::InputInverted);
        let reads_inputs = found.cells.keys().any(is_input);
        let mut proposals = Proposals::new(&found, Effort { steps, ..effort });
        self.skips = proposals.skips().to_vec();
        let (mut endless, mut for_target) = (0, 0);
        let (mut starts, mut is_long): (Vec<Circumstances>, bool) = (Vec::new(), false);
        let mut settled = Settled::default();
        while let Some(mut scenario) = proposals.next() {
            if self.is_out_of_time() {
                break;
            }
            scenario.milliseconds = scenario.milliseconds.map(|most| most.min(self.clock.left()));
            scenario.inch = inch;
            at_reference(&mut scenario, target);
            self.given.start(&mut scenario);
            supposed.of_run(&mut scenario);
            self.theirs = proposals.theirs().clone();
            if is_long {
                scenario.steps /= SHORTER;
            }
            if endless >= ENDLESS {
                scenario.steps = scenario.steps.min(ENDLESS_STEPS);
            }
            let run = self.run_longer(&mut scenario);
            is_long = run.steps > steps || (is_long || self.tried == 0) && is_cut(&run);
            self.tried += 1;
            self.steps += run.steps;
            let new = self.coverage.add(&run) || self.makes_sound(&run);
            if is_cut(&run) && !new {
                endless += 1;
            }
            let telling = proposals.are_telling();
            let ends = endless < ENDLESS || !is_cut(&run);
            if ends && (starts.len() < STARTS || new && starts.len() < NEW_STARTS) {
                starts.push(Circumstances::new(scenario.clone(), self.theirs.clone()));
            }
            let spare = self.compared < effort.fewest && self.tried.is_multiple_of(2);
            let wanted = !self.target_coverage.is_complete() && for_target < FOR_THE_TARGET;
            if new || telling || spare || wanted {
                for_target += usize::from(!new && !telling && !spare);
                let new_there = self.compare(&scenario, &run, there);
                self.tell(&scenario, &run, new || new_there);
            }
            if reads_inputs && is_cut(&run) {
                starts.extend(self.try_as_inputs_change(&scenario, there));
            }
            let gone = self.target_coverage.is_complete() || for_target >= FOR_THE_TARGET;
            let barren = self.compared == 0 && self.tried >= BARREN;
            let told = !telling || self.compared >= effort.telling;
            let enough = told && (self.compared >= effort.fewest || barren);
            let done = enough
                && (self.coverage.is_complete() && gone && (self.is_sound() || !self.called)
                    || self.is_settled(&mut settled, (&scenario, &run), there, &found));
            if self.witness.is_some()
                || done
                || self.gives_up(endless)
                || self.compared >= effort.scenarios
                || self.steps >= effort.all_steps
            {
                break;
            }
        }
        if endless >= ENDLESS {
            starts.retain(|start| start.scenario.steps <= ENDLESS_STEPS);
            let ended = self.telling.iter().map(|(scenario, theirs)| {
                let scenario = Scenario { steps: ENDLESS_STEPS, ..scenario.clone() };
                Circumstances::new(scenario, theirs.clone())
            });
            starts.extend(ended);
        }
        if (!self.went_every_way() || self.called && !self.is_sound()) && !settled.is_known() {
            starts = self.steer(there, &found, starts);
        }
        let came = self.steer_to_conditions(there, &found, &starts);
        self.try_unusual(there, &found, &starts);
        // What stands after such a condition was cut off until then.
        if !came.is_empty() && !self.went_every_way() && !settled.is_known() {
            self.steer(there, &found, came);
        }
        self.theirs.clear();
        // Both stop alike, and what stands after that was never looked at.
        if let Some(alarm) = self.stopped.take().filter(|_| self.compared > 0 && self.telling.is_empty()) {
            let text = format!(
                "every run stops with an alarm of the control ({alarm}): what comes after is not compared"
            );
            self.because(Why::SourceAlarms, &text);
        } else {
            self.tell_stuck();
        }
        if let (count, Some(what)) = std::mem::take(&mut self.cut_short)
            && count >= self.compared
        {
            let text = format!("every run comes to it: {what}. What comes after is not compared");
            self.because(Why::NoRunKept, &text);
        }
        if self.compared == 0 {
            for text in std::mem::take(&mut self.endless) {
                self.because(Why::Endless, &text);
            }
            self.because(Why::NothingCompared, "no scenario could be run on both sides");
        }
    }

    /// Keeps a scenario that tells much of the program: one that went a new way, and the first ones of all.
    pub(super) fn tell(&mut self, scenario: &Scenario, run: &Run, new: bool) {
        let ended = match &run.end {
            End::Ended => true,
            End::Alarm { stop, .. } => !stop.is_of_control(),
            _ => false,
        };
        self.returns |= run.events.last().is_some_and(|last| returns(&last.what));
        if ended && self.telling.len() < TELLING && (new || self.telling.len() < ANYWAY) {
            self.telling.push((scenario.clone(), self.theirs.clone()));
        }
    }

    /// True once its time is up: then it is not decided.
    pub(super) fn is_out_of_time(&mut self) -> bool {
        let is_up = self.clock.is_up();
        if is_up {
            let text = "the processor time for its verification is up: give it more with \
                        --program-seconds, or give all programs more with --library-seconds";
            self.because(Why::OutOfTime, text);
        }
        is_up
    }

    /// True after so many runs that came to no end. A program that waits for one value of an input comes to its end with that
    /// value alone, so one with ways left gets more of them.
    fn gives_up(&self, endless: usize) -> bool {
        endless >= if self.coverage.is_complete() { ENDLESS } else { ENDLESS_WITH_WAYS }
    }

    /// True where neither side has ways left.
    pub(super) fn went_every_way(&self) -> bool {
        self.coverage.is_complete() && self.target_coverage.is_complete()
    }

    /// A scenario in which the source came to no end, once more with inputs that change while it waits for them: given
    /// if it ends then.
    fn try_as_inputs_change(&mut self, scenario: &Scenario, there: ProgramRef) -> Option<Circumstances> {
        let scenario = Scenario { inputs_change: true, ..scenario.clone() };
        let run = self.run_source(&scenario);
        self.steps += run.steps;
        if is_cut(&run) {
            return None;
        }
        let new = self.coverage.add(&run);
        if new || self.compared < self.job.effort.fewest {
            let new_there = self.compare(&scenario, &run, there);
            self.tell(&scenario, &run, new || new_there);
        }
        Some(Circumstances::new(scenario, self.theirs.clone()))
    }

    /// A run of the source; a long way to its end is tried once.
    fn run_longer(&self, scenario: &mut Scenario) -> Run {
        let run = self.run_source(scenario);
        if !is_cut(&run) || self.tried > 0 {
            return run;
        }
        let steps = scenario.steps;
        scenario.steps = steps.saturating_mul(LONGER);
        let longer = self.run_source(scenario);
        // What goes round without an end is compared as far as other runs are: more turns show nothing more.
        if is_cut(&longer) && longer.branches == run.branches {
            scenario.steps = steps;
            return run;
        }
        longer
    }
}

/// Rotary axes that the target does not have stand at their reference position, where a return of all axes leaves them; so do Y and C of a lathe
/// whose profile does not list them.
fn at_reference(scenario: &mut Scenario, target: &Side<'_>) {
    let lathe = target.control.machine() == Machine::Lathe;
    let axes = target.control.profile().axes.as_ref();
    let listed = |axis: Axis| axes.is_some_and(|axes| axes.contains(&axis));
    for (axis, role, own) in
        [(1, Role::Y, Axis::Y), (3, Role::A, Axis::A), (4, Role::B, Axis::B), (5, Role::C, Axis::C)]
    {
        let has_letter = target.control.letter(role, None).is_some();
        let lacks = role != Role::Y && (!has_letter || axes.is_some() && !listed(own));
        if lacks || lathe && !listed(own) {
            scenario.start[axis] = scenario.references[0][axis];
        }
    }
}
