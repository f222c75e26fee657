//! Waits in a row.
//!
//! A wait that is too long for one word of the target becomes several. Nothing stands between them, so that the machine
//! waits as long as all of them together.

use super::observe::{Act, What};
use crate::control::trace::EventKind;

/// One wait in the place of several in a row.
pub(super) fn together(acts: Vec<Act<'_>>) -> Vec<Act<'_>> {
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
    out
}

fn is_wait(act: &Act<'_>) -> bool {
    matches!(*act.what, EventKind::Dwell { .. })
}
