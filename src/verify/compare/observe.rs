//! What an observer of the machine could tell of a run.

use super::kinds::{Setting, is_cut, is_mode, is_pause, returns, running, setting};
use super::loose::Order;
use super::paths::apart;
use super::substitutes::lacks;
use crate::canon::{Op, Sys};
use crate::control::Run;
use crate::control::trace::{Event, EventKind, FeedMode, Side, Spindle, Told};
use crate::dialect::Control;
use crate::verify::sides::Side as Library;
use std::ops::Deref;

/// Something that an observer could tell.
#[derive(Clone, Debug)]
pub struct Act<'r> {
    /// The event.
    pub event: &'r Event,
    /// What the observer tells of it: a stop at which the operator enters a value is a text and a question.
    pub what: What<'r>,
    /// By how much words rounded put it off, millimetres; of an arc in pieces the most of any.
    pub rounded: f64,
    /// What is known of the event.
    pub told: Told,
    /// Of a text, how many characters more the control would have shown; none if it knows no limit.
    pub room: Option<usize>,
}

/// What an observer tells of an event: the event as it is, or something else. Acts are moved from list to list, so it is
/// small.
#[derive(Clone, Debug)]
pub enum What<'r> {
    /// The event.
    Own(&'r EventKind),
    /// Something else.
    Other(Box<EventKind>),
}

impl Deref for What<'_> {
    type Target = EventKind;

    fn deref(&self) -> &EventKind {
        match self {
            What::Own(what) => what,
            What::Other(what) => what,
        }
    }
}

impl PartialEq for What<'_> {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

impl What<'_> {
    /// Something else than the event.
    pub fn other(what: EventKind) -> Self {
        What::Other(Box::new(what))
    }
}

/// The settings that a machine has before a program says anything. A spindle that was found running and is stopped keeps
/// its speed, which is nothing that anybody sees.
fn initial(run: &Run) -> Vec<EventKind> {
    let found = run.events.iter().take_while(|event| event.told == Told::Found);
    let speeds = found.filter_map(|event| match event.what {
        EventKind::Spindle { speed, .. } => Some(speed),
        _ => None,
    });
    let speed = speeds.last().unwrap_or(0.0);
    vec![
        EventKind::WorkOffset { number: 1 },
        EventKind::ToolLength { offset: 0, value: 0.0 },
        EventKind::CutterRadius { side: Side::Off, offset: 0, value: 0.0, tip: 0 },
        EventKind::ToolOffset { offset: 0, x: 0.0, z: 0.0 },
        EventKind::Spindle { direction: Spindle::Stopped, speed, surface: false },
        EventKind::Coolant { state: Op::CoolantOff },
    ]
}

/// A move that is no longer goes nowhere, millimetres: turning a place there and back leaves so much.
const NOWHERE: f64 = 1e-9;

/// The observable events of a run: calls and variables left out, moves that go nowhere and waits of no
/// time left out, and of the settings between two actions only those that changed, in one order.
///
/// Which work offset is selected shows in the machine coordinates of the moves, every offset having
/// values of its own; so the selection itself counts only where a program returns, for its caller. A tool length counts
/// from the next move along its axis on, and not before an M code of the machine's builder.
/// Which tool is made ready shows at the next change.
///
/// What `is_left_out` on the other side finds nothing there, so no setting counts before it. If the other side has no feed
/// per turn (`per_minute`), a cut feeds as fast as it does at the speed of the spindle.
fn observe<'r>(
    side: &Library<'_>,
    run: &'r Run,
    order: &Order<'r>,
    is_left_out: &dyn Fn(&EventKind) -> bool,
    per_minute: bool,
) -> Vec<Act<'r>> {
    let mut seen = Observer {
        side,
        out: Vec::new(),
        waiting: Vec::new(),
        held: Vec::new(),
        open: [false; 2],
        per_minute,
    };
    seen.held = initial(run).into_iter().filter_map(|what| Some((setting(&what)?, what))).collect();
    let events = order.events();
    for (at, event) in events.iter().copied().enumerate().filter(|(_, event)| is_observable(&event.what)) {
        if let Some(kind) = setting(&event.what) {
            // What the program says before a stop is told, whatever the stop does then; a speed alone says nothing of a
            // spindle that may stand.
            let implied = event.told == Told::Implied;
            let stays = |before: &Event| {
                let is_open = running(kind).is_some_and(|running| before.open[running as usize]);
                let said = (implied || before.told != Told::Found) && !is_open;
                said && (implied || is_end(&event.what)) && !is_end(&before.what)
            };
            if kind == Setting::Spindle && seen.waiting.iter().any(|(_, before)| is_as_found(before, event)) {
                continue;
            }
            seen.waiting.retain(|(other, before)| *other != kind || stays(before));
            seen.waiting.push((kind, event));
            continue;
        }
        // Which settings stand before a mode of corners, or before what is left out, and which after it nobody could tell.
        if !is_mode(&event.what) && !is_left_out(&event.what) {
            let (back, tool) = (returns(&event.what), finds_tool(&event.what));
            let across = is_across(&event.what) || is_machine_code(&event.what, side.control);
            seen.settle(|kind, event| match kind {
                Setting::Work => back,
                Setting::Length => !across,
                Setting::Ready => tool,
                // What was found running is nothing that counts before an idle move.
                Setting::Spindle | Setting::Coolant => !(is_idle(&event.what) && event.told == Told::Found),
                _ => true,
            });
        }
        seen.act(event, events.get(at + 1).copied());
    }
    // Where a run was stopped from outside, nothing says which settings the next action would have found.
    if !is_cut(run) {
        seen.settle(|kind, _| kind != Setting::Work);
    }
    seen.out
}

