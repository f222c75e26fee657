//! What differs between two events.

use super::deeds::apart as apart_in_kind;
use super::kinds::returns;
use super::paths::{apart, arcs_apart};
use super::texts::say_the_same;
use crate::control::Stop;
use crate::control::trace::{EventKind, Leg, Position};
use std::collections::BTreeMap;

/// Seconds by which waits may lie apart: words count milliseconds, and round to the nearest.
pub(super) const LEAST_WAIT: f64 = 0.000_501;

/// What differs where only the feed does.
pub const ANOTHER_FEED: &str = "the feed differs";

/// Of events that are not of one kind, or of codes that are not the same.
const OTHERWISE: &str = "they do different things";

/// The events' difference, if they have one; ends may lie `allowed` apart, arcs between their ends `paths`; `room`
/// is what the target's text could have had more.
pub fn differ(
    (source, target): (&EventKind, &EventKind),
    room: Option<usize>,
    (allowed, paths): (f64, f64),
    largest: &mut f64,
) -> Option<&'static str> {
    use EventKind::*;
    let mut beyond = |most: f64| {
        *largest = largest.max(if most <= allowed { most } else { 0.0 });
        most > allowed
    };
    let far = |a: &Position, b: &Position| apart(a, b);
    let differs = |a: f64, b: f64| exceeds((a - b).abs(), 1e-6 * a.abs().max(b.abs()).max(1.0));
    let about = |a: f64, b: f64| exceeds((a - b).abs(), 1e-4 * a.abs());
    let written = |a: f64, b: f64| exceeds((a - b).abs(), allowed.max(1e-9 * a.abs()));
    match (source, target) {
        (Rapid { from, to }, Rapid { from: other_from, to: other }) => (beyond(far(from, other_from))
            || beyond(far(to, other)))
        .then_some("the rapid move goes elsewhere"),
        (Feed { to, feed, mode, .. }, Feed { to: other, feed: other_feed, mode: other_mode, .. }) => {
            if beyond(far(to, other)) {
                return Some("the feed move goes elsewhere");
            }
            (about(*feed, *other_feed) || mode != other_mode).then_some(ANOTHER_FEED)
        }
        (
            Arc { to, feed, mode, sweep, .. },
            Arc { to: other, feed: other_feed, mode: other_mode, sweep: other_sweep, .. },
        ) => {
            if beyond(far(to, other)) {
                Some("the arc ends elsewhere")
            } else if exceeds(arcs_apart(source, target), paths) {
                Some(match exceeds((sweep - other_sweep).abs(), 90.0) {
                    true => "the arc goes the other way, or makes another number of turns",
                    false => "the arc differs",
                })
            } else {
                (about(*feed, *other_feed) || mode != other_mode).then_some(ANOTHER_FEED)
            }
        }
        (
            Thread { to, lead, start, change, .. },
            Thread { to: other, lead: other_lead, start: other_start, change: other_change, .. },
        ) => {
            let turns = start != other_start || about(*change, *other_change);
            if beyond(far(to, other)) || about(*lead, *other_lead) || turns {
                Some("the thread differs")
            } else {
                runs_out_otherwise(source, target).then_some("the thread runs out otherwise")
            }
        }
        (
            Probe { aim, to, hit, feed, .. },
            Probe { aim: other_aim, to: other, hit: other_hit, feed: other_feed, .. },
        ) => {
            let apart = beyond(far(aim, other_aim)) || beyond(far(to, other));
            (apart || hit != other_hit || about(*feed, *other_feed)).then_some("the probe move differs")
        }
        (
            Roughing { cycle, depth, allowance, contour, rapid, feed, mode },
            Roughing {
                cycle: other,
                depth: other_depth,
                allowance: others,
                contour: legs,
                rapid: other_rapid,
                feed: other_feed,
                mode: other_mode,
            },
        ) => {
            let left = allowance.iter().zip(others).any(|(a, b)| written(*a, *b));
            if cycle != other || left || written(*depth, *other_depth) {
                Some("the roughing takes another depth, or leaves another allowance")
            } else if contours_differ(contour, legs, &mut beyond) {
                Some("the contour that is roughed differs")
            } else if rapid != other_rapid {
                Some("the passes go in otherwise: rapidly, or at the feed")
            } else {
                (about(*feed, *other_feed) || mode != other_mode).then_some(ANOTHER_FEED)
            }
        }
        (Dwell { seconds }, Dwell { seconds: other }) => {
            exceeds((seconds - other).abs(), LEAST_WAIT).then_some("the wait differs")
        }
        (
            Spindle { direction, speed, surface },
            Spindle { direction: other, speed: other_speed, surface: other_surface },
        ) => (direction != other || exceeds((speed - other_speed).abs(), 0.5) || surface != other_surface)
            .then_some("the spindle's direction or speed differs"),
        (Coolant { state }, Coolant { state: other }) => (state != other).then_some("the coolant differs"),
        (ToolChange { tool }, ToolChange { tool: other })
        | (ToolReady { tool }, ToolReady { tool: other }) => (tool != other).then_some("the tool differs"),
        (ToolLength { value, .. }, ToolLength { value: other, .. }) => {
            written(*value, *other).then_some("the tool length in force differs")
        }
        (
            CutterRadius { side, value, tip, .. },
            CutterRadius { side: other_side, value: other, tip: other_tip, .. },
        ) => (side != other_side || tip != other_tip || written(*value, *other))
            .then_some("the cutter radius in force differs"),
        // What stands in its row the scenarios leave open, so the number counts: both turrets have the same rows.
        (ToolOffset { offset, x, z }, ToolOffset { offset: other, x: other_x, z: other_z }) => {
            let sizes = written(*x, *other_x) || written(*z, *other_z);
            (offset != other || sizes).then_some("the tool offset in force differs")
        }
        (WorkOffset { number }, WorkOffset { number: other }) => {
            (number != other).then_some("the work offset in force at the return differs")
        }
        (
            Write { state, subscripts, value },
            Write { state: other_state, subscripts: other_subscripts, value: other },
        ) => (state != other_state || subscripts != other_subscripts || written(*value, *other))
            .then_some("the written state of the machine differs"),
        (Message { text }, Message { text: other }) | (Output { text }, Output { text: other }) => {
            (!say_the_same(text, other, room)).then_some("the text differs")
        }
        // The operator is shown more than before.
        (Stop, Message { .. }) => None,
        (Act { name, words, surface }, Act { name: other, words: others, surface: of_surface }) => {
            let near = |(word, value): (&String, &f64)| {
                others.get(word).is_some_and(|other| !differs(*value, *other))
            };
            if name != other {
                Some(OTHERWISE)
            } else {
                let same = words.len() == others.len() && words.iter().all(near);
                let counts = (surface != of_surface).then_some("S of a builder's code counts otherwise");
                if same { counts } else { Some("a word of a builder's code differs") }
            }
        }
        (Asked { answer }, Asked { answer: other }) => {
            differs(*answer, *other).then_some("the answer differs")
        }
        (Outside(call), Outside(other)) => {
            let apart = |ours: &BTreeMap<u32, f64>, theirs: &BTreeMap<u32, f64>| {
                let near = |(number, value): (&u32, &f64)| {
                    theirs
                        .get(number)
                        .is_some_and(|other| !written(*value, *other) || !differs(*value, *other))
                };
                ours.len() != theirs.len() || !ours.iter().all(near)
            };
            if call.program != other.program || call.runs != other.runs {
                Some("another program that stands in the machine is called, or another number of times")
            } else if apart(&call.locals, &other.locals) {
                Some("a program that stands in the machine gets other arguments")
            } else {
                apart(&call.common, &other.common)
                    .then_some("a program that stands in the machine finds other common variables")
            }
        }
        (Alarm(stop), Alarm(other)) => alarm_differs(stop, other, room),
        (End { .. }, End { .. }) => (returns(source) != returns(target))
            .then_some("one ends the program, the other returns to its caller"),
        (Alarm(_), _) => Some("the source stops with an alarm, the target goes on"),
        (_, Alarm(_)) => Some("the target stops with an alarm, the source goes on"),
        _ => (source != target).then_some(OTHERWISE),
    }
}

