//! Blocks without a move between moves with cutter compensation.
//!
//! Law: a control that reads ahead for compensation takes some such blocks and not more. Where its table asks how many, and the
//! profile does not say that any may stand there, each place rests on it. Counter-example: a comment after G40.

use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::{BlockId, Module, Nc, Stmt, StmtKind, TermKind};
use crate::legalize::features::Features;
use crate::legalize::{Context, Modal};
use crate::text::Span;

/// True if the library compensates, and the target's table asks.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    context.target.behaviour(Question::RadiusStillBlocks).is_some()
        && features.any_op(|op| matches!(op, Op::RadiusLeft | Op::RadiusRight))
}

/// Reports such blocks.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let facts = context.modal_facts(module);
    for (index, program) in module.programs.iter().enumerate() {
        for (at, block) in program.blocks.iter().enumerate() {
            let mut state = facts.at(index, BlockId(at as u32));
            for stmt in &block.stmts {
                let before = compensates(&state);
                state.step(stmt);
                if before && compensates(&state) && is_still(stmt) {
                    report(context, index, stmt.site.span);
                }
            }
            let branches = matches!(
                block.term.kind,
                TermKind::Branch { .. } | TermKind::Computed { .. } | TermKind::Call { .. }
            );
            if branches && compensates(&state) {
                report(context, index, block.term.site.span);
            }
        }
    }
}

fn report(context: &mut Context<'_>, index: usize, span: Span) {
    let row = context.target.behaviour(Question::RadiusStillBlocks);
    if row.is_some_and(|row| row.value == "false") {
        context.add_once(index, REFUSED, Diagnostic::new(Code::NoEquivalent, span, REFUSED));
    } else {
        context.rests_on_target(index, span, Question::RadiusStillBlocks);
    }
}

fn compensates(state: &Modal) -> bool {
    matches!(state.op(Group::RadiusComp), Some(Op::RadiusLeft | Op::RadiusRight))
}

/// True for what becomes a block without a move.
fn is_still(stmt: &Stmt) -> bool {
    match &stmt.kind {
        StmtKind::Nc(nc) => !nc.names_axis() && !turns(nc),
        StmtKind::Comment => !stmt.site.comments.is_empty(),
        _ => true,
    }
}

/// True for a full circle, which needs no place.
fn turns(nc: &Nc) -> bool {
    [Role::ArcI, Role::ArcJ, Role::ArcK].iter().any(|role| nc.word(*role).is_some())
}

const REFUSED: &str = "a block without a move between moves with cutter compensation, which the target does not take: put it before \
     G41 or G42, or after G40";
