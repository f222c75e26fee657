//! State that is read before the moves are done, on a control that runs macro statements early.
//!
//! Law: where the target works out macro statements while moves before them are still to come, a wait before a statement that
//! reads what moves change, or that switches an output, lets it see and do what it would where the text has it. A wait
//! computes nothing. Where no move is to come it waits for nothing. A mill that has no wait is told to read no further ahead
//! than one block, with empty blocks to hold it back, and as far as before after them. Side condition: it takes no such limit
//! under cutter compensation, so programs that have any are left as they are. Counter-example: `G1 G31 X50.`, `V1=AX`, which
//! reads where the axes were when the probe began.

use super::by_number::numbers;
use super::lookahead::limit;
use crate::canon::{Op, Sys};
use crate::dialect::{Control, Machine, Question};
use crate::ir::analysis::{Assigned, Cfg, Summaries, calls_of, may_come_back, modal_bodies};
use crate::ir::{
    Block, BlockId, Callee, Expr, Module, NcItem, Place, Program, SourceInfo, Stmt, StmtKind, Stmts, TermKind,
};
use crate::legalize::Context;
use crate::legalize::features::{Feature, Features};
use foldhash::HashMap;
use std::cell::LazyCell;
use std::collections::{BTreeMap, BTreeSet};

/// True if the library reads state, and the target reads it early unless it is told to wait.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    features.has(Feature::System) && (reads_early(context.target) || takes_limit(context))
}

/// True for a mill that reads early, and that can be told to read less far ahead.
fn takes_limit(context: &Context<'_>) -> bool {
    let target = context.target;
    target.is(Question::LookaheadRunsEarly)
        && !target.is(Question::SystemReadWaits)
        && target.statement("wait").is_none()
        && target.code_for(Op::LimitLookahead, &BTreeMap::new()).is_some()
        && target.machine() == Machine::Mill
        && target.name() != context.source.name()
}

fn reads_early(target: &Control) -> bool {
    target.is(Question::LookaheadRunsEarly)
        && !target.is(Question::SystemReadWaits)
        && target.statement("wait").is_some()
}

/// Waits before what would be early.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let come_back = may_come_back(module);
    let limits = takes_limit(context);
    let compensates: Vec<bool> = match limits {
        true => {
            let summaries = context.summaries(module);
            let numbered = module.programs.iter().enumerate();
            let begin = numbered.map(|(index, program)| compensates(index, program, &summaries, context));
            in_touch(module, begin.collect())
        }
        false => Vec::new(),
    };
    let mut changed = false;
    for (index, program) in module.programs.iter_mut().enumerate() {
        match compensates.get(index) {
            Some(true) => continue,
            Some(false) => context.waiting.extend(context.origins.get(index)),
            None => {}
        }
        changed |= hold(program, come_back, limits);
    }
    changed
}

/// Waits in a program before what would be early, by a limit or a wait; true where any were put in.
pub(super) fn hold(program: &mut Program, come_back: bool, limits: bool) -> bool {
    let before = before(program, come_back, limits);
    // Statements after a wait are at their place until the next move.
    let mut left: Vec<bool> = Vec::with_capacity(before.len());
    let mut changed = false;
    for (block, before) in program.blocks.iter_mut().zip(before) {
        // A block that comes later in the text has not been looked at.
        let mut waited = before.is_some_and(|all| all.iter().all(|at| left.get(*at) == Some(&true)));
        changed |= look(block, &mut waited, limits);
        left.push(waited);
    }
    changed
}

/// By block: those that lead there and do no more than go on, if nothing else leads there. Where a limit holds reading back, those of a
/// condition too: each wait takes five blocks there.
fn before(program: &Program, come_back: bool, limits: bool) -> Vec<Option<Vec<usize>>> {
    let cfg = Cfg::whole(program, come_back);
    let modal: BTreeSet<BlockId> = modal_bodies(program).collect();
    let all = |id: BlockId| {
        let all: Vec<usize> = cfg.preds(id).iter().map(|pred| pred.index()).collect();
        let goes_on = |at: &usize| match program.blocks.get(*at).map(|block| &block.term.kind) {
            Some(TermKind::Jump(_)) => limits || *at + 1 == id.index(),
            Some(TermKind::Branch { .. }) => limits,
            _ => false,
        };
        let known = if limits { !all.is_empty() } else { all.len() == 1 };
        let is_entered = cfg.roots().contains(&id) || modal.contains(&id);
        (known && !is_entered && all.iter().all(goes_on)).then_some(all)
    };
    program.ids().map(all).collect()
}

