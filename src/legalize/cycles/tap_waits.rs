//! Waits at the bottom of taps, for a target whose taps do not wait.
//!
//! Law: where the source's profile says that its taps need no wait, the word that tells one tells nothing to a tap, and lasts for
//! the cycles after it. Side condition: a mill, and the answer is the shop's. Counter-example: `G84 P500`, then `G82` without P,
//! which waits half a second.

use crate::canon::{Op, Role};
use crate::diag::Diagnostic;
use crate::dialect::{Control, Question};
use crate::ir::{Expr, Nc, NcItem};
use crate::legalize::Context;

/// True for a tap of a mill of which the profile says that its wait is nothing.
fn is_none(op: Op, control: &Control) -> bool {
    is_tap(op) && control.behaviour(Question::TapDwell).is_some_and(|row| row.value == "none")
}

/// True for a tap of a mill.
pub(super) const fn is_tap(op: Op) -> bool {
    matches!(op, Op::CycleTap | Op::CycleTapLeft | Op::CycleTapRigid | Op::CycleTapByLead)
}

/// True for a tap whose wait the source has none of, where the target has it, or has no word for it.
pub(super) fn left_out(op: Op, context: &Context<'_>) -> bool {
    is_none(op, context.source) && !(super::cycle_words::sides(op, context)[1] && is_none(op, context.target))
}

/// Takes the wait of a tap out, or makes it 0 where the target would wait.
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

/// With what to do about it, and the line of the source's profile that answers it.
pub(super) fn told(finding: Diagnostic) -> Diagnostic {
    let name = Question::TapDwell;
    let help = format!(
        "taps do not wait at the bottom there. If the threads do not need it, write \"{name}\" = \"none\" under [behaviours] in \
         the source's profile, for all programs, or take the word out"
    );
    finding.with_help(help).lacking(format!("behaviour.{name}=none"))
}
