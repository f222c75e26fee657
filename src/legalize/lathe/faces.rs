//! Milling on the face of a part while C follows (polar interpolation), where the target is programmed there in other words.
//!
//! Law: in the plane of such milling a word of X as a diameter is twice a word of X as a radius, a word of C as a length is one of Y, and all
//! else is alike; where one control has its plane by itself, the other one is told it (G17), and the plane of before is said again after it. Side
//! conditions: it is known at each block whether the milling is in force, and what is in force with it; it begins where C stands at 0. Counter-examples:
//! `X10. C5.` at a label that is jumped to from before the milling; `G1 X[#5041-2.]`, which reads a place; `U-4.`, of which no source says what it counts, after a
//! place that is not known.

mod known;
mod rapids;
mod words;

use super::straight::returns_into;
use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question};
use crate::ir::analysis::Vacancy;
use crate::ir::analysis::over_calls::{OverCalls, called};
use crate::ir::{BlockId, Callee, Module, Nc, NcItem, SourceInfo, Stmt, StmtKind, TermKind};
use crate::legalize::features::Features;
use crate::legalize::layout::emptied::drop_emptied;
use crate::legalize::{Context, Modal};
use crate::text::Span;
use known::{Faces, Known, Mode, reads_place};
use std::collections::BTreeSet;

/// True where a program mills so.
pub fn concerns(features: &Features, _: &Context<'_>) -> bool {
    features.op(Op::PolarPlane) || features.op(Op::PolarPlaneOff)
}

/// How the words of a control are: true for X as a diameter and C, false for X as a radius and Y; none where it is not known.
fn by_c(control: &Control) -> Option<bool> {
    match control.behaviour(Question::PolarWords)?.value.as_str() {
        "x.c" => Some(true),
        "x.y" => Some(false),
        _ => None,
    }
}

/// Writes such milling in the words of the target; true if it changed anything.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    if context.agree(Question::PolarWords) {
        return false;
    }
    let (ours, theirs) = (by_c(context.source), by_c(context.target));
    let Some((ours, theirs)) = ours.zip(theirs).filter(|(ours, theirs)| ours != theirs) else {
        return refused(module, context);
    };
    if theirs && !context.features.op(Op::Incremental) {
        rapids::move_out(module);
    }
    let facts = context.modal_facts(module);
    let known = OverCalls::of(module, &Faces { by_c: ours });
    let called = called(module);
    let returns_to = returns_into(module);
    let names: BTreeSet<_> = module.programs.iter().filter_map(|program| program.name.clone()).collect();
    let mut found: Vec<(usize, Span, &'static str)> = Vec::new();
    let summaries = context.summaries(module);
    for (index, program) in module.programs.iter_mut().enumerate() {
        // A word that is computed from a vacant variable is not there.
        let vacant = Vacancy::of(program, &summaries, &BTreeSet::new()).absent(&|_, role| role == Role::X);
        for (at, block) in program.blocks.iter_mut().enumerate() {
            let id = BlockId(at as u32);
            let Some(state) = known.at(index, id) else {
                let polar = block.stmts.iter().find(|stmt| stmt.kind.nc().is_some_and(changes));
                found.extend(polar.map(|stmt| (index, stmt.site.span, MODE)));
                continue;
            };
            let mut face =
                Face { by_c: ours, known: state.clone(), modal: facts.at(index, id), found: Vec::new() };
            if returns_to && block.stmts.iter().any(|stmt| stmt.kind.has_op(Op::PolarPlane)) {
                face.found.push((block.term.site.span, MODE));
            }
            let old = std::mem::take(&mut block.stmts);
            for (place, stmt) in old.iter().enumerate() {
                let next = old.get(place + 1).filter(|next| next.site.skip.is_none());
                let next = next.and_then(|next| next.kind.nc());
                let says = next.is_some_and(|nc| nc.ops().any(|op| op.group() == Group::Plane));
                let (stmt, after) = face.stmt(stmt.clone(), says, vacant.contains(&(id, place)));
                block.stmts.push(stmt);
                block.stmts.extend(after);
            }
            drop_emptied(block);
            let within = |callee: &Callee| match callee {
                Callee::Block(_) => true,
                Callee::Program(name) => names.contains(name),
                Callee::Computed(_) | Callee::Cycle(_) => false,
            };
            let mut reads = false;
            block.term.kind.exprs(&mut |e| reads |= reads_place(e));
            let what = match &block.term.kind {
                _ if face.known.mode == Mode::Off => None,
                TermKind::End { .. } | TermKind::Stray | TermKind::Chain(_) => Some(ENDS),
                TermKind::Return { .. } if !called[index] => Some(ENDS),
                TermKind::Call { call, .. } if !within(&call.callee) => Some(CALLS),
                _ if reads => Some(READS),
                _ => None,
            };
            face.found.extend(what.map(|what| (block.term.site.span, what)));
            found.extend(face.found.into_iter().map(|(span, what)| (index, span, what)));
        }
    }
    for (index, span, what) in found {
        context.add_once(
            index,
            what,
            Diagnostic::new(Code::NoEquivalent, span, what).with_help(help_for(what)),
        );
    }
    true
}

