//! A survey for people.

use super::speeds;
use super::{AskedCode, AskedSetting, AskedStart, Missing, Outcomes, Shape, Survey};
use crate::dialect::{Control, Settled, Side};
use crate::library::TakenAsLathe;
use crate::report::asked;
use crate::text::shown;
use std::fmt::Write;

/// Things of one kind that are named before the rest is counted.
const LISTED: usize = 20;

/// Codes that are named before the rest is counted: a shop has dozens.
const CODES: usize = 100;

/// The survey as text.
pub fn text(survey: &Survey<'_>) -> String {
    let mut out = String::new();
    shape(&mut out, &survey.shape, survey.taken.as_ref());
    if !survey.codes.is_empty() {
        codes(&mut out, &survey.codes);
    }
    start(&mut out, &survey.start, Side::Source);
    start(&mut out, &survey.start_of_target, Side::Target);
    out.push_str(&survey.with_questions(|questions| asked(questions, "--format json has")));
    settings(&mut out, &survey.settings, survey.controls);
    let later = survey.with_later(|questions| asked(questions, "--format json has"));
    if !later.is_empty() {
        out.push_str("\nOnce all of that is answered, this is asked too:\n");
        out.push_str(&later);
    }
    ends(&mut out, survey);
    out
}

fn shape(out: &mut String, shape: &Shape, taken: Option<&TakenAsLathe>) {
    let Shape { files, programs, reads, lathe, lathe_sign, called, missing, twice, folders } = shape;
    let files = if *files == 1 { "1 file".into() } else { format!("{files} files") };
    let _ = writeln!(out, "library   {} in {files}", count(*programs));
    let reads: Vec<String> = reads.iter().map(|(title, share)| format!("{title} {share} %")).collect();
    let _ = writeln!(out, "control   how much of its text each control reads: {}", reads.join(", "));
    if let Some(taken) = taken {
        let _ = writeln!(out, "machine   {}", shown(&taken.to_string()));
    }
    if let Some((sign, place)) = lathe_sign {
        let mill = programs - lathe;
        let (sign, place) = (shown(sign), shown(place));
        let _ = writeln!(out, "machine   {mill} for a mill, {lathe} look like a lathe's ({sign}: {place})");
    }
    let called = if *called == 1 { "1 program is".into() } else { format!("{called} programs are") };
    let _ = writeln!(out, "calls     {called} called by others of the library");
    for Missing { name, programs, places, .. } in missing.iter().take(LISTED) {
        let (name, places) = (shown(name), shown(&places.join(", ")).into_owned());
        let call = if *programs == 1 { "calls" } else { "call" };
        let _ = writeln!(out, "missing   {name}, which {} {call}: {places}", count(*programs));
    }
    more(out, "missing", missing.len());
    for (name, files) in twice.iter().take(LISTED) {
        let _ = writeln!(out, "twice     {}: {}", shown(name), shown(&files.join(", ")));
    }
    more(out, "twice", twice.len());
    if !folders.is_empty() {
        let folders: Vec<&str> =
            folders.iter().map(|folder| if folder.is_empty() { "." } else { folder.as_str() }).collect();
        let _ = writeln!(
            out,
            "          If {} are libraries of several machines, survey and convert each by itself.",
            shown(&folders.join(", "))
        );
    }
}

fn more(out: &mut String, kind: &str, all: usize) {
    match all.saturating_sub(LISTED) {
        0 => {}
        more => _ = writeln!(out, "{kind:<9} and {more} more; --format json has all"),
    }
}

fn count(programs: usize) -> String {
    if programs == 1 { "1 program".into() } else { format!("{programs} programs") }
}

