//! What is written of a program once it was verified.

use super::verifier::Verifier;
use crate::canon::Op;
use crate::control::ProgramRef;
use crate::verify::certificate::{OpenFact, Outcome, ProgramCertificate, Reason, Why};
use crate::verify::explore::{Coverage, NotReached, by_own_numbers, compare_alarms};
use crate::verify::sides::Job;
use crate::verify::triage::through;
use std::collections::BTreeSet;

/// Ways not gone that a reason names.
const NAMED: usize = 3;

impl Verifier<'_, '_> {
    pub(super) fn certificate(mut self, there: Option<ProgramRef>) -> ProgramCertificate {
        let source_file = self.job.source.files.get(self.program.file);
        let target_file = there.and_then(|there| self.job.target.files.get(there.file));
        if there.is_some() && self.witness.is_none() {
            compare_alarms(self.job, self.program, &mut self.coverage, &mut self.target_coverage);
        }
        self.set_own_aside(there);
        let by_text = self.coverage.by_text(self.job.source);
        let ways = |coverage: &Coverage, side| there.map_or(Vec::new(), |_| coverage.not_reached(side));
        let not_reached = ways(&self.coverage, self.job.source);
        let target_not_reached = ways(&self.target_coverage, self.job.target);
        for (missed, whose) in [(&not_reached, ""), (&target_not_reached, " of the target")] {
            if !missed.is_empty() {
                self.because(Why::NotReached, &in_words(missed, whose));
            }
        }
        let open_facts: Vec<OpenFact> = self.unconfirmed.values().flatten().cloned().collect();
        for open in &open_facts {
            self.because(Why::Unconfirmed, &open.text);
        }
        let is_sound = self.is_sound();
        for text in self.source_stops.clone().iter().filter(|_| !is_sound) {
            self.because(Why::SourceAlarms, text);
        }
        if self.is_stopped_alone() {
            self.reasons.remove(&Why::SourceAlarms);
        }
        let assumptions = self.assumptions();
        let mut outcome = match (&self.witness, self.reasons.is_empty()) {
            (Some(_), _) => Outcome::Different,
            (None, false) => Outcome::Undecided,
            (None, true) => Outcome::Same,
        };
        let mut run_alone = false;
        if let Some(witness) = self.witness.clone() {
            let through = through(self.job, self.program, &self.shown, self.tolerance);
            run_alone = through.is_alone(&self.given);
            let locals = lacks_locals(self.job) && through.does_the_same();
            let by_registers =
                "what its callers give it stands in registers there, and called so it does the same";
            let stopped = lacks_locals(self.job) && through.is_stopped();
            let by_callers =
                "what its callers give it stands in registers there, and no run of them comes to its end";
            let why = locals.then(|| by_registers.into()).or(stopped.then(|| by_callers.into()));
            let unset = || there.and_then(|there| self.by_registers(&witness, &through, there));
            if let Some(excuse) = through.excuses().or(why).or_else(unset) {
                let text = format!("run by itself it differs ({}), but {excuse}", witness.what);
                self.because(Why::NotByItself, &text);
                outcome = Outcome::Undecided;
            }
        }
        let (branches_total, branches_covered) = self.coverage.totals();
        let (target_branches_total, target_branches_covered) = self.target_coverage.totals();
        let reasons = self
            .reasons
            .into_iter()
            .flat_map(|(why, texts)| texts.into_iter().map(move |text| Reason { why, text }));
        ProgramCertificate {
            source: source_file.map_or_else(String::new, |file| file.name.to_owned()),
            source_sha256: self.job.source.sha256(self.program.file).to_owned(),
            program: self.job.source.name(self.program).map(ToString::to_string),
            target: target_file.map(|file| file.name.to_owned()),
            target_sha256: there.map(|there| self.job.target.sha256(there.file).to_owned()),
            outcome,
            reasons: reasons.collect(),
            given: self.given.modes.iter().map(Op::to_string).collect(),
            never_come_to: self.given.never_come_to,
            run_alone,
            scenarios_tried: self.tried,
            scenarios_compared: self.compared,
            branches_covered,
            branches_total,
            not_reached,
            target_branches_covered,
            target_branches_total,
            target_not_reached,
            by_text,
            source_stops: if is_sound { self.source_stops.into_iter().collect() } else { Vec::new() },
            by_own_numbers: self.coverage.aside(self.job.source),
            target_by_own_numbers: self.target_coverage.aside(self.job.target),
            edits: self.edits,
            tolerance_mm: self.tolerance.rounded,
            largest_difference_mm: self.largest,
            rounding_sensitive: self.sensitive,
            unconfirmed: self.unconfirmed.into_keys().collect(),
            texts: self.texts.into_iter().take(20).collect(),
            witness: self.witness,
            started: self.started,
            open_facts,
            entered: self.entered,
            assumptions,
        }
    }

    /// Sets ways aside that no run of the programs as they stand can go. What is called gets its numbers from callers.
    fn set_own_aside(&mut self, there: Option<ProgramRef>) {
        if self.called || self.witness.is_some() || self.went_every_way() {
            return;
        }
        let (Some(there), Some((scenario, theirs))) = (there, self.telling.first().cloned()) else { return };
        self.theirs = theirs;
        let run = self.run_source(&scenario);
        let other = self.job.target.run(there, &self.circumstances(&scenario, &run));
        let own = by_own_numbers(self.job.source, self.program, &run);
        self.coverage.set_aside(self.program.file, &own, &self.apart);
        let own = by_own_numbers(self.job.target, there, &other);
        self.target_coverage.set_aside(there.file, &own, &BTreeSet::new());
    }

    /// True if nothing is open but that the source's control stops a program which is run by itself, as a peck cycle whose
    /// depth its caller gives, and if all runs of its callers come through it and do the same.
    fn is_stopped_alone(&self) -> bool {
        let others = self.reasons.keys().filter(|why| **why != Why::Unconfirmed);
        let stops = self.called && self.witness.is_none() && others.eq([&Why::SourceAlarms]);
        stops && through(self.job, self.program, &self.shown, self.tolerance).shows_all()
    }
}

/// True if calls of the source give locals, and the target has none: nobody can give them to a program by itself.
pub(super) fn lacks_locals(job: &Job<'_>) -> bool {
    job.source.has_locals() && !job.target.has_locals()
}

/// The ways that were never gone, the first of them by name.
fn in_words(missed: &[NotReached], whose: &str) -> String {
    let named = missed
        .iter()
        .take(NAMED)
        .map(|way| format!("'{}' in line {}{whose} was never {}", way.text.trim(), way.line, way.way));
    let more = missed.len().saturating_sub(NAMED);
    let rest = (more > 0).then(|| format!("and {more} more branches{whose} were not reached"));
    named.chain(rest).collect::<Vec<_>>().join("; ")
}