/// The difference of two events in words.
pub(super) fn told(what: &str, source: &EventKind, target: &EventKind) -> String {
    if what == OTHERWISE { apart_in_kind(source, target) } else { what.to_owned() }
}

/// True where two contours are not the same lines and arcs.
fn contours_differ(ours: &[Leg], theirs: &[Leg], beyond: &mut impl FnMut(f64) -> bool) -> bool {
    let mut legs = ours.iter().zip(theirs);
    let apart = |a: &Position, b: &Position| apart(a, b);
    ours.len() != theirs.len()
        || legs.any(|(a, b)| {
            let centres = a.centre.zip(b.centre).is_some_and(|(a, b)| beyond(apart(&a, &b)));
            a.centre.is_some() != b.centre.is_some()
                || a.ccw != b.ccw
                || centres
                || beyond(apart(&a.to, &b.to))
        })
}

/// An alarm of the program's own must be one on the target too, of the same number and text. Of what
/// stops the program for whoever runs it, the target may say itself what the source's control says: both stop there.
fn alarm_differs(source: &Stop, target: &Stop, room: Option<usize>) -> Option<&'static str> {
    match (source.program_number, target.program_number) {
        (None, None) => None,
        (Some(number), Some(other)) if exceeds((number - other).abs(), 1e-6) => {
            Some("the alarm's number differs")
        }
        (Some(_), Some(_)) => {
            (!say_the_same(&source.text, &target.text, room)).then_some("the alarm's text differs")
        }
        (None, Some(_)) if source.for_all => None,
        _ => Some("one alarm comes from the program, the other from the control"),
    }
}

/// True where the one thread runs out over another length than the other, as far as both are known.
fn runs_out_otherwise(source: &EventKind, target: &EventKind) -> bool {
    use EventKind::Thread;
    let (
        Thread { chamfer: Some(chamfer), chamfer_angle, .. },
        Thread { chamfer: Some(other), chamfer_angle: other_angle, .. },
    ) = (source, target)
    else {
        return false;
    };
    let another = exceeds((chamfer - other).abs(), 1e-3);
    another || (*chamfer > 0.0 && chamfer_angle != other_angle)
}

/// True where a difference is larger than allowed, or no number at all.
fn exceeds(difference: f64, allowed: f64) -> bool {
    difference.is_nan() || difference > allowed
}
