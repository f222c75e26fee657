//! A library of one lowered module through the passes and the emitter, and what was written read back.

use super::broken;
use super::names::naming;
use super::refused_calls::{self, Link};
use super::{Lock, Options};
use crate::diag::{Code, Diagnostic, Severity};
use crate::dialect::Control;
use crate::emit::{Emitted, Writer};
use crate::ir::validate::Invalid;
use crate::ir::{Module, Program, Valid};
use crate::legalize::{Context, Locked, Modal, pipeline};
use crate::opt;
use crate::syntax::parse_faults;
use crate::text::Span;
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// A library through the passes, by program of the source.
pub(super) struct Made {
    pub found: Vec<Vec<Diagnostic>>,
    pub parts: Vec<Vec<Emitted>>,
    pub lock: Lock,
    pub taken: String,
    pub links: Vec<Link>,
}

/// How the programs of a module begin.
#[derive(Clone, Debug)]
pub(super) struct Begun<'m> {
    /// What is in force then.
    pub entry: Modal,
    /// True where the text goes on after the last of them.
    pub goes_on: bool,
    /// True where the first of them goes on with what stands before the text: it has no head.
    pub continues: bool,
    /// By file, the line that says what its programs were made of.
    pub marks: &'m [String],
}

pub(super) fn make(
    mut module: Module,
    mut found: Vec<Vec<Diagnostic>>,
    source: &Control,
    target: &Control,
    mut lock: Lock,
    options: Options,
    Begun { entry, goes_on, continues, marks }: Begun<'_>,
) -> Made {
    super::marks::drop_old(&mut module);
    super::callers_modes::settle(&mut found, &module, &entry);
    let count = module.programs.len();
    let short = |program: &Program| Some(program.name.as_ref()?.short().into_owned());
    let names: Vec<Option<String>> = module.programs.iter().map(short).collect();
    let mut context = context(&found, source, target, options.level, lock.locked(), entry);
    context.goes_on = goes_on;
    let fault = pipeline::run(&mut module, &mut context).err();
    let registers = std::mem::take(&mut context.registers);
    let numbers = std::mem::take(&mut context.numbers);
    let origins = std::mem::take(&mut context.origins);
    let copied = std::mem::take(&mut context.copied);
    let waiting = std::mem::take(&mut context.waiting);
    let legal = context.into_findings();
    lock.take(&registers, numbers.chosen);
    lock.hold(copied.iter().filter_map(|copy| {
        // What a program without a name holds, its file says.
        Some((copy.name.clone(), names.get(copy.caller)?.clone()?))
    }));
    let taken = registers.taken_in_words();
    let mut naming = naming(&module, &registers, &numbers.of);
    naming.set_marks(marks, continues);
    found.resize_with(count, Vec::new);
    // The conversion waits there, or says where it does not: whether the source read earlier, and meant to, is one question
    // for all programs.
    let early = found.iter_mut().enumerate().filter(|(program, _)| waiting.contains(program));
    let early = early.flat_map(|(_, all)| all).filter(|finding| finding.code == Code::EarlyRead);
    early.for_each(|finding| finding.once = true);
    for (all, more) in found.iter_mut().zip(legal) {
        // A place that has no wait says so itself.
        let meets = |own: &Diagnostic, span: Span| own.span.start < span.end && span.start < own.span.end;
        let told = |span| more.iter().any(|own| own.code == Code::EarlyRead && meets(own, span));
        all.retain(|finding| finding.code != Code::EarlyRead || !told(finding.span));
        add_new(all, more);
    }
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
        let invents = |(at, program)| {
            Valid::of(program, at).is_ok_and(|valid| write(valid).is_ok_and(|made| made.invents))
        };
        if module.programs.par_iter().enumerate().any(invents) {
            drop(write);
            naming.set_guard(floor);
        }
    }
    let write = target.entry().emit.map(|emit| emit(&naming, target));
    let mut links = refused_calls::links(&module, &origins);
    links.extend(copied.into_iter().map(Link::of_copy));
    // Each program is checked when it is at hand, and dropped when it is written.
    let programs = std::mem::take(&mut module.programs);
    let emitted = programs.into_par_iter().enumerate().map(|(at, program)| {
        let findings = origins.get(at).and_then(|origin| found.get(*origin)).map_or(&[][..], Vec::as_slice);
        let mut made = Valid::of(&program, at).map(|valid| emit(valid, write.as_ref(), target, findings));
        // What is found in the text of a refused program counts, but nobody reads that.
        if let Ok(Ok(emitted)) = &mut made
            && !options.draft
            && findings.iter().any(|finding| finding.severity() == Severity::Error)
        {
            (emitted.text, emitted.blocks) = (String::new(), Vec::new());
        }
        made
    });
    let emitted: Vec<Result<_, Vec<Invalid>>> = emitted.collect();
    let mut broken: BTreeMap<usize, Vec<String>> = BTreeMap::new();
    for (origin, result) in origins.into_iter().zip(emitted) {
        match result {
            Ok(Ok(mut text)) => {
                found[origin].append(&mut text.findings);
                parts[origin].push(text);
            }
            Ok(Err(diagnostics)) => found[origin].extend(diagnostics),
            Err(faults) => {
                broken.entry(origin).or_default().extend(faults.iter().map(ToString::to_string));
            }
        }
    }
    for at in broken::refuse(&broken, &links, &mut found) {
        parts[at].clear();
    }
    refused_calls::report(&links, &mut found);
    Made { found, parts, lock, taken, links }
}

