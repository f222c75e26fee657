//! Calls that no run came back from, because what they call raised an alarm each time.

use super::verifier::Verifier;
use crate::control::trace::EventKind;
use crate::control::{End, Run};
use crate::text::Span;
use crate::verify::certificate::Why;
use std::collections::{BTreeMap, BTreeSet};

/// The calls of a program that runs came back from, and those that they stopped in.
#[derive(Clone, Debug, Default)]
pub(super) struct Calls {
    passed: BTreeSet<(u32, u32)>,
    stopped: BTreeMap<(u32, u32), String>,
}

impl Calls {
    /// Takes a run that was compared to its end.
    pub(super) fn add(&mut self, run: &Run) {
        let mut open: Vec<(u32, Span)> = Vec::new();
        for event in &run.events {
            match event.what {
                EventKind::Enter { .. } => open.push((event.at.program, event.at.span)),
                EventKind::Leave => {
                    let call = open.pop().filter(|(program, _)| open.is_empty() && *program == 0);
                    self.passed.extend(call.map(|(_, span)| (span.start, span.end)));
                }
                _ => {}
            }
        }
        if let End::Alarm { stop, .. } = &run.end
            && let Some((0, span)) = open.first()
        {
            self.stopped.entry((span.start, span.end)).or_insert_with(|| stop.told());
        }
    }
}

impl Verifier<'_, '_> {
    /// Says of each call that no run came back from that what stands after it was not compared.
    pub(super) fn tell_stuck(&mut self) {
        let Calls { passed, stopped } = std::mem::take(&mut self.calls);
        for ((start, end), alarm) in stopped {
            if !passed.contains(&(start, end)) {
                let (line, _) = self.job.source.line_of(self.program.file, start);
                let text = format!(
                    "every run that comes to line {line} stops in what it calls ({alarm}): what comes after is not compared"
                );
                self.because(Why::NotReached, &text);
            }
        }
    }
}
