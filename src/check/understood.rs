//! Whether files are read without loss, and every block of them has a meaning.

use super::Shelf;
use super::finding::{Finding, Pages};
use crate::diag::{Accepted, Code, Severity};
use crate::library::{OfPrograms, Understood};
use crate::syntax::parse_totals;
use crate::text::Span;
use std::collections::BTreeMap;
use std::sync::Arc;

/// What reading and lowering tell of the source itself, beside errors and what the text alone shows. The other questions
/// of lowering are about a conversion.
const OF_THE_SOURCE: &[Code] =
    &[Code::TargetTwice, Code::SubroutineLeft, Code::RegisterUnset, Code::TwinProgram, Code::AmbiguousCall];

/// What the first of all sections has codes for: what the text alone shows.
const OF_THE_TEXT: &str = "MG01";

/// What makes several findings of a file one: the file, the code, what is said, and by whom it was accepted.
type Told<'a> = (usize, Code, &'a str, Option<&'a Accepted>);

/// By file, true where every program of it is understood.
pub fn sound(library: &Understood, files: usize) -> Vec<bool> {
    let mut sound = vec![true; files];
    for (program, found) in library.module.programs.iter().zip(&library.found) {
        sound[program.file] &= found.iter().all(|finding| finding.severity() != Severity::Error);
    }
    sound
}

/// True if an error of this code is one of the source, whichever control it goes to.
pub fn is_of_source(code: Code) -> bool {
    ["MG01", "MG03"].iter().any(|section| code.number().starts_with(section)) || OF_THE_SOURCE.contains(&code)
}

/// The findings of the files that are looked at; those that somebody `accepted` say so.
pub fn findings(
    shelf: &Shelf,
    library: &Understood,
    accepted: &OfPrograms,
    pages: &Pages<'_>,
) -> Vec<Finding> {
    let mut found = Vec::new();
    let mut told: BTreeMap<Told<'_>, (usize, usize)> = BTreeMap::new();
    for (at, (program, diagnostics)) in library.module.programs.iter().zip(&library.found).enumerate() {
        if !shelf.wanted[program.file] {
            continue;
        }
        let is_one = |code: Code| {
            code.severity() == Severity::Error
                || code.number().starts_with(OF_THE_TEXT)
                || OF_THE_SOURCE.contains(&code)
        };
        for diagnostic in diagnostics.iter().filter(|diagnostic| is_one(diagnostic.code)) {
            // What a file says at many places is told at the first.
            let by = accepted.get(&(at, diagnostic.code, Arc::clone(&diagnostic.message)));
            let key = (program.file, diagnostic.code, &*diagnostic.message, by);
            let (_, more) = told.entry(key).or_insert((found.len(), 0));
            *more += 1;
            if *more == 1 {
                let by = by.map(ToString::to_string);
                found.push(Finding { accepted: by, ..pages.finding(program.file, diagnostic) });
            }
        }
    }
    for (at, count) in told.into_values().filter(|(_, count)| *count > 1) {
        let more = count - 1;
        let places = if more == 1 { "place" } else { "places" };
        found[at].message.push_str(&format!(" (and at {more} more {places} of this file)"));
    }
    let parse = shelf.control.entry().parse;
    let wanted = (0..shelf.inputs.len()).filter(|at| shelf.wanted[*at]);
    for at in wanted.filter(|at| !parse_totals(&shelf.inputs[*at].bytes, parse).lossless) {
        let message = "the file was read, but what was read does not print as it stands".to_owned();
        let help = Some("report the file: this is a fault of macroglot".to_owned());
        found.push(pages.at(Code::BytesLost, at, Span::default(), message, help));
    }
    found
}
