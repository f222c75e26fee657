//! Contours whose first number stands in a block without words (`N1;`, and `G0 X40.` below it).
//!
//! Law: a cycle that begins to read at a block without words makes the moves that it makes from the next block on, so the number may stand there. The
//! controls that say so want a first block that moves. Side condition: the next block has words, no number of its own and no block skip, and comes
//! right after it. Counter-example: `N1;` and `N2 G0 X40.` where another cycle begins at N2.

use crate::canon::{Op, Role};
use crate::ir::{Block, Module, Program, Stmt, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::Features;
use std::collections::BTreeSet;

/// True where cycles read contours.
pub fn concerns(features: &Features, _: &Context<'_>) -> bool {
    features.any_op(Op::reads_contour)
}

/// Moves such numbers to the blocks that follow; true if there were any.
pub fn run(module: &mut Module, _: &mut Context<'_>) -> bool {
    let mut changed = false;
    for program in &mut module.programs {
        let firsts = firsts(program);
        for block in program.blocks.iter_mut().filter(|_| !firsts.is_empty()) {
            changed |= move_numbers(block, &firsts);
        }
    }
    changed
}

/// The numbers at which contours of the program begin.
fn firsts(program: &Program) -> BTreeSet<u32> {
    let ncs = program.blocks.iter().flat_map(|block| &block.stmts).filter_map(|stmt| stmt.kind.nc());
    let cycles = ncs.filter(|nc| nc.ops().any(Op::reads_contour));
    let number = |value: f64| (value > 0.0 && value.fract() == 0.0).then_some(value as u32);
    cycles.filter_map(|nc| number(nc.word(Role::ContourFirst)?.constant()?)).collect()
}

fn move_numbers(block: &mut Block, firsts: &BTreeSet<u32>) -> bool {
    let mut moved = Vec::new();
    for at in 0..block.stmts.len() {
        let Some([bare, next, ..]) = block.stmts.get_mut(at..) else { break };
        let begins = bare.site.sequence.get().is_some_and(|number| firsts.contains(&number));
        let moves = matches!(next.kind, StmtKind::Nc(_)) && next.site.sequence.is_none();
        if begins && is_bare(bare) && moves && next.site.skip.is_none() {
            next.site.sequence = bare.site.sequence;
            bare.site.sequence.take();
            moved.push((at, bare.site.comments.is_empty()));
        }
    }
    for (at, _) in moved.iter().rev().filter(|(_, is_empty)| *is_empty) {
        block.stmts.remove(*at);
    }
    !moved.is_empty()
}

fn is_bare(stmt: &Stmt) -> bool {
    stmt.kind == StmtKind::Comment && stmt.site.skip.is_none()
}
