//! Increments right after the block of a rotation.
//!
//! Law: until the first absolute word after a rotation with its centre, increments turn about where the tool is, on a control that
//! says so; of another one the program rests on that it does. Side condition: the block of the rotation names its centre, else the
//! tool is the centre anyway. Counter-example: `G68 X1. Y1. R90.`, `G90 G1 X2.`, `G91 X1.`

use crate::canon::{Group, Op, Role};
use crate::dialect::Question;
use crate::ir::{Module, Nc, Stmt};
use crate::legalize::each_step::each_step;
use crate::legalize::features::Features;
use crate::legalize::{Context, Modal};

/// True if the library rotates and counts in increments, and the source's table says something of it.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    context.source.behaviour(Question::RotationIncrements).is_some()
        && features.any_op(|op| op == Op::RotateOn)
        && features.any_op(|op| op == Op::Incremental)
}

/// Says what rests on the controls.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let facts = context.modal_facts(module);
    each_step(module, &facts, step, |index, stmt, (_, rests)| {
        if rests {
            context.rests_on_source(index, stmt.site.span, Question::RotationIncrements);
            if context.target.behaviour(Question::RotationIncrements).is_some() {
                context.rests_on_target(index, stmt.site.span, Question::RotationIncrements);
            }
        }
    });
}

/// Takes a statement; true for increments right after a rotation. `fresh` is true where a rotation began, and no absolute word followed
/// yet, on some way.
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
