//! Stops with a message and alarms, where the target has neither: it shows a text and then stops, or halts.
//!
//! An operator sees the same: the text, and a machine that stands. So a text that is shown right before a stop is read as
//! the message of that stop, on both sides, and `ALARM 1 TEXT` before a halt of the control as the program's own alarm.

use super::observe::{Act, What, prompt};
use crate::canon::{Op, Sys};
use crate::control::trace::{EventKind, Spindle};
use crate::control::{End, Stop};
use crate::dialect::Control;
use std::collections::BTreeSet;

/// True if the control has no stop with a message and no alarm of the program's own, but shows texts.
pub fn lacks_messages(control: &Control) -> bool {
    control.statement("print").is_some() && control.system_runs(Sys::StopMessage).next().is_none()
}

/// Reads texts before stops as messages. Between a text and its stop stands only what the stop itself switches off.
pub fn as_messages<'r>(acts: Vec<Act<'r>>, control: &Control) -> Vec<Act<'r>> {
    let mut out: Vec<Act<'_>> = Vec::with_capacity(acts.len());
    for act in acts {
        // A stop at which the operator sets a variable is a question.
        if let (EventKind::Asked { .. }, Some(last)) = (&*act.what, out.last_mut())
            && let EventKind::Message { text } = &*last.what
        {
            let text = prompt(text, control).to_owned();
            if text.is_empty() {
                // It says nothing but which variable is asked for.
                out.pop();
            } else {
                last.what = What::other(EventKind::Output { text });
            }
        }
        let text = out.iter().rposition(|earlier| !is_switched_off(&earlier.what));
        let shown = text.and_then(|at| match &*out[at].what {
            EventKind::Output { text } => Some((at, message(text, &act.what)?)),
            _ => None,
        });
        match shown {
            Some((at, what)) => {
                out.remove(at);
                let room = room(&what, control);
                out.push(Act { what: What::other(what), room, ..act });
            }
            None => out.push(act),
        }
    }
    out
}

/// How many characters more the control would have shown of what is a message here.
fn room(what: &EventKind, control: &Control) -> Option<usize> {
    let (limit, text) = match what {
        EventKind::Message { text } => ("message", text),
        EventKind::Alarm(stop) => ("message.alarm", &stop.text),
        _ => return None,
    };
    Some((control.limit(limit)? as usize).saturating_sub(text.chars().count()))
}

/// True for a spindle or coolant that stops.
fn is_switched_off(what: &EventKind) -> bool {
    matches!(
        what,
        EventKind::Spindle { direction: Spindle::Stopped, .. } | EventKind::Coolant { state: Op::CoolantOff }
    )
}

/// What a text and the act after it are together.
fn message(text: &str, next: &EventKind) -> Option<EventKind> {
    match next {
        EventKind::Stop => Some(EventKind::Message { text: text.to_owned() }),
        EventKind::Alarm(stop) if stop.program_number.is_none() => {
            let (number, text) = text.strip_prefix("ALARM ")?.split_once(' ').unwrap_or_default();
            let stop =
                Stop { program_number: Some(number.parse().ok()?), text: text.to_owned(), ..stop.clone() };
            Some(EventKind::Alarm(stop))
        }
        _ => None,
    }
}

/// Without the output that the target's profile says to leave out: a text before a stop is such, where the target stops
/// without one, and a text before a question that the target asks without one.
pub fn without_outputs<'r>(mut ours: Vec<Act<'r>>, theirs: Vec<Act<'r>>) -> (Vec<Act<'r>>, Vec<Act<'r>>) {
    let stops = |act: &Act<'_>| matches!(*act.what, EventKind::Stop | EventKind::Message { .. });
    let bare: Vec<bool> =
        theirs.iter().filter(|act| stops(act)).map(|act| *act.what == EventKind::Stop).collect();
    for (act, bare) in ours.iter_mut().filter(|act| stops(act)).zip(bare) {
        if bare && act.event.what == EventKind::Stop {
            act.what = What::Own(&act.event.what);
        }
    }
    let asked = questions(&theirs).into_iter().map(|(_, text)| text).collect::<Vec<_>>();
    let wanted = |number: usize| asked.get(number).copied().unwrap_or(true);
    (outputs_out(ours, wanted), outputs_out(theirs, |_| true))
}

/// Where questions are asked, and whether a text stands right before each.
fn questions(acts: &[Act<'_>]) -> Vec<(usize, bool)> {
    let asks = |act: &Act<'_>| matches!(*act.what, EventKind::Asked { .. });
    let text = |at: usize| at > 0 && is_output(&acts[at - 1]);
    acts.iter().enumerate().filter(|(_, act)| asks(act)).map(|(at, _)| (at, text(at))).collect()
}

fn is_output(act: &Act<'_>) -> bool {
    matches!(*act.what, EventKind::Output { .. })
}

/// What stands before a question is its text, and no output, if the question of that number has a text.
fn outputs_out<'r>(acts: Vec<Act<'r>>, wanted: impl Fn(usize) -> bool) -> Vec<Act<'r>> {
    let asked = questions(&acts).into_iter().enumerate();
    let texts: BTreeSet<usize> =
        asked.filter(|(number, (_, text))| *text && wanted(*number)).map(|(_, (at, _))| at - 1).collect();
    let stays = |at: usize, act: &Act<'_>| !is_output(act) || texts.contains(&at);
    acts.into_iter().enumerate().filter(|(at, act)| stays(*at, act)).map(|(_, act)| act).collect()
}

/// Why two ends are not the same, if they are not.
pub(super) fn end_differs(source: &End, target: &End) -> Option<String> {
    let same = matches!((source, target), (End::Ended, End::Ended) | (End::Alarm { .. }, End::Alarm { .. }));
    (!same).then(|| "one side ends with an alarm, the other does not".to_owned())
}

/// Texts that count as the same and are written differently.
pub(super) fn texts(source: &EventKind, target: &EventKind) -> Option<(String, String)> {
    let show = |what: &EventKind| match what {
        EventKind::Message { text } | EventKind::Output { text } => Some(text.trim().to_owned()),
        EventKind::Stop => Some(String::new()),
        EventKind::Alarm(stop) => {
            stop.program_number.map(|number| format!("{number} {}", stop.text).trim().to_owned())
        }
        _ => None,
    };
    Some((show(source)?, show(target)?)).filter(|(a, b)| a != b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_is_a_message_only_right_before_a_stop() {
        let stop = Stop::alarm("", "root of a negative number");
        let said = |text: &str| match message(text, &EventKind::Alarm(stop.clone())) {
            Some(EventKind::Alarm(stop)) => Some((stop.program_number, stop.text)),
            _ => None,
        };
        assert_eq!(said("ALARM 12 TOO DEEP"), Some((Some(12.0), "TOO DEEP".into())));
        assert_eq!(said("ALARM X TOO DEEP"), None);
        assert_eq!(said("TOO DEEP"), None);
        let text = || "TURN THE PART".to_owned();
        assert_eq!(message(&text(), &EventKind::Stop), Some(EventKind::Message { text: text() }));
        assert_eq!(message(&text(), &EventKind::OptionalStop), None);
    }
}
