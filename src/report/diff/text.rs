//! A diff for a terminal.

use super::words::{about, headline, lines, silent, title, told, verdict, what};
use crate::diff::{Diff, FileDiff, Line, On, ProgramDiff, Text, Verdict};
use crate::text::shown;
use std::fmt::Write;

/// Whether colours are sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Colour {
    /// As terminals read them.
    On,
    /// None.
    Off,
}

const RED: &str = "31";
const GREEN: &str = "32";
const YELLOW: &str = "33";
const BOLD: &str = "1";
const DIM: &str = "2";
/// What changed within a line.
const INVERSE: &str = "7";

impl Colour {
    fn paint(self, codes: &[&str], text: &str) -> String {
        match self {
            Colour::On if !text.is_empty() => format!("\u{1b}[{}m{text}\u{1b}[0m", codes.join(";")),
            _ => text.to_owned(),
        }
    }
}

/// The diff as text: the verdict first. Nothing of a program reaches the terminal that acts on it.
pub fn diff(diff: &Diff, colour: Colour) -> String {
    let mut out = colour.paint(&[BOLD, of(diff.verdict)], &headline(diff)) + "\n";
    for note in &diff.notes {
        let _ = writeln!(out, "note: {}", shown(note));
    }
    diff.files.iter().for_each(|file| of_file(&mut out, file, colour));
    told(diff).for_each(|program| of_program(&mut out, program, diff.tolerance_mm, colour));
    if let Some(text) = silent(diff) {
        let _ = writeln!(out, "\n{text}");
    }
    out
}

fn of(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Same => GREEN,
        Verdict::Undecided => YELLOW,
        Verdict::Different => RED,
    }
}

fn of_file(out: &mut String, file: &FileDiff, colour: Colour) {
    let name =
        |side: &Option<String>| side.as_deref().map_or("/dev/null".into(), |name| shown(name).into_owned());
    for (level, text) in file.told() {
        let head = format!("{level}: {} -> {}", name(&file.old), name(&file.new));
        let _ = writeln!(out, "\n{}", colour.paint(&[BOLD], &head));
        of_text(out, text, colour);
    }
}

fn of_text(out: &mut String, text: &Text, colour: Colour) {
    for (at, hunk) in text.hunks.iter().enumerate() {
        if at > 0 {
            let _ = writeln!(out, "{}", colour.paint(&[DIM], "            ..."));
        }
        hunk.lines.iter().for_each(|line| of_line(out, line, colour));
    }
    if text.left_out > 0 {
        let _ = writeln!(out, "            and {} more changed lines", text.left_out);
    }
}

fn of_line(out: &mut String, line: &Line, colour: Colour) {
    let number = |side: Option<usize>| side.map(|number| number.to_string()).unwrap_or_default();
    let (sign, code) = match line.on {
        On::Both => (" ", DIM),
        On::Old => ("-", RED),
        On::New => ("+", GREEN),
    };
    let mut text = String::new();
    for piece in &line.pieces {
        let marked = piece.changed && line.pieces.len() > 1;
        let codes: &[&str] = if marked { &[code, INVERSE] } else { &[code] };
        text += &if line.on == On::Both {
            shown(&piece.text).into_owned()
        } else {
            colour.paint(codes, &shown(&piece.text))
        };
    }
    let places = format!("{:>5} {:>5}", number(line.old), number(line.new));
    let row = format!("{} {} {text}", colour.paint(&[DIM], &places), colour.paint(&[code], sign));
    let _ = writeln!(out, "{}", row.trim_end());
}

fn of_program(out: &mut String, program: &ProgramDiff, tolerance: f64, colour: Colour) {
    let head = format!("{}: {}", shown(&title(program)), verdict(program));
    let _ = writeln!(out, "\n{}", colour.paint(&[BOLD, of(program.verdict)], &head));
    for why in &program.why {
        let _ = writeln!(out, "  {}", shown(why));
    }
    for note in program.structure.iter().flatten() {
        let at = match (note.old, note.new) {
            (_, Some(line)) => format!("line {line}"),
            (Some(line), None) => format!("old line {line}"),
            (None, None) => String::new(),
        };
        let _ = writeln!(out, "  {} {}: {}", colour.paint(&[DIM], &at), note.about, shown(&note.text));
    }
    let Some(listing) = &program.motion else { return };
    let _ = writeln!(out, "  {}", colour.paint(&[DIM], &about(listing, tolerance)));
    for change in &listing.changes {
        let (sign, code) = match (&change.old, &change.new) {
            (Some(_), None) => ("-", RED),
            (None, Some(_)) => ("+", GREEN),
            _ => ("~", YELLOW),
        };
        let text = format!("{}: {}", lines(change), what(change, listing.inch));
        let _ = writeln!(out, "  {} {}", colour.paint(&[code], sign), shown(&text));
        for (seen, sign, code) in [(&change.old, "-", RED), (&change.new, "+", GREEN)] {
            if let Some(seen) = seen {
                let block = format!("{sign} {}: {}", seen.moment.file, seen.moment.block.trim());
                let _ = writeln!(out, "      {}", colour.paint(&[code], &shown(&block)));
            }
        }
    }
    if listing.left_out > 0 {
        let _ = writeln!(out, "  and {} more places", listing.left_out);
    }
    for text in &listing.at_end {
        let _ = writeln!(out, "  ~ at the end: {}", shown(text));
    }
}
