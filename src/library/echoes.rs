//! Findings that only say again what another one said.

use crate::diag::{Code, Diagnostic, Severity};
use crate::text::Span;

/// Emission fails again where an earlier part already said why, and lowering where reading did: the first word is
/// enough.
pub fn drop_echoes(diagnostics: &mut Vec<Diagnostic>) {
    // The places that get no register say nothing beside what their program competes with.
    let competes = |d: &Diagnostic| d.code == Code::OutOfRegisters && d.help.is_some();
    if diagnostics.iter().any(competes) {
        diagnostics.retain(|d| d.code != Code::OutOfRegisters || competes(d));
    }
    let later = |code| matches!(code, Code::Unmapped | Code::NotUnderstood);
    if !diagnostics.iter().any(|d| later(d.code)) {
        return;
    }
    let told = || diagnostics.iter().filter(|d| d.severity() == Severity::Error && d.code != Code::Unmapped);
    // What reading and lowering found; legalization comes after them.
    let before = |code: Code| code != Code::NotUnderstood && code.number() < "MG04";
    let all = Told::of(told().map(|d| d.span));
    let first = Told::of(told().filter(|d| before(d.code)).map(|d| d.span));
    diagnostics.retain(|d| match d.code {
        Code::Unmapped => !all.touches(d.span),
        Code::NotUnderstood => !first.holds(d.span),
        _ => true,
    });
}

/// Places of findings: a block may have as many as it has words.
struct Told {
    /// By their starts; with each, how far it and those before it go.
    places: Vec<(u32, u32)>,
}

impl Told {
    fn of(spans: impl Iterator<Item = Span>) -> Self {
        let mut places: Vec<(u32, u32)> = spans.map(|span| (span.start, span.end)).collect();
        places.sort_unstable();
        let mut furthest = 0;
        for (_, end) in &mut places {
            furthest = furthest.max(*end);
            *end = furthest;
        }
        Self { places }
    }

    /// How far those go that start before this.
    fn reach(&self, start: u32) -> Option<u32> {
        let count = self.places.partition_point(|place| place.0 < start);
        count.checked_sub(1).and_then(|last| self.places.get(last)).map(|place| place.1)
    }

    /// True if one of them has a byte of this place, or stands at it.
    fn touches(&self, span: Span) -> bool {
        let end = span.end.max(span.start.saturating_add(1));
        let at = self.places.partition_point(|place| place.0 < span.start);
        let begins = self.places.get(at).is_some_and(|place| place.0 < end);
        begins || self.reach(end).is_some_and(|furthest| furthest > span.start)
    }

    /// True if one of them has all of this place.
    fn holds(&self, span: Span) -> bool {
        self.reach(span.start.saturating_add(1)).is_some_and(|furthest| furthest >= span.end)
    }
}
