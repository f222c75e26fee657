//! Pecks that are told the first depth, by how much each later one is less, and the least one.
//!
//! Law: where the first is the least, or later ones are no less, all are as deep as the first, and Q tells them so on a target whose
//! code takes no other words. Side conditions: the block begins its cycle and tells it no Q, the numbers are known, and no block of the
//! library tells a cycle in force other pecks. What is not even is refused later, as words that the target's code does not take.
//! Counter-examples: `G83 I5. J1. K2.`, whose pecks are 5, 4, 3; `X6. Q1.` after a cycle that goes on by its I.

use crate::canon::{Op, Role};
use crate::dialect::Control;
use crate::ir::{Expr, Module, Nc, NcItem, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::Features;
use std::collections::BTreeMap;

/// True if such words stand in the library.
pub fn concerns(features: &Features) -> bool {
    features.role(Role::PeckFirst)
}

/// Tells them by Q; true where something changed.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let all = module.programs.iter().flat_map(|program| &program.blocks).flat_map(|block| &block.stmts);
    if all.filter_map(|stmt| stmt.kind.nc()).any(tells_later) {
        return false;
    }
    let mut changed = false;
    for stmt in module.programs.iter_mut().flat_map(|program| &mut program.blocks).flat_map(|b| &mut b.stmts)
    {
        let StmtKind::Nc(nc) = &mut stmt.kind else { continue };
        let cycle = nc.ops().find(|op| pecks(*op));
        let Some(depth) = cycle.filter(|op| by_depth(context.target, *op)).and_then(|_| even(nc)) else {
            continue;
        };
        nc.items.retain(|item| {
            !matches!(item, NcItem::Word(Role::PeckFirst | Role::PeckLess | Role::PeckLeast, _))
        });
        nc.items.push(NcItem::Word(Role::CycleQ, Expr::Number(depth)));
        changed = true;
    }
    changed
}

pub(super) fn pecks(op: Op) -> bool {
    matches!(op, Op::CyclePeck | Op::CycleChipBreak)
}

/// True for a block that tells a cycle in force how deep its pecks are.
fn tells_later(nc: &Nc) -> bool {
    let depths = [Role::PeckFirst, Role::PeckLess, Role::PeckLeast, Role::CycleQ];
    !nc.ops().any(Op::is_cycle) && depths.iter().any(|role| nc.word(*role).is_some())
}

/// True if the control tells this cycle one depth of all pecks, and cannot tell it a first one.
pub(super) fn by_depth(target: &Control, cycle: Op) -> bool {
    let row = target.code_for(cycle, &BTreeMap::new());
    row.is_some_and(|row| row.takes(Role::CycleQ) && !row.takes(Role::PeckFirst))
}

/// The depth of all pecks, where it is one.
pub(super) fn even(nc: &Nc) -> Option<f64> {
    let number = |role| nc.word(role).map(|word| word.constant());
    let first = number(Role::PeckFirst)??;
    let (less, least) = (number(Role::PeckLess), number(Role::PeckLeast));
    let even = less.is_none_or(|less| less == Some(0.0)) || least == Some(Some(first));
    (first > 0.0 && even && nc.word(Role::CycleQ).is_none()).then_some(first)
}
