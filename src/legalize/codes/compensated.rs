//! Where cutter compensation may be in force.
//!
//! A forward analysis over all programs at once. Programs start without compensation, so a place is marked if some way leads there from
//! a block that may begin it and past none that surely ends it. Side conditions, all on the safe side: the returns of a program go on
//! after all of its calls, those to a sequence number at every number of its callers; a callee that names no code of compensation
//! leaves it as its caller had it, and so does one that is not in the library. The macro of a modal call may run at any move,
//! so it is marked if any place of the library is. A code that may be skipped ends nothing. A computed code of which nothing is known,
//! and that stands alone in its block, as those that select a work offset do, is supposed to begin none: whoever asks tells that.

use super::by_number::numbers;
use crate::canon::{Group, Op};
use crate::ir::analysis::computed_calls::CalledPrograms;
use crate::ir::analysis::{Assigned, Summaries};
use crate::ir::{Block, BlockId, Call, Callee, Module, NcItem, Program, Stmt, StmtKind, TermKind};
use crate::legalize::Context;
use crate::syntax::Label;
use crate::text::Span;
use std::cell::LazyCell;
use std::collections::{BTreeMap, BTreeSet};

/// What a statement does to compensation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Effect {
    /// It may be in force from here on.
    Begins,
    /// It is not in force from here on.
    Ends,
}

/// Where compensation may be in force in a library.
pub(super) struct Compensated {
    /// By program and block, whether it may be in force at its start.
    entries: Vec<Vec<bool>>,
    /// By program and block, what its statements do to it, in their order.
    effects: Vec<Vec<Vec<(usize, Effect)>>>,
    /// The programs and places of computed codes that are supposed to begin none.
    pub(super) supposed: BTreeSet<(usize, Span)>,
}

impl Compensated {
    /// Looks through a library.
    pub(super) fn of(module: &Module, summaries: &Summaries, context: &Context<'_>) -> Self {
        let mut supposed = BTreeSet::new();
        let mut all = |(index, program)| {
            let (effects, more) = effects(index, program, summaries, context);
            supposed.extend(more.into_iter().map(|span| (index, span)));
            effects
        };
        let effects: Vec<Vec<Vec<(usize, Effect)>>> =
            module.programs.iter().enumerate().map(&mut all).collect();
        let begins = |(_, effect): &(usize, Effect)| *effect == Effect::Begins;
        let any = effects.iter().flatten().flatten().any(begins);
        let blank = module.programs.iter().map(|program| vec![false; program.blocks.len()]).collect();
        let mut found = Self { entries: blank, effects, supposed };
        if any {
            Ways::of(module, &found.effects, &context.called(module)).follow(&mut found);
        }
        found
    }

    /// Whether it may be in force at the start of a block, and what its statements do to it.
    pub(super) fn at(&self, program: usize, block: usize) -> (bool, &[(usize, Effect)]) {
        let entry = self.entries.get(program).and_then(|all| all.get(block));
        let effects = self.effects.get(program).and_then(|all| all.get(block));
        (entry.copied().unwrap_or(true), effects.map_or(&[][..], Vec::as_slice))
    }

    fn after(&self, program: usize, block: usize) -> bool {
        let (entry, effects) = self.at(program, block);
        effects.last().map_or(entry, |(_, last)| *last == Effect::Begins)
    }

    /// Marks the start of a block; true if that is news.
    fn mark(&mut self, program: usize, block: BlockId) -> bool {
        let entry = self.entries.get_mut(program).and_then(|all| all.get_mut(block.index()));
        entry.is_some_and(|entry| !std::mem::replace(entry, true))
    }
}

fn effects(
    index: usize,
    program: &Program,
    summaries: &Summaries,
    context: &Context<'_>,
) -> (Vec<Vec<(usize, Effect)>>, Vec<Span>) {
    let mut supposed = Vec::new();
    let (source, origin) = (context.source, context.origin(index));
    let assigned = LazyCell::new(|| Assigned::new(program, summaries));
    let mut of = |id: BlockId, at: usize, stmt: &Stmt| {
        let mut found = None;
        let items = stmt.kind.nc().map_or(&[][..], |nc| &nc.items);
        for item in items {
            let ops: Option<Vec<Op>> = match item {
                NcItem::Op(op) => Some(vec![*op]),
                NcItem::Code('G', value) => {
                    let known = context.computed_codes.get(&(origin, stmt.site.span)).cloned().flatten();
                    let here = || {
                        let all = numbers(value, &assigned, id, at, source)?;
                        Some(all.iter().map(|n| n.number).collect::<Vec<_>>())
                    };
                    let all = known.or_else(here);
                    all.map(|all| all.iter().filter_map(|n| Some(source.code('G', *n, &[])?.op)).collect())
                }
                _ => continue,
            };
            let Some(ops) = ops else {
                if items.len() > 1 {
                    return Some(Effect::Begins);
                }
                supposed.push(stmt.site.span);
                continue;
            };
            let begins = |op: &Op| op.group() == Group::RadiusComp && *op != Op::RadiusOff;
            if ops.iter().any(begins) {
                return Some(Effect::Begins);
            }
            // One of several computed codes ends it only perhaps.
            let ends = !ops.is_empty() && ops.iter().all(|op| *op == Op::RadiusOff);
            if ends && (ops.len() == 1 || matches!(item, NcItem::Code(..))) && stmt.site.skip.is_none() {
                found = Some(Effect::Ends);
            }
        }
        found
    };
    let mut in_block = |(id, block): (BlockId, &Block)| {
        block.stmts.iter().enumerate().filter_map(|(at, stmt)| Some((at, of(id, at, stmt)?))).collect()
    };
    let effects = program.ids().zip(&program.blocks).map(&mut in_block).collect();
    (effects, supposed)
}

