//! Taps that are told no lead, on a control that takes it from them.
//!
//! Law: they are refused. The feed that is in force was meant for something else, and so was a lead of an earlier tap.

use crate::canon::{Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::Module;
use crate::legalize::Context;
use crate::legalize::features::Features;

const WHAT: &str = "this tap is told no lead, so it is not known how far it goes in a turn";

const HELP: &str = "write the lead into its block (Q); if F is its feed and S its speed, the machine has another format than its \
                    profile says";

/// True for taps of a control that tells them by speed and lead.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    features.any_op(Op::is_tap)
        && context.source.behaviour(Question::CycleTapFeed).is_some_and(|row| row.value == "lead")
}

/// Refuses them.
pub fn run(module: &Module, context: &mut Context<'_>) {
    for (index, program) in module.programs.iter().enumerate() {
        for stmt in program.blocks.iter().flat_map(|block| &block.stmts) {
            let tap = stmt.kind.nc().filter(|nc| nc.ops().any(Op::is_tap));
            if tap.is_some_and(|nc| nc.word(Role::Lead).is_none()) {
                context.add(index, Diagnostic::new(Code::NoEquivalent, stmt.site.span, WHAT).with_help(HELP));
            }
        }
    }
}
