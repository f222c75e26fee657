//! A conversion as Markdown, for a merge request: totals, what a person must answer, a table of programs.

use super::questions::{Question, Questions};
use super::{Part, Totals, words};
use crate::diag::Severity;
use crate::text::acts;
use crate::verify;
use std::collections::BTreeSet;
use std::fmt::Write;

/// What a code host shows of a text: letters. Bytes are no fewer.
const MOST: usize = 65_536;

/// Room for the line that says what is left out.
const ROOM: usize = 200;

/// Letters of a message.
const LETTERS: usize = 500;

/// The conversions as Markdown text: no more than a code host shows.
pub fn conversion(parts: &[Part<'_>]) -> String {
    let mut out = Sheet::default();
    out.line("# Conversion");
    out.line("");
    out.line(&Totals::of(parts).to_string());
    for part in parts {
        let totals = Totals::of(std::slice::from_ref(part));
        out.line("");
        out.line(&format!("**{} to {}**: {totals}", escaped(part.from), escaped(part.to)));
        if let Some(advice) = part.advised() {
            out.line("");
            out.line(&format!("{}: {}", escaped(part.to), escaped(advice)));
        }
        for note in part.notes {
            out.line("");
            out.line(&escaped(note));
        }
    }
    let questions = Questions::of(parts);
    asked(&mut out, &questions);
    accepted(&mut out, &questions);
    programs(&mut out, parts);
    out.end()
}

/// What a person must answer, what most depends on first; then what was refused.
fn asked(out: &mut Sheet, questions: &Questions<'_>) {
    let (refused, mut open): (Vec<_>, Vec<_>) =
        questions.open.iter().partition(|question| question.code.severity() == Severity::Error);
    open.sort_by_key(|question| (question.danger, question.code, std::cmp::Reverse(question.programs)));
    let facts = questions.machines.iter().flat_map(|machine| machine.facts.iter().map(|fact| &fact.asked));
    let (library, programs): (Vec<&Question<'_>>, Vec<_>) =
        open.into_iter().partition(|question| question.once);
    let all = [
        ("Questions", "- [ ] ", programs),
        ("Decided once for the library", "- [ ] ", library),
        ("Asked of the machines", "- [ ] ", facts.collect()),
        ("Refused", "- ", refused),
    ];
    for (title, box_, all) in all {
        if all.is_empty() {
            continue;
        }
        out.line("");
        out.line(&format!("## {title}"));
        out.line("");
        for question in all {
            out.line(&format!("{box_}{}", item(question)));
            if let Some(help) = question.help {
                out.line(&format!("  {}", escaped(help)));
            }
        }
    }
}

fn item(question: &Question<'_>) -> String {
    let text: String = question.text.chars().take(LETTERS).collect();
    let dots = if text.len() < question.text.len() { "..." } else { "" };
    let more = if question.programs > question.places.len() { ", ..." } else { "" };
    let programs = if question.programs == 1 { "program" } else { "programs" };
    let places = escaped(&question.places.join(", "));
    format!(
        "**{}** {}{dots} ({} {programs}: {places}{more})",
        question.code.number(),
        escaped(&text),
        question.programs
    )
}

/// What somebody accepted.
fn accepted(out: &mut Sheet, questions: &Questions<'_>) {
    if questions.accepted.is_empty() {
        return;
    }
    out.line("");
    out.line("## Accepted");
    out.line("");
    for (accepted, question) in &questions.accepted {
        out.line(&format!("- {}", item(question)));
        out.line(&format!("  {}", escaped(&accepted.to_string())));
    }
}

/// A table of all programs.
fn programs(out: &mut Sheet, parts: &[Part<'_>]) {
    for part in parts.iter().filter(|part| part.programs().next().is_some()) {
        out.line("");
        out.line(&format!("## {} to {}", escaped(part.from), escaped(part.to)));
        out.line("");
        out.line("| File | Program | Outcome | Verified | Codes |");
        out.line("|---|---|---|---|---|");
        for (_, program) in part.programs() {
            let file = escaped(&part.inputs[program.file].name);
            let name = program.name.as_deref().map(escaped).unwrap_or_default();
            let codes: BTreeSet<&str> = program.diagnostics.iter().map(|d| d.code.number()).collect();
            let verdict = match program.verdict {
                Some(verify::Outcome::Same) => "the same",
                Some(verify::Outcome::Undecided) => "not decided",
                Some(verify::Outcome::Different) => "different",
                None => "",
            };
            out.line(&format!(
                "| {file} | {name} | {} | {verdict} | {} |",
                words(program.outcome),
                codes.into_iter().collect::<Vec<_>>().join(" ")
            ));
        }
    }
}

/// Lines, as long as there is room.
#[derive(Default)]
struct Sheet {
    text: String,
    left_out: usize,
}

impl Sheet {
    fn line(&mut self, line: &str) {
        // What comes behind a line that found no room would look as if nothing were missing.
        if self.left_out > 0 || self.text.len() + line.len() + 1 + ROOM > MOST {
            self.left_out += usize::from(!line.is_empty());
            return;
        }
        let _ = writeln!(self.text, "{line}");
    }

    fn end(mut self) -> String {
        if self.left_out > 0 {
            let lines = if self.left_out == 1 { "line is" } else { "lines are" };
            let _ = writeln!(
                self.text,
                "\n**{} more {lines} left out here: a report that ends in .html has all.**",
                self.left_out
            );
        }
        self.text
    }
}

/// Text whose signs Markdown and HTML would read, with each of them taken literally.
pub(super) fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for sign in text.chars() {
        match sign {
            '<' => out.push_str("&lt;"),
            '&' => out.push_str("&amp;"),
            '\\' | '`' | '*' | '_' | '[' | ']' | '#' | '|' | '~' | '!' | '@' => out.extend(['\\', sign]),
            sign if acts(sign) => out.extend(sign.escape_default()),
            sign => out.push(sign),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::{MOST, Sheet, escaped};

    #[test]
    fn signs_of_programs_stay_signs() {
        assert_eq!(escaped("#1=[#2*3]"), r"\#1=\[\#2\*3\]");
        assert_eq!(escaped("<b>&\n"), r"&lt;b>&amp;\n");
        assert_eq!(escaped("@all"), r"\@all");
    }

    #[test]
    fn a_sheet_holds_what_a_host_shows_and_says_what_is_left_out() {
        let mut sheet = Sheet::default();
        (0..1000).for_each(|_| sheet.line(&"x".repeat(99)));
        sheet.line("");
        sheet.line("short");
        let text = sheet.end();
        assert!(text.len() <= MOST, "{}", text.len());
        // 653 lines of a hundred letters leave room for the last one.
        let told = "\n\n**348 more lines are left out here: a report that ends in .html has all.**\n";
        assert!(text.ends_with(told) && !text.contains("short"), "{}", &text[text.len() - 120..]);
    }
}
