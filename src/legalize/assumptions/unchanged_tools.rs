//! Tools that programs name and no program changes to.
//!
//! Nothing is changed. On both mills T only gets a tool ready, and M6 changes it. Where a whole library names tools and has no M6, the
//! old machine may change by T alone, and the conversion would cut with the tool that is in the spindle. Which of the two it is, is asked once
//! for the library, unless the profile of the source says it. Side condition: no code of a builder stands in it that may change the
//! tool. Counter-example: one program for one tool, whose T is a reminder.

use super::shop::are_mills;
use crate::canon::{Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Question, Side};
use crate::ir::{Expr, Module, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::Features;

/// True if tools are named, none is changed to, and no profile says by which word the source changes them.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let row = context.source.behaviour(Question::ToolChangeWord);
    let is_open = row.is_some_and(|row| row.value == "m6" && !row.one_of.is_empty());
    are_mills(context)
        && is_open
        && features.role(Role::Tool)
        && !features.any_op(|op| matches!(op, Op::ToolChange | Op::Act))
}

/// Tells of the first tool of each program.
pub fn run(module: &Module, context: &mut Context<'_>) {
    for (index, program) in module.programs.iter().enumerate() {
        for stmt in program.blocks.iter().flat_map(|block| &block.stmts) {
            let StmtKind::Nc(nc) = &stmt.kind else { continue };
            if nc.word(Role::Tool).and_then(Expr::constant).is_some_and(|tool| tool > 0.0) {
                let fact = Question::ToolChangeWord.fact();
                let finding = Diagnostic::new(Code::UnconfirmedFact, stmt.site.span, UNCHANGED)
                    .with_help(context.source.to_settle(fact, Side::Source))
                    .with_fact(fact);
                context.add_once(index, UNCHANGED, finding.asked_once());
            }
        }
    }
}

const UNCHANGED: &str = "tools are named here, and no program of the library changes to one by M6: if T alone changes the tool on this machine, \
                         it is \"t\"; with \"m6\" T only makes a tool ready, and the programs go on with the tool that is in the spindle";
