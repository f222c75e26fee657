//! Machine coordinates under G91, for a target of which nobody knows what they are there.
//!
//! Law: the source goes to the place in machine coordinates whether G90 or G91 is in force. Under G90 each target goes to it too, so
//! the block gets G90, and G91 comes back after it. Side conditions: G91 is in force for certain; the block has a move, its feed,
//! the spindle, coolant and the end of length compensation alone; no block skip, no drilling cycle, no modal call, which would run between the two, and no rotation,
//! whose centre the first absolute word after it may set. What does not keep them stays, and `under_increments` asks of it.
//! Counter-example: `G91 G53 Z0 M33`, whose M33 may act when the move is done.

use super::under_increments::MOVE;
use crate::canon::{Group, Op, Role};
use crate::ir::analysis::modal_facts::replace_statements;
use crate::ir::{Module, Nc, NcItem, SourceInfo, Stmt, StmtKind};
use crate::legalize::assumptions::shop::are_mills;
use crate::legalize::features::{Feature, Features};
use crate::legalize::{Context, Modal};

/// True if the source goes to places, as far as is known, and the target is not known to.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let answer = |control: &crate::dialect::Control| control.behaviour(MOVE).map(|row| row.value.clone());
    let goes = answer(context.source).is_none_or(|value| matches!(value.as_str(), "place" | "unknown"));
    are_mills(context)
        && features.op(Op::MachineOnce)
        && features.op(Op::Incremental)
        && !features.has(Feature::Modal)
        && !features.any_op(|op| matches!(op, Op::RotateOn | Op::ScaleOn | Op::MirrorOn))
        && goes
        && answer(context.target).is_some_and(|value| value != "place")
}

/// Puts the codes in.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let facts = context.modal_facts(module);
    let drills = Features::of(&module.programs).any_op(Op::is_cycle);
    replace_statements(module, &facts, |index, state, stmt, out| {
        state.step(&stmt);
        let Some(nc) = stmt.kind.nc().filter(|nc| stmt.site.skip.is_none() && is_place(nc, state, drills))
        else {
            return out.push(stmt);
        };
        let span = stmt.site.span;
        let kept = nc.items.iter().filter(|item| !matches!(item, NcItem::Op(Op::Incremental)));
        let items = [NcItem::Op(Op::Absolute)].into_iter().chain(kept.cloned()).collect();
        context.rests_on_source(index, span, MOVE);
        let after = Nc { items: vec![NcItem::Op(Op::Incremental)] };
        out.push(Stmt { kind: StmtKind::Nc(Nc { items }), site: stmt.site });
        let aside = SourceInfo { span, ..SourceInfo::default() };
        out.push(Stmt { kind: StmtKind::Nc(after), site: aside });
    });
}

/// True for a move in machine coordinates under G91 that keeps the side conditions.
fn is_place(nc: &Nc, state: &Modal, drills: bool) -> bool {
    let own = |item: &NcItem| match item {
        NcItem::Op(op) => {
            matches!(op, Op::MachineOnce | Op::Incremental | Op::Rapid | Op::Linear)
                || matches!(op, Op::LengthOff)
                || matches!(op.group(), Group::Spindle | Group::Coolant)
        }
        NcItem::Word(role, _) => role.is_axis() || matches!(role, Role::Feed | Role::Speed),
        _ => false,
    };
    nc.has(Op::MachineOnce)
        && nc.names_axis()
        && nc.items.iter().all(own)
        && state.op(Group::Distance) == Some(Op::Incremental)
        && (!drills || state.op(Group::Cycle) == Some(Op::CycleOff))
}
