//! Labels, jumps, loops and ends: what nothing uses, what nothing reaches, what never ends.

use super::looked::{Findings, Looked};
use crate::canon::Op;
use crate::diag::Code;
use crate::ir::analysis::dataflow::reached_among;
use crate::ir::analysis::{last_place, text_ends};
use crate::ir::{Block, BlockId, Callee, Program, StmtKind, TermKind};
use crate::syntax::{ItemKind, Label, parse_file};
use crate::text::Span;
use std::collections::{BTreeMap, BTreeSet};

/// A label that no jump and no call names.
pub(super) fn unused_label(looked: &Looked<'_>, findings: &mut Findings) {
    unnamed_labels(looked, findings);
    let comes_back = returns_to(looked);
    for (at, program) in looked.programs().filter(|(at, _)| !looked.has_hole(*at)) {
        if names_by_words(program) {
            continue;
        }
        let named = named_blocks(program);
        let computed =
            program.blocks.iter().any(|block| matches!(block.term.kind, TermKind::Computed { .. }));
        let few = few_numbers(program);
        for (id, block) in program.ids().zip(&program.blocks).filter(|(id, _)| !named.contains(id)) {
            for label in &block.labels {
                let shown = match label {
                    Label::Name(_) => continue,
                    Label::Number(_) if computed || comes_back || !few || is_heading(block) => continue,
                    Label::Number(number) => number.to_string(),
                };
                let Some(span) = start_of(program, id) else { continue };
                let message = format!("no jump and no call of {} names the label {shown}", looked.shown(at));
                findings.add(program.file, Code::UnusedLabel, span, message);
            }
        }
    }
}

/// A label of its own that no jump and no call names. It may stand in no block of the common form, so the text is asked.
fn unnamed_labels(looked: &Looked<'_>, findings: &mut Findings) {
    if looked.control.statement("goto.label").is_none() {
        return;
    }
    let mut used: BTreeMap<usize, BTreeSet<&str>> = BTreeMap::new();
    for (at, program) in looked.programs() {
        let named = named_blocks(program).into_iter().filter_map(|id| program.block(id));
        let names = named.flat_map(|block| &block.labels).filter_map(|label| match label {
            Label::Name(name) => Some(name.as_str()),
            Label::Number(_) => None,
        });
        used.insert(at, names.collect());
    }
    for (file, input) in looked.inputs.iter().enumerate() {
        let programs: Vec<(usize, &Program)> =
            looked.programs().filter(|(at, program)| program.file == file && !looked.has_hole(*at)).collect();
        let parsed = parse_file(&input.bytes, looked.control.entry().parse_items);
        for item in parsed.blocks.iter().flat_map(|block| &block.items) {
            let ItemKind::Label(label) = &item.kind else { continue };
            let own = programs.iter().rev().find(|(_, program)| program.site.span.start <= item.span.start);
            let Some(used) = own.and_then(|(at, _)| used.get(at)) else { continue };
            let is_used = match label {
                Label::Name(name) => used.contains(name.as_str()),
                // The common form keeps the sign before the number.
                Label::Number(number) => {
                    let number = number.to_string();
                    used.iter().any(|name| name.trim_start_matches(|c: char| !c.is_ascii_digit()) == number)
                }
            };
            if !is_used {
                let text = String::from_utf8_lossy(item.span.of(&input.bytes)).trim().to_owned();
                let message = format!("no jump and no call names the label '{text}'");
                findings.add(file, Code::UnusedLabel, item.span, message);
            }
        }
    }
}

/// True where the number stands before a comment alone: it is for people.
fn is_heading(block: &Block) -> bool {
    let first = block.stmts.first();
    first.is_some_and(|stmt| stmt.kind == StmtKind::Comment && !stmt.site.comments.is_empty())
}

/// The blocks that jumps and calls name; falling through names none.
fn named_blocks(program: &Program) -> BTreeSet<BlockId> {
    let mut named = BTreeSet::new();
    for block in &program.blocks {
        let falls = block.term.site.span == Span::default();
        match &block.term.kind {
            TermKind::Jump(_) if falls => {}
            TermKind::Call { call, .. } => {
                if let Callee::Block(entry) = call.callee {
                    named.insert(entry);
                }
            }
            kind => named.extend(kind.successors()),
        }
        for stmt in &block.stmts {
            if let StmtKind::ModalCall(call) = &stmt.kind
                && let Callee::Block(entry) = call.callee
            {
                named.insert(entry);
            }
        }
    }
    named
}

/// True where a code that only its machine has may name blocks by their numbers.
fn names_by_words(program: &Program) -> bool {
    let mut stmts = program.blocks.iter().flat_map(|block| &block.stmts);
    stmts.any(|stmt| stmt.kind.has_op(Op::MachineSpecific) || stmt.kind.has_op(Op::CycleOther))
}

/// True where a program that jumps numbers few of its blocks: then it numbers them to jump there.
fn few_numbers(program: &Program) -> bool {
    let jumps = program.blocks.iter().any(|block| {
        block.term.site.span != Span::default() && !matches!(block.term.kind, TermKind::End { .. })
    });
    let stmts = program.blocks.iter().flat_map(|block| &block.stmts);
    let numbered =
        |(numbered, all): (usize, usize), sequence: bool| (numbered + usize::from(sequence), all + 1);
    let (numbered, all) = stmts.map(|stmt| stmt.site.sequence.is_some()).fold((0, 0), numbered);
    let labels = program.blocks.iter().flat_map(|block| &block.labels);
    let labels = labels.filter(|label| matches!(label, Label::Number(_))).count();
    jumps && numbered.max(labels) * 3 <= all
}

