//! A program that is given arguments, for a target whose calls have none: it is run as its library calls it.
//!
//! There the caller writes the arguments into registers, and which ones is known to its calls alone: run by itself, the
//! program finds nothing in them, and does something else than the source with arguments. So runs begin in what calls it, on
//! both sides, and search for the ways of its branches through that.

use super::summary::lacks_locals;
use super::verifier::Verifier;
use crate::control::ProgramRef;
use crate::verify::entry::is_root;
use crate::verify::explore::{Coverage, Given, inputs};
use crate::verify::sides::{Arguments, class_of, of_target};

/// What runs of its callers show of a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum AsCalled {
    /// All of it.
    Shown,
    /// Not all of it.
    Open,
    /// One of them does something else on the target.
    Differs,
}

/// Programs that it is run from, at the most.
const CALLERS: usize = 4;

impl Verifier<'_, '_> {
    /// Runs a program that takes arguments through what calls it. [`AsCalled::Shown`] if that shows all of it: every way was
    /// gone, and nothing but what its callers are asked for themselves is left to be said.
    pub(super) fn as_called(&mut self) -> AsCalled {
        let job = self.job;
        if !self.called || !lacks_locals(job) || !self.takes_arguments() {
            return AsCalled::Open;
        }
        let above = job.source.links().calling(self.program).into_iter();
        let callers: Vec<ProgramRef> = above.filter(|at| is_root(job, at)).take(CALLERS + 1).collect();
        let mut coverage = self.coverage.clone();
        let mut target_coverage = Coverage::new(job.target, &of_target(job, self.program), true);
        let mut differs = false;
        let (mut shown, mut clean) = (false, !callers.is_empty() && callers.len() <= CALLERS);
        for caller in callers.into_iter().take(CALLERS) {
            let Some(there) = job.names.program(job.source, caller, job.target) else {
                clean = false;
                continue;
            };
            let mut run = Verifier { counted: self.program, ..Verifier::new(job, caller) };
            (run.coverage, run.target_coverage) = (coverage.clone(), target_coverage.clone());
            run.search(there);
            job.spent.add(&run.clock);
            self.tried += run.tried;
            self.steps += run.steps;
            let enters = run.entered.contains(&self.program);
            if run.witness.is_some() || run.compared == 0 || !enters {
                differs |= run.witness.is_some();
                clean &= !differs;
                continue;
            }
            (coverage, target_coverage) = (run.coverage.clone(), run.target_coverage.clone());
            shown = true;
            clean &= run.reasons.is_empty() && run.endless.is_empty();
            self.take_in(run);
        }
        let all = coverage.is_complete() && target_coverage.is_complete();
        if shown {
            (self.coverage, self.target_coverage) = (coverage, target_coverage);
        }
        match (differs, shown && clean && all) {
            (true, _) => AsCalled::Differs,
            (false, true) => AsCalled::Shown,
            (false, false) => AsCalled::Open,
        }
    }

    /// Runs it by itself with arguments in the registers that stand for them, as a caller sets them. True if that shows no
    /// difference: then nothing else is to be run. Where it shows one, that may be what no caller gives, and counts for nothing.
    pub(super) fn with_arguments(&mut self, there: ProgramRef) -> bool {
        let job = self.job;
        if !lacks_locals(job) {
            return false;
        }
        let sides = (job.source.control, job.target.control);
        let read = inputs(job.source, self.program, job.source).variables.into_iter().map(|input| input.name);
        let name = job.source.name(self.program);
        let Some(arguments) = name.and_then(|name| Arguments::of(name, read, job.names, sides)) else {
            return false;
        };
        let mut run = Verifier { arguments: Some(arguments), ..Verifier::new(job, self.program) };
        (run.coverage, run.target_coverage) = (self.coverage.clone(), self.target_coverage.clone());
        let locals: Vec<String> = run.arguments.iter().flat_map(Arguments::always).cloned().collect();
        run.coverage.given(job.source, self.program, &Given { locals: &locals, unit: None });
        run.all(there);
        if run.witness.is_some() || run.compared == 0 {
            job.spent.add(&run.clock);
            self.tried += run.tried;
            self.steps += run.steps;
            return false;
        }
        (run.tried, run.steps) = (run.tried + self.tried, run.steps + self.steps);
        let before = std::mem::replace(self, run);
        self.take_in(before);
        true
    }

    /// True if its text reads what only a call gives.
    pub(super) fn takes_arguments(&self) -> bool {
        let source = self.job.source;
        let found = inputs(source, self.program, source);
        let is_local =
            |name: &str| class_of(source.control, name).is_some_and(|class| class.class == "local");
        found.variables.iter().any(|input| is_local(&input.name))
    }

    /// Takes in what runs of a caller, or of an edited text, showed.
    pub(super) fn take_in(&mut self, run: Verifier<'_, '_>) {
        self.compared += run.compared;
        self.largest = self.largest.max(run.largest);
        self.texts.extend(run.texts);
        self.entered.extend(run.entered);
        for (fact, open) in run.unconfirmed {
            self.unconfirmed.entry(fact).or_insert(open);
        }
        for (at, (kept, broken)) in run.assumed {
            let own = self.assumed.entry(at).or_default();
            *own = (own.0 + kept, own.1 + broken);
        }
        self.sensitive = match (self.sensitive, run.sensitive) {
            (Some(true), _) | (_, Some(true)) => Some(true),
            (own, other) => own.or(other),
        };
    }
}
