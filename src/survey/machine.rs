//! What every profile should say of its machine, as lines to fill in.

use super::Survey;
use super::filled::{ASKS, after_dialect, plain, spliced};
use crate::dialect::{CODE_SYSTEM, Control, Profile, Side};

/// Of a machine that is taken as a lathe: the line that says so.
pub(super) fn lathe(survey: &Survey<'_>, side: Side) -> Option<String> {
    let taken = survey.taken.as_ref();
    let at = match side {
        Side::Source => 0,
        Side::Target => 1,
    };
    survey.is_open_lathe.get(at).filter(|open| **open)?;
    Some(match (side, taken) {
        (Side::Source, Some(taken)) => {
            format!("machine = \"lathe\" # or \"mill\": {} in {}", plain(&taken.sign), plain(&taken.place))
        }
        _ => "machine = \"lathe\" # as the programs are a lathe's".to_owned(),
    })
}

/// The G code system of a lathe whose profile does not say it, as a line, if programs do not show it. It is asked until it is answered.
pub(super) fn code_system(survey: &Survey<'_>, side: Side, old: Option<&str>) -> Option<String> {
    let key = format!("{ASKS} {CODE_SYSTEM} = ");
    let asks = lathe(survey, side).is_some() || old.is_some_and(|old| old.contains(&key));
    let control = survey.controls[usize::from(side == Side::Target)];
    let (system, row) = control.open_code_system().filter(|_| asks && !survey.shows_code_system(side))?;
    let others = row.values.iter().filter(|value| **value != system);
    let others = others.map(|value| format!("\"{value}\"")).collect::<Vec<_>>().join(" or ");
    Some(format!("{key}\"{system}\" # or {others}: {}\n", row.meaning))
}

/// What a new profile says without a question: what the programs themselves show.
pub(super) fn begun(survey: &Survey<'_>, side: Side, control: &Control) -> String {
    let mut text = format!("dialect = \"{}\"\n", control.name());
    if let Some(line) = lathe(survey, side) {
        text.push_str(&format!("{line}\n"));
    }
    if side == Side::Source && survey.shows_axes() {
        text.push_str(&format!(
            "{}; these are those that programs move\n",
            super::variables::axes_line(survey, control)
        ));
    }
    text
}

/// The text with what every profile should say of its machine, as far as this one does not and the library needs it.
pub(super) fn with_machine(
    text: &str,
    (survey, side, control): (&Survey<'_>, Side, &Control),
    point: Option<String>,
    unit: &str,
) -> String {
    let said = control.profile();
    let lathe = lathe(survey, side);
    let kind = lathe.as_deref().unwrap_or(if survey.shape.lathe > 0 {
        "machine = \"mill\" or \"lathe\" # some programs look like a lathe's"
    } else {
        "machine = \"mill\" or \"lathe\" # no program shows which of them it is for"
    });
    let Ok(profile) = Profile::read(text) else { return text.to_owned() };
    let units = format!(
        "units = \"inch\" or \"metric\" # what its programs are in where no code says so, and its settings{unit}"
    );
    let axes = super::variables::axes_line(survey, control);
    let open = survey.is_told("machine = \"mill\" or \"lathe\"");
    let mixed = (survey.shape.lathe > 0 || open) && said.machine.is_none();
    // Programs are given variables on the machine that they go to.
    let gives = side == Side::Target && survey.takes_registers();
    let all = [
        (profile.machine.is_none() && (mixed || lathe.is_some()), kind),
        (said.units.is_none() && survey.needs_units(side, control), units.as_str()),
        (point.is_some(), point.as_deref().unwrap_or_default()),
        (said.axes.is_none() && profile.axes.is_none() && survey.needs_axes(), &axes),
        (
            gives && !control.states_reserved(),
            "reserved = [] # variables that programs must not be given: those that the probe, the tool changer or the operator uses",
        ),
    ];
    let missing = all.iter().filter(|(missing, _)| *missing);
    let lines: String = missing.map(|(_, line)| format!("{ASKS} {line}\n")).collect();
    spliced(text, after_dialect(text, &profile), &lines)
}
