//! Pecks that become less, as moves, where the target tells all pecks of a hole one depth; and pecks with a wait at the bottom, where
//! its cycle takes none.
//!
//! Law: a cycle with such pecks becomes the moves that its holes are (see [`super::hole_moves`]), from the block that names it to the one
//! that ends it. If a call comes between, the holes of its program do, and of those that it calls or that call it: so no cycle begins on
//! one control and goes on on the other. Side conditions: those of that pass, and all
//! numbers of these cycles are known. Counter-examples: `G83 I#1 J1. K2.` and `G83 Q#1 P500`, which stay and are refused later.

use super::cycle_words::takes;
use super::even_pecks::{by_depth, even, pecks};
use super::{hole_moves, needless_waits};
use crate::canon::{Op, Role};
use crate::dialect::Control;
use crate::ir::{Callee, Module, Nc, Program};
use crate::legalize::features::Features;
use crate::legalize::{Context, calls_of};
use std::collections::BTreeSet;

/// True if such words stand in the library.
pub fn concerns(features: &Features) -> bool {
    features.role(Role::PeckFirst) || features.role(Role::CycleDwell) && features.any_op(pecks)
}

/// Writes them as moves.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let (source, target) = (context.source, context.target);
    let is_clear = source.peck_clearance().is_some();
    let is_such = |nc: &Nc| uneven(nc, target) || is_clear && waits(nc, (source, target)) && is_known(nc);
    let concerned = |program: &Program| cycles(program).any(is_such);
    if !module.programs.iter().any(concerned) {
        return;
    }
    hole_moves::write_cycles(module, context, &is_such);
    let mut all: BTreeSet<usize> =
        (0..module.programs.len()).filter(|index| concerned(&module.programs[*index])).collect();
    if all.is_empty() {
        return;
    }
    let callees: Vec<BTreeSet<usize>> =
        module.programs.iter().map(|program| callees(module, program)).collect();
    let mut grows = true;
    while std::mem::take(&mut grows) {
        for (index, callees) in callees.iter().enumerate() {
            if all.contains(&index) || callees.iter().any(|callee| all.contains(callee)) {
                let before = all.len();
                all.insert(index);
                all.extend(callees);
                grows |= all.len() > before;
            }
        }
    }
    // A tap beside them has no moves, and the target has a code for it: then these pecks alone are refused, by their words.
    if all.iter().all(|index| has_moves_only(&module.programs[*index])) {
        hole_moves::write_programs(module, context, &all);
    }
}

fn cycles(program: &Program) -> impl Iterator<Item = &Nc> {
    let stmts = program.blocks.iter().flat_map(|block| &block.stmts).filter_map(|stmt| stmt.kind.nc());
    stmts.filter(|nc| nc.ops().any(Op::is_cycle))
}

/// True for a block whose pecks become less, which the target's code has no words for.
fn uneven(nc: &Nc, target: &Control) -> bool {
    let cycle = nc.ops().find(|op| pecks(*op)).filter(|op| by_depth(target, *op));
    cycle.is_some() && nc.word(Role::PeckFirst).is_some() && even(nc).is_none()
}

/// True for a block that tells a peck drill a wait, for which the target's code has no word.
fn waits(nc: &Nc, (source, target): (&Control, &Control)) -> bool {
    let Some(op) = nc.ops().find(|op| pecks(*op)) else { return false };
    let told = nc.word(Role::CycleDwell).is_some_and(|wait| wait.constant() != Some(0.0));
    told && needless_waits::waits(op, source) && !takes(target, op, Role::CycleDwell)
}

/// True where all numbers of a cycle's block are known.
fn is_known(nc: &Nc) -> bool {
    let roles = [Role::Z, Role::CycleR, Role::CycleQ, Role::CycleDwell];
    roles.iter().all(|role| nc.word(*role).is_none_or(|word| word.constant().is_some()))
}

/// True for a program all of whose cycles can be written as moves.
fn has_moves_only(program: &Program) -> bool {
    let stmts = program.blocks.iter().flat_map(|block| &block.stmts);
    let mut ops = stmts.filter_map(|stmt| stmt.kind.nc()).flat_map(Nc::ops);
    ops.all(|op| !op.is_cycle() || hole_moves::has_moves(op))
}

/// The programs of the library that a program calls.
fn callees(module: &Module, program: &Program) -> BTreeSet<usize> {
    let place = |callee: &Callee| {
        module
            .programs
            .iter()
            .position(|p| matches!(callee, Callee::Program(name) if p.name.as_ref() == Some(name)))
    };
    program.blocks.iter().flat_map(calls_of).filter_map(|call| place(&call.callee)).collect()
}
