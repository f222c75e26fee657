//! A library from one control to another: read, lower, link, legalize, emit.

use super::chunks::lower::lower;
use super::compile::{Begun, make};
use super::marks::marks;
use super::names::both_nameless;
use super::prepare::{Prepared, prepare};
use super::refused_calls::{self, Link};
use super::{Input, Lock};
use crate::CHECKED;
use crate::diag::{Diagnostic, Severity};
use crate::dialect::Control;
use crate::emit::Emitted;
use crate::legalize::Modal;
use crate::opt;
use crate::text::Span;
use crate::verify;

/// What became of a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Outcome {
    /// It does the same on the target, by all that is known.
    Converted,
    /// It does the same if what its diagnostics name is so, and a person has accepted each of them.
    Accepted,
    /// It does the same if what the diagnostics name is so: a person must look.
    Review,
    /// It has no runnable conversion.
    Refused,
}

/// What became of one program of the source.
#[derive(Clone, Debug)]
pub struct ProgramReport {
    /// Index of its file among the inputs.
    pub file: usize,
    /// Its name on the source, as it is written there; none for one without.
    pub name: Option<String>,
    /// What became of it.
    pub outcome: Outcome,
    /// What the verifier found; none if it was not asked, or the program has no conversion.
    pub verdict: Option<verify::Outcome>,
    /// What was found, in source order.
    pub diagnostics: Vec<Diagnostic>,
    /// Which bytes of the target file each block comes from: source span, target range.
    pub map: Vec<(Span, std::ops::Range<usize>)>,
    /// The bytes of the target file that are its own; empty where nothing is written.
    pub range: std::ops::Range<usize>,
}

/// What became of a library.
#[derive(Clone, Debug)]
pub struct Conversion {
    /// One report a program of the source, in order of files and places.
    pub programs: Vec<ProgramReport>,
    /// The text of each target file; none if every program of the file was refused.
    pub texts: Vec<Option<String>>,
    /// What the next run is to choose again.
    pub lock: Lock,
    /// The registers that were taken on the target.
    pub taken: String,
    /// True where the target's profile says which registers the shop keeps for itself.
    pub states_reserved: bool,
    /// The calls between its programs.
    pub links: Vec<Link>,
}

/// How a library is converted.
#[derive(Clone, Copy, Debug, Default)]
pub struct Options {
    /// How much is optimized.
    pub level: opt::Level,
    /// True to write refused programs too, with an alarm at every hole.
    pub draft: bool,
    /// True where each program says in a line at its head what it was made of, unless the target's profile wants none.
    pub marks: bool,
}

/// Converts a library.
pub fn convert(
    inputs: &[Input],
    source: &Control,
    target: &Control,
    lock: Lock,
    options: Options,
) -> Conversion {
    if source.is_same_machine(target) {
        return unchanged(inputs, source, lock);
    }
    let lock = lock.for_run(inputs.iter().map(|input| input.name.as_str()));
    let in_pieces = super::chunks::convert::convert(inputs, source, target, &lock, options);
    let mut done = in_pieces.unwrap_or_else(|| whole(inputs, source, target, lock, options));
    super::line_ends::keep(inputs, target, &mut done);
    done
}

