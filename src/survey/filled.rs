//! A machine profile with what a survey asks of it, as lines to fill in.
//!
//! What stands in the profile stays, byte for byte. Each question is a comment that begins with `#?`: who answers it takes
//! these signs away. What is told of questions begins with `#:`, as nothing there is filled in. The next survey takes out
//! what is left of both, and puts its own in.

use super::keys::{needed_by, setting_of};
use super::machine::{begun, code_system, with_machine};
use super::start::lines as lines_of_start;
use super::unseen;
use super::words::with_words;
use super::{AskedSetting, AskedStart, AskedWord, Survey};
use crate::dialect::{CODE_SYSTEM, Control, Profile, Setting, Settled, Side};
use crate::report::{Fact, Questions};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

/// What a line begins with that is a question.
pub(super) const ASKS: &str = "#?";
/// What a line begins with that tells of questions.
pub(super) const TELLS: &str = "#:";
/// Letters of a question's text.
const LONGEST: usize = 300;
/// Why a profile could not be filled.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "the questions do not fit into this profile: {0}. Write it in the form of machines/*.toml, with [sections]"
)]
pub struct Unfit(String);

/// The profile's text with the questions of the survey. An `old` text is kept; without one a new profile begins.
///
/// # Errors
/// If putting the questions in would change what the profile says.
pub fn filled(survey: &Survey<'_>, side: Side, old: Option<&str>) -> Result<String, Unfit> {
    let control = survey.controls[usize::from(side == Side::Target)];
    let mut text = old.map_or_else(|| begun(survey, side, control), without_questions);
    if !text.ends_with('\n') {
        text.push('\n');
    }
    let before = read(old.unwrap_or(&text))?;
    let mut asked = survey.with_all(|questions| lines(questions, control));
    let left = super::families::left(survey, side, control);
    for setting in survey.settings.iter().filter(|setting| setting.side == side) {
        if left.contains(&setting.name.as_str()) || super::families::is_answered(setting, control, &asked) {
            continue;
        }
        if let Some(fact) = setting.fact() {
            let (what, about) = (short(&plain(&setting.meaning)), counted(setting.programs, &setting.places));
            let _ =
                writeln!(asked.entry(unseen::SECTION).or_default(), "{ASKS} \"{fact}\", # {what} ({about})");
            continue;
        }
        let lines = asked.entry(setting.section).or_default();
        let line = super::families::or_each(line_of(setting, control.profile()), setting, &left);
        let names = [format!("{ASKS} {} = ", setting.name), format!("{ASKS} \"{}\" = ", setting.name)];
        if !names.iter().any(|name| lines.contains(name)) {
            lines.push_str(&line);
        }
    }
    if side == Side::Target && !survey.far_places.is_empty() {
        asked.entry("behaviours").or_default().push_str(&super::far_places::told(&survey.far_places));
    }
    super::kept::others(old.unwrap_or_default(), &|file| survey.has_file(file), &mut asked);
    if let Some(lines) = asked.remove(unseen::SECTION) {
        asked.insert(unseen::SECTION, unseen::together(&lines));
    }
    if let Some(line) = code_system(survey, side, old) {
        let lines = asked.entry("settings").or_default();
        if !lines.contains(&format!("{ASKS} {CODE_SYSTEM} = ")) {
            lines.insert_str(0, &line);
        }
    }
    let start = if side == Side::Source { &survey.start } else { &survey.start_of_target };
    let (unit, start): (Vec<_>, Vec<_>) = start.iter().cloned().partition(AskedStart::is_unit);
    if !start.is_empty() {
        asked.insert("start", lines_of_start(&start, control.profile().start.codes.as_deref()));
    }
    let codes = match side {
        Side::Source => super::site_rows::lines(survey),
        Side::Target => super::there::lines(survey),
    };
    for (section, lines) in &asked {
        text = inserted(&text, section, lines)?;
    }
    let codes = super::kept::codes(old.unwrap_or_default(), &|file| survey.has_file(file), codes);
    if !codes.is_empty() {
        text = inserted(&text, super::site_rows::SECTION, &codes)?;
    }
    let point = survey.with_all(|questions| point(questions, control));
    let unit =
        unit.first().map_or(String::new(), |unit| format!(" ({})", counted(unit.programs, &unit.places)));
    text = with_machine(&text, (survey, side, control), point, &unit);
    let words: Vec<&AskedWord> = survey.words.iter().filter(|asked| asked.side == side).collect();
    text = with_words(&text, &words, (ASKS, TELLS));
    text = match side {
        Side::Source => super::variables::asked_in(&text, survey),
        Side::Target => super::signals::asked_in(&super::programs::asked_in(&text, survey), survey),
    };
    match read(&text)? == before {
        true => Ok(text),
        false => Err(Unfit("they would change what it says".into())),
    }
}

