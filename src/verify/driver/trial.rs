//! One scenario on both sides.

use super::verifier::{Pair, Verifier};
use crate::control::trace::EventKind;
use crate::control::{End, ProgramRef, Run, Scenario};
use crate::dialect::Side as Of;
use crate::verify::certificate::{Moment, OpenFact, Why};
use crate::verify::compare::{Difference, compare, is_cut, writes_elsewhere};
use crate::verify::sides::{Job, Side};
use crate::verify::triage::{ROUNDS, excuse, facts, told_substitutes, tried};
use std::collections::BTreeSet;
use std::sync::Arc;

impl Verifier<'_, '_> {
    /// Keeps what a run rested on that nobody confirmed; where it did, of what the conversion did not report.
    fn hear_doubts(&mut self, (of, library, run): (Of, &Side<'_>, &Run), assumed: &BTreeSet<Arc<str>>) {
        for event in &run.events {
            if let EventKind::Unsure { fact } = &event.what {
                let is_new = !assumed.contains(fact.as_str());
                let kept = self.unconfirmed.entry(fact.clone()).or_default();
                if is_new && kept.iter().all(|open| open.side != of) {
                    kept.push(OpenFact::new(fact, of, &Moment::of(library, run, event)));
                }
            }
        }
    }

    /// True for a run that may show what the source does where so far its control stopped each run that went there.
    pub(super) fn makes_sound(&self, run: &Run) -> bool {
        self.called
            && !self.source_stops.is_empty()
            && !is_stopped(run)
            && !is_cut(run)
            && self.sound.has_new(run)
    }

    /// True if no run was stopped by the source's control; or if callers give the program what stopped it, and for each way that
    /// such a run went another went it to its own end.
    pub(super) fn is_sound(&self) -> bool {
        self.source_stops.is_empty()
            || self.called && self.compared > 0 && self.sound.lacks(&self.coverage).is_empty()
    }

    /// Takes in the ways of a pair that did the same.
    pub(super) fn went_alike(&mut self, pair: &Pair<'_>) {
        let new = self.coverage.add(pair.run);
        if self.target_coverage.add(pair.other) || new {
            let Job { source, target, .. } = self.job;
            let assumed = facts(self.job, pair.run);
            self.hear_doubts((Of::Source, source, pair.run), &assumed);
            self.hear_doubts((Of::Target, target, pair.other), &assumed);
        }
    }

    /// Compares the runs of a scenario. True where the target's went a new way.
    pub(super) fn compare(&mut self, scenario: &Scenario, run: &Run, there: ProgramRef) -> bool {
        let Job { source, target, names, .. } = self.job;
        let circumstances = self.circumstances(scenario, run);
        let other = target.run(there, &circumstances);
        self.entered.extend(source.links().entered(run));
        let assumed = facts(self.job, run);
        let new_there = self.target_coverage.add(&other);
        for (of, library, library_run) in [(Of::Source, source, run), (Of::Target, target, &other)] {
            match &library_run.end {
                End::Error { text, .. } => self.because(Why::CannotRun, &format!("the {of}: {text}")),
                End::StepBudget | End::TimeBudget => {
                    let text = format!("the {of} did not end in {} blocks", library_run.steps);
                    let alone = of == Of::Target && !is_cut(run);
                    if alone { self.because(Why::Endless, &text) } else { self.endless.extend([text]) }
                }
                End::Alarm { stop, .. } if stop.is_of_control() => {
                    self.stopped.get_or_insert_with(|| stop.told());
                }
                End::Ended | End::Alarm { .. } => {}
            }
            self.hear_doubts((of, library, library_run), &assumed);
        }
        let found = compare((source, run), (target, &other), names, self.tolerance);
        self.largest = self.largest.max(found.largest);
        self.texts.extend(found.texts);
        if let Some(text) = found.stopped {
            self.cut_short.0 += 1;
            self.cut_short.1.get_or_insert(text);
        }
        let told = told_substitutes(self.job, run);
        let replaced = found.replaced.into_iter().filter(|(op, _)| !told.contains(op)).map(|(_, text)| text);
        for text in found.substituted.into_iter().chain(replaced) {
            self.because(Why::Substituted, &text);
        }
        let ended = !is_cut(run) && !is_cut(&other);
        // A hair that the last digit decides is no fault of the conversion; any other is.
        let hair = found.hair;
        let hangs = hair.is_some() && self.wavers((there, &circumstances), &other);
        if let Some(hair) = hair.as_ref().filter(|_| hangs) {
            let text = format!("rounding may decide this: add a tolerance or round first ({})", hair.what);
            self.because(Why::Substituted, &text);
        }
        let difference = hair.filter(|_| !hangs).or(found.difference).or_else(|| {
            let what = writes_elsewhere(source, (target, &other), &circumstances.variables, names)?;
            Some(Difference::new(None, None, what))
        });
        let tried = tried(self.job, run, &other);
        let excuse = difference.as_ref().and_then(|d| excuse(&tried, run, &other, d));
        self.count(&tried, ended && difference.is_none());
        self.compared += usize::from(ended && excuse.is_none());
        if ended {
            self.calls.add(run);
        }
        if ended && difference.is_none() && !is_stopped(run) {
            self.sound.add(run);
        }
        let upto = difference.as_ref().map(|difference| difference.target);
        if let Some(difference) = &difference {
            let pair = Pair { scenario, run, there, circumstances: &circumstances, other: &other };
            match self.weigh(&pair, difference, excuse) {
                Some((Why::SourceAlarms, text)) if is_stopped(run) => _ = self.source_stops.insert(text),
                Some((why, text)) => {
                    if why == Why::Unconfirmed {
                        self.unconfirmed.insert(ROUNDS.into(), Vec::new());
                    }
                    self.because(why, &text);
                }
                None => self.witnessed(&pair, difference),
            }
        }
        if self.witness.is_none() && self.sensitive != Some(true) && !is_cut(&other) {
            self.sensitive = Some(self.is_sensitive((there, &circumstances), &other, upto, new_there));
        }
        new_there
    }
}

/// True for a run that the source's control stopped.
fn is_stopped(run: &Run) -> bool {
    matches!(&run.end, End::Alarm { stop, .. } if stop.is_of_control())
}
