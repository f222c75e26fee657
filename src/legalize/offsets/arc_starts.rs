//! Cutter compensation that begins or ends on an arc, where a control takes that for a fault.
//!
//! Law: the first move after the code begins the compensation, or ends it, and it must be straight. A program that does it on an arc
//! stops on such a control, and is refused. Counter-example: `G41 D1 G1 X10.`, then `G3`.

use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Machine, Question, Row, Side};
use crate::ir::{Module, Nc, Stmt};
use crate::legalize::each_step::each_step;
use crate::legalize::features::Features;
use crate::legalize::{Context, Modal};

/// True if the library compensates and cuts arcs, and one of the controls does not take them together.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    context.target.machine() == Machine::Mill
        && (forbids(context.source) || forbids(context.target))
        && features.any_op(|op| matches!(op, Op::RadiusLeft | Op::RadiusRight))
        && features.any_op(Op::is_arc)
}

fn forbids(control: &Control) -> bool {
    control.behaviour(Question::RadiusStartsOnArc).is_some_and(|row| row.value == "false")
}

/// Reports arcs on which compensation begins or ends.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let facts = context.modal_facts(module);
    each_step(module, &facts, step, |index, stmt, (_, on_arc)| {
        if !on_arc {
            return;
        }
        let side = if forbids(context.source) { Side::Source } else { Side::Target };
        let control = if side == Side::Source { context.source } else { context.target };
        let origin = control.behaviour(Question::RadiusStartsOnArc).map(|row| row.origin().source.clone());
        let what = format!(
            "cutter compensation begins or ends on this arc: the {side} stops there ({}). Begin and end it on a \
             straight move",
            origin.unwrap_or_default()
        );
        context.add(index, Diagnostic::new(Code::NoEquivalent, stmt.site.span, what));
    });
}

/// Takes a statement; true where it begins or ends compensation on an arc. `waiting` is true where compensation was switched, and no
/// move in the plane followed yet, on some way.
fn step(stmt: &Stmt, state: &mut Modal, waiting: &mut bool) -> bool {
    let was = state.op(Group::RadiusComp);
    state.step(stmt);
    let Some(nc) = stmt.kind.nc() else { return false };
    let is_on = |op: Option<Op>| op.is_some_and(|op| op != Op::RadiusOff);
    let named = nc.ops().filter(|op| op.group() == Group::RadiusComp).last();
    let switched = named.is_some() && is_on(was) != is_on(named);
    let due = *waiting || switched;
    let arc = due && is_arc(nc, state);
    // A block that may be skipped leaves what was due before it.
    *waiting = due && (!goes(nc, state) || *waiting && stmt.site.skip.is_some());
    arc
}

/// True for a block that cuts an arc; `after` is what is in force after it.
fn is_arc(nc: &Nc, after: &Modal) -> bool {
    let turns =
        after.op(Group::Motion).is_some_and(Op::is_arc) && !after.op(Group::Cycle).is_some_and(Op::is_cycle);
    turns && goes(nc, after)
}

/// True for a block that moves in the plane.
fn goes(nc: &Nc, after: &Modal) -> bool {
    let plane = match after.op(Group::Plane) {
        Some(Op::PlaneZx) => [Role::Z, Role::X],
        Some(Op::PlaneYz) => [Role::Y, Role::Z],
        _ => [Role::X, Role::Y],
    };
    let centre = [Role::ArcI, Role::ArcJ, Role::ArcK].iter().any(|role| nc.word(*role).is_some());
    let across = plane.iter().any(|role| nc.word(*role).is_some());
    (centre || nc.moves() && across) && !nc.ops().any(Op::takes_axes)
}
