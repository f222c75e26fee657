//! What a program leaves to whoever called it.
//!
//! A caller goes on in the modes, with the feed and in the frame of coordinates that a called program returns in.
//! They are no events, so they are compared as they stand at the return.

use super::compare::Tolerance;
use super::names::Side;
use super::observe::returns;
use super::substitutes::lacks;
use crate::canon::Op;
use crate::control::Run;
use crate::control::machine::Left;
use crate::control::scenario::AXES;
use std::collections::BTreeSet;

/// What two programs that return leave otherwise.
///
/// Where the source's control goes straight in a block of an arc that has no centre, arcs and lines leave the same.
/// Nothing is asked of the end of a main program: what a control resets there is its own matter. A mode is none
/// where a control has no code for what the other is in: no program of that control can rest on it.
pub fn left_differs(
    (source, run): (&Side<'_>, &Run),
    (target, other): (&Side<'_>, &Run),
    tolerance: Tolerance,
    substituted: &mut BTreeSet<String>,
) -> Option<String> {
    let (ours, theirs) = (run.left.as_ref()?, other.left.as_ref()?);
    let returned = |run: &Run| run.events.last().is_some_and(|last| returns(&last.what));
    if !(returned(run) && returned(other)) {
        return None;
    }
    // A conversion says which it is at each arc that a caller makes, and refuses one where that is not known.
    let is_line = |op: Op, side: &Side<'_>| match op {
        Op::Linear => true,
        Op::ArcCw | Op::ArcCcw => {
            side.control.behaviour("arc.without.centre").is_some_and(|row| row.value == "straight")
        }
        _ => false,
    };
    let has = |side: &Side<'_>, op: Op| side.control.code_for(op, &Default::default()).is_some();
    let same = |op: Op, there: Op| op == there || (is_line(op, source) && is_line(there, source));
    for ((_, op), (_, there)) in ours.modes.iter().zip(&theirs.modes) {
        if !same(*op, *there) && has(source, *there) && has(target, *op) {
            return Some(format!("it returns in {op}, the target in {there}"));
        }
    }
    // What a tap by its lead leaves is known only where a feed was in force before.
    if ours.feed == 0.0 && theirs.feed != 0.0 {
        let text = "the target returns with a feed, the source with that of its caller";
        substituted.insert(text.into());
    } else if (ours.feed - theirs.feed).abs() > 1e-4 * ours.feed.abs() {
        return Some(format!("it returns with a feed of {}, the target of {}", ours.feed, theirs.feed));
    }
    let allowed = tolerance.between(ours.rounded, theirs.rounded).min(tolerance.rounded);
    let apart = |a: f64, b: f64| (a - b).abs() > allowed;
    // Where the target cannot do without a work offset, the events say so.
    let uncancelled = ours.work == 0 && lacks(target, Op::ShiftCancel);
    if !uncancelled && (0..AXES).any(|axis| apart(ours.shift[axis], theirs.shift[axis])) {
        return Some("it returns with another shift of coordinates".into());
    }
    let turn = |left: &Left| left.rotation.map_or(0.0, |turn| turn.degrees);
    if apart(turn(ours), turn(theirs)) {
        return Some("it returns with another rotation of coordinates".into());
    }
    let same = ours.mirror == theirs.mirror && ours.scale == theirs.scale;
    (!same).then(|| "it returns with coordinates mirrored or scaled otherwise".into())
}
