//! How far a fine bore moves the tool off the wall, by one word or by two.
//!
//! Law: one word says how far the tool goes along the first axis of the plane, whatever its sign; the other two say by how much it
//! goes along each axis. So `Q0.2` is `I0.2`, and `I0.2` alone is `Q0.2`. Side conditions: the shift goes along the first axis, and
//! in plus (a fact of the machine with the one word); the cycle is told the word itself, as others share the letters.
//! Counter-example: `G83 Q5.`, then `G76` without Q.

use crate::canon::{Func, Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Side, matters};
use crate::ir::{Expr, Nc, NcItem};
use crate::legalize::Context;
use crate::text::Span;
use std::collections::BTreeMap;
use thin_vec::thin_vec;

const FACT: &str = "machine:cycle.shift.direction";

/// Says the shift of a fine bore as the target's code takes it.
pub(super) fn fit(
    (nc, span): (&mut Nc, Span),
    (before, op): (Option<Op>, Op),
    index: usize,
    context: &mut Context<'_>,
) {
    if before != Some(Op::CycleFineBore) && op != Op::CycleFineBore {
        return;
    }
    let takes = |control: &Control, role: Role| {
        control.code_for(Op::CycleFineBore, &BTreeMap::new()).is_some_and(|row| row.takes(role))
    };
    let [ours, theirs] =
        [context.source, context.target].map(|of| [Role::CycleQ, Role::CycleI].map(|role| takes(of, role)));
    let (role, side) = match (ours, theirs) {
        ([true, _], [false, true]) => (Role::CycleQ, Side::Source),
        ([_, true], [true, false]) => (Role::CycleI, Side::Target),
        _ => return,
    };
    let says_cycle = nc.ops().any(|op| op.group() == Group::Cycle);
    let is_told = nc.word(role).is_some();
    let follows = says_cycle && before != Some(Op::CycleOff) && before != Some(op);
    if follows && (op != Op::CycleFineBore || !is_told) {
        return context.add_once(index, FOLLOWS, Diagnostic::new(Code::NoEquivalent, span, FOLLOWS));
    }
    let across = nc.word(Role::CycleJ).is_none_or(|by| by.constant() == Some(0.0));
    let Some(by) = nc.word(role).filter(|by| op == Op::CycleFineBore && !by.may_be_vacant()).cloned() else {
        return;
    };
    let new = match (role, by.constant()) {
        (Role::CycleQ, Some(by)) => NcItem::Word(Role::CycleI, Expr::Number(by.abs())),
        (Role::CycleQ, None) => NcItem::Word(Role::CycleI, Expr::Call(Func::Abs, thin_vec![by])),
        (_, Some(by)) if by > 0.0 && across => NcItem::Word(Role::CycleQ, Expr::Number(by)),
        _ => return,
    };
    for item in &mut nc.items {
        if matches!(item, NcItem::Word(of, _) if *of == role) {
            *item = new.clone();
        }
    }
    nc.items.retain(|item| role == Role::CycleQ || !matches!(item, NcItem::Word(Role::CycleJ, _)));
    let one_word = if side == Side::Source { context.source } else { context.target };
    if !one_word.has_tried(FACT) {
        let what = matters::meaning(FACT).unwrap_or_default();
        context.unconfirmed(index, side, span, FACT, what);
    }
}

const FOLLOWS: &str = "a drilling cycle follows another one without G80 between, and one of them is a fine bore: the shift of the one may \
                       be the peck of the other. Write G80 between the two, and the shift into the block of the fine bore";