fn read(text: &str) -> Result<Profile, Unfit> {
    let read = Profile::read(text);
    read.map(Profile::without_places).map_err(|faults| {
        let first = faults.first().map(|fault| fault.message.to_string());
        Unfit(first.unwrap_or_default())
    })
}

/// True for a line of a survey.
fn is_asked(line: &str) -> bool {
    [ASKS, TELLS].iter().any(|sign| line.trim_start().starts_with(sign))
}

/// The text without the questions of an earlier survey.
fn without_questions(text: &str) -> String {
    text.split_inclusive('\n').filter(|line| !is_asked(line)).collect()
}

/// What numbers without a decimal point count, as a line, if programs rest on it.
fn point(questions: &Questions<'_>, control: &Control) -> Option<String> {
    let fact = facts(questions, control).find(|fact| fact.settled_by == Settled::POINT)?;
    let places = counted(fact.asked.programs, &fact.asked.places);
    let choice = "decimal_point = \"calculator\" or \"increments\"";
    Some(format!("{choice} # what X10 without a point counts: whole units, or least increments ({places})"))
}

fn facts<'q, 'a>(questions: &'q Questions<'a>, control: &Control) -> impl Iterator<Item = &'q Fact<'a>> {
    let is_it = |of: &Control| of.name() == control.name() && of.profile().file == control.profile().file;
    questions.machines.iter().filter(move |machine| is_it(machine.control)).flat_map(|machine| &machine.facts)
}

