//! One program: what became of it and why, what the verifier found, its path, its registers, its two texts.

use super::super::diff::{change_lines, change_text};
use super::super::plot::overlay;
use super::super::{Part, words};
use super::first::{class, codes, title, verdict};
use super::registers::held;
use super::{certificate, escaped, id, plural, sides};
use crate::control::{End, Run};
use crate::diag::Severity;
use crate::diff::variables;
use crate::library::{Outcome, Pairs, ProgramReport};
use crate::report::trace::number;
use crate::text::LineIndex;
use crate::verify::Picture;
use std::collections::BTreeSet;
use std::fmt::Write;

/// Places that are listed at which the two paths of a picture differ.
const PLACES: usize = 20;

/// Variables that are named of a scenario.
const NAMED: usize = 12;

/// A program that is to be shown.
pub struct Shown<'s, 'p> {
    /// Its library.
    pub part: &'s Part<'p>,
    /// Its index there.
    pub index: usize,
    /// Its number in the page.
    pub number: usize,
    /// The lines of the library's files.
    pub lines: &'s [LineIndex],
    /// The library to be run; none where it cannot be.
    pub pairs: Option<&'s Pairs<'s>>,
}

/// The section of a program.
pub fn program(shown: &Shown<'_, '_>) -> String {
    let Shown { part, index, .. } = *shown;
    let program = &part.conversion.programs[index];
    let mut out = String::new();
    let codes = codes(program);
    let numbers: Vec<&str> = codes.iter().map(|code| code.number()).collect();
    let class = class(program.outcome);
    let _ = writeln!(
        out,
        "<details class=\"program\" open id=\"{}\" data-outcome=\"{class}\" data-codes=\"{}\">\n<summary><h3>{}</h3> <span \
         class=\"outcome {class}\">{}</span>, {}</summary>",
        id(shown.number),
        numbers.join(" "),
        escaped(&title(part, program)),
        words(program.outcome),
        verdict(program)
    );
    why(&mut out, part, program);
    let found = part.certificates.and_then(|certificates| certificates.of_program(index));
    certificate::certificate(&mut out, program, found);
    match shown.pairs.map(|pairs| pairs.picture(index, PLACES)) {
        Some(Some(picture)) => path(&mut out, &picture, shown.number),
        Some(None) => out.push_str("<h4>Path</h4>\n<p>It was not run for a picture: its file is too long, or could not be paired with its target.</p>\n"),
        None => {}
    }
    registers(&mut out, shown);
    sides::sides(&mut out, shown);
    out.push_str("</details>\n");
    out
}

/// Why the outcome is what it is.
fn why(out: &mut String, part: &Part<'_>, program: &ProgramReport) {
    let written =
        part.targets.get(program.file).and_then(Option::as_ref).filter(|_| !program.range.is_empty());
    let written = written.map(|path| escaped(&path.display().to_string()));
    let deciding = match program.outcome {
        Outcome::Converted => Severity::Note,
        Outcome::Accepted | Outcome::Review => Severity::Review,
        Outcome::Refused => Severity::Error,
    };
    let reasons = program.diagnostics.iter().filter(|finding| finding.in_program() == deciding);
    let reasons: BTreeSet<_> = reasons.map(|finding| finding.code).collect();
    let reasons =
        reasons.into_iter().map(|code| format!("{} ({})", super::code(code), escaped(code.title())));
    let reasons = reasons.collect::<Vec<_>>().join(", ");
    let is_draft = program.outcome == Outcome::Refused && !program.map.is_empty();
    let says = match (program.outcome, reasons.is_empty()) {
        (Outcome::Converted, _) => "Nothing was found that a person must look at.".to_owned(),
        (Outcome::Accepted, _) => format!("A person looked at it and accepted what was asked: {reasons}."),
        (Outcome::Review, true) => "A person must look at it.".to_owned(),
        (Outcome::Review, false) => format!("A person must look at it: {reasons}."),
        (Outcome::Refused, _) if is_draft => {
            format!(
                "Refused: {reasons}. What is written is a draft with an alarm at every hole; it is no conversion."
            )
        }
        (Outcome::Refused, _) => format!("Refused: {reasons}. Nothing is written for it."),
    };
    let place = written.map(|path| format!(" Written to <code>{path}</code>.")).unwrap_or_default();
    let _ = writeln!(out, "<p>{says}{place}</p>");
}