/// What the passes are given, for a library in which this was found when it was lowered.
pub(super) fn context<'a>(
    found: &[Vec<Diagnostic>],
    source: &'a Control,
    target: &'a Control,
    level: opt::Level,
    locked: Locked<'a>,
    entry: Modal,
) -> Context<'a> {
    let mut context = Context::new(source, target, found.len());
    (context.entry, context.level, context.locked) = (entry, level, locked);
    let fault = |d: &&Diagnostic| d.severity() == Severity::Error;
    context.faults = found.iter().map(|list| list.iter().filter(fault).map(|d| d.span).collect()).collect();
    context
}

/// Adds findings but for facts of the source that lowering has told already.
pub(super) fn add_new(all: &mut Vec<Diagnostic>, more: Vec<Diagnostic>) {
    let is_fact = |d: &Diagnostic| matches!(d.code, Code::UnconfirmedFact | Code::CommonFact);
    let facts = all.iter().filter(|finding| is_fact(finding));
    let told: BTreeSet<Arc<str>> = facts.map(|finding| finding.message.clone()).collect();
    let is_told = |d: &Diagnostic| is_fact(d) && told.contains(&d.message);
    all.reserve_exact(more.len());
    all.extend(more.into_iter().filter(|finding| !is_told(finding)));
}

/// Emits a program, and reads the text back: what the target's own grammar refuses is never written, but for what
/// `findings` tell of the source, which is an alarm there too.
fn emit(
    program: Valid<'_>,
    write: Option<&Writer<'_>>,
    target: &Control,
    findings: &[Diagnostic],
) -> Result<Emitted, Vec<Diagnostic>> {
    let Some(write) = write else {
        let what = format!("macroglot cannot write programs for {}", target.dialect().title);
        return Err(vec![Diagnostic::new(Code::NoEquivalent, program.program().site.span, what)]);
    };
    let mut emitted = write(program)?;
    emitted.text.shrink_to_fit();
    emitted.blocks.shrink_to_fit();
    let entry = target.entry();
    let faults: Vec<Diagnostic> = parse_faults(emitted.text.as_bytes(), entry.parse_faults)
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
            Some(Diagnostic::new(code, source.unwrap_or(program.program().site.span), what))
        })
        .collect();
    if faults.is_empty() { Ok(emitted) } else { Err(faults) }
}

/// True where the source has an alarm after a condition in this block.
fn alarms_in(findings: &[Diagnostic], block: Option<Span>) -> bool {
    let inside = |block: Span, span: Span| block.start <= span.start && span.end <= block.end;
    findings.iter().any(|finding| {
        finding.code == Code::AlarmIfRun && block.is_some_and(|block| inside(block, finding.span))
    })
}
