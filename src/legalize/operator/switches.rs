//! What programs switch of the operator's own switches, on a target that has no variable for them.
//!
//! Law: whether single block, feed hold and the override of feeds act is seen by an operator alone: a run in which nobody touches them does
//! the same to the part. So the writes are left out, and a person is told once for the library. Side conditions: no program reads
//! what was written, and what is written is a number that says nothing of exact stops. Counter-example: `#3004=4`, no exact stop.

use crate::canon::Sys;
use crate::diag::{Code, Diagnostic};
use crate::ir::{Expr, Module, Place, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::Features;

/// The states, and the largest number that says nothing of moves.
const STATES: [(Sys, f64); 2] = [(Sys::SingleBlock, 1.0), (Sys::FeedHold, 3.0)];

/// True for a target that lacks one of them.
pub fn concerns(_: &Features, context: &Context<'_>) -> bool {
    STATES.iter().any(|(state, _)| context.target.system_run(*state).is_none())
}

/// Leaves the writes out.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    for (state, most) in STATES {
        if context.target.system_run(state).is_some() || reads(module, state) {
            continue;
        }
        for (index, program) in module.programs.iter_mut().enumerate() {
            for stmt in program.blocks.iter_mut().flat_map(|block| &mut block.stmts) {
                let StmtKind::Assign { target: Place::System(written, _), value } = &stmt.kind else {
                    continue;
                };
                let plain = value.constant().is_some_and(|value| (0.0..=most).contains(&value));
                if *written != state || !plain {
                    continue;
                }
                stmt.kind = StmtKind::Comment;
                let what = if state == Sys::SingleBlock { SINGLE } else { HOLD };
                context.add_once(
                    index,
                    what,
                    Diagnostic::new(Code::Conditional, stmt.site.span, what).asked_once(),
                );
            }
        }
    }
}

/// True where some program reads it.
fn reads(module: &Module, state: Sys) -> bool {
    let mut found = false;
    let mut look = |e: &Expr| e.walk(&mut |e| found |= matches!(e, Expr::System(read, _) if *read == state));
    for block in module.programs.iter().flat_map(|program| &program.blocks) {
        block.stmts.iter().for_each(|stmt| stmt.kind.exprs(&mut look));
        block.term.kind.exprs(&mut look);
    }
    found
}

const SINGLE: &str = "the program switches off the stop after each block, and the target has no variable for that: it is left out. In single block \
                      the target stops inside such macros too; see that nobody leaves them there";
const HOLD: &str = "the program switches off feed hold or the override of feeds, and the target has no variable for that: it is left out. An operator must \
                    touch neither while such a program probes or cuts a thread";
