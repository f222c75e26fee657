//! Increments right after the block of a rotation.
//!
//! Law: until the first absolute word after a rotation with its centre, increments turn about where the tool is, on a control that
//! says so; of another one the program rests on that it does. Side condition: the block of the rotation names its centre, else the
//! tool is the centre anyway. Counter-example: `G68 X1. Y1. R90.`, `G90 G1 X2.`, `G91 X1.`

use crate::canon::{Group, Op, Role};
use crate::dialect::Question;
use crate::ir::analysis::over_calls::{Follow, OverCalls};
use crate::ir::{Block, BlockId, Module, Nc, Stmt};
use crate::legalize::features::Features;
use crate::legalize::{Context, Modal, ModalFacts};

/// True if the library rotates and counts in increments, and the source's table says something of it.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    context.source.behaviour(Question::RotationIncrements).is_some()
        && features.any_op(|op| op == Op::RotateOn)
        && features.any_op(|op| op == Op::Incremental)
}

/// Says what rests on the controls.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let facts = context.modal_facts(module);
    let starts = OverCalls::of(module, &Fresh { facts: &facts });
    for (index, program) in module.programs.iter().enumerate() {
        for (id, block) in program.ids().zip(&program.blocks) {
            let mut state = facts.at(index, id);
            let mut is_fresh = starts.at(index, id).copied().unwrap_or(false);
            for stmt in &block.stmts {
                if step(stmt, &mut state, &mut is_fresh) {
                    context.rests_on_source(index, stmt.site.span, Question::RotationIncrements);
                    if context.target.behaviour(Question::RotationIncrements).is_some() {
                        context.rests_on_target(index, stmt.site.span, Question::RotationIncrements);
                    }
                }
            }
        }
    }
}

/// Whether a rotation began, and no absolute word followed yet, on some way.
struct Fresh<'f> {
    facts: &'f ModalFacts,
}

impl Follow for Fresh<'_> {
    type Known = bool;

    fn outside(&self, _: usize) -> bool {
        false
    }

    fn stmts(&self, (index, id): (usize, BlockId), block: &Block, fresh: &mut bool) {
        let mut state = self.facts.at(index, id);
        for stmt in &block.stmts {
            step(stmt, &mut state, fresh);
        }
    }

    // What the library does not have is taken to leave it as it is.
    fn lose(&self, _: &mut bool) {}
}

/// Takes a statement; true for increments right after a rotation.
fn step(stmt: &Stmt, state: &mut Modal, fresh: &mut bool) -> bool {
    state.step(stmt);
    let Some(nc) = stmt.kind.nc() else { return false };
    let before = *fresh;
    if nc.has(Op::RotateOn) {
        *fresh = across(nc);
        return false;
    }
    let goes = nc.moves() && across(nc);
    let incremental = state.op(Group::Distance) == Some(Op::Incremental);
    let ends = nc.has(Op::RotateOff) || goes && !incremental;
    // A block that may be skipped leaves what was.
    *fresh = before && (!ends || stmt.site.skip.is_some());
    before && goes && incremental && !nc.has(Op::RotateOff)
}

/// True for a word along an axis that may be turned.
fn across(nc: &Nc) -> bool {
    [Role::X, Role::Y, Role::Z].iter().any(|role| nc.word(*role).is_some())
}
