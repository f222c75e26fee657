//! Codes of the tool length without a word of its axis, where they move that axis on the source, and nothing on the target.
//!
//! Law: such a code takes the axis to the place that the program named last, by the length that is in force now. So the same
//! place may stand beside the code. Side conditions: both blocks are in one stretch without jumps and calls; the place is
//! absolute, and its words still have the value they had; what stands between leaves that axis and what coordinates count
//! from alone; the code stands in a block without words of axes, where straight moves are in force. Counter-example: `G91 Z5.`, `G43 H1`, where no place is known.

use super::later_lengths::{goes, is_quiet, reads_state, stands};
use crate::canon::{Group, Op, Role};
use crate::ir::{Block, Expr, Module, Nc, NcItem, Stmt, StmtKind};
use crate::legalize::assumptions::shop::{moves_by_code, moves_on_one};
use crate::legalize::features::Features;
use crate::legalize::moves::mains::facts_from_reset;
use crate::legalize::{Context, Modal};

/// True if the library names tool lengths, and their codes move the axis on the source alone.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    moves_on_one(features, context, [context.source, context.target])
}

/// Puts the places beside the codes.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let facts = facts_from_reset(module, context);
    let mut changed = false;
    for (index, program) in module.programs.iter_mut().enumerate() {
        for (id, block) in program.ids().zip(&mut program.blocks) {
            for (at, place) in named(block, facts.at(index, id), context) {
                let StmtKind::Nc(nc) = &mut block.stmts[at].kind else { continue };
                nc.items.push(NcItem::Word(Role::Z, place));
                changed = true;
            }
        }
    }
    changed
}

/// The statements whose codes move, and the places.
fn named(block: &Block, mut state: Modal, context: &Context<'_>) -> Vec<(usize, Expr)> {
    let mut found = Vec::new();
    let mut here: Option<Expr> = None;
    for (at, stmt) in block.stmts.iter().enumerate() {
        let before = state.clone();
        state.step(stmt);
        let sure = stmt.site.skip.is_none();
        let moves = |nc: &&Nc| {
            sure && moves_by_code(nc, &before)
                && goes(nc, &state, context)
                && !other_zero(nc)
                && !goes_across(nc)
        };
        if let (Some(_), Some(place)) = (stmt.kind.nc().filter(moves), &here)
            && straight(&state)
            && state.op(Group::Distance) == Some(Op::Absolute)
        {
            found.push((at, place.clone()));
        } else {
            here = placed(stmt, &state).or(here.filter(|place| stays(stmt, place, &state, context)));
        }
    }
    found
}

/// The absolute place along the axis of the length that a straight move goes to.
fn placed(stmt: &Stmt, after: &Modal) -> Option<Expr> {
    let nc = stmt.kind.nc().filter(|nc| stmt.site.skip.is_none() && nc.ops().all(is_straight))?;
    let place = nc.word(Role::Z).filter(|value| !value.may_be_vacant() && !reads_state(value))?;
    let is_place = straight(after) && after.op(Group::Distance) == Some(Op::Absolute);
    is_place.then(|| place.clone())
}

/// True for codes beside which words of axes are places.
fn is_straight(op: Op) -> bool {
    use Group::{Coolant, Distance, FeedMode, Spindle};
    matches!(op, Op::Rapid | Op::Linear | Op::CycleOff | Op::SelectWork)
        || op.group() == Group::LengthComp
        || matches!(op.group(), Coolant | Distance | FeedMode | Spindle)
}

fn straight(after: &Modal) -> bool {
    stands(after) && matches!(after.op(Group::Motion), Some(Op::Rapid | Op::Linear))
}

/// True where the axis is at the same place after a statement, and its words have the same values.
fn stays(stmt: &Stmt, place: &Expr, after: &Modal, context: &Context<'_>) -> bool {
    match &stmt.kind {
        StmtKind::Assign { .. } => place.constant().is_some() && is_quiet(stmt, after, context),
        StmtKind::Nc(nc) => !other_zero(nc) && is_quiet(stmt, after, context),
        _ => is_quiet(stmt, after, context),
    }
}

/// True where places count from another zero, or along other axes, from here on.
fn other_zero(nc: &Nc) -> bool {
    nc.word(Role::WorkOffset).is_some()
        || nc.ops().any(|op| op == Op::SelectWork || op.group() == Group::Plane)
}

/// True for a block that moves other axes: no source says whether that of the length goes along.
fn goes_across(nc: &Nc) -> bool {
    use Role::{A, ArcI, ArcJ, ArcRadius, B, C, X, Y};
    [A, ArcI, ArcJ, ArcRadius, B, C, X, Y].into_iter().any(|role| nc.word(role).is_some())
}
