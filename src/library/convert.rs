//! A library from one control to another: read, lower, link, legalize, emit.

use super::names::{naming, number_programs, report_twins};
use super::parts::lower;
use super::refused_calls::{self, Link};
use super::{Input, Lock, machine_kind};
use crate::diag::{Code, Diagnostic, Severity};
use crate::dialect::Control;
use crate::emit::{Emitted, Writer};
use crate::ir::analysis::Numbers;
use crate::ir::validate::{Invalid, breaches};
use crate::ir::{Module, Program};
use crate::legalize::{Context, Modal, assign_registers, legalize};
use crate::lower::Lowered;
use crate::opt;
use crate::syntax::{ProgramName, parse_faults};
use crate::text::Span;
use crate::verify;
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::sync::Arc;

/// What became of a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Outcome {
    /// It does the same on the target, by all that is known.
    Converted,
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
    /// What the verifier found; none where it was not asked, or the program has no conversion.
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
    /// The text of each target file; none where every program of the file was refused.
    pub texts: Vec<Option<String>>,
    /// What the next run is to choose again.
    pub lock: Lock,
    /// The registers that were taken on the target.
    pub taken: Numbers,
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
}

/// A file of the source, lowered.
struct File {
    tape: bool,
    /// Indexes of its programs in the module.
    programs: std::ops::Range<usize>,
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
    if let Some(done) = super::segments::convert(inputs, source, target, &lock, options) {
        return done;
    }
    let lowered: Vec<Lowered> =
        inputs.par_iter().enumerate().map(|(at, input)| lower(at, input, source)).collect();
    let mut module = Module::default();
    let mut found: Vec<Vec<Diagnostic>> = Vec::new();
    let mut files = Vec::with_capacity(inputs.len());
    for file in lowered {
        let first = module.programs.len();
        for (program, diagnostics) in file.programs {
            module.programs.push(program);
            found.push(diagnostics);
        }
        module.names.extend(file.names);
        files.push(File { tape: file.tape, programs: first..module.programs.len() });
    }
    let written: Vec<Option<String>> =
        module.programs.iter().map(|p| p.name.as_ref().map(ToString::to_string)).collect();
    name_the_nameless(&mut module, inputs, source, target);
    report_twins(&module, inputs, &mut found);
    machine_kind::report(&module, inputs, source, &mut found);
    let home: Vec<usize> = module.programs.iter().map(|p| p.file).collect();
    let mut holes = vec![Vec::new(); module.programs.len()];
    let original = options.draft.then(|| (module.clone(), found.clone()));
    let mut made = make(module, found, source, target, lock.clone(), options.level, Modal::unknown());
    if let Some((original, found)) = original {
        // Each round stops the machine where the last one found a hole, until none is left.
        for _ in 0..4 {
            let more = super::draft::holes(&made.found, &mut holes);
            if !more {
                break;
            }
            let mut module = original.clone();
            super::draft::fill(&mut module, &holes);
            let mut next =
                make(module, found.clone(), source, target, lock.clone(), options.level, Modal::unknown());
            super::draft::keep_findings(&made.found, &mut next.found);
            made = next;
        }
        refused_calls::report(&made.links, &mut made.found);
    }
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
            let outcome = outcome(&diagnostics);
            let mut map = Vec::new();
            let start = text.len();
            if outcome != Outcome::Refused || options.draft {
                // Nothing else shows where a program without a number begins.
                if framed && written[index].is_none() && text.len() > head && same_family(source, target) {
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
    debug_assert!(home.windows(2).all(|w| w[0] <= w[1]));
    let (lock, taken, links) = (made.lock, made.taken, made.links);
    Conversion { programs: reports, texts, lock, taken, states_reserved: target.states_reserved(), links }
}

fn same_family(source: &Control, target: &Control) -> bool {
    source.dialect().family == target.dialect().family
}

/// On a control that knows programs by number each needs one. Programs without a name get that of their
/// file, and a number by it; within a family a program without a number stays what it is.
fn name_the_nameless(module: &mut Module, inputs: &[Input], source: &Control, target: &Control) {
    if same_family(source, target) {
        return;
    }
    for program in module.programs.iter_mut().filter(|program| program.name.is_none()) {
        let file = inputs.get(program.file).map(|input| input.name.clone());
        program.name = file.map(ProgramName::Name);
    }
}

/// A library through the passes, by program of the source.
pub(super) struct Made {
    pub found: Vec<Vec<Diagnostic>>,
    pub parts: Vec<Vec<Emitted>>,
    lock: Lock,
    pub taken: Numbers,
    links: Vec<Link>,
}

pub(super) fn make(
    mut module: Module,
    mut found: Vec<Vec<Diagnostic>>,
    source: &Control,
    target: &Control,
    mut lock: Lock,
    level: opt::Level,
    entry: Modal,
) -> Made {
    let count = module.programs.len();
    let mut context = Context::new(source, target, count);
    context.entry = entry;
    let fault = |d: &&Diagnostic| d.severity() == Severity::Error;
    context.faults = found.iter().map(|list| list.iter().filter(fault).map(|d| d.span).collect()).collect();
    let mut fault = opt::run(&mut module, opt::Options { level, ..Default::default() }).err();
    legalize(&mut module, &mut context);
    let tidied = opt::run(&mut module, opt::Options { level, legalized: true, ..Default::default() });
    fault = fault.or(tidied.err());
    let registers = assign_registers(&mut module, &lock.locked(), &mut context);
    let names = number_programs(&module, &mut lock, target, &mut context);
    lock.take(&registers);
    let taken = Numbers::of(registers.taken().map(|number| (number, number)));
    let mut naming = naming(&module, &registers, &names);
    let origins = context.origins.clone();
    let legal = context.into_findings();
    found.resize_with(count, Vec::new);
    found.iter_mut().zip(legal).for_each(|(all, more)| add_new(all, more));
    let mut parts: Vec<Vec<Emitted>> = vec![Vec::new(); count];
    if let Some(fault) = fault {
        found.iter_mut().for_each(|all| {
            all.push(Diagnostic::new(Code::Internal, Span::default(), fault.to_string()));
        });
    }
    // A return to any block must not find one that is numbered here: it stops before, where there is such a block.
    if let (Some(floor), Some(emit)) = (naming.returns_floor(target.text().sequence_max), target.entry().emit)
    {
        let write = emit(&naming, target);
        if module.programs.par_iter().any(|program| write(program).is_ok_and(|made| made.invents)) {
            drop(write);
            naming.set_guard(floor);
        }
    }
    let write = target.entry().emit.map(|emit| emit(&naming, target));
    let links = refused_calls::links(&module, &origins);
    // Each program is checked when it is at hand, and dropped when it is written.
    let programs = std::mem::take(&mut module.programs);
    let emitted = programs.into_par_iter().enumerate().map(|(at, program)| {
        let broken = breaches(&program, at);
        let findings = origins.get(at).and_then(|origin| found.get(*origin)).map_or(&[][..], Vec::as_slice);
        if broken.is_empty() { Ok(emit(&program, write.as_ref(), target, findings)) } else { Err(broken) }
    });
    let emitted: Vec<Result<_, Vec<Invalid>>> = emitted.collect();
    let broken: Vec<String> =
        emitted.iter().filter_map(|made| made.as_ref().err()).flatten().map(ToString::to_string).collect();
    if broken.is_empty() {
        for (origin, result) in origins.into_iter().zip(emitted.into_iter().flatten()) {
            match result {
                Ok(mut text) => {
                    found[origin].append(&mut text.findings);
                    parts[origin].push(text);
                }
                Err(diagnostics) => found[origin].extend(diagnostics),
            }
        }
        refused_calls::report(&links, &mut found);
    } else {
        // What one program of a library is broken by may have touched the others.
        for all in &mut found {
            all.push(Diagnostic::new(Code::Internal, Span::default(), broken.join("; ")));
        }
    }
    Made { found, parts, lock, taken, links }
}

/// Adds findings but for facts of the source that lowering has told already.
fn add_new(all: &mut Vec<Diagnostic>, more: Vec<Diagnostic>) {
    let facts = all.iter().filter(|finding| finding.code == Code::UnconfirmedFact);
    let told: BTreeSet<Arc<str>> = facts.map(|finding| finding.message.clone()).collect();
    let is_told = |d: &Diagnostic| d.code == Code::UnconfirmedFact && told.contains(&d.message);
    all.reserve_exact(more.len());
    all.extend(more.into_iter().filter(|finding| !is_told(finding)));
}

/// Emits a program, and reads the text back: what the target's own grammar refuses is never written, but for what
/// `findings` tell of the source, which is an alarm there too.
fn emit(
    program: &Program,
    write: Option<&Writer<'_>>,
    target: &Control,
    findings: &[Diagnostic],
) -> Result<Emitted, Vec<Diagnostic>> {
    let Some(write) = write else {
        let what = format!("programs cannot be written for {}", target.dialect().title);
        return Err(vec![Diagnostic::new(Code::NoEquivalent, program.site.span, what)]);
    };
    let mut emitted = write(program)?;
    emitted.text.shrink_to_fit();
    emitted.blocks.shrink_to_fit();
    let entry = target.entry();
    let faults: Vec<Diagnostic> = parse_faults(emitted.text.as_bytes(), entry.parse, entry.is_sound)
        .into_iter()
        .filter(|fault| fault.code.severity() == Severity::Error)
        .filter_map(|fault| {
            let at = fault.span.start as usize;
            let source = emitted.blocks.iter().find(|(_, range)| range.contains(&at)).map(|(span, _)| *span);
            let line = emitted.text[..at.min(emitted.text.len())].rfind('\n').map_or(0, |i| i + 1);
            let line = emitted.text[line..].lines().next().unwrap_or_default();
            let (code, what) = match fault.code {
                Code::DivisionByZero | Code::FunctionDomain if alarms_in(findings, source) => return None,
                // Constants that were computed out of the domain: so would they be on the machine.
                Code::DivisionByZero | Code::FunctionDomain => (fault.code, "this would become"),
                _ => (Code::Internal, "the target would not read"),
            };
            let what = format!("{what} '{line}': {}", fault.message);
            Some(Diagnostic::new(code, source.unwrap_or(program.site.span), what))
        })
        .collect();
    if faults.is_empty() { Ok(emitted) } else { Err(faults) }
}

/// True where the source has an alarm behind a condition in this block.
fn alarms_in(findings: &[Diagnostic], block: Option<Span>) -> bool {
    let inside = |block: Span, span: Span| block.start <= span.start && span.end <= block.end;
    findings.iter().any(|finding| {
        finding.code == Code::AlarmIfRun && block.is_some_and(|block| inside(block, finding.span))
    })
}

pub(super) fn outcome(diagnostics: &[Diagnostic]) -> Outcome {
    match diagnostics.iter().map(Diagnostic::severity).max() {
        Some(Severity::Error) => Outcome::Refused,
        Some(Severity::Review) => Outcome::Review,
        _ => Outcome::Converted,
    }
}

/// Whether the file is framed by `%`: as the source was within a family, else as the target's files are.
pub(super) fn frames(source: &Control, target: &Control, tape: bool) -> bool {
    tape || !same_family(source, target)
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
    let (taken, links) = (Numbers::default(), Vec::new());
    Conversion { programs, texts, lock, taken, states_reserved: control.states_reserved(), links }
}
