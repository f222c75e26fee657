//! What a called program does where it begins otherwise than in what its callers give it.

use super::verifier::Verifier;
use crate::canon::Op;
use crate::control::{ProgramRef, Scenario};
use crate::verify::certificate::Why;
use crate::verify::compare::lacks;
use crate::verify::entry::given;
use crate::verify::explore::unit;
use crate::verify::sides::{EntryState, Job};

impl Verifier<'_, '_> {
    /// Looks at what the program does in the other unit that callers come in, and as after power-on in the machine's own
    /// unit, where its callers run it otherwise.
    ///
    /// What no caller gives it is no fault. The unit counts, for a library names it at the heads of its programs.
    pub(super) fn elsewhere(&mut self, there: ProgramRef) {
        let own = unit(self.job.source, self.job.target).unwrap_or(false);
        if self.given.never_come_to {
            self.guessed(own, there);
        } else if self.witness.is_some() {
            self.each_as_called(own, there);
            if self.in_cycle(there) {
                return;
            }
        }
        let selects = !lacks(self.job.target, Op::Inch);
        for inch in self.given.both_units().filter(|inch| selects && *inch != own).collect::<Vec<_>>() {
            if self.witness.is_none() {
                let other = self.begun_as(self.given.in_unit(inch), there);
                (self.witness, self.shown) = (other.witness, other.shown);
            }
        }
        let is_own = self.given.inch().is_none_or(|given| given == own);
        let is_plain = self.given.never_come_to || self.given.unlike_power_on().is_empty();
        if self.witness.is_some() {
            return;
        }
        if is_own && is_plain {
            return self.unstarted(there);
        }
        let Some(witness) = self.begun_as(EntryState::default(), there).witness else { return };
        let given = in_words(&self.given, own);
        let whose = if self.given.never_come_to {
            "in which the runs of its callers end before they reach it"
        } else {
            "as its callers run it"
        };
        let text = format!("{given}, {whose}, it does the same; otherwise not: {}", witness.what);
        self.because(Why::NotByItself, &text);
    }

    /// Runs the telling scenarios on a machine that nobody has started, where all callers give the program a spindle that
    /// runs, or the like. What differs there alone is for review: that no caller ever leaves it out is not shown.
    fn unstarted(&mut self, there: ProgramRef) {
        let unstarted = self.given.unstarted();
        if self.given.entry == unstarted {
            return;
        }
        let given = match self.given.started() {
            none if none.is_empty() => "a feed in force".to_owned(),
            started => started.join(", "),
        };
        for (scenario, registers) in self.telling.clone() {
            self.theirs = registers;
            self.once_more(&Scenario { entry: unstarted.clone(), ..scenario }, there);
            if let Some(witness) = self.witness.take() {
                let text = format!(
                    "with {given}, as its callers run it, it does the same; otherwise not: {}",
                    witness.what
                );
                self.because(Why::NotByItself, &text);
                break;
            }
        }
        self.theirs.clear();
    }

    /// Looks at a program that no caller comes to: the modes that it was run in are those in which their runs ended, and
    /// may not be those of the call. A difference counts that shows in the modes of power-on too, and in a straight cut.
    fn guessed(&mut self, own: bool, there: ProgramRef) {
        if !self.given.unlike_power_on().is_empty() {
            self.or_begun_as(&self.given.unit_alone(), own, there);
        }
        if self.witness.is_some() {
            self.or_begun_as(&self.given.in_straight_cut(), own, there);
        }
    }

    /// Begins in a drilling cycle, if every caller leaves one in force: what differs without one alone is for review. True if
    /// that is all that differs.
    fn in_cycle(&mut self, there: ProgramRef) -> bool {
        let (Some(witness), Some(drilling)) = (&self.witness, self.given.in_cycle()) else { return false };
        let text = format!(
            "with a drilling cycle in force, as its callers run it, it does the same; otherwise not: {}",
            witness.what
        );
        let mut other = self.anew(drilling);
        other.search(there);
        let is_all = other.witness.is_none() && other.compared > 0;
        if is_all {
            self.witness = None;
            self.because(Why::NotByItself, &text);
        }
        is_all
    }

    /// Begins each side as its own callers do: the target's may leave other modes, of which they make something else.
    fn each_as_called(&mut self, own: bool, there: ProgramRef) {
        let Job { source, target, .. } = *self.job;
        let given = target.given.get_or_init(|| given(&Job { source: target, target: source, ..*self.job }));
        let Some(theirs) = given.get(&there).filter(|given| !given.never_come_to) else { return };
        let begins = |given: &EntryState| (given.unlike_power_on(), given.entry.clone());
        if begins(theirs) == begins(&self.given) {
            return;
        }
        let text = format!(
            "{} on the source and {} on the target, as the callers of each run it, it does the same",
            in_words(&self.given, own),
            in_words(theirs, own)
        );
        let mut other = self.anew(self.given.clone());
        other.target_given = Some(theirs.clone());
        other.search(there);
        if other.witness.is_none() {
            self.witness = None;
            self.because(Why::NotByItself, &text);
        }
    }

    /// Tries the program in another guess of what is in force at its call: what differs in one of the two alone is for
    /// review.
    fn or_begun_as(&mut self, guess: &EntryState, own: bool, there: ProgramRef) {
        let other = self.begun_as(guess.clone(), there).witness;
        let here = self.witness.take();
        match here.as_ref().xor(other.as_ref()).map(|witness| witness.what.clone()) {
            None => self.witness = here,
            Some(what) => {
                let (ours, others) = (in_words(&self.given, own), in_words(guess, own));
                let (bad, good) = if here.is_some() { (ours, others) } else { (others, ours) };
                let text =
                    format!("no caller's run reaches it: {good} it does the same, {bad} it does not: {what}");
                self.because(Why::NotByItself, &text);
            }
        }
    }

    /// The program tried anew, in other circumstances.
    fn begun_as(&self, given: EntryState, there: ProgramRef) -> Self {
        let mut other = self.anew(given);
        other.search(there);
        other
    }

    /// A new verifier of the program, which is given this.
    fn anew(&self, given: EntryState) -> Self {
        Self { given, ..Self::new(self.job, self.program) }
    }
}

/// What a program is given that is not as after power-on: `in inches, distance.incremental`; or that nothing is.
fn in_words(given: &EntryState, own: bool) -> String {
    let unit =
        given.inch().filter(|inch| *inch != own).map(|inch| if inch { "inches" } else { "millimetres" });
    let modes = given.unlike_power_on().iter().map(Op::to_string).collect::<Vec<_>>();
    let all: Vec<String> = unit.map(str::to_owned).into_iter().chain(modes).collect();
    let started = given.started();
    let modes = (!all.is_empty()).then(|| format!("in {}", all.join(", ")));
    let started = (!started.is_empty()).then(|| format!("with {}", started.join(", ")));
    match modes.into_iter().chain(started).collect::<Vec<_>>() {
        none if none.is_empty() => "as after power-on".into(),
        all => all.join(" "),
    }
}
