//! What every profile should say of its machine, as lines to fill in.

use super::Survey;
use super::filled::{ASKS, after_dialect, plain, spliced};
use crate::dialect::{Profile, Side};

/// Of a machine that is taken as a lathe: the line that says so, and its G code system with what that is, if it has several.
pub(super) fn lathe(survey: &Survey<'_>, side: Side) -> Option<(String, Option<(String, String)>)> {
    let taken = survey.taken.as_ref();
    let at = match side {
        Side::Source => 0,
        Side::Target => 1,
    };
    survey.is_open_lathe.get(at).filter(|open| **open)?;
    let line = match (side, taken) {
        (Side::Source, Some(taken)) => {
            format!("machine = \"lathe\" # or \"mill\": {} in {}", plain(&taken.sign), plain(&taken.place))
        }
        _ => "machine = \"lathe\" # as the programs are a lathe's".to_owned(),
    };
    let system = survey.controls[at].open_code_system().map(|(system, row)| {
        let others = row.values.iter().filter(|value| **value != system);
        let others = others.map(|value| format!("\"{value}\"")).collect::<Vec<_>>().join(" or ");
        (system.to_owned(), format!("or {others}: {}", row.meaning))
    });
    Some((line, system))
}

/// The text with what every profile should say of its machine, as far as this one does not.
pub(super) fn with_machine(
    text: &str,
    said: &Profile,
    side: Side,
    (lathe, point): (Option<String>, Option<String>),
    (unit, axes): (&str, &str),
) -> String {
    let kind = lathe.as_deref().unwrap_or("machine = \"mill\" or \"lathe\"");
    let Ok(profile) = Profile::read(text) else { return text.to_owned() };
    let units =
        format!("units = \"inch\" or \"metric\" # what its programs are in where no code says so{unit}");
    // Programs are given variables on the machine that they go to.
    let gives = side == Side::Target;
    let all = [
        (said.title.is_none(), "title = \"\" # what people call the machine"),
        (said.machine.is_none() || lathe.is_some(), kind),
        (said.units.is_none(), units.as_str()),
        (point.is_some(), point.as_deref().unwrap_or_default()),
        (said.axes.is_none(), axes),
        (
            gives && profile.place("reserved").is_none(),
            "reserved = [] # variables that programs must not be given",
        ),
    ];
    let missing = all.iter().filter(|(missing, _)| *missing);
    let lines: String = missing.map(|(_, line)| format!("{ASKS} {line}\n")).collect();
    spliced(text, after_dialect(text, &profile), &lines)
}