/// Where control may go in a library.
struct Ways<'m> {
    module: &'m Module,
    called: &'m CalledPrograms,
    /// By program, whether it or what it calls names compensation.
    touches: Vec<bool>,
    /// By program, those that call it.
    callers: BTreeMap<usize, BTreeSet<usize>>,
    /// The programs and blocks that modal calls run.
    modal: BTreeSet<(usize, BlockId)>,
}

impl<'m> Ways<'m> {
    fn of(module: &'m Module, effects: &[Vec<Vec<(usize, Effect)>>], called: &'m CalledPrograms) -> Self {
        let mut touches: Vec<bool> =
            effects.iter().map(|blocks| blocks.iter().any(|all| !all.is_empty())).collect();
        let mut callers: BTreeMap<usize, BTreeSet<usize>> = BTreeMap::new();
        for (caller, callee) in called.pairs(module) {
            callers.entry(callee).or_default().insert(caller);
        }
        let mut left: Vec<usize> = (0..touches.len()).filter(|at| touches[*at]).collect();
        while let Some(at) = left.pop() {
            for caller in callers.get(&at).into_iter().flatten() {
                if touches.get_mut(*caller).is_some_and(|touches| !std::mem::replace(touches, true)) {
                    left.push(*caller);
                }
            }
        }
        let mut modal = BTreeSet::new();
        for (index, program) in module.programs.iter().enumerate() {
            for (id, block) in program.ids().zip(&program.blocks) {
                for stmt in &block.stmts {
                    let StmtKind::ModalCall(call) = &stmt.kind else { continue };
                    if let Callee::Block(entry) = &call.callee {
                        modal.insert((index, *entry));
                    }
                    modal.extend(called.by((index, id), call).iter().map(|callee| (*callee, BlockId(0))));
                }
            }
        }
        Self { module, called, touches, callers, modal }
    }

    /// Marks all places where compensation may be in force.
    fn follow(&self, found: &mut Compensated) {
        // What a macro does at the moves after its modal call is done somewhere among them.
        if self.modal.iter().any(|(program, _)| self.touches.get(*program) != Some(&false)) {
            found.entries.iter_mut().flatten().for_each(|entry| *entry = true);
            found.effects.iter_mut().flatten().for_each(Vec::clear);
            return;
        }
        for (program, block) in &self.modal {
            found.mark(*program, *block);
        }
        let mut leaves = vec![false; self.module.programs.len()];
        loop {
            let mut changed = false;
            for (index, program) in self.module.programs.iter().enumerate() {
                for (id, block) in program.ids().zip(&program.blocks) {
                    changed |= self.block((index, id), block, &mut leaves, found);
                }
            }
            if !changed {
                return;
            }
        }
    }

    fn block(
        &self,
        (index, id): (usize, BlockId),
        block: &Block,
        leaves: &mut [bool],
        found: &mut Compensated,
    ) -> bool {
        let after = found.after(index, id.index());
        match &block.term.kind {
            TermKind::Call { call, next } => {
                let mut changed = self.callees((index, id), call, after, found);
                changed |= self.comes_back((index, id), call, after, leaves) && found.mark(index, *next);
                changed
            }
            _ if !after => false,
            TermKind::Return { to } => self.returned(index, to.is_some(), leaves, found),
            TermKind::Stray => {
                let next = found.mark(index + 1, BlockId(0));
                self.returned(index, false, leaves, found) || next
            }
            TermKind::Chain(name) => {
                let named = |program: &Program| program.name.as_ref() == Some(name);
                let to = self.module.programs.iter().position(named);
                to.is_some_and(|to| found.mark(to, BlockId(0)))
            }
            kind => {
                let mut changed = false;
                kind.successors().into_iter().for_each(|to| changed |= found.mark(index, to));
                changed
            }
        }
    }

    fn callees(&self, place: (usize, BlockId), call: &Call, after: bool, found: &mut Compensated) -> bool {
        if !after {
            return false;
        }
        if let Callee::Block(entry) = &call.callee {
            return found.mark(place.0, *entry);
        }
        let mut changed = false;
        for callee in self.called.by(place, call) {
            changed |= found.mark(*callee, BlockId(0));
        }
        changed
    }

    /// True where compensation may be in force after a call.
    fn comes_back(&self, place: (usize, BlockId), call: &Call, after: bool, leaves: &[bool]) -> bool {
        let own = [place.0];
        let callees = match &call.callee {
            Callee::Block(_) => &own[..],
            _ => self.called.by(place, call),
        };
        let passes = call.count.is_some()
            || matches!(&call.callee, Callee::Block(_) if call.level)
            || self.called.may_leave(place, call)
            || callees.iter().any(|callee| self.touches.get(*callee) == Some(&false));
        let left =
            |callee: &usize| self.touches.get(*callee) != Some(&false) && leaves.get(*callee) != Some(&false);
        passes && after || callees.iter().any(left)
    }

    fn returned(&self, index: usize, labelled: bool, leaves: &mut [bool], found: &mut Compensated) -> bool {
        let mut changed = leaves.get_mut(index).is_some_and(|leaves| !std::mem::replace(leaves, true));
        let callers = self.callers.get(&index);
        if callers.is_none() {
            changed |= found.mark(index, BlockId(0));
        }
        if labelled {
            for caller in callers.into_iter().flatten().chain([&index]) {
                let program = &self.module.programs[*caller];
                for (id, block) in program.ids().zip(&program.blocks) {
                    if block.labels.iter().any(|label| matches!(label, Label::Number(_))) {
                        changed |= found.mark(*caller, id);
                    }
                }
            }
        }
        changed
    }
}
