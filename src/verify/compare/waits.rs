//! Waits in a row.
//!
//! A wait that is too long for one word of the target becomes several. Nothing stands between them, so that the machine
//! waits as long as all of them together. A run that is cut may end amid them: how long it would have waited nobody knows.

use super::observe::{Act, What};
use crate::control::trace::EventKind;

/// One wait in the place of several in a row; none at the end of a run that is `cut`.
pub(super) fn together(acts: Vec<Act<'_>>, cut: bool) -> Vec<Act<'_>> {
    let mut out: Vec<Act<'_>> = Vec::with_capacity(acts.len());
    for act in acts {
        match (out.last_mut(), &*act.what) {
            (Some(last), EventKind::Dwell { seconds }) if is_wait(last) => {
                let before = if let EventKind::Dwell { seconds } = *last.what { seconds } else { 0.0 };
                last.what = What::other(EventKind::Dwell { seconds: before + seconds });
                last.rounded += act.rounded;
            }
            _ => out.push(act),
        }
    }
    if cut && out.last().is_some_and(is_wait) {
        out.pop();
    }
    out
}

fn is_wait(act: &Act<'_>) -> bool {
    matches!(*act.what, EventKind::Dwell { .. })
}
