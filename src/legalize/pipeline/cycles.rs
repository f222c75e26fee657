//! The passes of drilling cycles, waits and dwells, in the order they run in.

use super::Pass;
use super::lathe::is_mill;
use crate::canon::{Op, Role};
use crate::legalize::codes::{lookahead, waits};
use crate::legalize::cycles::{
    cycle_ends, cycle_here, cycle_planes, cycle_words, dwell, even_pecks, first_holes, hole_moves,
    missing_pecks, shift_ways, tap_retracts, uneven_pecks,
};
use crate::legalize::features::{Feature, Features};
use crate::legalize::operator::alarms;

/// True if the library drills.
fn drills(features: &Features) -> bool {
    features.any_op(|op| op.is_cycle() || matches!(op, Op::CycleHere | Op::ReturnR | Op::ReturnInitial))
}

pub(super) const CYCLES: &[Pass] = &[
    Pass::reports("alarms", "checks alarm numbers that the target does not take", alarms::run)
        .when(|c, _| c.has(Feature::Message)),
    Pass::rewrites("lookahead", "waits for the moves become what holds the target back", lookahead::run)
        .when(|c, _| c.has(Feature::Wait) || c.has(Feature::Emptied)),
    Pass::edits("waits", "what is read before the moves are done waits for them", waits::run)
        .when(waits::concerns)
        .needs(&["state", "lookahead"]),
    Pass::edits(
        "tap-retracts",
        "how much faster a tap comes out is left out where there is no word for it",
        tap_retracts::run,
    )
    .when(tap_retracts::concerns),
    Pass::rewrites("hole-moves", "holes become moves, where cycles take no planes", hole_moves::run)
        .when(|c, context| is_mill(context) && drills(c) && hole_moves::replaces(context.target))
        .needs(&["modal-calls", "units", "tool-lengths"])
        .changes_flow(),
    Pass::rewrites(
        "uneven-pecks",
        "pecks that become less, or that wait, are moves where the target has none such",
        uneven_pecks::run,
    )
    .when(|c, context| is_mill(context) && uneven_pecks::concerns(c) && !hole_moves::replaces(context.target))
    .needs(&["modal-calls", "units", "tool-lengths"])
    .changes_flow(),
    Pass::rewrites("dwell", "dwells get the target's unit", dwell::run)
        .when(|c, _| c.op(Op::Dwell) || c.role(Role::CycleDwell))
        .needs(&["hole-moves", "uneven-pecks"]),
    Pass::edits("first-holes", "cycles that are only stored begin at their first hole", first_holes::run)
        .when(|c, context| {
            is_mill(context) && first_holes::concerns(c, context) && !hole_moves::replaces(context.target)
        })
        .needs(&["hole-moves", "uneven-pecks"]),
    Pass::rewrites("cycle-here", "a cycle at the present place gets that place", cycle_here::run)
        .when(|c, context| is_mill(context) && drills(c) && !hole_moves::replaces(context.target)),
    Pass::rewrites(
        "cycle-ends",
        "cycles that motion does not end there are ended before it",
        cycle_ends::run,
    )
    .when(|c, context| {
        let open = c.has(Feature::Code) || context.chained || context.drills;
        cycle_ends::concerns(c, context) && (open || !hole_moves::replaces(context.target))
    })
    .needs(&["cycle-here"]),
    Pass::rewrites(
        "cycle-planes",
        "retract planes are told again where a cycle goes on from another",
        cycle_planes::run,
    )
    .when(cycle_planes::concerns)
    .needs(&["cycle-here"]),
    Pass::edits("even-pecks", "pecks that are all as deep as the first are told by Q", even_pecks::run).when(
        |c, context| is_mill(context) && even_pecks::concerns(c) && !hole_moves::replaces(context.target),
    ),
    Pass::rewrites("missing-pecks", "peck cycles that are told no pecks drill in one go", missing_pecks::run)
        .when(|c, context| is_mill(context) && missing_pecks::concerns(c, context))
        .needs(&["cycle-here", "even-pecks"]),
    Pass::edits("shift-ways", "boring bars leave the wall the way they do on the source", shift_ways::run)
        .when(shift_ways::concerns)
        .needs(&["cycle-here"]),
    Pass::rewrites("cycle-words", "words last for the cycles that they lasted for", cycle_words::run)
        .when(|c, context| {
            let words = cycle_words::ROLES.iter().any(|role| c.role(*role));
            is_mill(context) && words && !hole_moves::replaces(context.target)
        })
        .needs(&["dwell", "cycle-here"]),
];