/// The questions of a machine as lines, by section of its profile; those of most programs first.
fn lines(questions: &Questions<'_>, control: &Control) -> BTreeMap<&'static str, String> {
    let mut all: BTreeMap<&'static str, String> = BTreeMap::new();
    for fact in facts(questions, control) {
        let (section, line) = match &fact.settled_by {
            Settled::Confirmed(name) => (unseen::SECTION, format!("\"{name}\",")),
            Settled::Setting { section, name, values } => (*section, Settled::choice(name, values)),
            // They stand at the head of every profile that does not say them.
            Settled::Key { .. } => continue,
            Settled::Answer { question, answers } => ("behaviours", format!("\"{question}\" = {answers}")),
        };
        let _ = writeln!(all.entry(section).or_default(), "{ASKS} {line} # {}", about(fact, control));
    }
    all
}

/// A setting that programs wait for, as a line. What the profile says already is no key again.
fn line_of(setting: &AskedSetting, said: &Profile) -> String {
    let AskedSetting { name, section, values, default, meaning, .. } = setting;
    let choice = match *section {
        // A name with points is one key.
        super::speeds::SECTION => super::speeds::line(name),
        "behaviours" => Settled::choice(&format!("\"{name}\""), values),
        _ => Settled::choice(name, values),
    };
    let usual = default.as_ref().map_or(String::new(), |default| format!("; {default} if nobody changed it"));
    let stated = match *section {
        "parameters" => &said.parameters,
        "behaviours" => &said.behaviours,
        _ => &said.settings,
    };
    let other = if stated.contains_key(name) { "# another value than below: " } else { "" };
    let where_needed = needed_by(setting);
    format!("{ASKS} {other}{choice} # {} ({where_needed}{usual})\n", short(&plain(meaning)))
}

/// `4 programs: a.nc:3, b.nc:1`.
pub(super) fn counted(programs: usize, places: &[String]) -> String {
    let programs = if programs == 1 { String::new() } else { format!("{programs} programs: ") };
    format!("{programs}{}", plain(&places.join(", ")))
}

/// A text that a line has room for, cut between two words.
fn short(text: &str) -> String {
    match text.char_indices().nth(LONGEST) {
        None => text.to_owned(),
        Some((end, _)) => {
            let kept = text.get(..end).unwrap_or_default();
            let words = kept.rsplit_once(' ').map_or(kept, |(words, _)| words);
            format!("{} ...", words.trim_end_matches([',', ';', ':']))
        }
    }
}

fn about(fact: &Fact<'_>, control: &Control) -> String {
    let asked = &fact.asked;
    // The fact's name stands before, and whose it is is plain in a profile.
    let title = format!("{}: ", control.dialect().title);
    let said = asked.text.split_once(&title).map_or(asked.text, |(_, said)| said);
    // Which value of a parameter is which stands in its own row.
    // A setting that answers several questions is about this one here.
    let said = setting_of(fact, control)
        .filter(|row| answers(row).len() < 2)
        .map_or(said, |row| row.meaning.as_str());
    format!("{} ({})", short(&plain(said)), counted(asked.programs, &asked.places))
}

/// The questions that a setting answers.
fn answers(row: &Setting) -> BTreeSet<&str> {
    row.sets.values().flatten().map(|(target, _)| target.as_str()).collect()
}

/// Text that stays on its line, and is a comment.
pub(super) fn plain(text: &str) -> String {
    text.chars().map(|letter| if letter.is_control() { ' ' } else { letter }).collect()
}

/// The text with lines in a section: before what stands there, or in a section of their own.
fn inserted(text: &str, section: &str, lines: &str) -> Result<String, Unfit> {
    let profile = Profile::read(text).map_err(|_| Unfit("it cannot be read".into()))?;
    if section == "confirm" {
        let Some(list) = profile.place("confirm") else {
            // It stands at the top, before all sections.
            let head = profile.place("dialect").map(|place| place.end).unwrap_or_default();
            let head =
                text.get(head..).and_then(|rest| rest.find('\n')).map_or(text.len(), |end| head + end + 1);
            return Ok(spliced(text, head, &format!("confirm = [\n{lines}]\n")));
        };
        let first = list.start + 1;
        return Ok(match text.get(first..).is_some_and(|rest| rest.starts_with('\n')) {
            true => spliced(text, first + 1, lines),
            false => spliced(text, first, &format!("\n{lines}")),
        });
    }
    let header = format!("[{section}]");
    let mut at = 0;
    for line in text.split_inclusive('\n') {
        at += line.len();
        if line.trim_end() == header || line.trim_end().starts_with(&format!("{header} ")) {
            let end = if line.ends_with('\n') { "" } else { "\n" };
            return Ok(spliced(text, at, &format!("{end}{lines}")));
        }
    }
    if profile.place(section).is_some() {
        return Err(Unfit(format!("'{section}' is no section")));
    }
    // A section that holds only questions says nothing, and stands last but for the codes.
    let end = if text.is_empty() || text.ends_with('\n') { "" } else { "\n" };
    let first_site = text.find("\n[[").map_or(text.len(), |at| with_comments(text, at + 1));
    Ok(spliced(text, first_site, &format!("{end}\n{header}\n{lines}")))
}

/// Where the comments begin that stand right above the line at `at`: they are about it.
fn with_comments(text: &str, at: usize) -> usize {
    let before = text.get(..at).unwrap_or_default();
    let own = before.split_inclusive('\n').rev().take_while(|line| line.starts_with('#') && !is_asked(line));
    at - own.map(str::len).sum::<usize>()
}

/// The end of the line that names the dialect: what stands there is in no section.
pub(super) fn after_dialect(text: &str, profile: &Profile) -> usize {
    let head = profile.place("dialect").map(|place| place.end).unwrap_or_default();
    text.get(head..).and_then(|rest| rest.find('\n')).map_or(text.len(), |end| head + end + 1)
}

pub(super) fn spliced(text: &str, at: usize, more: &str) -> String {
    let (before, after) = text.split_at_checked(at).unwrap_or((text, ""));
    format!("{before}{more}{after}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::library::Input;
    use crate::survey::survey;

    fn control(profile: &str) -> Control {
        Control::from_profile(profile).unwrap()
    }

    fn filled_for(program: &str, profile: Option<&str>) -> String {
        let inputs = [Input { path: "a.nc".into(), name: "a.nc".into(), bytes: program.into() }];
        let (source, target) =
            (control(profile.unwrap_or("dialect = \"fanuc\"\n")), control("dialect = \"haas\"\n"));
        filled(&survey(&inputs, &source, Some(&target)), Side::Source, profile).unwrap()
    }

    const PROGRAM: &str = "O1000\nG21 G90\nM14 (CHUCK \"AIR\")\n(DOOR)\nM38\n#3006=1 (STOP)\n#1=ATAN[1.]/[2.]\nG83 X1. \
                           Y1. R1. Z-5. Q2. F9.\nX[1/#500]\nM30\n";

    /// What stands in the text without its questions.
    fn said(text: &str) -> Vec<&str> {
        text.lines().filter(|line| !is_asked(line) && !line.is_empty()).collect()
    }

    #[test]
    fn a_new_profile_asks_for_each_code_once() {
        let text = filled_for(PROGRAM, None);
        for line in [
            "#? M14 = { target = \"\", text = \"CHUCK AIR\" } # a.nc:3; as in: M14 (CHUCK \"AIR\")",
            "#? M38 = { target = \"\", text = \"DOOR\" } # a.nc:5; as in: M38",
        ] {
            assert_eq!(text.lines().filter(|own| *own == line).count(), 1, "{line}\n{text}");
        }
        assert!(Profile::read(&text).unwrap().site.is_empty());
    }

    /// A new section does not part a table from the comment above it.
    #[test]
    fn comments_stay_with_their_tables() {
        let own = "# The door of the new cell.\n[[site]]\ncode = \"M38\"\ndo = \"omit\"\n";
        let text = filled_for(PROGRAM, Some(&format!("dialect = \"fanuc\"\n\n{own}")));
        assert!(text.contains(&format!("\n{own}")) && text.contains("\n[codes]\n"), "{text}");
    }

    #[test]
    fn it_is_the_same_when_nothing_was_answered() {
        for profile in [
            "dialect = \"fanuc\"",
            &filled_for(PROGRAM, None),
            "# mine\ndialect = \"fanuc\"\nconfirm = []\n[settings]\nm_stop = \"end\"",
            "dialect = \"fanuc\" # 0i\nunits = \"metric\"\nconfirm = [\"numbers\"]\n\n[behaviours] # found\n\n[[site]]\ncode = \
             \"M14\"\ntext = \"air\"\ndo = \"omit\"\n",
            "dialect = \"fanuc\"\n[codes]\nM14 = { do = \"omit\" }\n[[site]]\ncode = \"M38\"\ndo = \"omit\"\n",
        ] {
            let once = filled_for(PROGRAM, Some(profile));
            assert_eq!(said(&once), said(&filled_for(PROGRAM, Some(&once))), "{once}");
            assert_eq!(once, filled_for(PROGRAM, Some(&once)));
            let lines = said(&once);
            let kept = said(profile).into_iter().filter(|line| !line.starts_with("confirm"));
            assert!(kept.into_iter().all(|line| lines.contains(&line)), "{once}");
        }
    }

    #[test]
    fn what_is_answered_stays_and_is_not_asked_again() {
        let text = filled_for(PROGRAM, None);
        let answered = text.replace("#? M14 = { target = \"\",", "M14 = { do = \"omit\",");
        let again = filled_for(PROGRAM, Some(&answered));
        assert!(!again.contains("#? M14 =") && again.contains("#? M38 ="), "{again}");
        assert!(again.contains("\nM14 = { do = \"omit\", text = \"CHUCK AIR\" } #"), "{again}");
        assert_eq!(Profile::read(&again).unwrap().site.len(), 1);
    }

    #[test]
    fn codes_of_another_system_are_asked_by_its_name() {
        let program = "O1\nT0101\nG95 G90 G0 X50. Z2.\nG92 S3000\nM30\n";
        let text = filled_for(program, Some("dialect = \"fanuc\"\nmachine = \"lathe\"\n"));
        assert!(text.contains("#? gcode_system = \"B\" or \"C\" or \"A\""), "{text}");
        assert!(!text.contains("code = \"G95\""), "{text}");
    }

    #[test]
    fn what_the_profile_says_is_no_key_again() {
        let text = filled_for(PROGRAM, Some("dialect = \"fanuc\"\naxes = [\"X\", \"Y\", \"Z\"]\n"));
        assert!(!text.contains("#? axes") && !text.contains("#? title"), "{text}");
        let bare = "O1\nG90 G54 G17 G94 G0 X1. Y1.\nM30\n";
        assert!(filled_for(bare, None).contains("#? units"));
        assert!(!filled_for(&bare.replace("G90", "G21 G90"), None).contains("#? units"));
    }

    #[test]
    fn a_profile_in_another_form_is_left_alone() {
        let inputs = [Input { path: "a.nc".into(), name: "a.nc".into(), bytes: PROGRAM.into() }];
        // The arc tangent asks for a parameter, and there is no line [parameters] to put it after.
        let profile = "dialect = \"fanuc\"\nparameters = { 6000.3 = 0 }\n";
        let (source, target) = (control(profile), control("dialect = \"haas\"\n"));
        let text = filled(&survey(&inputs, &source, Some(&target)), Side::Source, Some(profile));
        assert!(text.is_err(), "{text:?}");
    }
}
