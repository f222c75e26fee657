//! Drilling cycles in another plane than the first, where a control drills in that alone.
//!
//! Law: a hole goes along the axis of its plane. A control whose cycles run under G17 alone has no such hole, and of a source
//! that has none it is not known what it does there: the program is refused. If the plane depends on the path, it is for review.
//! Where nobody says whether a control has one, the program rests on that it has. Holes that are written as moves go along Z
//! alone.

use crate::canon::{Group, Op};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Behaviour, Control, Machine, Question, Row, Side};
use crate::ir::analysis::behind::in_other_planes;
use crate::ir::{Module, Nc};
use crate::legalize::cycles::hole_moves;
use crate::legalize::features::Features;
use crate::legalize::{Context, Modal};
use crate::text::Span;

/// True if the library drills and selects planes, and a table says something of it.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let asked = |control: &Control| along_plane(control).is_some();
    (asked(context.source) || asked(context.target) || as_moves(context.target))
        && features.any_op(Op::is_cycle)
        && features.any_op(|op| matches!(op, Op::PlaneZx | Op::PlaneYz))
}

/// What a control says of the planes of its holes; a lathe's code says the axis, whatever the plane is (docs/lathe.md Q5, Q6, Q9).
fn along_plane(control: &Control) -> Option<&Behaviour> {
    control.behaviour(Question::CyclePlane).filter(|_| control.machine() == Machine::Mill)
}

/// True for a mill whose holes are moves.
fn as_moves(target: &Control) -> bool {
    target.machine() == Machine::Mill && hole_moves::replaces(target)
}

/// Reports cycles in other planes.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let (facts, turned) = (context.modal_facts(module), in_other_planes(module));
    facts.each(module, &mut |index, stmt, _, after| {
        let plane = after.op(Group::Plane);
        // A way that names no plane is in that of X and Y, in which machines begin.
        let is_flat = plane.is_none() && !turned.contains(&(index, stmt.site.span));
        if plane != Some(Op::PlaneXy) && !is_flat && stmt.kind.nc().is_some_and(|nc| drills(nc, after)) {
            report(context, index, stmt.site.span, plane.is_some());
        }
    });
}

/// True for a block that begins a cycle, or goes somewhere under one; `after` is what is in force after it.
fn drills(nc: &Nc, after: &Modal) -> bool {
    let goes_on = after.op(Group::Cycle).is_some_and(Op::is_cycle) && (nc.moves() || nc.has(Op::CycleHere));
    nc.ops().any(Op::is_cycle) || goes_on
}

const OTHER: &str = "a drilling cycle under G18 or G19: for the target holes are written as moves, and those go along Z. Write the moves of the \
     holes";
const ON_THE_WAY: &str = "the plane of this drilling cycle depends on the path: make sure that it is G17, as the moves of its holes go along Z";

fn report(context: &mut Context<'_>, index: usize, span: Span, known: bool) {
    if as_moves(context.target) {
        let code = if known { Code::NoEquivalent } else { Code::Conditional };
        let what = if known { OTHER } else { ON_THE_WAY };
        context.add_once(index, what, Diagnostic::new(code, span, what));
        return;
    }
    let sides = [(context.source, Side::Source), (context.target, Side::Target)];
    let said = sides.into_iter().filter_map(|(control, side)| Some((along_plane(control)?, side)));
    let said = said.filter(|(row, _)| row.value != "any");
    if let Some((row, side)) = said.clone().find(|(row, _)| row.value == "xy") {
        let source = &row.origin().source;
        let (code, what) = if known {
            let what = format!(
                "a drilling cycle under G18 or G19: the {side} drills under G17 alone ({source}). Write the moves of the holes"
            );
            (Code::NoEquivalent, what)
        } else {
            let what = format!(
                "the plane of this drilling cycle depends on the path: make sure that it is G17, which the {side}'s cycles need"
            );
            (Code::Conditional, what)
        };
        context.add_once(index, &what, Diagnostic::new(code, span, what.clone()));
        return;
    }
    for (_, side) in said {
        match side {
            Side::Source => context.rests_on_source(index, span, Question::CyclePlane),
            Side::Target => context.rests_on_target(index, span, Question::CyclePlane),
        }
    }
}
