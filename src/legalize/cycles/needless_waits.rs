//! Waits at the bottom of taps and of peck drills, for a target whose taps or peck drills do not wait.
//!
//! Law: where the source's profile says that its taps or its peck drills need no wait, the word that tells one tells nothing to them, and
//! lasts for the cycles after it. Side condition: a mill, and the answer is the shop's. Counter-example: `G84 P500`, then `G82` without P,
//! which waits half a second.

use crate::canon::{Op, Role};
use crate::diag::Diagnostic;
use crate::dialect::{Control, Question};
use crate::ir::{Expr, Nc, NcItem};
use crate::legalize::Context;
use std::collections::BTreeMap;

/// True for a cycle whose code takes a wait that counts.
pub(super) fn waits(op: Op, control: &Control) -> bool {
    let row = control.code_for(op, &BTreeMap::new());
    row.is_some_and(|row| row.takes(Role::CycleDwell)) && !is_none(op, control)
}

/// True for a cycle of which the profile says that its wait is nothing.
pub(super) fn is_none(op: Op, control: &Control) -> bool {
    let answer = question(op).and_then(|question| control.behaviour(question));
    answer.is_some_and(|row| row.value == "none")
}

/// What the shop may say of the wait of a cycle of a mill; none for a cycle that is for its wait.
pub(super) const fn question(op: Op) -> Option<Question> {
    match op {
        Op::CycleTap | Op::CycleTapLeft | Op::CycleTapRigid | Op::CycleTapByLead => Some(Question::TapDwell),
        Op::CyclePeck | Op::CycleChipBreak => Some(Question::PeckDwell),
        _ => None,
    }
}

/// True for a cycle whose wait the source has none of, where the target has it, or has no word for it.
pub(super) fn left_out(op: Op, context: &Context<'_>) -> bool {
    is_none(op, context.source) && !(super::cycle_words::sides(op, context)[1] && is_none(op, context.target))
}

/// Takes such a wait out, or makes it 0 where the target would wait.
pub(super) fn fit(nc: &mut Nc, op: Op, context: &Context<'_>) {
    if !left_out(op, context) {
        return;
    }
    let waits = super::cycle_words::sides(op, context)[1];
    let is_wait = |item: &NcItem| matches!(item, NcItem::Word(Role::CycleDwell, _));
    nc.items.retain(|item| waits || !is_wait(item));
    for item in nc.items.iter_mut().filter(|item| is_wait(item)) {
        *item = NcItem::Word(Role::CycleDwell, Expr::Number(0.0));
    }
}

/// With what to do about it, and the line of the source's profile that answers it, of a cycle that may need no wait.
pub(super) fn told(finding: Diagnostic, op: Op, context: &Context<'_>) -> Diagnostic {
    let Some(name) = question(op) else { return finding };
    let (who, what) = match name {
        Question::TapDwell => ("taps do", "the threads do"),
        _ => ("peck drills do", "the holes do"),
    };
    let mut help = format!(
        "{who} not wait at the bottom there. If {what} not need it, write \"{name}\" = \"none\" under [behaviours] in \
         the source's profile, for all programs, or take the word out"
    );
    if name == Question::PeckDwell && context.source.peck_clearance().is_none() {
        help += "; if they need it, say there how far over the last depth each peck begins (\"cycle.peck.clearance\"): then the pecks \
                 are written as moves";
    }
    finding.with_help(help).lacking(format!("behaviour.{name}=none"))
}