/// The same where it is not known how one of the two is programmed.
fn refused(module: &Module, context: &mut Context<'_>) -> bool {
    for (index, program) in module.programs.iter().enumerate() {
        let mut stmts = program.blocks.iter().flat_map(|block| &block.stmts);
        if let Some(stmt) = stmts.find(|stmt| stmt.kind.has_op(Op::PolarPlane)) {
            let found = Diagnostic::new(Code::NoEquivalent, stmt.site.span, UNKNOWN).with_help(HELP);
            context.add_once(index, UNKNOWN, found);
        }
    }
    false
}

/// What to do about it.
fn help_for(what: &str) -> &'static str {
    if what == RAPID { RAPID_HELP } else { HELP }
}

/// True for a block that begins or ends such milling.
fn changes(nc: &Nc) -> bool {
    nc.has(Op::PolarPlane) || nc.has(Op::PolarPlaneOff)
}

/// What is known on the way through a block.
struct Face {
    by_c: bool,
    known: Known,
    modal: Modal,
    found: Vec<(Span, &'static str)>,
}

impl Face {
    /// What stands on the target for a statement, and what after it; `says` is true where the next one names a plane, `vacant` where its X may not
    /// be there.
    fn stmt(&mut self, mut stmt: Stmt, says: bool, vacant: bool) -> (Stmt, Option<Stmt>) {
        let before = self.known.clone();
        self.known.step(&stmt, self.by_c);
        self.modal.step(&stmt);
        let span = stmt.site.span;
        let tell = SourceInfo { span, skip: stmt.site.skip, ..SourceInfo::default() };
        let StmtKind::Nc(nc) = &mut stmt.kind else {
            self.other(&before, &stmt);
            return (stmt, None);
        };
        let what = if changes(nc) { self.change(&before, nc) } else { self.inside(&before, nc, vacant) };
        let begins = nc.has(Op::PolarPlane);
        let acts = begins || changes(nc) && before.mode != Mode::Off;
        let what = what.or((acts && stmt.site.skip.is_some()).then_some(MODE));
        let plane = match (begins, self.by_c) {
            _ if !changes(nc) || before.mode != Mode::On && !begins => None,
            (true, true) => {
                before.plane.map_or(Some(Op::PlaneXy), |plane| (plane != Op::PlaneXy).then_some(Op::PlaneXy))
            }
            (false, true) => before.plane.filter(|plane| *plane != Op::PlaneXy),
            (true, false) => None,
            (false, false) => before.plane.filter(|plane| before.entered != Some(*plane)),
        };
        let unsure = changes(nc) && !begins && before.mode == Mode::On && before.plane.is_none();
        self.found.extend(what.or(unsure.then_some(PLANE)).map(|what| (span, what)));
        let plane = plane.filter(|_| !says || begins);
        let after =
            plane.map(|op| Stmt { kind: StmtKind::Nc(Nc { items: vec![NcItem::Op(op)] }), site: tell });
        (stmt, after)
    }