/// The paths of both, and where they differ.
fn path(out: &mut String, picture: &Picture, at: usize) {
    let Picture { scenario, source, target, apart } = picture;
    let name =
        if target.is_some() { "the path of the source and of the target" } else { "the path of the source" };
    let drawn = overlay(picture, at, name);
    out.push_str("<h4>Path</h4>\n");
    let variables: Vec<String> = scenario
        .variables
        .iter()
        .take(NAMED)
        .map(|(name, value)| format!("{name} = {}", number(*value)))
        .collect();
    let more = scenario.variables.len().saturating_sub(NAMED);
    let more = if more > 0 { format!(", and {more} more") } else { String::new() };
    let with = match variables.is_empty() {
        true => String::new(),
        false => format!(", started with {}{more}", variables.join(", ")),
    };
    let _ = writeln!(
        out,
        "<p class=\"small\">One run{}: the part's zero is the machine's, and tools have no size. The source {}{}. \
         Wide and pale is the source, thin and dark the target; rapid moves are brown. A red ring is where a move differs, with its line.</p>",
        escaped(&with),
        escaped(&end(source)),
        target.as_ref().map(|run| format!("; the target {}", escaped(&end(run)))).unwrap_or_default()
    );
    match drawn {
        Some(svg) => out.push_str(&svg),
        None => out.push_str("<p>Nothing moves in it.</p>\n"),
    }
    let Some(other) = target else { return };
    if apart.changes.is_empty() && apart.at_end.is_empty() {
        let both_ended = source.end == End::Ended && other.end == End::Ended;
        out.push_str(match both_ended {
            true => "<p>In this run no move, feed, wait or stop differs.</p>\n",
            false => {
                "<p>Nothing differs as far as both went. <b>They did not both run to their ends, so this run does not show the \
                 rest.</b></p>\n"
            }
        });
        return;
    }
    out.push_str("<p>In this run these differ, source to target:</p>\n<ul>\n");
    for change in &apart.changes {
        let text = format!("{}: {}", change_lines(change), change_text(change, apart.inch));
        let _ = writeln!(out, "<li>{}", escaped(&text));
    }
    if apart.left_out > 0 {
        let _ = writeln!(out, "<li>and {}", plural(apart.left_out, "more place"));
    }
    for text in &apart.at_end {
        let _ = writeln!(out, "<li>at the end: {}", escaped(text));
    }
    out.push_str("</ul>\n");
}

/// How a run ended.
fn end(run: &Run) -> String {
    match &run.end {
        End::Ended => "ran to its end".into(),
        End::Alarm { stop, .. } => {
            let text = format!("{} {}", stop.number, stop.text);
            format!("stopped with an alarm ({})", text.trim())
        }
        End::StepBudget | End::TimeBudget => format!("was still running after {} blocks", run.steps),
        End::Error { text, .. } => format!("could not go on: {text}"),
    }
}

/// The registers that hold the variables of a program.
fn registers(out: &mut String, shown: &Shown<'_, '_>) {
    let Some(pairs) = shown.pairs else { return };
    let blocks = pairs.blocks(shown.index);
    let used: BTreeSet<String> = blocks
        .iter()
        .flat_map(|block| variables(&block.items, shown.part.controls[0]))
        .map(|(_, name)| name)
        .collect();
    let held = held(shown.part);
    let here = held.iter().filter(|held| used.contains(held.variable));
    let here: Vec<String> =
        here.map(|held| format!("{} holds {}", escaped(&held.register), escaped(held.variable))).collect();
    if !here.is_empty() {
        let _ = writeln!(out, "<h4>Registers</h4>\n<p>{}</p>", here.join(", "));
    }
}
