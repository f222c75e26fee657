//! State that is read before the moves are done, on a control that runs macro statements early.
//!
//! Law: where the target works out macro statements while moves before them are still to come, a wait before a statement that
//! reads what moves change, or that switches an output, lets it see and do what it would where the text has it. A wait
//! computes nothing. Side condition: none; where no move is to come it waits for nothing. Counter-example: `G1 G31 X50.`,
//! `V1=AX`, which reads where the axes were when the probe began.

use crate::canon::Sys;
use crate::dialect::{Control, Question};
use crate::ir::analysis::{Cfg, may_come_back, modal_bodies};
use crate::ir::{Block, BlockId, Expr, Module, Place, Program, SourceInfo, Stmt, StmtKind, Stmts, TermKind};
use crate::legalize::Context;
use crate::legalize::features::{Feature, Features};
use std::collections::BTreeSet;

/// True if the library reads state, and the target reads it early unless it is told to wait.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    features.has(Feature::System) && reads_early(context.target)
}

fn reads_early(target: &Control) -> bool {
    target.is(Question::LookaheadRunsEarly)
        && !target.is(Question::SystemReadWaits)
        && target.statement("wait").is_some()
}

/// Waits before what would be early.
pub fn run(module: &mut Module, _: &mut Context<'_>) -> bool {
    let come_back = may_come_back(module);
    module.programs.iter_mut().fold(false, |changed, program| hold(program, come_back) | changed)
}

/// Waits in a program before what would be early; true where any were put in.
pub(super) fn hold(program: &mut Program, come_back: bool) -> bool {
    let follows = following(program, come_back);
    // Statements after a wait are at their place until the next move.
    let (mut waited, mut changed) = (false, false);
    for (block, follows) in program.blocks.iter_mut().zip(follows) {
        waited &= follows;
        changed |= look(block, &mut waited);
    }
    changed
}

/// By block: true where only the block before it leads there, and does no more than go on.
fn following(program: &Program, come_back: bool) -> Vec<bool> {
    let cfg = Cfg::whole(program, come_back);
    let modal: BTreeSet<BlockId> = modal_bodies(program).collect();
    let only = |id: BlockId| {
        let before = id.index().checked_sub(1).and_then(|at| program.blocks.get(at));
        let goes_on = before.is_some_and(|block| block.term.kind == TermKind::Jump(id));
        goes_on && cfg.preds(id).len() == 1 && !cfg.roots().contains(&id) && !modal.contains(&id)
    };
    program.ids().map(only).collect()
}

/// Waits in a block; `waited` tells whether nothing moved since the last wait.
fn look(block: &mut Block, waited: &mut bool) -> bool {
    let mut changed = false;
    let mut out = Stmts::with_capacity(block.stmts.len());
    for stmt in std::mem::take(&mut block.stmts) {
        let stands = stmt.site.skip.is_none();
        if !*waited && is_early(&stmt.kind) {
            out.push(wait(&stmt.site));
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
    block.term.kind.exprs(&mut |e| early |= reads(e));
    if early && !*waited {
        out.push(wait(&block.term.site));
        (*waited, changed) = (true, true);
    }
    block.stmts = out;
    changed
}

fn is_early(kind: &StmtKind) -> bool {
    let mut early = matches!(kind.target(), Some(Place::System(Sys::Output | Sys::OutputInverted, _)));
    kind.exprs(&mut |e| early |= reads(e));
    early
}

fn reads(e: &Expr) -> bool {
    let mut found = false;
    e.walk(&mut |e| found |= matches!(e, Expr::System(state, _) if state.is_changed_by_moves()));
    found
}

fn wait(site: &SourceInfo) -> Stmt {
    let site = SourceInfo { span: site.span, skip: site.skip, ..SourceInfo::default() };
    Stmt { kind: StmtKind::Sync, site }
}
