//! Roughing of contours by a control that ends it otherwise.
//!
//! Law: both leave the allowances on the contour, go as deep each pass, and come back to where they began. What differs is which passes there are:
//! one control ends along the contour, the other level by level, which may leave steps for the finishing. A person must accept that.

use super::settings::takes;
use crate::assume::Predicate;
use crate::canon::{Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question};
use crate::ir::{Module, Nc, NcItem, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::Features;

/// The cycles whose passes may differ.
const CYCLES: [Op; 2] = [Op::RoughTurning, Op::RoughFacing];

/// True where contours are roughed, and the controls do not end that alike.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    CYCLES.iter().any(|op| features.op(*op)) && !context.agree(Question::RoughingEnds)
}

/// Says which roughing ends otherwise.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let along = context.target.behaviour(Question::RoughingEnds).is_some_and(|row| row.value == "along");
    let what = if along {
        "the target ends this roughing with a pass along the contour, which the source has only with I or K, and takes no I and K: \
         without them the levels lie otherwise"
    } else {
        "the target is not known to end this roughing with a pass along the contour, as the source does: steps may be left for \
         the finishing tool, up to the depth of a pass"
    };
    for (index, program) in module.programs.iter().enumerate() {
        for stmt in program.blocks.iter().flat_map(|block| &block.stmts) {
            let StmtKind::Nc(nc) = &stmt.kind else { continue };
            let Some(op) = nc.ops().find(|op| CYCLES.contains(op)) else { continue };
            let told = Diagnostic::new(Code::Conditional, stmt.site.span, what)
                .with_help("run one such cycle in the air or on the screen, and look at its last passes")
                .assuming(Predicate::Substitute(op))
                .asked_once();
            context.add_once(index, &format!("{what} {op}"), told);
        }
    }
}

/// A control that always ends roughing with a pass along the contour needs no words for what that pass takes: `roughing` says
/// that the passes differ.
pub(super) fn drop_rough(nc: &mut Nc, source: &Control, target: &Control) {
    let is_along =
        |control: &Control| control.behaviour(Question::RoughingEnds).is_some_and(|row| row.value == "along");
    let along = is_along(target) && !is_along(source);
    let Some(op) = nc.ops().find(|op| matches!(op, Op::RoughTurning | Op::RoughFacing)) else { return };
    let rough = |role: Role| matches!(role, Role::RoughX | Role::RoughZ) && !takes(target, op, role);
    if along {
        nc.items.retain(|item| !matches!(item, NcItem::Word(role, _) if rough(*role)));
    }
}
