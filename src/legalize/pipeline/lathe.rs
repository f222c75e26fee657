//! The passes of lathes, in the order they run in.

use super::Pass;
use crate::canon::{Op, Role};
use crate::dialect::Machine;
use crate::legalize::Context;
use crate::legalize::lathe::{
    bare_passes, bare_starts, contour_ends, contour_left, contour_nose, contour_types, contours, corners,
    counts, cycle_words, faces, geometry_rows, held_holes, hole_codes, hole_returns, holes, inch_leads,
    interpolations, lasting_pecks, lone_passes, modes, none_offsets, pass_run_outs, roughing, run_outs,
    short_tools, steps, tap_feeds, thread_ways, written_corners, x_counts, zeros,
};
use crate::legalize::moves::rapid_in_force;

/// True for a target whose cycles drill along the axis of their plane; those of lathes have passes of their own.
pub(super) fn is_mill(context: &Context<'_>) -> bool {
    context.target.machine() == Machine::Mill
}

pub(super) const LASTING_PECKS: Pass = Pass::edits(
    "lasting-pecks",
    "holes without a peck get that of their cycle, where it lasts",
    lasting_pecks::run,
)
.when(lasting_pecks::concerns);

pub(super) const HELD_HOLES: Pass = Pass::edits(
    "held-holes",
    "holes that a code of their block clamps the C axis for are told step by step",
    held_holes::run,
)
.when(held_holes::concerns);

pub(super) const HOLE_CODES: Pass = Pass::reports(
    "hole-codes",
    "refuses M codes and tool words in the drilling blocks of lathes",
    hole_codes::run,
)
.when(|c, _| c.any_op(Op::is_hole));

pub(super) const LONE_PASSES: Pass = Pass::edits(
    "lone-passes",
    "M, S and T alone repeat a turning pass on the target as they do on the source",
    lone_passes::run,
)
.when(lone_passes::concerns);

const PASS_ENDS: Pass = Pass::edits(
    "pass-ends",
    "the pass in force ends before M, S and T alone, where the target would make it once more",
    lone_passes::run,
)
.when(lone_passes::ends)
.needs(&["start", "beside-moves", "pauses"]);

pub(super) const INTERPOLATIONS: Pass = Pass::reports(
    "interpolations",
    "reports what milling with the C axis on a face rests on",
    interpolations::run,
)
.when(interpolations::concerns);

pub(super) const BARE_PASSES: Pass =
    Pass::edits("bare-passes", "codes of passes that stand without a word fall away", bare_passes::run)
        .when(bare_passes::concerns);

pub(super) const FACES: Pass =
    Pass::edits("faces", "milling with the C axis on a face is told in the words of the target", faces::run)
        .when(faces::concerns)
        .needs(&["start", "beside-moves"]);

