//! How the runs of a program kept what its conversion supposes.

use super::verifier::Verifier;
use crate::verify::certificate::{Assumed, Why};
use crate::verify::triage::Tried;

/// Letters of a condition that a reason names: the report has all of it.
const LETTERS: usize = 80;

impl Verifier<'_, '_> {
    /// Counts what a pair of runs shows of the program's own assumptions; `same` where they did the same to their ends.
    pub(super) fn count(&mut self, tried: &[Tried<'_>], same: bool) {
        for tried in tried.iter().filter(|tried| tried.program == self.counted) {
            let (kept, broken) = self.assumed.entry(tried.at).or_default();
            *kept += usize::from(same && tried.is_kept());
            *broken += usize::from(tried.is_broken());
        }
    }

    /// What the conversion supposes of the program, and how its runs kept that. What none kept is not shown.
    pub(super) fn assumptions(&mut self) -> Vec<Assumed> {
        let job = self.job;
        let mut list = Vec::new();
        for (at, assumption) in job.assumptions.get(&self.program).into_iter().flatten().enumerate() {
            let (kept, broken) = self.assumed.get(&at).copied().unwrap_or_default();
            let (line, column) = job.source.line_of(self.program.file, assumption.place.start);
            let (kind, text) = (assumption.predicate.kind(), assumption.text.to_string());
            if kept == 0 && self.compared > 0 && assumption.predicate.is_seen() {
                let short: String = text.chars().take(LETTERS).collect();
                let dots = if short.len() < text.len() { "..." } else { "" };
                self.because(
                    Why::NoRunKept,
                    &format!("no run met the condition of line {line}: {short}{dots}"),
                );
            }
            let [kept, broken] =
                [kept, broken].map(|runs| (!assumption.predicate.is_accepted()).then_some(runs));
            list.push(Assumed { kind, text, line, column, kept, broken });
        }
        list
    }
}
