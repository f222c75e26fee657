//! Alarms of a program's own, on a control that has none: a stop that nothing gets past.
//!
//! An operator sees the same: the text, and a machine that stands, whoever presses start. Such a stop shows `ALARM 1 TEXT`.

use crate::canon::Sys;
use crate::control::trace::{EventKind, Told};
use crate::control::{End, Run, Stop};
use crate::dialect::Control;

/// Reads a run that ends at such a stop as one that ends with the alarm.
pub(super) fn stands(control: &Control, mut run: Run) -> Run {
    let shows = control.system_runs(Sys::Alarm).next().is_some() || control.statement("print").is_some();
    if shows || run.end != End::StepBudget {
        return run;
    }
    if let Some(event) = run.events.last_mut()
        && let EventKind::Message { text } = &event.what
        && let Some(stop) = alarm(text)
    {
        event.what = EventKind::Alarm(stop.clone());
        run.end = End::Alarm { at: event.at, stop };
        // What the stop itself ends is no act of the program: of an alarm nobody asks it.
        let alarm = run.events.pop();
        while run.events.last().is_some_and(|event| event.told == Told::Implied) {
            run.events.pop();
        }
        run.events.extend(alarm);
    }
    run
}

/// The alarm in `ALARM 12 TOO DEEP`.
fn alarm(text: &str) -> Option<Stop> {
    let rest = text.strip_prefix("ALARM ")?;
    let (number, text) = rest.split_once(' ').unwrap_or((rest, ""));
    Some(Stop { program_number: Some(number.parse().ok()?), ..Stop::alarm("", text) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_alarm_has_a_number_and_perhaps_a_text() {
        let said = |text| alarm(text).map(|stop| (stop.program_number, stop.text));
        assert_eq!(said("ALARM 12 TOO DEEP"), Some((Some(12.0), "TOO DEEP".into())));
        assert_eq!(said("ALARM 1"), Some((Some(1.0), String::new())));
        assert_eq!(said("ALARM X TOO DEEP"), None);
        assert_eq!(said("TOO DEEP"), None);
    }
}
