//! How far a fine bore moves the tool off the wall, by one word or by two.
//!
//! Law: one word says how far the tool goes along the first axis of the plane, whatever its sign; the other two say by how much it
//! goes along each axis. So `Q0.2` is `I0.2`, and `I0.2` alone is `Q0.2`. Side conditions: the shift goes along the first axis, and
//! the way of the machine with the one word, plus where nobody says it; the cycle is told the word itself, as others share the letters.
//! Counter-example: `G83 Q5.`, then `G76` without Q.

use super::shift_ways::{way, write};
use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question, Side};
use crate::ir::{Expr, Nc, NcItem};
use crate::legalize::Context;
use crate::text::Span;
use std::collections::BTreeMap;

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
    let one_word = if side == Side::Source { context.source } else { context.target };
    let known = way(one_word);
    let (second, minus) = known.unwrap_or_default();
    match (role, by.constant()) {
        (Role::CycleQ, _) => write(nc, (second, minus)),
        (_, Some(by)) if !second && across && by != 0.0 && (by < 0.0) == minus => {
            for item in &mut nc.items {
                if matches!(item, NcItem::Word(of, _) if *of == role) {
                    *item = NcItem::Word(Role::CycleQ, Expr::Number(by.abs()));
                }
            }
            nc.items.retain(|item| !matches!(item, NcItem::Word(Role::CycleJ, _)));
        }
        _ => return,
    }
    match side {
        _ if known.is_some() => {}
        Side::Source => context.rests_on_source(index, span, Question::CycleShift),
        Side::Target => context.rests_on_target(index, span, Question::CycleShift),
    }
}

const FOLLOWS: &str = "a drilling cycle follows another one without G80 between, and one of them is a fine bore: the shift of the one may \
                       be the peck of the other. Write G80 between the two, and the shift into the block of the fine bore";
