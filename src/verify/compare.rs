//! Whether two runs amount to the same.

use super::names::{Names, Side, class_of};
use super::observe::observe;
use crate::control::trace::{Event, Happening, Position};
use crate::control::{End, Run, Stop};
use std::collections::BTreeSet;

/// How far numbers may lie apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Positions that are computed and not rounded on the way, millimetres.
    pub computed: f64,
    /// Positions that words rounded: the coarser least increment of the two controls, millimetres.
    pub rounded: f64,
}

impl Tolerance {
    /// Of two controls.
    pub fn of(source: &Side<'_>, target: &Side<'_>) -> Self {
        let increment = |side: &Side<'_>| {
            let numbers = side.control.numbers();
            numbers.increment_mm.max(numbers.increment_inch * 25.4)
        };
        Self { computed: 1e-6, rounded: increment(source).max(increment(target)) * 1.0001 }
    }
}

/// What a comparison found.
#[derive(Clone, Debug)]
pub struct Comparison<'r> {
    /// The first difference.
    pub difference: Option<Difference<'r>>,
    /// The largest distance between positions that counted as the same, millimetres.
    pub largest: f64,
    /// Texts that differ: messages, outputs, alarm numbers.
    pub texts: BTreeSet<(String, String)>,
}

/// A difference: the events that should be the same, where there are any, and what is wrong.
#[derive(Clone, Debug)]
pub struct Difference<'r> {
    /// Of the source.
    pub source: Option<&'r Event>,
    /// Of the target.
    pub target: Option<&'r Event>,
    /// What differs.
    pub what: String,
}

/// Compares what an observer could tell of two runs, and the variables that outlive them.
pub fn compare<'r>(
    source: (&Side<'_>, &'r Run),
    target: (&Side<'_>, &'r Run),
    names: &Names,
    tolerance: Tolerance,
) -> Comparison<'r> {
    let (ours, theirs) = (observe(source.1), observe(target.1));
    let mut found = Comparison { difference: None, largest: 0.0, texts: BTreeSet::new() };
    let mut pairs = ours.iter().zip(&theirs);
    found.difference = pairs.find_map(|(a, b)| {
        let what = differ(&a.what, &b.what, tolerance, &mut found.largest, &mut found.texts)?;
        Some(Difference { source: Some(a), target: Some(b), what })
    });
    if found.difference.is_some() || is_cut(source.1) || is_cut(target.1) {
        return found;
    }
    let beyond = (ours.get(theirs.len()), theirs.get(ours.len()));
    found.difference = match beyond {
        (Some(event), _) => Some(Difference {
            source: Some(event),
            target: None,
            what: "the target does less than the source".into(),
        }),
        (None, Some(event)) => Some(Difference {
            source: None,
            target: Some(event),
            what: "the target does more than the source".into(),
        }),
        (None, None) => end_differs(&source.1.end, &target.1.end)
            .or_else(|| variables_differ(source, target, names))
            .map(|what| Difference { source: None, target: None, what }),
    };
    found
}

/// True where the run was stopped from outside.
pub fn is_cut(run: &Run) -> bool {
    !matches!(run.end, End::Ended | End::Alarm { .. })
}

fn end_differs(source: &End, target: &End) -> Option<String> {
    let same = matches!((source, target), (End::Ended, End::Ended) | (End::Alarm { .. }, End::Alarm { .. }));
    (!same).then(|| "one of them ends with an alarm, the other does not".to_owned())
}

/// Compares the final values of variables that both sides keep from program to program.
fn variables_differ(source: (&Side<'_>, &Run), target: (&Side<'_>, &Run), names: &Names) -> Option<String> {
    if matches!(source.1.end, End::Alarm { .. }) {
        return None;
    }
    let shared = |name: &str| class_of(source.0.control, name).is_some_and(|class| class.class != "local");
    let mut all: BTreeSet<String> = names.variables.keys().cloned().collect();
    all.extend(source.1.variables.keys().chain(target.1.variables.keys()).cloned());
    for name in all.iter().filter(|name| shared(name)) {
        let Some(there) = names.variable(name, source.0.control, target.0.control) else { continue };
        let value = |side: &Side<'_>, run: &Run, name: &str| {
            let nullable = class_of(side.control, name).is_some_and(|class| class.nullable);
            run.variables.get(name).copied().or((!nullable).then_some(0.0))
        };
        let (a, b) = (value(source.0, source.1, name), value(target.0, target.1, &there));
        // What a control without vacancy never wrote is vacant on one that has it, and reads as 0 there.
        let never = |a: Option<f64>, b: Option<f64>| b.is_none() && a == Some(0.0);
        let is_nullable = class_of(source.0.control, name).is_some_and(|class| class.nullable);
        let same = match (a, b) {
            (Some(a), Some(b)) => (a - b).abs() <= 1e-6 * a.abs().max(b.abs()).max(1.0),
            (None, None) => true,
            _ => !is_nullable && never(a, b),
        };
        if !same {
            let show = |value: Option<f64>| value.map_or_else(|| "vacant".into(), |value| value.to_string());
            return Some(format!("{name} is {} at the end, {there} is {}", show(a), show(b)));
        }
    }
    None
}

