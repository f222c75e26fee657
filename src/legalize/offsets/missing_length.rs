//! Codes of the tool length without the number of one, where none was named before.
//!
//! Law: the number of a length lasts until another is named, on both controls. Where on some way none was named since the program
//! began, the program rests on which one its controls take then. Counter-example: `G43 H1 Z5.`, `G49`, `G43 Z5.`.

use crate::canon::{Op, Role};
use crate::dialect::Question;
use crate::ir::{BlockId, Module, Nc};
use crate::legalize::Context;
use crate::legalize::features::Features;

/// True if the library has codes of the tool length, and the source's table asks it.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let asked = context.source.behaviour(Question::LengthNeverNamed).is_some();
    asked && features.any_op(|op| matches!(op, Op::LengthPlus | Op::LengthMinus))
}

/// Says what rests on the controls.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let facts = context.modal_facts(module);
    for (index, program) in module.programs.iter().enumerate() {
        for (at, block) in program.blocks.iter().enumerate() {
            let mut state = facts.at(index, BlockId(at as u32));
            for stmt in &block.stmts {
                let bare = stmt.kind.nc().is_some_and(is_bare);
                if bare && !state.length_word {
                    let span = stmt.site.span;
                    context.rests_on_source(index, span, Question::LengthNeverNamed);
                    if context.target.behaviour(Question::LengthNeverNamed).is_some() {
                        context.rests_on_target(index, span, Question::LengthNeverNamed);
                        context.must_agree(index, span, Question::LengthNeverNamed);
                    }
                }
                state.step(stmt);
            }
        }
    }
}

/// True for a code of the length without its number.
fn is_bare(nc: &Nc) -> bool {
    nc.word(Role::LengthOffset).is_none() && nc.ops().any(|op| matches!(op, Op::LengthPlus | Op::LengthMinus))
}
