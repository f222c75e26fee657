//! State that is read before the moves are done, on a control that runs macro statements early.
//!
//! Law: where the target works out macro statements while moves before them are still to come, a wait before a statement that
//! reads what moves change, that reads or sets a clock, or that switches an output, lets it see and do what it would where the text has it. A wait
//! computes nothing. Where no move is to come it waits for nothing. A mill that has no wait is told to read no further ahead
//! than one block, with empty blocks to hold it back, and as far as before after them. Side condition: it takes no such limit
//! under cutter compensation: where that may be in force (`compensated`), nothing is put in, and each such place is reported. Counter-example: `G1 G31 X50.`, `V1=AX`, which
//! reads where the axes were when the probe began.

use super::compensated::{Compensated, Effect};
use super::lookahead::limit;
use crate::canon::{Op, Sys};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Machine, Question};
use crate::ir::analysis::{Cfg, may_come_back, modal_bodies};
use crate::ir::{Block, BlockId, Expr, Module, Place, Program, SourceInfo, Stmt, StmtKind, Stmts, TermKind};
use crate::legalize::Context;
use crate::legalize::features::{Feature, Features};
use crate::text::Span;
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
    let summaries = limits.then(|| context.summaries(module));
    let compensated = summaries.map(|summaries| Compensated::of(module, &summaries, context));
    let mut changed = false;
    for (index, program) in module.programs.iter_mut().enumerate() {
        if limits {
            context.waiting.extend(context.origins.get(index));
        }
        let (more, open) = hold(program, come_back, limits, compensated.as_ref().map(|all| (index, all)));
        changed |= more;
        for span in open {
            let told = Diagnostic::new(Code::EarlyRead, span, OPEN).with_help(OPEN_HELP);
            context.add(index, told);
        }
    }
    for (index, span) in compensated.into_iter().filter(|_| changed).flat_map(|all| all.supposed) {
        context.add(index, Diagnostic::new(Code::Conditional, span, SUPPOSED).with_help(SUPPOSED_HELP));
    }
    changed
}

pub(super) const SUPPOSED: &str = "waits before places that read where the machine is, or limits on reading ahead, were written as if this computed code began no cutter compensation: \
     the target takes no limit on reading ahead then";

pub(super) const SUPPOSED_HELP: &str = "make sure that the code is none of those of cutter compensation";

const OPEN: &str = "no wait could be written here, because cutter compensation may be in force: the target takes no limit on reading \
     ahead then. It may read this before the moves before it are done, and act on an old value";

const OPEN_HELP: &str = "cancel the compensation before this block (in every program that calls this one, too), or read the value \
     where none is in force";

/// Waits in a program before what would be early, by a limit or a wait; true where any were put in. Yields the places too that
/// compensation leaves without one.
pub(super) fn hold(
    program: &mut Program,
    come_back: bool,
    limits: bool,
    compensated: Option<(usize, &Compensated)>,
) -> (bool, BTreeSet<Span>) {
    let before = before(program, come_back, limits);
    // Statements after a wait are at their place until the next move.
    let mut left: Vec<bool> = Vec::with_capacity(before.len());
    let mut changed = false;
    let mut open = BTreeSet::new();
    for (at, (block, before)) in program.blocks.iter_mut().zip(before).enumerate() {
        // A block that comes later in the text has not been looked at.
        let mut waited = before.is_some_and(|all| all.iter().all(|at| left.get(*at) == Some(&true)));
        let (in_force, effects) = compensated.map_or((false, &[][..]), |(index, all)| all.at(index, at));
        let mut under = Under { in_force, effects, open: &mut open };
        changed |= look(block, &mut waited, limits, &mut under);
        left.push(waited);
    }
    (changed, open)
}

/// Whether compensation may be in force, while a block is gone through.
struct Under<'a> {
    in_force: bool,
    effects: &'a [(usize, Effect)],
    /// The places that had to stay without a wait.
    open: &'a mut BTreeSet<Span>,
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

/// Waits in a block; `waited` tells whether nothing moved since the last wait, `limits` how the target waits.
fn look(block: &mut Block, waited: &mut bool, limits: bool, under: &mut Under<'_>) -> bool {
    let mut changed = false;
    let mut out = Stmts::with_capacity(block.stmts.len());
    for (at, stmt) in std::mem::take(&mut block.stmts).into_iter().enumerate() {
        let stands = stmt.site.skip.is_none();
        let is_early = !*waited && is_early(&stmt.kind, limits);
        if is_early && under.in_force {
            under.open.insert(stmt.site.span);
        } else if is_early {
            wait(&stmt.site, limits, &mut out);
            // One that may be skipped is no wait for what comes after it.
            (*waited, changed) = (stands, true);
        }
        if let Some((_, effect)) = under.effects.iter().find(|(place, _)| *place == at) {
            under.in_force = *effect == Effect::Begins;
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
    if early && !*waited && under.in_force {
        under.open.insert(block.term.site.span);
    } else if early && !*waited {
        wait(&block.term.site, limits, &mut out);
        (*waited, changed) = (true, true);
    }
    block.stmts = out;
    changed
}

fn is_early(kind: &StmtKind, limits: bool) -> bool {
    let switches = matches!(kind.target(), Some(Place::System(Sys::Output | Sys::OutputInverted, _)));
    let sets = matches!(kind.target(), Some(Place::System(state, _)) if state.runs_on());
    let mut early = !limits && (switches || sets);
    kind.exprs(&mut |e| early |= reads(e, limits));
    early
}

fn reads(e: &Expr, limits: bool) -> bool {
    let mut found = false;
    e.walk(&mut |e| {
        found |= match e {
            Expr::System(state, _) if limits => state.is_read_early(),
            // The tool in the spindle is that of the last change that was made, not of one that was read.
            Expr::System(state, _) => {
                state.is_changed_by_moves() || *state == Sys::ActiveTool || state.runs_on()
            }
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