fn codes(out: &mut String, codes: &[AskedCode]) {
    out.push_str(
        "\nCodes that mean something on this machine alone, or that have no equal on the target: what is to become of them?\n",
    );
    out.push_str(
        "The source's profile says it in [[site]]; what a builder made of a code stands in the machine's own manual.\n",
    );
    for AskedCode { code, programs, frees, places, comment, block, calls, .. } in codes.iter().take(CODES) {
        let frees = if *frees > 0 { format!(", {frees} wait for nothing else") } else { String::new() };
        let places = places.join(", ");
        let _ = writeln!(out, "  {code:<6} {}{frees}: {}", count(*programs), shown(&places));
        let _ = match comment {
            Some((comment, times)) => {
                writeln!(out, "         ({}) stands beside it, {times} x", shown(comment))
            }
            None => writeln!(out, "         {}", shown(block)),
        };
        if let Some(called) = calls.first().filter(|_| super::callers::is_call(calls, code)) {
            let more = if calls.len() > 1 { ", or another such program of the library" } else { "" };
            let _ = writeln!(
                out,
                "         does it call O{}{more}? parameter {} says it",
                called.program, called.parameter
            );
        }
    }
    let left = codes.len().saturating_sub(CODES);
    if left > 0 {
        let _ = writeln!(out, "  and {left} more; --format json has all");
    }
}

fn start(out: &mut String, asked: &[AskedStart], side: Side) {
    if asked.is_empty() {
        return;
    }
    out.push_str(match side {
        Side::Source => {
            "\nWhat programs take from the machine, because they do not say it when they begin:\n\
             The source's profile says it under [start]; the machine's page of codes shows it after a reset.\n"
        }
        Side::Target => {
            "\nWhat the target has to begin in as well, because no code can stand at the head of these programs:\n\
             The target's profile says it under [start].\n"
        }
    });
    for begun @ AskedStart { what, programs, places, .. } in asked {
        let _ =
            writeln!(out, "  {what} ({}) {}: {}", begun.told(), count(*programs), shown(&places.join(", ")));
    }
}

fn settings(out: &mut String, asked: &[AskedSetting], controls: [&Control; 2]) {
    for (side, control) in [Side::Source, Side::Target].into_iter().zip(controls) {
        let own: Vec<_> = asked.iter().filter(|asked| asked.side == side).collect();
        if own.is_empty() {
            continue;
        }
        let title = &control.dialect().title;
        let _ = writeln!(out, "\nSettings of the {title} that programs wait for: its profile says them.");
        for AskedSetting { section, name, values, meaning, programs, places, .. } in own {
            let limit = (*section == speeds::SECTION).then(|| speeds::line(name));
            let line = limit.unwrap_or_else(|| Settled::choice(name, values));
            let (meaning, places) = (shown(meaning), shown(&places.join(", ")).into_owned());
            let _ = writeln!(out, "  [{section}] {line}: {meaning}");
            let _ = writeln!(out, "         {}: {places}", count(*programs));
        }
    }
}

fn ends(out: &mut String, survey: &Survey<'_>) {
    let line = |what: &str, outcomes: &Outcomes| {
        let Outcomes { converted, review, refused } = outcomes;
        format!("{what:<9} {converted} converted, {review} for review, {refused} refused\n")
    };
    out.push('\n');
    if !survey.goes {
        let Outcomes { refused, .. } = survey.now;
        let _ =
            writeln!(out, "{} not understood; --to says what they would be on another control", are(refused));
        return;
    }
    out.push_str(&line("now", &survey.now));
    if let Some(answered) = &survey.answered {
        out.push_str(&line("answered", answered));
    }
    if !survey.stays.is_empty() {
        out.push_str("\nWhat no profile answers:\n");
    }
    for (why, programs) in survey.stays.iter().take(LISTED) {
        let _ = writeln!(out, "  {}: {}", count(*programs), shown(why));
    }
    let left = survey.stays.len().saturating_sub(LISTED);
    if left > 0 {
        let _ = writeln!(out, "  and {left} more; --format json has all");
    }
}

fn are(programs: usize) -> String {
    if programs == 1 { "1 program is".into() } else { format!("{programs} programs are") }
}
