//! Questions as text: each once, with where it stands and how it is answered.

use super::grade;
use super::questions::{Fact, Machine, Question, Questions};
use crate::dialect::Settled;
use crate::text::shown;
use std::fmt::Write;

/// Questions of one code that concern one program each, before the rest of them is counted.
const ALONE: usize = 3;

/// What a person must look at, and the lines of machine profiles that answer what they can. `all_by` is what shows the rest of
/// what is counted alone: `--verbose draws`.
pub fn asked(questions: &Questions<'_>, all_by: &str) -> String {
    let mut out = String::new();
    let (of_programs, of_library) = questions.of_programs_and_library();
    by_code(&mut out, of_programs, all_by);
    if !of_library.is_empty() {
        out.push_str("\nWhat is decided once for the library; no program is for review because of it:\n");
    }
    by_code(&mut out, of_library, all_by);
    if !questions.machines.is_empty() {
        out.push_str(
            "\nWhat is open of the machines (MG0201, MG0205): check it on the machine, then put it into the machine's \
             profile.\nThe conversions rest on it.\n",
        );
    }
    questions.machines.iter().for_each(|machine| profile(&mut out, machine));
    accepted(&mut out, questions);
    match questions.notes {
        0 => {}
        1 => _ = writeln!(out, "\n1 note, which asks nothing; {all_by} it"),
        more => _ = writeln!(out, "\n{more} notes, which ask nothing; {all_by} them"),
    }
    out
}

/// Questions under the heads of their codes.
fn by_code(out: &mut String, questions: &[Question<'_>], all_by: &str) {
    for all in questions.chunk_by(|a, b| a.code == b.code) {
        let Some(Question { code, .. }) = all.first() else { continue };
        let _ = writeln!(out, "\n{} {}: {}", grade(code.severity()), code.number(), code.title());
        let (alone, shared): (Vec<_>, Vec<_>) = all.iter().partition(|question| question.programs == 1);
        shared.iter().chain(alone.iter().take(ALONE)).for_each(|question| open(out, question));
        match alone.len().saturating_sub(ALONE) {
            0 => {}
            1 => _ = writeln!(out, "  and one more, in one program; {all_by} it"),
            more => _ = writeln!(out, "  and {more} more, each in one program; {all_by} them"),
        }
    }
}

/// What somebody accepted: by whom, and where.
fn accepted(out: &mut String, questions: &Questions<'_>) {
    if !questions.accepted.is_empty() {
        out.push_str("\nAccepted, and not asked again before it changes:\n");
    }
    for (accepted, question) in &questions.accepted {
        let (code, accepted) = (question.code.number(), accepted.to_string());
        let _ = writeln!(out, "  {code}, {}: {}", stands(question), shown(&accepted));
        let _ = writeln!(out, "      {}", shown(question.text));
    }
}

fn open(out: &mut String, question: &Question<'_>) {
    let _ = writeln!(out, "  {}", shown(question.text));
    let (number, line) = &question.line;
    let _ = writeln!(out, "      {}", stands(question));
    let _ = writeln!(out, "      {number} | {}", shown(line));
    if let Some(help) = question.help {
        let _ = writeln!(out, "      help: {}", shown(help));
    }
}

/// `4 programs: a.nc:3, b.nc:1, c.nc:7, ...`
fn stands(question: &Question<'_>) -> String {
    let places: Vec<String> = question.places.iter().map(|place| shown(place).into_owned()).collect();
    let places = places.join(", ");
    match question.programs {
        1 => places,
        programs => {
            let more = if programs > question.places.len() { ", ..." } else { "" };
            format!("{programs} programs: {places}{more}")
        }
    }
}

fn profile(out: &mut String, machine: &Machine<'_>) {
    let dialect = machine.control.dialect();
    let _ = match &machine.control.profile().file {
        Some(file) => writeln!(out, "{}, for the {}:", shown(&file.to_string_lossy()), dialect.title),
        None => writeln!(
            out,
            "a profile for the {}, which --machine or macroglot.toml names (dialect = \"{}\"):",
            dialect.title,
            machine.control.name()
        ),
    };
    let of = |is: fn(&Settled) -> bool| machine.facts.iter().filter(move |fact| is(&fact.settled_by));
    lines(out, "", of(|settled| matches!(settled, Settled::Key { .. })), "", machine);
    let confirmed = of(|settled| matches!(settled, Settled::Confirmed(_)));
    lines(out, "confirm = [", confirmed, "]", machine);
    for section in ["settings", "parameters"] {
        let all = machine.facts.iter().filter(
            |fact| matches!(&fact.settled_by, Settled::Setting { section: of, .. } if *of == section),
        );
        lines(out, &format!("[{section}]"), all, "", machine);
    }
    lines(out, "[behaviours]", of(|settled| matches!(settled, Settled::Answer { .. })), "", machine);
}

fn lines<'f, 'a: 'f>(
    out: &mut String,
    head: &str,
    facts: impl Iterator<Item = &'f Fact<'a>>,
    end: &str,
    machine: &Machine<'_>,
) {
    let mut any = false;
    for fact in facts {
        if !std::mem::replace(&mut any, true) && !head.is_empty() {
            let _ = writeln!(out, "  {head}");
        }
        let title = &machine.control.dialect().title;
        let said =
            fact.asked.text.split_once(&format!("{title}: ")).map_or(fact.asked.text, |(_, said)| said);
        let line = match &fact.settled_by {
            Settled::Confirmed(fact) => format!("  \"{fact}\","),
            Settled::Setting { name, values, .. } => format!("# {}", Settled::choice(name, values)),
            Settled::Key { name, values } => format!("# {}", Settled::choice(name, values)),
            Settled::Answer { question, answers } => format!("# \"{question}\" = {answers}"),
        };
        let _ = writeln!(out, "  {line} # {} ({})", shown(said), stands(&fact.asked));
    }
    if any && !end.is_empty() {
        let _ = writeln!(out, "  {end}");
    }
}
