//! Local shifts of 0, on a target that has none.
//!
//! Law: where the target has no local shift, none is ever in force there, so a block that sets the source's to 0 can go. Side
//! conditions: the block does nothing else, and no cutter compensation is in force, as some controls suspend it at such a block.
//! Counter-example: `G52 X10.`, which stays, and is refused.

use super::left_shifts::{AXES, is_none};
use crate::canon::{Group, Op};
use crate::ir::{BlockId, Module, Nc, NcItem, StmtKind};
use crate::legalize::features::Features;
use crate::legalize::{Context, Modal};
use std::collections::BTreeMap;

/// True if the library shifts so, and the target cannot.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    features.op(Op::LocalShift) && context.target.code_for(Op::LocalShift, &BTreeMap::new()).is_none()
}

/// Leaves out such blocks; true if there was one.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let facts = context.modal_facts(module);
    let mut changed = false;
    for (index, program) in module.programs.iter_mut().enumerate() {
        for (at, block) in program.blocks.iter_mut().enumerate() {
            let mut state = facts.at(index, BlockId(at as u32));
            for stmt in &mut block.stmts {
                let drops = stmt.kind.nc().is_some_and(only_ends_shifts) && is_free(&state);
                state.step(stmt);
                if drops {
                    stmt.kind = StmtKind::Comment;
                    changed = true;
                }
            }
        }
    }
    changed
}

/// True for a block that sets local shifts to 0 and does nothing else.
fn only_ends_shifts(nc: &Nc) -> bool {
    nc.has(Op::LocalShift)
        && nc.items.iter().all(|item| match item {
            NcItem::Op(op) => *op == Op::LocalShift,
            NcItem::Word(role, value) => AXES.contains(role) && is_none(value),
            NcItem::Code(..) => false,
        })
}

/// True where it is known that no cutter compensation is in force.
fn is_free(state: &Modal) -> bool {
    state.op(Group::RadiusComp) == Some(Op::RadiusOff)
}
