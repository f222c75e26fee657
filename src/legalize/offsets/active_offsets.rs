//! Work offsets that a program writes while they may be selected.
//!
//! Law: a table row that is written before it is selected counts the same on every control. One that is selected
//! already may count at once, from the next block, or when it is selected again: where the two controls are
//! not both known to do the same, the reviewer is told. Side condition: what is selected is known from the text.

use crate::canon::{Group, Op, Sys};
use crate::dialect::{Question, Side};
use crate::ir::{BlockId, Module, Place, StmtKind};
use crate::legalize::{Context, Setting};

/// Reports writes to offsets that may be in force.
pub fn run(module: &Module, context: &mut Context<'_>) {
    const FACT: Question = Question::OffsetActiveImmediately;
    let answer = |control: &crate::dialect::Control| {
        control.behaviour(FACT).filter(|row| row.value != "unknown").map(|row| row.value.clone())
    };
    if context.agree(FACT) {
        return;
    }
    let stmts = || module.programs.iter().flat_map(|p| &p.blocks).flat_map(|b| &b.stmts);
    if !stmts().any(|stmt| row(&stmt.kind).is_some()) {
        return;
    }
    let facts = context.modal_facts(module);
    for (index, program) in module.programs.iter().enumerate() {
        for (at, block) in program.blocks.iter().enumerate() {
            let mut state = facts.at(index, BlockId(at as u32));
            for stmt in &block.stmts {
                if let Some(written) = row(&stmt.kind) {
                    let other = match state.of(Group::WorkOffset) {
                        Setting::Known(Op::ShiftCancel, _) => true,
                        Setting::Known(Op::SelectWork, Some(selected)) => {
                            written.is_some_and(|row| row != f64::from(selected))
                        }
                        _ => false,
                    };
                    if !other {
                        let what = "the work offset may be in force while it is written: it is not known \
                                    for both controls whether the new value counts at once or when the \
                                    offset is selected again";
                        let side = if answer(context.target).is_none() { Side::Target } else { Side::Source };
                        let fact = FACT.fact();
                        context.unconfirmed(index, side, stmt.site.span, fact, what);
                    }
                }
                state.step(stmt);
            }
        }
    }
}

/// The row of the work offset that a statement writes, the number where it is constant.
fn row(kind: &StmtKind) -> Option<Option<f64>> {
    match kind {
        StmtKind::Assign { target: Place::System(Sys::WorkOffset, subscripts), .. } => {
            Some(subscripts.first().and_then(|row| row.constant()))
        }
        _ => None,
    }
}