/// True for a program in which cutter compensation may begin.
fn compensates(index: usize, program: &Program, summaries: &Summaries, context: &Context<'_>) -> bool {
    let (source, origin) = (context.source, context.origin(index));
    let begins = |op: Op| matches!(op, Op::RadiusLeft | Op::RadiusRight);
    let assigned = LazyCell::new(|| Assigned::new(program, summaries));
    program.ids().zip(&program.blocks).any(|(id, block)| {
        block.stmts.iter().enumerate().any(|(at, stmt)| {
            let items = stmt.kind.nc().map_or(&[][..], |nc| &nc.items);
            items.iter().any(|item| match item {
                NcItem::Op(op) => begins(*op),
                NcItem::Code('G', value) => {
                    let known = context.computed_codes.get(&(origin, stmt.site.span)).cloned().flatten();
                    let found = || {
                        let all = numbers(value, &assigned, id, at, source)?;
                        Some(all.iter().map(|n| n.number).collect::<Vec<_>>())
                    };
                    known.or_else(found).is_none_or(|all| {
                        let mut rows = all.iter().filter_map(|number| source.code('G', *number, &[]));
                        rows.any(|row| begins(row.op))
                    })
                }
                _ => false,
            })
        })
    })
}

/// Those that call one of these programs, or that one of them calls, through others too: compensation is in force there as well.
fn in_touch(module: &Module, mut all: Vec<bool>) -> Vec<bool> {
    if !all.contains(&true) {
        return all;
    }
    let numbered = module.programs.iter().enumerate();
    let named: HashMap<_, _> = numbered.filter_map(|(at, p)| Some((p.name.as_ref()?, at))).collect();
    let mut touch: Vec<Vec<usize>> = vec![Vec::new(); all.len()];
    let mut anyone = false;
    for (caller, program) in module.programs.iter().enumerate() {
        for call in program.blocks.iter().flat_map(calls_of) {
            match &call.callee {
                Callee::Program(name) => {
                    if let Some(callee) = named.get(name) {
                        touch[caller].push(*callee);
                        touch[*callee].push(caller);
                    }
                }
                Callee::Block(_) | Callee::Cycle(_) => {}
                Callee::Computed(_) => anyone = true,
            }
        }
    }
    if anyone {
        return vec![true; all.len()];
    }
    let mut left: Vec<usize> = (0..all.len()).filter(|at| all[*at]).collect();
    while let Some(at) = left.pop() {
        for other in &touch[at] {
            if !std::mem::replace(&mut all[*other], true) {
                left.push(*other);
            }
        }
    }
    all
}

/// Waits in a block; `waited` tells whether nothing moved since the last wait, `limits` how the target waits.
fn look(block: &mut Block, waited: &mut bool, limits: bool) -> bool {
    let mut changed = false;
    let mut out = Stmts::with_capacity(block.stmts.len());
    for stmt in std::mem::take(&mut block.stmts) {
        let stands = stmt.site.skip.is_none();
        if !*waited && is_early(&stmt.kind, limits) {
            wait(&stmt.site, limits, &mut out);
            // One that may be skipped is no wait for what comes after it.
            (*waited, changed) = (stands, true);
        }
        match &stmt.kind {
            StmtKind::Sync => *waited = stands,
            StmtKind::Nc(nc) if !nc.items.is_empty() => *waited = false,
            StmtKind::ModalCall(_) => *waited = false,
            _ => {}
        }
        out.push(stmt);
    }
    let mut early = false;
    block.term.kind.exprs(&mut |e| early |= reads(e, limits));
    if early && !*waited {
        wait(&block.term.site, limits, &mut out);
        (*waited, changed) = (true, true);
    }
    block.stmts = out;
    changed
}

fn is_early(kind: &StmtKind, limits: bool) -> bool {
    let switches = matches!(kind.target(), Some(Place::System(Sys::Output | Sys::OutputInverted, _)));
    let mut early = !limits && switches;
    kind.exprs(&mut |e| early |= reads(e, limits));
    early
}

fn reads(e: &Expr, limits: bool) -> bool {
    let mut found = false;
    e.walk(&mut |e| {
        found |= match e {
            Expr::System(state, _) if limits => state.is_read_early(),
            // The tool in the spindle is that of the last change that was made, not of one that was read.
            Expr::System(state, _) => state.is_changed_by_moves() || *state == Sys::ActiveTool,
            _ => false,
        }
    });
    found
}

fn wait(site: &SourceInfo, limits: bool, out: &mut Stmts) {
    let site = SourceInfo { span: site.span, skip: site.skip, ..SourceInfo::default() };
    if limits {
        limit(site, true, out);
    } else {
        out.push(Stmt { kind: StmtKind::Sync, site });
    }
}