pub(super) const LATHE: &[Pass] = &[
    Pass::edits(
        "bare-starts",
        "numbers of contours that stand in blocks without words go to the next block",
        bare_starts::run,
    )
    .when(bare_starts::concerns),
    Pass::edits(
        "contour-ends",
        "contours end before a last block that the target does not take; finishing is moves",
        contour_ends::run,
    )
    .when(contour_ends::concerns)
    .needs(&["start", "beside-moves", "bare-starts"]),
    PASS_ENDS,
    Pass::edits("corners", "corners lose the sign that says which way the next block goes", corners::run)
        .when(|c, _| corners::concerns(c))
        .needs(&["start", "beside-moves"]),
    Pass::edits(
        "written-corners",
        "corners and lines by their angle become moves where the target has no words for them",
        written_corners::run,
    )
    .when(written_corners::concerns)
    .needs(&["corners", "increments", "units"]),
    Pass::reports("zeros", "refuses increments of zeros and tables that no source explains", zeros::run)
        .when(zeros::concerns),
    Pass::reports(
        "contour-left",
        "refuses a contour after which nobody knows whether places are absolute",
        contour_left::run,
    )
    .when(|c, _| contour_left::concerns(c))
    .needs(&["start", "bare-starts"]),
    Pass::edits("steps", "increments that a mode tells get letters of their own", steps::to_letters)
        .when(steps::mode_to_letters)
        .needs(&["start", "beside-moves"]),
    Pass::edits(
        "lathe-lengths",
        "pecks and depths of a lathe's cycles that count become lengths",
        counts::to_lengths,
    )
    .when(counts::counts_there)
    .needs(&["units"]),
    Pass::edits(
        "hole-returns",
        "holes of a lathe end where they ended, where only one control chooses that",
        hole_returns::run,
    )
    .when(hole_returns::concerns)
    .needs(&["steps", "hole-codes"]),
    Pass::edits(
        "tap-feeds",
        "taps in feed a minute get their lead, where the target's take it",
        tap_feeds::run,
    )
    .when(tap_feeds::concerns)
    .needs(&["hole-returns"]),
    Pass::edits("holes", "drilling cycles of a lathe get the target's planes and codes", holes::run)
        .when(holes::concerns)
        .needs(&["steps", "lathe-lengths", "hole-returns", "tap-feeds"]),
    Pass::reports(
        "thread-ways",
        "tells of threads that may take the P of a code before them",
        thread_ways::run,
    )
    .when(thread_ways::concerns),
    Pass::edits(
        "thread-ends",
        "single passes of threads run out as they do on the source",
        pass_run_outs::run,
    )
    .when(|c, _| c.op(Op::ThreadingPass)),
    Pass::reports("hole-pecks", "checks how far the pecks of a lathe's holes go back", holes::pecks)
        .when(|c, _| c.any_op(Op::is_hole) && c.role(Role::CycleQ)),
    Pass::rewrites("run-outs", "threads are told that they do not run out by a word", run_outs::run)
        .when(|c, context| run_outs::concerns(c, context.target)),
    Pass::reports(
        "none-offsets",
        "reports moves under offset 00, where the two lathes do not take the same away by it",
        none_offsets::run,
    )
    .when(none_offsets::concerns),
    Pass::reports("short-tools", "asks what T words of one or two digits say", short_tools::run)
        .when(short_tools::concerns),
    Pass::reports(
        "geometry-rows",
        "reports T words of two numbers, if the two lathes take the geometry by another one",
        geometry_rows::run,
    )
    .when(geometry_rows::concerns),
    Pass::reports(
        "lathe-modes",
        "asks what threads in feed a minute and changes of the speed's mode rest on",
        modes::run,
    )
    .when(|c, _| modes::concerns(c)),
    Pass::edits_some(
        "lathe-cycles",
        "cycles of a lathe take their values where the target does; threads without one are moves",
        cycle_words::run,
    )
    .when(cycle_words::concerns)
    .needs(&["steps", "lathe-lengths", "run-outs"])
    .changes_flow(),
    Pass::edits("inch-leads", "threads an inch become leads", inch_leads::run)
        .when(inch_leads::concerns)
        .needs(&["units"]),
    Pass::edits("step-modes", "increments that letters tell get a mode", steps::to_mode)
        .when(steps::letters_to_mode)
        .needs(&["beside-moves", "holes", "lathe-cycles"]),
    Pass::edits(
        "lathe-counts",
        "pecks and depths of a lathe's cycles count where the target counts",
        counts::to_counts,
    )
    .when(counts::counts_here)
    .needs(&["units", "lathe-cycles"]),
    Pass::edits(
        "rapid-in-force",
        "moves in machine coordinates get the code of the rapid that they need there",
        rapid_in_force::run,
    )
    .when(rapid_in_force::concerns)
    .needs(&["home", "second-home", "lathe-cycles"]),
    Pass::rewrites(
        "contour-types",
        "contours with valleys are told to the target by a word, or by their first block",
        contour_types::run,
    )
    .when(contour_types::concerns)
    .needs(&["lathe-cycles"]),
    Pass::reports("roughing", "checks that the roughing of contours ends alike", roughing::run)
        .when(roughing::concerns),
    Pass::reports(
        "contour-nose",
        "reports compensation in contours that the target may stop at",
        contour_nose::run,
    )
    .when(contour_nose::concerns),
    Pass::reports("contours", "checks that the contours of cycles are whole", contours::run)
        .when(|c, _| contours::concerns(c))
        .needs(&["lathe-cycles", "beside-moves", "pauses"]),
    Pass::edits("x-counts", "X is a radius, where the target is set to radii", x_counts::run)
        .when(x_counts::concerns)
        .needs(&["lathe-counts", "written-corners"]),
];
