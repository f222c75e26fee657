//! Machine coordinates, and centres of rotations, under incremental coordinates.
//!
//! Law: the words of such a block are places on one control, increments on another, and one may ignore the block. Nothing is
//! changed: each control of which it is not known is asked, and a program is refused where the two are known to differ. Side
//! condition: G91 is in force for certain; where it may be, runs show it. Counter-example: `G91 G53 G0 X-20.`.

use crate::canon::{Group, Op};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::Module;
use crate::legalize::Context;
use crate::legalize::assumptions::shop::{are_mills, rests};
use crate::legalize::features::Features;
use crate::text::Span;

pub(super) const MOVE: Question = Question::MachineUnderIncremental;
const CENTRE: Question = Question::RotationCentreIncremental;

/// True if the library has such blocks, between two mills.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    are_mills(context)
        && features.any_op(|op| op == Op::Incremental)
        && features.any_op(|op| matches!(op, Op::MachineOnce | Op::RotateOn))
}

/// Says what rests on the controls.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let facts = context.modal_facts(module);
    facts.each(module, &mut |index, stmt, _, after| {
        let Some(nc) = stmt.kind.nc() else { return };
        if after.op(Group::Distance) != Some(Op::Incremental) || !nc.names_axis() {
            return;
        }
        if nc.has(Op::MachineOnce) {
            rests(MOVE, index, stmt.site.span, context);
            as_places(index, stmt.site.span, context);
        }
        if nc.has(Op::RotateOn) {
            rests(CENTRE, index, stmt.site.span, context);
        }
    });
}

/// A target that has no such code is given the places.
fn as_places(index: usize, span: Span, context: &mut Context<'_>) {
    let other = |value: &str| !matches!(value, "place" | "unknown");
    let is_other = context.source.behaviour(MOVE).is_some_and(|row| other(&row.value));
    if is_other && context.target.behaviour(MOVE).is_none() {
        context.add_once(index, PLACES, Diagnostic::new(Code::NoEquivalent, span, PLACES).with_help(HELP));
    }
}

const PLACES: &str =
    "machine coordinates under G91 are no places on the source, and the target has no such code";
const HELP: &str = "write G90 before it, and the place";
