//! Pecks that are told the first depth, by how much each later one is less, and the least one.
//!
//! Law: where the first is the least, or later ones are no less, all are as deep as the first, and Q tells them so on a target whose
//! code takes no other words. Side conditions: the block begins its cycle and tells it no Q, and the numbers are known. What is not
//! even is refused later, as words that the target's code does not take. Counter-example: `G83 I5. J1. K2.`, whose pecks are 5, 4, 3.

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
    let mut changed = false;
    for stmt in module.programs.iter_mut().flat_map(|program| &mut program.blocks).flat_map(|b| &mut b.stmts)
    {
        let StmtKind::Nc(nc) = &mut stmt.kind else { continue };
        let cycle = nc.ops().find(|op| matches!(op, Op::CyclePeck | Op::CycleChipBreak));
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

/// True if the control tells this cycle one depth of all pecks, and cannot tell it a first one.
fn by_depth(target: &Control, cycle: Op) -> bool {
    let row = target.code_for(cycle, &BTreeMap::new());
    row.is_some_and(|row| row.takes(Role::CycleQ) && !row.takes(Role::PeckFirst))
}

/// The depth of all pecks, where it is one.
fn even(nc: &Nc) -> Option<f64> {
    let number = |role| nc.word(role).map(|word| word.constant());
    let first = number(Role::PeckFirst)??;
    let (less, least) = (number(Role::PeckLess), number(Role::PeckLeast));
    let even = less.is_none_or(|less| less == Some(0.0)) || least == Some(Some(first));
    (first > 0.0 && even && nc.word(Role::CycleQ).is_none()).then_some(first)
}
