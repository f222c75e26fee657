//! Waits in a row.
//!
//! A wait that is too long for one word of the target becomes several. Nothing stands between them, so that the machine
//! waits as long as all of them together. A run that is cut may end amid them: how long it would have waited nobody knows.

use super::differ::LEAST_WAIT;
use super::observe::Act;
use crate::control::trace::EventKind;

/// How many waits of each side are as long as those of the other, where both sides wait and one of them in parts.
pub(super) fn as_long([ours, theirs]: [&[Act<'_>]; 2], cut: bool) -> Option<[usize; 2]> {
    let mut waited = [seconds(ours, 0)?, seconds(theirs, 0)?];
    let mut count = [1, 1];
    loop {
        let [a, b] = waited;
        if (a - b).abs() <= LEAST_WAIT * count[0].max(count[1]) as f64 {
            return Some(count);
        }
        let (side, acts) = if a < b { (0, ours) } else { (1, theirs) };
        match seconds(acts, count[side]) {
            Some(more) => waited[side] += more,
            None => return (cut && acts.len() == count[side]).then_some(count),
        }
        count[side] += 1;
    }
}

/// How long an act waits, if it is a wait.
fn seconds(acts: &[Act<'_>], at: usize) -> Option<f64> {
    match *acts.get(at)?.what {
        EventKind::Dwell { seconds } => Some(seconds),
        _ => None,
    }
}