/// True for a setting that was found so, and is said again: nothing is new, and it still counts only before a cut.
fn is_as_found(before: &Event, event: &Event) -> bool {
    let known = before.open == [false; 2] && event.open == [false; 2];
    before.told == Told::Found && before.what == event.what && known
}

struct Observer<'o, 'r> {
    side: &'o Library<'o>,
    out: Vec<Act<'r>>,
    waiting: Vec<(Setting, &'r Event)>,
    held: Vec<(Setting, EventKind)>,
    /// For each of [`Running`], true if nobody knows whether it runs: what the program says of it next is told, even
    /// if it is what ran before.
    open: [bool; 2],
    /// True where a feed per turn is told as one per minute.
    per_minute: bool,
}

impl<'r> Observer<'_, 'r> {
    /// Lets the settings that count now take their places, if they changed.
    fn settle(&mut self, counts: impl Fn(Setting, &Event) -> bool) {
        self.waiting.sort_by_key(|(kind, _)| *kind);
        let all = std::mem::take(&mut self.waiting).into_iter();
        let (now, later): (Vec<_>, Vec<_>) = all.partition(|(kind, event)| counts(*kind, event));
        self.waiting = later;
        for (kind, event) in now {
            let old = self.held.iter_mut().find(|(other, _)| *other == kind);
            let is_news = running(kind)
                .is_some_and(|running| self.open[running as usize] && !event.open[running as usize]);
            if !is_news && old.as_ref().is_some_and(|(_, what)| *what == event.what) {
                continue;
            }
            if let Some(running) = running(kind) {
                self.open[running as usize] = event.open[running as usize];
            }
            match old {
                Some((_, what)) => *what = event.what.clone(),
                None => self.held.push((kind, event.what.clone())),
            }
            self.out.push(Act {
                event,
                what: What::Own(&event.what),
                rounded: event.rounded,
                told: event.told,
                room: None,
            });
        }
    }

    fn act(&mut self, event: &'r Event, next: Option<&Event>) {
        let room = |limit: &str, text: &str| {
            let limit = self.side.control.limit(limit)? as usize;
            Some(limit.saturating_sub(text.chars().count()))
        };
        let (what, room) = match &event.what {
            EventKind::Message { text } => {
                let room = room("message", text);
                let asks = next.is_some_and(|next| matches!(next.what, EventKind::Asked { .. }));
                match asks.then(|| prompt(text, self.side.control)) {
                    Some("") => return,
                    Some(text) => (What::other(EventKind::Output { text: text.to_owned() }), room),
                    None => (What::Own(&event.what), room),
                }
            }
            EventKind::Alarm(stop) => (What::Own(&event.what), room("message.alarm", &stop.text)),
            what => (self.in_minutes(what).map_or(What::Own(what), What::other), None),
        };
        self.out.push(Act { event, what, rounded: event.rounded, told: event.told, room });
        if is_pause(&event.what) {
            self.open = event.open;
        }
    }
}

