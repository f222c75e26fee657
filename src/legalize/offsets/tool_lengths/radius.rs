//! The number of a tool beside a code of the cutter radius, where the same letter changes the tool.

use super::number;
use crate::canon::{Op, Role};
use crate::dialect::Question;
use crate::ir::Nc;
use crate::legalize::Context;
use crate::text::Span;

/// Asks what such a number does where it is not that of the tool in the spindle: of that tool it only names the radius.
pub(super) fn ask(nc: &Nc, tool: Option<u32>, (index, span): (usize, Span), context: &mut Context<'_>) {
    let Some(row) = nc.word(Role::RadiusOffset).filter(|_| names(nc)) else { return };
    if number(row).is_none_or(|row| tool != Some(row)) {
        context.rests_on_target(index, span, Question::RadiusWordNames);
    }
}

/// True for a code of the cutter radius with a number.
pub(super) fn names(nc: &Nc) -> bool {
    nc.word(Role::RadiusOffset).is_some() && (nc.has(Op::RadiusLeft) || nc.has(Op::RadiusRight))
}
