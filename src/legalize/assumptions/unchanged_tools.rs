//! Tools that programs name and no program changes to.
//!
//! Nothing is changed. On both mills T only gets a tool ready, and M6 changes it. Where a whole library names tools and has no M6, the
//! old machine may change by T alone, and the conversion would cut with the tool that is in the spindle. It is told once for the library. Side
//! condition: no code of a builder stands in it that may change the tool. Counter-example: one program for one tool, whose T is a
//! reminder.

use super::shop::are_mills;
use crate::canon::{Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::{Expr, Module, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::Features;

/// True if tools are named, none is changed to, and both machines change by a code of its own.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let by_code = |control: &crate::dialect::Control| {
        control.behaviour(Question::ToolChangeWord).is_some_and(|row| row.value == "m6")
    };
    are_mills(context)
        && features.role(Role::Tool)
        && !features.any_op(|op| matches!(op, Op::ToolChange | Op::Act))
        && by_code(context.source)
        && by_code(context.target)
}

/// Tells of the first tool of each program.
pub fn run(module: &Module, context: &mut Context<'_>) {
    for (index, program) in module.programs.iter().enumerate() {
        for stmt in program.blocks.iter().flat_map(|block| &block.stmts) {
            let StmtKind::Nc(nc) = &stmt.kind else { continue };
            if nc.word(Role::Tool).and_then(Expr::constant).is_some_and(|tool| tool > 0.0) {
                let finding = Diagnostic::new(Code::Conditional, stmt.site.span, UNCHANGED).with_help(HELP);
                context.add_once(index, UNCHANGED, finding.asked_once());
            }
        }
    }
}

const UNCHANGED: &str = "tools are named here, and no program of the library changes to one by M6: the target gets them ready, and goes on \
                         with the tool that is in the spindle";

const HELP: &str = "if the old machine changes the tool by T alone, write M6 beside T into these programs before they are converted";