/// What an observer could tell of each of two runs, in these orders; `is_left_out` of the target for the source.
pub(super) fn observed<'r>(
    (source, run): (&Library<'_>, &'r Run),
    (target, other): (&Library<'_>, &'r Run),
    [ours, theirs]: [&Order<'r>; 2],
    is_left_out: &dyn Fn(&EventKind) -> bool,
) -> [Vec<Act<'r>>; 2] {
    let by_minute = |other: &Library<'_>| lacks(other, Op::FeedPerTurn);
    let ours = observe(source, run, ours, is_left_out, by_minute(target));
    [ours, observe(target, other, theirs, &|_| false, by_minute(source))]
}

impl Observer<'_, '_> {
    /// A cut in feed per turn, with its feed per minute, where that is asked and the spindle has a speed of turns.
    fn in_minutes(&self, what: &EventKind) -> Option<EventKind> {
        if !self.per_minute {
            return None;
        }
        let turns = |kind: &Setting| *kind == Setting::Spindle;
        let speed = self.held.iter().find(|(kind, _)| turns(kind)).and_then(|(_, held)| match held {
            EventKind::Spindle { speed, surface: false, .. } => Some(*speed).filter(|speed| *speed > 0.0),
            _ => None,
        });
        let is_cut = matches!(what, EventKind::Feed { .. } | EventKind::Arc { .. });
        let speed = speed.filter(|_| is_cut)?;
        let mut what = what.clone();
        match &mut what {
            EventKind::Feed { feed, mode, .. } | EventKind::Arc { feed, mode, .. }
                if *mode == FeedMode::PerTurn =>
            {
                (*feed, *mode) = (*feed * speed, FeedMode::PerMinute);
                Some(what)
            }
            _ => None,
        }
    }
}

/// The question in a message that names the variable of the answer first: `#100 DEPTH`, `SET #100`.
pub(super) fn prompt<'t>(text: &'t str, control: &Control) -> &'t str {
    let rest = text.trim().trim_start_matches("SET ").trim_start();
    let numbered = |name: &str| {
        rest.strip_prefix(name).filter(|rest| rest.starts_with(|sign: char| sign.is_ascii_digit()))
    };
    match control.prefixes().into_iter().find_map(numbered) {
        Some(rest) => rest.trim_start_matches(|sign: char| sign.is_ascii_digit()).trim_start(),
        None => rest,
    }
}

/// True for a straight move that leaves the axis of the tool length where it is: which length is in force shows in none.
fn is_across(what: &EventKind) -> bool {
    const ALONG: usize = 2;
    match what {
        EventKind::Rapid { from, to } | EventKind::Feed { from, to, .. } => from.0[ALONG] == to.0[ALONG],
        _ => false,
    }
}

/// True for an M code of the machine's builder: no place in it counts the tool length.
fn is_machine_code(what: &EventKind, control: &Control) -> bool {
    let EventKind::Act { name, .. } = what else { return false };
    control.code_of(crate::canon::Act::named(name)).is_some_and(|row| row.code.starts_with('M'))
}

/// True for a move or a wait in which nothing is cut.
fn is_idle(what: &EventKind) -> bool {
    matches!(what, EventKind::Rapid { .. } | EventKind::Dwell { .. })
}

/// True for what stops the spindle or switches coolant off.
fn is_end(what: &EventKind) -> bool {
    use EventKind::{Coolant, Spindle};
    matches!(
        what,
        Spindle { direction: crate::control::trace::Spindle::Stopped, .. }
            | Coolant { state: Op::CoolantOff }
    )
}

/// True for what finds the tool that was made ready: a change, what goes on after an end, and what nobody knows.
fn finds_tool(what: &EventKind) -> bool {
    matches!(what, EventKind::ToolChange { .. } | EventKind::End { .. } | EventKind::Outside(_))
}

fn is_observable(what: &EventKind) -> bool {
    match what {
        EventKind::Rapid { from, to } | EventKind::Feed { from, to, .. } => apart(from, to) > NOWHERE,
        EventKind::Dwell { seconds } => *seconds > 0.0,
        // It shows in the machine coordinates of the moves, and in the table at the end.
        EventKind::Write { state: Sys::ExternalShift, .. } => false,
        EventKind::Variable { .. }
        | EventKind::Enter { .. }
        | EventKind::Leave
        | EventKind::Unsure { .. }
        | EventKind::Hole { .. } => false,
        _ => true,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::trace::Position;

    #[test]
    fn what_turning_there_and_back_leaves_is_no_move() {
        let to = |x: f64| {
            let mut to = Position::default();
            to.0[0] = x;
            is_observable(&EventKind::Rapid { from: Position::default(), to })
        };
        assert!(!to(0.0) && !to(3e-13));
        assert!(to(1e-6));
    }
}
