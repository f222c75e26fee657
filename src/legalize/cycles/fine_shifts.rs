//! How far a fine bore moves the tool off the wall, by one word or by two.
//!
//! Law: one word says how far the tool goes along the first axis of the plane, whatever its sign; the other two say by how much it
//! goes along each axis. So `Q0.2` is `I0.2`, and `I0.2` alone is `Q0.2`. Side conditions: the shift goes along the first axis, and
//! the way of the machine with the one word, plus where nobody says it (a shift another way is refused); the cycle is told the word itself, as others share the letters; what follows it without G80 takes none of them.
//! Counter-example: `G83 Q5.`, then `G76` without Q.

use super::shift_ways::{Way, way, write};
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
    // A cycle that takes none of these words on either control is told nothing by the bore before it.
    let no_shift = |control: &Control| {
        let words = [Role::CycleQ, Role::CycleI, Role::CycleJ];
        control.code_for(op, &BTreeMap::new()).is_some_and(|row| !words.iter().any(|role| row.takes(*role)))
    };
    if follows && op != Op::CycleFineBore && no_shift(context.source) && no_shift(context.target) {
        return;
    }
    if follows && (op != Op::CycleFineBore || !is_told) {
        return context.add_once(index, FOLLOWS, Diagnostic::new(Code::NoEquivalent, span, FOLLOWS));
    }
    if side == Side::Target {
        return one_word((nc, span), op, index, context);
    }
    if nc.word(role).is_none_or(|by| op != Op::CycleFineBore || by.may_be_vacant()) {
        return;
    }
    let known = way(context.source);
    write(nc, known.unwrap_or_default());
    if known.is_none() {
        context.rests_on_source(index, span, Question::CycleShift);
    }
}

/// Says by one word what the words of both axes say, where that is along the target's way: a zero along the other axis is nothing.
fn one_word((nc, span): (&mut Nc, Span), op: Op, index: usize, context: &mut Context<'_>) {
    let by = |role| nc.word(role).map_or(Some(0.0), Expr::constant);
    let (Some(x), Some(y)) = (by(Role::CycleI), by(Role::CycleJ)) else { return };
    if op != Op::CycleFineBore || (x == 0.0) == (y == 0.0) {
        return;
    }
    let far = x + y;
    let told: Way = (x == 0.0, far < 0.0);
    let known = way(context.target);
    // Of a machine of which nobody says it the commonest way is taken, and asked.
    if known.unwrap_or_default() == told {
        if known.is_none() {
            context.rests_on_target(index, span, Question::CycleShift);
        }
    } else {
        let what = if known.is_some() { OTHER_WAY } else { UNKNOWN_WAY };
        let help = match known {
            Some(_) => OTHER_HELP.to_owned(),
            None => context.target.to_settle(Question::CycleShift.fact(), Side::Target),
        };
        context.add_once(index, what, Diagnostic::new(Code::NoEquivalent, span, what).with_help(help));
    }
    let mut told = Some(NcItem::Word(Role::CycleQ, Expr::Number(far.abs())));
    nc.items.retain_mut(|item| match item {
        NcItem::Word(Role::CycleI | Role::CycleJ, _) => told.take().is_some_and(|q| {
            *item = q;
            true
        }),
        _ => true,
    });
}

const OTHER_WAY: &str = "the bar leaves the wall the other way than on the target, where the cycle's word says only how far: it would be drawn along the \
                         wall or into it";
const OTHER_HELP: &str = "set the way on the target's machine as this program has it, turn the bar in its holder so that its tip points the other way, and \
                          write the way into the machine's profile (\"cycle.shift\" under [behaviours]); do not leave the shift out, or the tip scores the bore";
const UNKNOWN_WAY: &str =
    "which way the target moves the boring bar off the wall is not known: its cycle's word says only how far";

const FOLLOWS: &str = "a drilling cycle follows another one without G80 between, and one of them is a fine bore: the shift of the one may \
                       be the peck of the other. Write G80 between the two, and the shift into the block of the fine bore";
