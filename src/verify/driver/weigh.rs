//! Whether a difference of two runs is held against the conversion.

use super::verifier::{Pair, Verifier};
use crate::control::trace::Event;
use crate::control::{End, Run};
use crate::verify::certificate::{Moment, Why, Witness};
use crate::verify::compare::{Difference, compare, writes_elsewhere};
use crate::verify::sides::Job;
use crate::verify::triage::{
    ROUNDS, Shown, excuse, hangs_on_rounding, off_its_circle, stops_by_itself, tried, ways,
};

impl Verifier<'_, '_> {
    /// Why a difference is not held against the conversion; none if it is. `excuse` is what an assumption says of it.
    pub(super) fn weigh(
        &self,
        pair: &Pair<'_>,
        difference: &Difference<'_>,
        excuse: Option<String>,
    ) -> Option<(Why, String)> {
        // Where the source's control itself stops the program, the program says nothing.
        if stops_by_itself(pair.run, difference) && !stops_for_all(pair.run) {
            let text = match &pair.run.end {
                End::Alarm { stop, .. } => stop.told(),
                _ => String::new(),
            };
            let text = format!("the source stops with an alarm of the control ({text})");
            return Some((Why::SourceAlarms, text));
        }
        if let Some(excuse) = excuse {
            return Some((Why::Condition, excuse));
        }
        if let Some(off) = off_its_circle(difference) {
            let text = format!(
                "an arc of the source ends {off:.3} mm off its circle: no source says what the control does"
            );
            return Some((Why::SourceAlarms, text));
        }
        let hangs = hangs_on_rounding(
            self.job,
            self.tolerance,
            (self.program, pair.scenario, pair.run),
            (pair.there, pair.circumstances, pair.other),
        );
        if hangs {
            let text = format!("no manual confirms '{ROUNDS}', and it decides the value that is read back");
            return Some((Why::Unconfirmed, text));
        }
        difference.by_place.then(|| {
            let text = format!(
                "a variable keeps a position that was read, and rounded words led to it: {}",
                difference.what
            );
            (Why::Substituted, text)
        })
    }

    /// Keeps a difference, and where it showed itself.
    pub(super) fn witnessed(&mut self, pair: &Pair<'_>, difference: &Difference<'_>) {
        let (source, target) = (self.job.source, self.job.target);
        let spot = |run: &Run, event: Option<&Event>| {
            let at = event?.at;
            Some((run.programs.get(at.program as usize)?.file, at.span))
        };
        self.shown = Shown {
            source: spot(pair.run, difference.source),
            target: spot(pair.other, difference.target),
            ways: ways(pair.run, self.program.file).collect(),
        };
        self.witness = Some(Witness {
            what: difference.what.clone(),
            scenario: pair.scenario.clone(),
            started: Vec::new(),
            target_variables: self.theirs.clone(),
            source: difference.source.map(|event| Moment::of(source, pair.run, event)),
            target: difference.target.map(|event| Moment::of(target, pair.other, event)),
        });
    }

    /// What differs between the runs of a pair, where it is held against the conversion; hears nothing else.
    pub(super) fn fault<'r>(&self, pair: &Pair<'r>) -> Result<(), Option<Difference<'r>>> {
        let Job { source, target, names, .. } = self.job;
        let found = compare((source, pair.run), (target, pair.other), names, self.tolerance);
        let hair = found.hair.filter(|_| !self.wavers((pair.there, pair.circumstances), pair.other));
        let difference = hair.or(found.difference).or_else(|| {
            let what = writes_elsewhere(source, (target, pair.other), &pair.circumstances.variables, names)?;
            Some(Difference::new(None, None, what))
        });
        let Some(difference) = difference else { return Ok(()) };
        let excuse = excuse(&tried(self.job, pair.run, pair.other), pair.run, pair.other, &difference);
        let is_held = self.weigh(pair, &difference, excuse).is_none();
        Err(is_held.then_some(difference))
    }
}

/// True where what stops the source stops the program for whoever runs it: the target must stop too.
fn stops_for_all(run: &Run) -> bool {
    matches!(&run.end, End::Alarm { stop, .. } if stop.for_all)
}