/// Converts a library as a whole.
fn whole(inputs: &[Input], source: &Control, target: &Control, lock: Lock, options: Options) -> Conversion {
    let Prepared { module, found, files, written } = prepare(inputs, source, target);
    let home: Vec<usize> = module.programs.iter().map(|p| p.file).collect();
    let mut holes = vec![Vec::new(); module.programs.len()];
    let original = options.draft.then(|| (module.clone(), found.clone()));
    let marks = marks(inputs, target, options);
    let begun = Begun { entry: Modal::unknown(), goes_on: false, continues: false, marks: &marks };
    let mut made = make(module, found, source, target, lock.clone(), options, begun.clone());
    if let Some((original, found)) = original {
        // Each round stops the machine where the last one found a hole, until none is left.
        for _ in 0..4 {
            let more = super::draft::holes(&made.found, &mut holes);
            if !more {
                break;
            }
            let mut module = original.clone();
            super::draft::fill(&mut module, &holes);
            let mut next = make(module, found.clone(), source, target, lock.clone(), options, begun.clone());
            super::draft::keep_findings(&made.found, &mut next.found);
            made = next;
        }
        refused_calls::report(&made.links, &mut made.found);
    }
    super::names::tell_files_without_number(inputs, &mut made.found);
    let mut texts = Vec::with_capacity(files.len());
    let mut reports: Vec<ProgramReport> = Vec::with_capacity(written.len());
    let mut parts: Vec<Vec<Emitted>> = made.parts;
    for (at, file) in files.iter().enumerate() {
        let framed = frames(source, target, file.tape);
        let written_here = parts.get(file.programs.clone()).into_iter().flatten().flatten();
        let mut text = String::with_capacity(written_here.map(|part| part.text.len() + 2).sum::<usize>() + 4);
        text.push_str(if framed { "%\n" } else { "" });
        let head = text.len();
        let mut any = false;
        for index in file.programs.clone() {
            let mut diagnostics = std::mem::take(&mut made.found[index]);
            diagnostics.sort_by_key(|d| (d.span.start, d.code));
            diagnostics.dedup();
            super::echoes::drop_echoes(&mut diagnostics);
            super::two_paths::drop_others(&mut diagnostics);
            crate::legalize::drop_what_another_machine_asks(&mut diagnostics);
            let outcome = outcome(&diagnostics);
            let mut map = Vec::new();
            let start = text.len();
            if outcome != Outcome::Refused || options.draft {
                // Nothing else shows where a program without a number begins.
                if framed && written[index].is_none() && text.len() > head && both_nameless(source, target) {
                    text.push_str("%\n");
                }
                for part in std::mem::take(&mut parts[index]) {
                    any |= !part.text.is_empty();
                    let base = text.len();
                    let moved = part.blocks.into_iter().map(|(span, r)| (span, r.start + base..r.end + base));
                    // Most programs are one part, whose table is changed in place.
                    if map.is_empty() {
                        map = moved.collect()
                    } else {
                        map.extend(moved)
                    }
                    text.push_str(&part.text);
                }
            }
            reports.push(ProgramReport {
                file: at,
                name: written[index].clone(),
                outcome,
                verdict: None,
                diagnostics,
                map,
                range: start..text.len(),
            });
        }
        text.push_str(if framed { "%\n" } else { "" });
        texts.push(any.then_some(text));
    }
    assert!(!CHECKED || home.windows(2).all(|w| w[0] <= w[1]));
    let (lock, taken, links) = (made.lock, made.taken, made.links);
    Conversion { programs: reports, texts, lock, taken, states_reserved: target.states_reserved(), links }
}

/// What becomes of a program with these findings. What is asked of the library or of a machine is a note here.
pub fn outcome(diagnostics: &[Diagnostic]) -> Outcome {
    match diagnostics.iter().map(|finding| finding.in_program()).max() {
        Some(Severity::Error) => Outcome::Refused,
        Some(Severity::Review) => Outcome::Review,
        _ => Outcome::Converted,
    }
}

/// Whether the file is framed by `%`: as the source was where files mean the same on both, else as the target's files are.
pub(super) fn frames(source: &Control, target: &Control, tape: bool) -> bool {
    target.names().tape && (tape || !both_nameless(source, target))
}

/// From a machine to itself: the text stays as it is, byte for byte.
fn unchanged(inputs: &[Input], control: &Control, lock: Lock) -> Conversion {
    let mut programs = Vec::new();
    let mut texts = Vec::new();
    for (at, input) in inputs.iter().enumerate() {
        let lowered = lower(at, input, control);
        texts.push(String::from_utf8(input.bytes.clone()).ok());
        programs.extend(lowered.programs.into_iter().map(|(program, diagnostics)| {
            let diagnostics: Vec<_> =
                diagnostics.into_iter().filter(|d| d.severity() == Severity::Error).collect();
            let outcome = outcome(&diagnostics);
            let name = program.name.as_ref().map(ToString::to_string);
            let (verdict, map, range) = (None, Vec::new(), 0..0);
            ProgramReport { file: at, name, outcome, verdict, diagnostics, map, range }
        }));
    }
    let (taken, links) = (String::new(), Vec::new());
    Conversion { programs, texts, lock, taken, states_reserved: control.states_reserved(), links }
}