    /// A block that begins or ends it.
    fn change(&mut self, before: &Known, nc: &mut Nc) -> Option<&'static str> {
        let begins = nc.has(Op::PolarPlane);
        if before.mode == Mode::Off && !begins {
            // A block that only makes sure.
            return None;
        }
        let is_plane = |item: &NcItem| matches!(item, NcItem::Op(op) if op.group() == Group::Plane);
        nc.items.retain(|item| !is_plane(item));
        let compensated = matches!(self.modal.op(Group::RadiusComp), Some(Op::RadiusLeft | Op::RadiusRight));
        match before.mode {
            _ if nc.items.len() > 1 => Some(BESIDE),
            Mode::Unknown => Some(MODE),
            Mode::On if begins => Some(MODE),
            _ if compensated => Some(COMPENSATED),
            Mode::Off if !before.at_zero => Some(ZERO),
            _ => None,
        }
    }

    /// Any other block.
    fn inside(&mut self, before: &Known, nc: &mut Nc, vacant: bool) -> Option<&'static str> {
        match before.mode {
            Mode::Off => return None,
            Mode::Unknown => return words::counts(nc).then_some(MODE),
            Mode::On => {}
        }
        let motion = self.modal.op(Group::Motion);
        let arc = matches!(motion, Some(Op::ArcCw | Op::ArcCcw));
        let moves = words::counts(nc) && !nc.has(Op::Dwell);
        if nc.items.iter().any(|item| matches!(item, NcItem::Code(letter, _) if *letter != 'M'))
            || nc.ops().any(|op| !words::may_stand(op))
        {
            return Some(CODE);
        }
        if moves && self.modal.may_call() {
            return Some(CALLS);
        }
        if moves && !arc && motion != Some(Op::Linear) || nc.has(Op::Rapid) {
            return Some(if motion == Some(Op::Rapid) { RAPID } else { MOTION });
        }
        if moves && !self.known.absolute {
            return Some(STEPS);
        }
        if !self.by_c && arc && moves && self.known.plane != Some(Op::PlaneXy) {
            return Some(PLANE);
        }
        let mut reads = false;
        let values = nc.items.iter().filter_map(|item| match item {
            NcItem::Word(_, value) | NcItem::Code(_, value) => Some(value),
            NcItem::Op(_) => None,
        });
        values.for_each(|value| reads |= reads_place(value));
        if reads {
            return Some(READS);
        }
        nc.items.retain(|item| !matches!(item, NcItem::Op(op) if op.group() == Group::Plane));
        words::rewrite(nc, self.by_c, vacant, before.at)
    }

    /// A statement that is no block of words.
    fn other(&mut self, before: &Known, stmt: &Stmt) {
        if before.mode == Mode::Off {
            return;
        }
        let mut reads = false;
        stmt.kind.exprs(&mut |e| reads |= reads_place(e));
        let what = match &stmt.kind {
            StmtKind::ModalCall(_) | StmtKind::ModalCallOff => Some(CALLS),
            _ if reads => Some(READS),
            _ => None,
        };
        self.found.extend(what.map(|what| (stmt.site.span, what)));
    }
}

const UNKNOWN: &str = "polar interpolation: how it is programmed on one of the two controls is not known";
const MODE: &str =
    "whether polar interpolation is in force here is not known, and its words count otherwise on the target";
const BESIDE: &str =
    "polar interpolation begins or ends in a block with other codes or words: no source says what they do";
const COMPENSATED: &str = "polar interpolation begins or ends while the radius of the tool is compensated: no source says what comes of it";
const ZERO: &str = "polar interpolation begins where C is not known to stand at 0: one of the two controls counts its plane from where C stands";
const ENDS: &str = "the program ends in polar interpolation: what the target is in then no source says";
const CALLS: &str = "a program is called in polar interpolation that may do anything there";
const READS: &str = "a place is read in polar interpolation: no source says in what it is read";
const CODE: &str = "a code in polar interpolation of which no source says that it may stand there";
const RAPID: &str = "a rapid move in polar interpolation, which one of the two controls does not take there";
const MOTION: &str = "a move in polar interpolation of which it is not known whether it is a rapid one, and one of the two controls takes none there";
const STEPS: &str =
    "an increment in polar interpolation: no source says what it counts on one of the two controls";
const PLANE: &str =
    "which plane is in force in polar interpolation is not known, and the target must be told";
const AXIS: &str = "a word in polar interpolation that has no equal there on the target";
const VACANT: &str = "X in polar interpolation is computed from a variable that may be vacant, and the target counts it otherwise";
const RAPID_HELP: &str = "write G1 with a feed in its place, or end polar interpolation before it";
const HELP: &str = "let the CAM system write this part for the target, or write it by hand";
