//! What `macroglot accept` did, for people.

use super::totals::plural;
use crate::library::{Edit, Entry};
use crate::text::shown;
use std::fmt::Write;

/// What was accepted, and what was not.
#[derive(Clone, Copy, Debug)]
pub struct Accepting<'a> {
    /// What changes in the project file.
    pub edits: &'a [Edit],
    /// The entries that stood there.
    pub entries: &'a [Entry],
    /// Questions that had no answer before.
    pub open: usize,
    /// Programs that were left out because they are refused.
    pub refused: usize,
    /// True if nothing is written.
    pub is_tried: bool,
}

/// What was accepted, a line each with what was asked; then how many.
pub fn accepting(told: &Accepting<'_>) -> String {
    let mut out = String::new();
    let mut counts = [0; 3];
    for edit in told.edits {
        let (at, word, entry) = match edit {
            Edit::Add(entry) => (0, "accepted", Some(entry)),
            Edit::Renew(_, entry) => (1, "renewed", Some(entry)),
            Edit::Drop(at) => (2, "dropped", told.entries.get(*at)),
        };
        let Some(entry) = entry else { continue };
        counts[at] += 1;
        let _ = writeln!(out, "{word:<8}  {}", shown(&entry.about()));
        let _ = writeln!(out, "          {}", shown(entry.says()));
    }
    let [accepted, renewed, dropped] = counts;
    let _ = write!(out, "{accepted} accepted, {renewed} renewed, {dropped} dropped");
    match told.open.saturating_sub(accepted + renewed) {
        0 => {}
        open => {
            _ = write!(
                out,
                "; {} still open",
                if open == 1 { "1 question is".into() } else { format!("{open} questions are") }
            )
        }
    }
    if told.refused > 0 {
        let _ = write!(out, "; {} refused, of which nothing is accepted", plural(told.refused, "program"));
    }
    let _ = writeln!(out, "{}", if told.is_tried { " (nothing was written)" } else { "" });
    out
}
