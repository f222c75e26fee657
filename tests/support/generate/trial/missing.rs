//! What must be said where a program is called that is not written.
//!
//! The calls are found in the source's text, by the spelling that the writers use, so that nothing of the library's
//! own reading of calls is trusted.

use crate::generate::File;
use macroglot::diag::{Code, Severity};
use macroglot::library::{Conversion, Outcome, ProgramReport};
use std::ops::Range;

/// A program of the source's files.
struct Part<'f> {
    number: Option<u32>,
    /// Its bytes in its file.
    range: Range<usize>,
    text: &'f str,
}

/// Programs that should have been refused, and calls of refused ones of which nothing is said.
pub fn silent(files: &[File], made: &Conversion) -> Vec<String> {
    let parts: Vec<Part<'_>> =
        files.iter().enumerate().flat_map(|(at, file)| parts(at, &file.text)).collect();
    if parts.len() != made.programs.len() {
        return vec![format!("{} programs are counted as {}", parts.len(), made.programs.len())];
    }
    let both = || parts.iter().zip(&made.programs);
    let mut faults = Vec::new();
    for (part, report) in both().filter(|(_, report)| report.outcome != Outcome::Refused) {
        if part.text.lines().any(|line| line.ends_with("777")) {
            faults.push(format!("not refused: {:?} has an unknown code", part.number));
        }
        for (callee, _) in both().filter(|(_, callee)| callee.outcome == Outcome::Refused) {
            let Some(number) = callee.number else { continue };
            // A modal call calls nothing until a move, and may come to none.
            let lines = calls(part, number);
            if !lines.is_empty() && !says_so(report, number, &lines) {
                faults.push(format!("not said: {:?} calls the refused program {number}", part.number));
            }
        }
    }
    faults
}

/// True where a finding stands at one of these lines that tells of what is called, or one at a move that calls it names
/// it: it is said once a program.
fn says_so(report: &ProgramReport, number: u32, lines: &[Range<usize>]) -> bool {
    let name = format!("O{number} ");
    report.diagnostics.iter().any(|found| {
        let tells = matches!(found.code, Code::OutsideLibrary | Code::CalleeWithdrawn);
        let here = lines.iter().any(|line| line.contains(&(found.span.start as usize)));
        tells && (here || found.message.contains(&name)) && found.code.severity() != Severity::Note
    })
}

/// The programs of a file: each begins with its number, but for one that has none.
fn parts(file: usize, text: &str) -> Vec<Part<'_>> {
    let mut starts: Vec<(usize, Option<u32>)> = lines(text)
        .filter_map(|(at, line)| {
            let digits: String = line.strip_prefix('O')?.chars().take_while(char::is_ascii_digit).collect();
            Some((at, Some(digits.parse().ok()?)))
        })
        .collect();
    if starts.is_empty() {
        starts.push((0, None));
    }
    let ends = starts.iter().skip(1).map(|(at, _)| *at).chain([text.len()]).collect::<Vec<_>>();
    let part = |((start, number), end): (&(usize, Option<u32>), usize)| Part {
        // The cycles of the one control that has them stand in files of their own, behind that of the program.
        number: number.or(file.checked_sub(1).map(|cycle| 820 + cycle as u32)),
        range: *start..end,
        text: &text[*start..end],
    };
    starts.iter().zip(ends).map(part).collect()
}

/// The lines of a program in which it calls one of this number.
fn calls(part: &Part<'_>, number: u32) -> Vec<Range<usize>> {
    let names = [format!("M98P{number}"), format!("G65P{number}")];
    let repeated = format!("{number:04}");
    let called = |line: &str| {
        let line: String = line.chars().filter(|sign| *sign != ' ').collect();
        let named = names.iter().any(|name| {
            let behind = line.split_once(name.as_str()).map(|(_, rest)| rest);
            behind.is_some_and(|rest| !rest.starts_with(|sign: char| sign.is_ascii_digit()))
        });
        let cycle = part.number.is_none() || (820..830).contains(&part.number.unwrap_or(0));
        named
            || (line.starts_with("M98P") && line.len() == 12 && line.ends_with(&repeated))
            || (cycle && line.ends_with(&format!("G{number}")))
    };
    let all = lines(part.text).filter(|(_, line)| called(line));
    all.map(|(at, line)| part.range.start + at..part.range.start + at + line.len()).collect()
}

/// Lines, and where each begins.
fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    text.split_inclusive('\n').scan(0, |at, line| {
        let start = *at;
        *at += line.len();
        Some((start, line.trim_end()))
    })
}
