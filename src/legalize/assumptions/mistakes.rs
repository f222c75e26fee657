//! What a run does by mistake alone, where of one control it is known what comes of that.
//!
//! A division by 0, the root of a negative number, an arc by its radius that ends at its start: no program is written to do so.
//! Where one control is known to stop there, or to move nothing, nobody is asked what the other does. A note tells of it.
//! Law: runs without such a mistake are as they were. Counter-example: none of the two is known, so that both are asked.

use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question, Side, matters};
use crate::ir::NcItem;
use crate::legalize::Context;
use crate::text::Span;
use crate::{canon::Role, ir::Nc};

/// The matter of an arc by its radius that ends at its start.
const CLOSED: &str = "machine:arc.radius.full.circle";

/// A calculation that may have no result.
pub(super) fn no_result(context: &mut Context<'_>, program: usize, span: Span, question: Question) {
    let mistake = match question {
        Question::DivideByZero => "a division by 0",
        _ => "the root of a negative number",
    };
    let [source, target] = [context.source, context.target];
    for (side, ours, other, theirs) in
        [(Side::Source, source, Side::Target, target), (Side::Target, target, Side::Source, source)]
    {
        if is_unknown(ours, question) && stops(theirs, question) {
            let what = format!(
                "{mistake} stops the {other} with an alarm, and no source says what the {side} does then: it is a mistake, so \
                 nobody is asked"
            );
            tell(context, program, side, span, question.fact(), what);
        } else if side == Side::Source {
            context.rests_on_source(program, span, question);
        } else {
            context.rests_on_target(program, span, question);
        }
    }
    context.must_agree(program, span, question);
}

/// An arc by its radius whose end may be its start.
pub(super) fn closed_arc(nc: &Nc, program: usize, span: Span, context: &mut Context<'_>) {
    let computed = |item: &NcItem| match item {
        NcItem::Word(role, value) => {
            (role.is_axis() || *role == Role::ArcRadius) && value.constant().is_none()
        }
        _ => false,
    };
    if nc.word(Role::ArcRadius).is_none() || !nc.items.iter().any(computed) {
        return;
    }
    let [source, target] = [context.source, context.target];
    for (side, ours, other, theirs) in
        [(Side::Source, source, Side::Target, target), (Side::Target, target, Side::Source, source)]
    {
        if ours.has_tried(CLOSED) {
            continue;
        }
        let meaning = matters::meaning(CLOSED).unwrap_or_default();
        if theirs.has_tried(CLOSED) {
            let what = format!("{meaning} on the {other}; the {side} may stop with an alarm there");
            tell(context, program, side, span, CLOSED, what);
        } else {
            let what = format!("no manual confirms '{CLOSED}': {meaning}");
            context.unconfirmed(program, side, span, CLOSED, what);
        }
    }
}

fn is_unknown(control: &Control, question: Question) -> bool {
    control.behaviour(question).is_some_and(|row| row.value == "unknown")
}

/// True where a source or the profile says that the control stops.
fn stops(control: &Control, question: Question) -> bool {
    control.behaviour(question).is_some_and(|row| row.origin.is_settled() && row.value == "alarm")
}

fn tell(context: &mut Context<'_>, program: usize, side: Side, span: Span, fact: &str, what: String) {
    let note = Diagnostic::new(Code::MistakeOnly, span, what).with_fact(fact);
    context.add_once(program, &format!("{side} {fact}"), note);
}
