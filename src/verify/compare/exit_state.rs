//! What a program leaves to whoever goes on: the one that called it, or the next one that is started.
//!
//! A caller goes on in the modes, with the feed and in the frame of coordinates that a called program returns in.
//! They are no events, so they are compared as they stand at the return. After the end of a main program a person
//! still sees where the machine stands and what its tables hold. Which modes and shifts the next program finds is for
//! each control to say, and no source does: where they differ, that is told and not judged.

use super::kinds::returns;
use super::substitutes::lacks;
use super::tolerance::Tolerance;
use crate::canon::{Group, Op};
use crate::control::machine::ExitState;
use crate::control::scenario::{AXES, Axes, Tool};
use crate::control::trace::EventKind;
use crate::control::{Run, Table};
use crate::dialect::Question;
use crate::verify::sides::Side;
use std::collections::BTreeSet;

/// What two programs leave otherwise; what only a next program could tell goes to `substituted`, a feed that a tap may have left to
/// `replaced`.
pub fn left_differs(
    (source, run): (&Side<'_>, &Run),
    (target, other): (&Side<'_>, &Run),
    tolerance: Tolerance,
    substituted: &mut BTreeSet<String>,
    replaced: &mut BTreeSet<(Op, String)>,
) -> Option<String> {
    let (ours, theirs) = (run.left.as_ref()?, other.left.as_ref()?);
    let seen = seen_differs(ours, theirs, tolerance);
    if seen.is_some() {
        return seen;
    }
    let returned = |run: &Run| run.events.last().is_some_and(|last| returns(&last.what));
    if returned(run) && returned(other) {
        return state_differs((source, ours), (target, theirs), tolerance, substituted)
            .map(|what| format!("the exit state differs: it returns {what}"));
    }
    let mut scratch = BTreeSet::new();
    // No program is read as one that begins in a drilling cycle: a target that ends it leaves nothing out.
    let mut theirs = without_end_of_cycle(ours, theirs);
    let text = |what| {
        format!("the exit state differs: it ends {what}; no source says whether the next program inherits it")
    };
    let feed = feed_differs(ours, &theirs).filter(|_| !has_no_such_feed(ours, target));
    replaced.extend(feed.map(|what| (Op::CycleTapByLead, text(what))));
    theirs.feed = ours.feed;
    substituted.extend(state_differs((source, ours), (target, &theirs), tolerance, &mut scratch).map(text));
    None
}

/// A target without feeds per turn has none to compare: the conversion reports a return with one in force.
fn has_no_such_feed(ours: &ExitState, target: &Side<'_>) -> bool {
    ours.feed_by_turn && lacks(target, Op::FeedPerTurn)
}

/// Two feeds that differ, where the source has one.
fn feed_differs(ours: &ExitState, theirs: &ExitState) -> Option<String> {
    let differs = ours.feed != 0.0 && (ours.feed - theirs.feed).abs() > 1e-4 * ours.feed.abs();
    differs.then(|| format!("with a feed of {}, the target with {}", ours.feed, theirs.feed))
}

/// What the target leaves, where it ended the drilling cycle that the source leaves in force.
fn without_end_of_cycle(ours: &ExitState, theirs: &ExitState) -> ExitState {
    let mut left = theirs.clone();
    for ((group, op), (_, there)) in ours.modes.iter().zip(&mut left.modes) {
        if *group == Group::Cycle && *there == Op::CycleOff {
            *there = *op;
        }
    }
    left
}

/// What a program that is called, and that nobody knows, finds otherwise in the machine; none of two other events.
pub fn outside_differs(
    (source, ours): (&Side<'_>, &EventKind),
    (target, theirs): (&Side<'_>, &EventKind),
    tolerance: Tolerance,
) -> Option<String> {
    let (EventKind::Outside(ours), EventKind::Outside(theirs)) = (ours, theirs) else { return None };
    let found = found_differs((source, &ours.state), (target, &theirs.state), tolerance);
    found
        .filter(|_| ours.program == theirs.program)
        .map(|what| format!("where {} is called, {what}", ours.name()))
}

fn found_differs(
    (source, ours): (&Side<'_>, &ExitState),
    (target, theirs): (&Side<'_>, &ExitState),
    tolerance: Tolerance,
) -> Option<String> {
    if let Some(what) = seen_differs(ours, theirs, tolerance) {
        return Some(what.trim_end_matches(" at the end").to_owned());
    }
    if ours.work != theirs.work {
        return Some(format!("work offset {} is in force, on the target {}", ours.work, theirs.work));
    }
    let mut scratch = BTreeSet::new();
    state_differs((source, ours), (target, theirs), tolerance, &mut scratch)
        .map(|what| format!("the machine is {what}"))
}

/// What a person could tell of the machine after the end.
pub fn seen_differs(ours: &ExitState, theirs: &ExitState, tolerance: Tolerance) -> Option<String> {
    let allowed = tolerance.between(ours.rounded, theirs.rounded).max(tolerance.rounded);
    let apart = |a: f64, b: f64| (a - b).abs() > allowed;
    let places = |a: &Axes, b: &Axes| a.iter().zip(b).any(|(a, b)| apart(*a, *b));
    if places(&ours.position, &theirs.position) {
        return Some("the machine stands at another position at the end".into());
    }
    // The shift of all offsets is number 0. What the source keeps in the register of the local shift ends as that does:
    // it shows in the shift at a return.
    let external = (!ours.external_is_local && places(&ours.external, &theirs.external)).then_some(0);
    let offset = external.or_else(|| first_apart(&ours.work_offsets, &theirs.work_offsets, places));
    let sizes = |tool: &Tool| [tool.length, tool.length_wear, tool.radius, tool.radius_wear];
    let tools = |a: &Tool, b: &Tool| sizes(a).iter().zip(sizes(b)).any(|(a, b)| apart(*a, b));
    let offset = offset.map(|number| format!("work offset {number}"));
    let tool =
        || first_apart(&ours.tools, &theirs.tools, tools).map(|number| format!("tool offset {number}"));
    offset.or_else(tool).map(|what| format!("{what} has another value at the end"))
}

/// The first row that two tables hold otherwise; one that is not there holds zeros.
fn first_apart<T: Default>(
    ours: &Table<T>,
    theirs: &Table<T>,
    apart: impl Fn(&T, &T) -> bool,
) -> Option<u32> {
    if ours.is_shared_with(theirs) {
        return None;
    }
    let none = T::default();
    let mut all = ours.keys().chain(theirs.keys()).copied();
    all.find(|number| apart(ours.get(number).unwrap_or(&none), theirs.get(number).unwrap_or(&none)))
}

/// What two programs leave in force otherwise.
///
/// Where the source's control goes straight in a block of an arc that has no centre, arcs and lines leave the same.
/// A mode is none where a control has no code for what the other is in: no program of that control can rest on it.
fn state_differs(
    (source, ours): (&Side<'_>, &ExitState),
    (target, theirs): (&Side<'_>, &ExitState),
    tolerance: Tolerance,
    substituted: &mut BTreeSet<String>,
) -> Option<String> {
    // A conversion says which it is at each arc that a caller makes, and refuses one where that is not known.
    let is_line = |op: Op, side: &Side<'_>| match op {
        Op::Linear => true,
        Op::ArcCw | Op::ArcCcw => {
            side.control.behaviour(Question::ArcWithoutCentre).is_some_and(|row| row.value == "straight")
        }
        _ => false,
    };
    let has = |side: &Side<'_>, op: Op| side.control.code_for(op, &Default::default()).is_some();
    let same = |op: Op, there: Op| op == there || (is_line(op, source) && is_line(there, source));
    // Without a word of it each leaves the unit that its caller, or its machine, was in.
    let kept = |group: Group| group == Group::Units && !ours.unit_named && !theirs.unit_named;
    for ((_, op), (_, there)) in ours.modes.iter().zip(&theirs.modes).filter(|((group, _), _)| !kept(*group))
    {
        if !same(*op, *there) && has(source, *there) && has(target, *op) {
            return Some(format!("in {op}, the target in {there}"));
        }
    }
    // What a tap by its lead leaves is known only where a feed was in force before.
    if has_no_such_feed(ours, target) {
        // Nothing to compare.
    } else if ours.feed == 0.0 && theirs.feed != 0.0 {
        let text = "the target returns with a feed of its own, the source with its caller's feed";
        substituted.insert(text.into());
    } else if let Some(what) = feed_differs(ours, theirs) {
        return Some(what);
    }
    let allowed = tolerance.between(ours.rounded, theirs.rounded).min(tolerance.rounded);
    let apart = |a: f64, b: f64| (a - b).abs() > allowed;
    // Where the target cannot do without a work offset, the events say so.
    let uncancelled = ours.work == 0 && lacks(target, Op::ShiftCancel);
    // Whether a length that may be lost is back shows where it counts, and there nobody has to be asked if it is off.
    let ((length, is_lost), (there, is_lost_there)) = (ours.length, theirs.length);
    let may_be_off = (is_lost || is_lost_there) && (length == 0.0 || there == 0.0);
    let is_apart = apart(length, there) && !may_be_off;
    if !uncancelled && (is_apart || (0..AXES).any(|axis| apart(ours.shift[axis], theirs.shift[axis]))) {
        return Some("with a different shift of coordinates".into());
    }
    let turn = |left: &ExitState| left.rotation.map_or(0.0, |turn| turn.degrees);
    if apart(turn(ours), turn(theirs)) {
        return Some("with a different rotation of coordinates".into());
    }
    let same = ours.mirror == theirs.mirror && ours.scale == theirs.scale;
    (!same).then(|| "with a different mirror image or scale".into())
}
