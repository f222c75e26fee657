//! What a program does where one that stands in the machine leaves other modes than it found.

use super::verifier::Verifier;
use crate::control::trace::EventKind;
use crate::control::{ProgramRef, Scenario};
use crate::verify::certificate::Why;

/// Ways to leave the machine that are tried in each telling scenario.
const WAYS: u64 = 3;

impl Verifier<'_, '_> {
    /// Runs the telling scenarios where programs that stand in the machine leave other modes. What differs there alone is for
    /// review: that such a program leaves the modes as they were may well be so.
    pub(super) fn in_modes_left(&mut self, there: ProgramRef) {
        if self.witness.is_some() || self.job.source.library.outside.is_empty() {
            return;
        }
        for (scenario, registers) in self.telling.clone() {
            let run = self.run_source(&scenario);
            let mut called = run.events.iter().filter_map(|event| match &event.what {
                EventKind::Outside(call) => Some(call.name()),
                _ => None,
            });
            let Some(program) = called.next() else { continue };
            self.theirs = registers;
            for way in 1..=WAYS {
                self.once_more(&Scenario { outside: way, outside_modes: true, ..scenario.clone() }, there);
            }
            if let Some(witness) = self.witness.take() {
                let text = format!(
                    "it does the same where {program} leaves the modes as they were (G90 or G91, G0 or G1, the cycle), otherwise \
                     not: {}",
                    witness.what
                );
                self.because(Why::EntryState, &text);
                break;
            }
        }
        self.theirs.clear();
    }
}
