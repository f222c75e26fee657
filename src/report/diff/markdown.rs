//! A diff as Markdown, for a merge request.

use super::words::{about, headline, lines, silent, title, told, verdict, what};
use crate::diff::{Diff, On, ProgramDiff, Text};
use crate::report::markdown::escaped;
use crate::text::shown;
use std::fmt::Write;

/// Bytes of a comment that code hosts take; what has no room is counted.
const MOST: usize = 60_000;

/// The diff as Markdown: the verdict, then what changed in each program, then the lines.
pub fn diff(diff: &Diff) -> String {
    let mut out = format!("**{}**\n", escaped(&headline(diff)));
    for note in &diff.notes {
        let _ = writeln!(out, "\n{}", escaped(note));
    }
    let mut left_out = 0;
    for program in told(diff) {
        let text = of_program(program, diff.tolerance_mm);
        if out.len() + text.len() > MOST { left_out += 1 } else { out += &text }
    }
    if let Some(text) = silent(diff) {
        let _ = writeln!(out, "\n{text}");
    }
    for file in &diff.files {
        let name = |side: &Option<String>| side.as_deref().map_or("nothing".into(), escaped);
        for (level, text) in file.told() {
            let part =
                format!("\n### {level}: {} to {}\n\n{}", name(&file.old), name(&file.new), of_text(text));
            if out.len() + part.len() > MOST { left_out += 1 } else { out += &part }
        }
    }
    if left_out > 0 {
        let _ = writeln!(out, "\n{left_out} parts have no room here: `macroglot diff` prints them.");
    }
    out
}

fn of_program(program: &ProgramDiff, tolerance: f64) -> String {
    let mut out = format!("\n### {}: {}\n", escaped(&title(program)), verdict(program));
    if !program.why.is_empty() || program.structure.as_ref().is_some_and(|notes| !notes.is_empty()) {
        out.push('\n');
    }
    for why in &program.why {
        let _ = writeln!(out, "- {}", escaped(why));
    }
    for note in program.structure.iter().flatten() {
        let line = note.new.or(note.old).map(|line| format!("line {line}, ")).unwrap_or_default();
        let _ = writeln!(out, "- {line}{}: {}", note.about, escaped(&note.text));
    }
    let Some(listing) = &program.motion else { return out };
    let _ = writeln!(out, "\n{}\n", escaped(&about(listing, tolerance)));
    for change in &listing.changes {
        let _ = writeln!(out, "- {}: {}", lines(change), escaped(&what(change, listing.inch)));
        // Indented code needs no fence, which a program's text could close.
        let _ = writeln!(out);
        for (seen, sign) in [(&change.old, '-'), (&change.new, '+')] {
            if let Some(seen) = seen {
                let _ = writeln!(out, "      {sign} {}", code(seen.moment.block.trim()));
            }
        }
        let _ = writeln!(out);
    }
    if listing.left_out > 0 {
        let _ = writeln!(out, "- and {} more places", listing.left_out);
    }
    for text in &listing.at_end {
        let _ = writeln!(out, "- at the end: {}", escaped(text));
    }
    out
}

fn of_text(text: &Text) -> String {
    let mut out = String::new();
    for hunk in &text.hunks {
        for line in &hunk.lines {
            let sign = match line.on {
                On::Both => ' ',
                On::Old => '-',
                On::New => '+',
            };
            let whole: String = line.pieces.iter().map(|piece| piece.text.as_str()).collect();
            let _ = writeln!(out, "    {sign} {}", code(&whole));
        }
        out.push('\n');
    }
    if text.left_out > 0 {
        let _ = writeln!(out, "and {} more changed lines\n", text.left_out);
    }
    out
}

/// A line of code: nothing in it ends the line.
fn code(text: &str) -> String {
    shown(&text.replace('\t', " ")).into_owned()
}
