//! A conversion as JSON. Its keys are a contract: `programs` with `source`, `target`, `program`,
//! `outcome`, `diagnostics`; `totals`; and `machines` and `library`, if something is open of them, `notes`, `folders` and `left_out`, if there is something to be said of the
//! programs as a whole, of files of earlier runs, or of files that were not read.
//!
//! It is written piece by piece: a library of many findings makes more of it than of itself.

use super::questions::{Machine, Question, Questions};
use super::{Part, Totals};
use crate::diag::{Accepted, Code, Severity};
use crate::library::{Input, LeftOut, Outcome, ProgramReport, Told};
use crate::text::{LineIndex, Texts, write_json_pretty};
use crate::verify;
use serde::ser::{Error, SerializeSeq};
use serde::{Serialize, Serializer};
use serde_json::value::RawValue;
use std::cell::RefCell;
use std::io::{self, Write};

#[derive(Serialize)]
struct Report<'a> {
    #[serde(serialize_with = "programs")]
    programs: &'a [Part<'a>],
    totals: Totals,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    machines: Vec<Open>,
    /// What is decided once for all programs.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    library: Vec<Asked>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    notes: Vec<String>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    folders: Vec<&'a Told>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    left_out: Vec<&'a LeftOut>,
}

/// What is open of a machine, which its profile answers for all programs.
#[derive(Serialize)]
struct Open {
    dialect: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    profile: Option<String>,
    questions: Vec<Asked>,
}

#[derive(Serialize)]
struct Asked {
    code: Code,
    severity: Severity,
    message: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    help: Option<String>,
    programs: usize,
    places: Vec<String>,
}

impl Asked {
    fn of(question: &Question<'_>) -> Self {
        Self {
            code: question.code,
            severity: question.code.severity(),
            message: question.text.to_owned(),
            help: question.help.map(str::to_owned),
            programs: question.programs,
            places: question.places.clone(),
        }
    }
}

impl Open {
    fn of(machine: &Machine<'_>) -> Self {
        let questions = machine.facts.iter().map(|fact| Asked::of(&fact.asked));
        let file = machine.control.profile().file.as_ref();
        Self {
            dialect: machine.control.name().to_owned(),
            profile: file.map(|file| file.display().to_string()),
            questions: questions.collect(),
        }
    }
}

#[derive(Serialize)]
struct Program<'a> {
    source: &'a str,
    target: Option<String>,
    program: Option<&'a str>,
    from: &'a str,
    to: &'a str,
    outcome: Outcome,
    verdict: Option<verify::Outcome>,
    #[serde(serialize_with = "findings")]
    diagnostics: (&'a ProgramReport, &'a str, &'a LineIndex, &'a RefCell<Texts<'a>>),
}

#[derive(Serialize)]
struct Finding<'a> {
    code: Code,
    severity: Severity,
    file: &'a RawValue,
    line: u32,
    column: u32,
    message: &'a RawValue,
    #[serde(skip_serializing_if = "Option::is_none")]
    help: Option<&'a RawValue>,
    #[serde(skip_serializing_if = "Option::is_none")]
    accepted: Option<&'a Accepted>,
}

/// The conversions as JSON text.
pub fn conversion(parts: &[Part<'_>]) -> String {
    let mut text = Vec::new();
    // Writing to memory cannot fail.
    let _ = write_conversion(parts, &mut text);
    String::from_utf8(text).unwrap_or_default()
}

/// Writes the conversions as JSON.
///
/// # Errors
/// Those of `out`.
pub fn write_conversion(parts: &[Part<'_>], out: impl Write) -> io::Result<()> {
    // Of a known type: what it is given are mostly single marks.
    let mut out = io::BufWriter::with_capacity(64 * 1024, out);
    let said = |part: &Part<'_>| {
        let advice = part.advised().map(|advice| format!("{}: {advice}", part.to));
        part.notes.iter().cloned().chain(advice).collect::<Vec<_>>()
    };
    let notes = parts.iter().flat_map(said).collect();
    let left_out = parts.iter().flat_map(|part| part.left_out).collect();
    let folders = parts.iter().map(|part| part.folder).filter(|told| !told.is_empty()).collect();
    let questions = Questions::of(parts);
    let machines = questions.machines.iter().map(Open::of).collect();
    let library = questions.of_programs_and_library().1.iter().map(Asked::of).collect();
    let report =
        Report { programs: parts, totals: Totals::of(parts), machines, library, notes, folders, left_out };
    write_json_pretty(&report, &mut out)?;
    out.write_all(b"\n")?;
    out.flush()
}

fn programs<S: Serializer>(parts: &[Part<'_>], serializer: S) -> Result<S::Ok, S::Error> {
    let files: Vec<Vec<(String, LineIndex)>> = parts.iter().map(files).collect();
    let texts = RefCell::default();
    let texts = &texts;
    let programs = parts.iter().zip(&files).flat_map(|(part, files)| {
        part.programs().map(move |(_, program)| {
            let (file, index) = &files[program.file];
            let target = part.targets.get(program.file).and_then(Option::as_ref);
            // Another program of the same file may have been written when this one was not.
            let target = target.filter(|_| !program.map.is_empty() || program.outcome != Outcome::Refused);
            Program {
                source: file,
                target: target.map(|path| path.display().to_string()),
                program: program.name.as_deref(),
                from: part.from,
                to: part.to,
                outcome: program.outcome,
                verdict: program.verdict,
                diagnostics: (program, file, index, texts),
            }
        })
    });
    serializer.collect_seq(programs)
}

fn files(part: &Part<'_>) -> Vec<(String, LineIndex)> {
    // Lines are counted as far as findings lie.
    let mut ends = vec![0; part.inputs.len()];
    for (_, program) in part.programs() {
        let last = program.diagnostics.iter().map(|d| d.span.start as usize + 1).max();
        ends[program.file] = last.unwrap_or(0).max(ends[program.file]);
    }
    let index = |(input, end): (&Input, usize)| {
        let bytes = &input.bytes[..end.min(input.bytes.len())];
        (input.path.display().to_string(), LineIndex::new(bytes))
    };
    part.inputs.iter().zip(ends).map(index).collect()
}

fn findings<'a, S: Serializer>(
    (program, file, index, texts): &(&'a ProgramReport, &'a str, &LineIndex, &RefCell<Texts<'a>>),
    serializer: S,
) -> Result<S::Ok, S::Error> {
    let mut texts = texts.borrow_mut();
    let file = &*texts.escaped(file).map_err(S::Error::custom)?;
    let mut all = serializer.serialize_seq(Some(program.diagnostics.len()))?;
    for d in &program.diagnostics {
        let (line, column) = index.place(d.span.start);
        let message = texts.escaped(&d.message).map_err(S::Error::custom)?;
        let help = d.help.as_deref().map(|help| texts.escaped(help));
        let help = help.transpose().map_err(S::Error::custom)?;
        all.serialize_element(&Finding {
            code: d.code,
            severity: d.in_program(),
            file,
            line,
            column,
            message: &message,
            help: help.as_deref(),
            accepted: d.accepted.as_deref(),
        })?;
    }
    all.end()
}