/// True where some program returns to a sequence number of its caller.
fn returns_to(looked: &Looked<'_>) -> bool {
    let blocks = looked.module.programs.iter().flat_map(|program| &program.blocks);
    blocks.into_iter().any(|block| matches!(block.term.kind, TermKind::Return { to: Some(_) }))
}

/// The first place of a block, or of what it falls through to.
fn start_of(program: &Program, mut id: BlockId) -> Option<Span> {
    for _ in 0..=program.blocks.len() {
        let block = program.block(id)?;
        let spans = block.stmts.iter().map(|stmt| stmt.site.span).chain([block.term.site.span]);
        if let Some(span) = spans.into_iter().find(|span| *span != Span::default()) {
            return Some(span);
        }
        let TermKind::Jump(to) = block.term.kind else { return None };
        id = to;
    }
    None
}

/// Blocks that nothing reaches.
pub(super) fn unreached(looked: &Looked<'_>, findings: &mut Findings) {
    let comes_back = returns_to(looked);
    for (at, program) in looked.programs().filter(|(at, _)| !looked.has_hole(*at)) {
        let Some(cfg) = looked.cfg(at) else { continue };
        let labelled = program.ids().zip(&program.blocks).filter(|(_, block)| {
            comes_back && block.labels.iter().any(|label| matches!(label, Label::Number(_)))
        });
        let roots = cfg.roots().iter().copied().chain(labelled.map(|(id, _)| id)).map(BlockId::index);
        let seen = reached_among(program.blocks.len(), roots, |at, go| {
            cfg.succs(BlockId(at as u32)).iter().for_each(|to| go(to.index()));
        });
        let mut run = false;
        for (block, seen) in program.blocks.iter().zip(&seen) {
            let first = (!seen).then(|| first_act(block)).flatten();
            if let Some(span) = first.filter(|_| !run) {
                let message = "nothing reaches this block, and the program never runs it";
                findings.add(program.file, Code::Unreached, span, message);
            }
            run = !seen && (run || first.is_some());
        }
    }
}

/// The first place of a block that does something.
fn first_act(block: &Block) -> Option<Span> {
    let acts = block.stmts.iter().filter(|stmt| stmt.kind != StmtKind::Comment);
    let ends = matches!(
        block.term.kind,
        TermKind::Branch { .. } | TermKind::Call { .. } | TermKind::Computed { .. }
    );
    let spans = acts.map(|stmt| stmt.site.span).chain(ends.then_some(block.term.site.span));
    spans.into_iter().find(|span| *span != Span::default())
}

/// Where control comes to from a block that does nothing.
fn resolved(program: &Program, mut id: BlockId) -> BlockId {
    for _ in 0..program.blocks.len() {
        match program.block(id) {
            Some(Block { stmts, term, .. }) if stmts.iter().all(|stmt| stmt.kind == StmtKind::Comment) => {
                match term.kind {
                    TermKind::Jump(to) if term.site.span == Span::default() => id = to,
                    _ => return id,
                }
            }
            _ => return id,
        }
    }
    id
}

/// A jump to where control comes to without it.
pub(super) fn jump_to_next(looked: &Looked<'_>, findings: &mut Findings) {
    for (_, program) in looked.programs().filter(|(at, _)| !looked.has_hole(*at)) {
        for (id, block) in program.ids().zip(&program.blocks) {
            if block.term.site.span == Span::default() {
                continue;
            }
            let same = match &block.term.kind {
                TermKind::Jump(to) => {
                    let next = BlockId(id.0 + 1);
                    *to > id
                        && program.block(next).is_some()
                        && resolved(program, *to) == resolved(program, next)
                }
                TermKind::Branch { then, otherwise, cond } => {
                    !cond.has_switch() && resolved(program, *then) == resolved(program, *otherwise)
                }
                _ => false,
            };
            if same {
                let message = "the jump goes to the next block, where the program goes on without it too";
                findings.add(program.file, Code::JumpToNext, block.term.site.span, message);
            }
        }
    }
}

/// A program whose text ends without a code that ends it.
pub(super) fn no_end(looked: &Looked<'_>, findings: &mut Findings) {
    for (at, program) in looked.programs().filter(|(at, _)| !looked.has_hole(*at)) {
        let Some(cfg) = looked.cfg(at) else { continue };
        let acts = program.blocks.iter().any(|block| first_act(block).is_some());
        // What stands without a name and without an end is a part of something.
        if !acts || program.name.is_none() {
            continue;
        }
        for _ in text_ends(program, cfg) {
            let message = format!("the text of {} ends here without a code that ends it", looked.shown(at));
            findings.add(program.file, Code::EndMissing, last_place(program), message);
        }
    }
}

/// A sequence number that stands twice in a program.
pub(super) fn sequence_twice(looked: &Looked<'_>, findings: &mut Findings) {
    for (at, program) in looked.programs() {
        let mut first: BTreeMap<u32, Span> = BTreeMap::new();
        let stmts = program
            .blocks
            .iter()
            .flat_map(|block| block.stmts.iter().map(|stmt| &stmt.site).chain([&block.term.site]));
        for site in stmts {
            let Some(number) = site.sequence.get() else { continue };
            let before = *first.entry(number).or_insert(site.span);
            if before.start < site.span.start {
                let line = looked.line(at, before);
                let message = format!("the sequence number {number} stands at line {line} too");
                findings.add(program.file, Code::SequenceTwice, site.span, message);
            }
        }
    }
}

/// True for what lets a person in: the run stops, and variables may be changed by hand.
pub(super) fn waits(kind: &StmtKind) -> bool {
    matches!(kind, StmtKind::StopMessage { .. } | StmtKind::Input { .. } | StmtKind::Alarm { .. })
        || kind.has_op(Op::Stop)
        || kind.has_op(Op::OptionalStop)
}
