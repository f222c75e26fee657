//! Drilling cycles of lathes, where the two controls tell them otherwise: the retract plane as a way from where the cycle began or as a place,
//! one code for all drilling or one for each way of it, pecks that count in their block alone.
//!
//! Law: a hole goes to the same plane and bottom, in the same pecks, with the same wait, and ends at the level where its cycle began. Side
//! conditions: that level is a known number, or is read where the cycle begins; the cycle begins above its plane; what lasts from block to block
//! (a wait, a peck, a plane) is known where the target needs it again. Counter-example: a hole that a called program leaves the cycle of.

mod all;
mod by_place;
mod by_step;
mod called_waits;
mod known;
mod levels;
mod pecks;
mod rigid;
mod waits;
mod walk;

use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question, Side};
use crate::ir::{Module, Nc};
use crate::legalize::features::Features;
use crate::legalize::{Context, Modal};
use crate::text::Span;

/// True where the two controls tell retract planes otherwise.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    features.any_op(Op::is_hole) && tells_by_step(context.source) != tells_by_step(context.target)
}

/// True of a control whose retract planes of holes are ways from where the cycle began.
pub(super) fn tells_by_step(control: &Control) -> bool {
    control.dialect().codes.iter().any(|row| row.words.values().any(|role| *role == Role::CycleRStep))
}

/// The drilling cycle of a lathe that a block runs; `state` is what is in force in it.
pub fn drills(nc: &Nc, state: &Modal) -> Option<Op> {
    let goes_on = || {
        let aside = |op: Op| {
            op.acts_with_words() || matches!(op, Op::MachineOnce | Op::ReferenceReturn | Op::Reference2)
        };
        let places = nc.names_axis() || nc.word(Role::CycleR).or(nc.word(Role::CycleRStep)).is_some();
        state.op(Group::Cycle).filter(|op| op.is_hole() && places && !nc.ops().any(aside))
    };
    nc.ops().find(|op| op.is_hole()).or_else(goes_on)
}

/// Gives the cycles the target's form.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    walk::run(module, context, tells_by_step(context.target));
    true
}

/// Looks at each block that drills.
pub(super) fn each(
    module: &Module,
    context: &mut Context<'_>,
    mut look: impl FnMut(usize, Span, &Nc, &mut Context<'_>),
) {
    let facts = context.modal_facts(module);
    facts.each(module, &mut |index, stmt, _, after| {
        if let Some(nc) = stmt.kind.nc().filter(|nc| drills(nc, after).is_some()) {
            look(index, stmt.site.span, nc, context);
        }
    });
}

/// Where nobody says it of one control, its pecks are taken to go back to the plane; the other's are known to break the chip alone.
fn short_pecks(index: usize, span: Span, context: &mut Context<'_>) {
    let known = |control: &Control| control.behaviour(Question::HolePecks).map(|row| row.value.clone());
    let (ours, theirs) = (known(context.source), known(context.target));
    let short = Some("clearance");
    let open = |one: &Option<String>| !matches!(one.as_deref(), Some("plane" | "clearance"));
    let (control, side) = match (ours.as_deref() == short, theirs.as_deref() == short) {
        (true, false) if open(&theirs) => (context.target, Side::Target),
        (false, true) if open(&ours) => (context.source, Side::Source),
        _ => return,
    };
    let what = format!(
        "how far a peck goes back is not known of the {side}, and the pecks of the other control only break the chip"
    );
    let help = control.to_settle(Question::HolePecks.fact(), side);
    context.add_once(index, &what, Diagnostic::new(Code::NoEquivalent, span, what.as_str()).with_help(help));
}

/// Pecks that the two controls do not make alike, or are not known to.
pub fn pecks(module: &Module, context: &mut Context<'_>) {
    each(module, context, |index, span, nc, context| {
        if nc.word(Role::CycleQ).is_some() {
            context.rests_on_source(index, span, Question::HolePecks);
            context.rests_on_target(index, span, Question::HolePecks);
            context.must_agree(index, span, Question::HolePecks);
            short_pecks(index, span, context);
        }
    });
}

/// True for a block that says the plane and the depth of its cycle.
fn tells_all(nc: &Nc, op: Op, by_steps: bool) -> bool {
    let plane = if by_steps { Role::CycleR } else { Role::CycleRStep };
    let depths = if op.is_side_hole() { [Role::X, Role::StepX] } else { [Role::Z, Role::StepZ] };
    nc.word(plane).is_some() && depths.into_iter().any(|depth| nc.word(depth).is_some())
}
