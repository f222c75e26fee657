//! What an observer of the machine could tell of a run.

use crate::canon::Op;
use crate::control::Run;
use crate::control::trace::{Event, Happening, Side, Spindle};

/// A group of settings, of which only what is in force at the next action counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Setting {
    Work,
    Length,
    Cutter,
    Limit,
    Ready,
    Spindle,
    Coolant,
}

fn setting(what: &Happening) -> Option<Setting> {
    Some(match what {
        Happening::WorkOffset { .. } => Setting::Work,
        Happening::ToolLength { .. } => Setting::Length,
        Happening::CutterRadius { .. } => Setting::Cutter,
        Happening::SpeedLimit { .. } => Setting::Limit,
        Happening::ToolReady { .. } => Setting::Ready,
        Happening::Spindle { .. } => Setting::Spindle,
        Happening::Coolant { .. } => Setting::Coolant,
        _ => return None,
    })
}

/// The settings that a machine has before a program says anything.
fn initial() -> Vec<Happening> {
    vec![
        Happening::WorkOffset { number: 1 },
        Happening::ToolLength { offset: 0, value: 0.0 },
        Happening::CutterRadius { side: Side::Off, offset: 0, value: 0.0 },
        Happening::Spindle { direction: Spindle::Stopped, speed: 0.0, surface: false },
        Happening::Coolant { state: Op::CoolantOff },
    ]
}

/// The observable events of a run: calls and variables left out, moves that go nowhere and waits of no
/// time left out, and of the settings between two actions only those that changed, in one order.
pub fn observe(run: &Run) -> Vec<&Event> {
    let mut out: Vec<&Event> = Vec::new();
    let mut waiting: Vec<(Setting, &Event)> = Vec::new();
    let mut held: Vec<(Setting, Happening)> =
        initial().into_iter().filter_map(|what| Some((setting(&what)?, what))).collect();
    for event in run.events.iter().filter(|event| is_observable(&event.what)) {
        if let Some(kind) = setting(&event.what) {
            waiting.retain(|(other, _)| *other != kind);
            waiting.push((kind, event));
            continue;
        }
        settle(&mut waiting, &mut held, &mut out);
        out.push(event);
    }
    settle(&mut waiting, &mut held, &mut out);
    out
}

/// Lets the settings that changed take their places.
fn settle<'r>(
    waiting: &mut Vec<(Setting, &'r Event)>,
    held: &mut Vec<(Setting, Happening)>,
    out: &mut Vec<&'r Event>,
) {
    waiting.sort_by_key(|(kind, _)| *kind);
    for (kind, event) in waiting.drain(..) {
        let old = held.iter_mut().find(|(other, _)| *other == kind);
        if old.as_ref().is_some_and(|(_, what)| *what == event.what) {
            continue;
        }
        match old {
            Some((_, what)) => *what = event.what.clone(),
            None => held.push((kind, event.what.clone())),
        }
        out.push(event);
    }
}

fn is_observable(what: &Happening) -> bool {
    match what {
        Happening::Rapid { from, to } | Happening::Feed { from, to, .. } => from != to,
        Happening::Dwell { seconds } => *seconds > 0.0,
        Happening::Variable { .. }
        | Happening::Enter { .. }
        | Happening::Leave
        | Happening::Unsure { .. }
        | Happening::Hole { .. } => false,
        _ => true,
    }
}
