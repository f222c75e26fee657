//! Codes of the tool length without the number of one, where none was named before.
//!
//! Law: the number of a length lasts until another is named, on both controls. Where on some way none was named since the program
//! began, the program rests on which one its controls take then. Where the target has no such code, the program is refused.
//! Counter-example: `G43 H1 Z5.`, `G49`, `G43 Z5.`.

use crate::canon::{Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::{Module, Nc};
use crate::legalize::Context;
use crate::legalize::features::Features;
use std::collections::BTreeMap;

/// True if the library has codes of the tool length, and the source's table asks it.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let asked = context.source.behaviour(Question::LengthNeverNamed).is_some();
    asked && features.any_op(|op| matches!(op, Op::LengthPlus | Op::LengthMinus))
}

/// Says what rests on the controls.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let facts = context.modal_facts(module);
    facts.each(module, &mut |index, stmt, before, _| {
        if !stmt.kind.nc().is_some_and(is_bare) {
            return;
        }
        let span = stmt.site.span;
        if context.target.code_for(Op::LengthPlus, &BTreeMap::new()).is_none() {
            let title = &context.target.dialect().title;
            let what = format!("{UNNAMED}, and {title} takes up a length by its number alone");
            let told = Diagnostic::new(Code::NoEquivalent, span, what.clone());
            return context.add_once(index, &what, told.with_help("write H with its number beside the code"));
        }
        if before.length_word {
            return;
        }
        context.rests_on_source(index, span, Question::LengthNeverNamed);
        if context.target.behaviour(Question::LengthNeverNamed).is_some() {
            context.rests_on_target(index, span, Question::LengthNeverNamed);
            context.must_agree(index, span, Question::LengthNeverNamed);
        }
    });
}

const UNNAMED: &str = "this code takes up the length whose number was named last";

/// True for a code of the length without its number.
fn is_bare(nc: &Nc) -> bool {
    nc.word(Role::LengthOffset).is_none() && nc.ops().any(|op| matches!(op, Op::LengthPlus | Op::LengthMinus))
}
