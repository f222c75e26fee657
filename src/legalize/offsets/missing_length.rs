//! Codes of the tool length without the number of one, where none was named before.
//!
//! Law: the number of a length lasts until another is named, on both controls. Where on some way none was named since the program
//! began, the program rests on which one its controls take then. Counter-example: `G43 H1 Z5.`, `G49`, `G43 Z5.`.

use crate::canon::{Op, Role};
use crate::dialect::Question;
use crate::ir::{Module, Nc};
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
    facts.each(module, &mut |index, stmt, before, _| {
        if before.length_word || !stmt.kind.nc().is_some_and(is_bare) {
            return;
        }
        let span = stmt.site.span;
        context.rests_on_source(index, span, Question::LengthNeverNamed);
        if context.target.behaviour(Question::LengthNeverNamed).is_some() {
            context.rests_on_target(index, span, Question::LengthNeverNamed);
            context.must_agree(index, span, Question::LengthNeverNamed);
        }
    });
}

/// True for a code of the length without its number.
fn is_bare(nc: &Nc) -> bool {
    nc.word(Role::LengthOffset).is_none() && nc.ops().any(|op| matches!(op, Op::LengthPlus | Op::LengthMinus))
}
