//! Moves under an arc mode that name neither centre nor radius.
//!
//! Law: such a block is what the control makes of it: a straight move, an alarm, the last radius. Where the table of the
//! source does not say which, no other control can be told; lowering spells the move out where it does.

use super::{Context, ModalFacts};
use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::ir::{BlockId, Module, Nc, StmtKind};

/// Refuses arcs that say nothing about their curve.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let same_family = context.source.dialect().family == context.target.dialect().family;
    let known = context.source.behaviour("arc.without.centre").is_some_and(|row| row.value != "unknown");
    let curves = |nc: &Nc| nc.ops().any(is_arc);
    let stmts = || module.programs.iter().flat_map(|p| &p.blocks).flat_map(|b| &b.stmts);
    if same_family || known || !stmts().any(|stmt| matches!(&stmt.kind, StmtKind::Nc(nc) if curves(nc))) {
        return;
    }
    let facts = ModalFacts::of(module, &context.entry);
    for (index, program) in module.programs.iter().enumerate() {
        for (at, block) in program.blocks.iter().enumerate() {
            let mut state = facts.at(index, BlockId(at as u32));
            for stmt in &block.stmts {
                state.step(stmt);
                if let StmtKind::Nc(nc) = &stmt.kind
                    && state.op(Group::Motion).is_some_and(is_arc)
                    && is_bare(nc)
                {
                    let what = "no source says what a move under an arc code does without centre and radius";
                    context.add(index, Diagnostic::new(Code::NoEquivalent, stmt.site.span, what));
                }
            }
        }
    }
}

fn is_arc(op: Op) -> bool {
    matches!(op, Op::ArcCw | Op::ArcCcw)
}

fn is_bare(nc: &Nc) -> bool {
    let curve = [Role::ArcI, Role::ArcJ, Role::ArcK, Role::ArcRadius];
    let elsewhere = [Op::ReferenceReturn, Op::SetPosition, Op::MachineOnce, Op::Pole];
    nc.moves()
        && curve.iter().all(|role| nc.word(*role).is_none())
        && !nc.ops().any(|op| elsewhere.contains(&op))
}
