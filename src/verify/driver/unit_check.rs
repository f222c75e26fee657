//! The check of the unit, on a target that selects none.

use super::verifier::Verifier;
use crate::canon::Op;
use crate::control::ProgramRef;
use crate::control::trace::{Event, EventKind};
use crate::verify::compare::lacks;

impl Verifier<'_, '_> {
    /// Runs the target on a machine that is set to the other unit than both are set to in the scenarios.
    ///
    /// A program that selects its unit checks it on such a target. That this way was gone counts where it does nothing
    /// but stop with a message.
    pub(super) fn in_other_unit(&mut self, there: ProgramRef) {
        let target = self.job.target;
        if !lacks(target, Op::Inch) || self.target_coverage.is_complete() || self.witness.is_some() {
            return;
        }
        let Some((scenario, theirs)) = self.telling.first().cloned() else { return };
        self.theirs = theirs;
        let run = self.run_source(&scenario);
        let mut circumstances = self.circumstances(&scenario, &run);
        circumstances.inch = Some(!circumstances.inch.unwrap_or(false));
        let other = target.run(there, &circumstances);
        if other.events.iter().any(|event| matches!(event.what, EventKind::Message { .. }))
            && other.events.iter().all(only_tells)
        {
            self.target_coverage.add(&other);
        }
        self.theirs.clear();
    }
}

/// True for what does nothing to a machine.
fn only_tells(event: &Event) -> bool {
    use EventKind::{Alarm, Asked, Enter, Leave, Message, Unsure, Variable};
    matches!(
        event.what,
        Message { .. } | Alarm(_) | Asked { .. } | Variable { .. } | Enter { .. } | Leave | Unsure { .. }
    )
}