/// The events' difference, if they have one.
fn differ(
    source: &Happening,
    target: &Happening,
    tolerance: Tolerance,
    largest: &mut f64,
    texts: &mut BTreeSet<(String, String)>,
) -> Option<String> {
    use Happening::*;
    let mut far = |a: &Position, b: &Position| {
        let most = a.0.iter().zip(b.0).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        *largest = largest.max(if most <= tolerance.rounded { most } else { 0.0 });
        // What is no number is as far as can be.
        exceeds(most, tolerance.rounded)
    };
    let apart = |a: f64, b: f64| exceeds((a - b).abs(), 1e-6 * a.abs().max(b.abs()).max(1.0));
    let about = |a: f64, b: f64| exceeds((a - b).abs(), tolerance.rounded.max(1e-4 * a.abs()));
    let wrong = match (source, target) {
        (Rapid { from, to }, Rapid { from: other_from, to: other }) => {
            (far(from, other_from) || far(to, other)).then_some("the rapid move goes elsewhere")
        }
        (Feed { to, feed, mode, .. }, Feed { to: other, feed: other_feed, mode: other_mode, .. }) => {
            if far(to, other) {
                Some("the feed move goes elsewhere")
            } else {
                (about(*feed, *other_feed) || mode != other_mode).then_some("the feed is another")
            }
        }
        (
            Arc { to, centre, radius, plane, sweep, feed, mode, .. },
            Arc {
                to: other,
                centre: other_centre,
                radius: other_radius,
                plane: other_plane,
                sweep: other_sweep,
                feed: other_feed,
                mode: other_mode,
                ..
            },
        ) => {
            if far(to, other) {
                Some("the arc ends elsewhere")
            } else if far(centre, other_centre) || about(*radius, *other_radius) || plane != other_plane {
                Some("the arc is another")
            } else if (sweep - other_sweep).abs() > 0.1 {
                Some("the arc goes the other way or another number of turns")
            } else {
                (about(*feed, *other_feed) || mode != other_mode).then_some("the feed is another")
            }
        }
        (Thread { to, lead, .. }, Thread { to: other, lead: other_lead, .. }) => {
            (far(to, other) || about(*lead, *other_lead)).then_some("the thread is another")
        }
        (
            Probe { aim, to, hit, feed, .. },
            Probe { aim: other_aim, to: other, hit: other_hit, feed: other_feed, .. },
        ) => (far(aim, other_aim) || far(to, other) || hit != other_hit || about(*feed, *other_feed))
            .then_some("the probe move is another"),
        (Dwell { seconds }, Dwell { seconds: other }) => {
            ((seconds - other).abs() > 1e-3).then_some("the wait is another")
        }
        (
            Spindle { direction, speed, surface },
            Spindle { direction: other, speed: other_speed, surface: other_surface },
        ) => (direction != other || (speed - other_speed).abs() > 0.5 || surface != other_surface)
            .then_some("the spindle turns otherwise"),
        (ToolLength { value, .. }, ToolLength { value: other, .. }) => {
            apart(*value, *other).then_some("another tool length is in force")
        }
        (CutterRadius { side, value, .. }, CutterRadius { side: other_side, value: other, .. }) => {
            (side != other_side || apart(*value, *other)).then_some("another cutter radius is in force")
        }
        (
            Write { state, subscripts, value },
            Write { state: other_state, subscripts: other_subscripts, value: other },
        ) => (state != other_state || subscripts != other_subscripts || apart(*value, *other))
            .then_some("another state of the machine is written"),
        (Message { text }, Message { text: other }) | (Output { text }, Output { text: other }) => {
            if text.trim() != other.trim() {
                texts.insert((text.clone(), other.clone()));
            }
            None
        }
        (Alarm(stop), Alarm(other)) => alarm_differs(stop, other, texts),
        (End { .. }, End { .. }) => end_code_differs(source, target),
        _ => (source != target).then_some("they do different things"),
    };
    wrong.map(str::to_owned)
}

/// An alarm of the program's own must be one on the target too; its number and text may be the target's.
fn alarm_differs(
    source: &Stop,
    target: &Stop,
    texts: &mut BTreeSet<(String, String)>,
) -> Option<&'static str> {
    if source.program_number.is_some() != target.program_number.is_some() {
        return Some("one alarm is the program's own, the other the control's");
    }
    if source.program_number.is_some() && source != target {
        let show = |stop: &Stop| format!("{} {}", stop.program_number.unwrap_or(0.0), stop.text);
        texts.insert((show(source), show(target)));
    }
    None
}

/// Which codes end a program alike: those that end it, and those that return from it.
fn end_code_differs(source: &Happening, target: &Happening) -> Option<&'static str> {
    use crate::canon::Op;
    let returns = |what: &Happening| match what {
        Happening::End { by } => matches!(by, Op::Return | Op::SubEnd),
        _ => false,
    };
    (returns(source) != returns(target)).then_some("one ends, the other returns to its caller")
}

/// True where a difference is larger than allowed, or no number at all.
fn exceeds(difference: f64, allowed: f64) -> bool {
    difference.is_nan() || difference > allowed
}
