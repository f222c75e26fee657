//! The passes that look at what the programs rest on at the source, in the order they run in.

use super::Pass;
use super::lathe::{HELD_HOLES, HOLE_CODES, INTERPOLATIONS, LASTING_PECKS, LONE_PASSES};
use super::moves::{LATER_LENGTHS, NAMED_LENGTHS};
use crate::canon::Op;
use crate::legalize::assumptions::{
    bare_changes, changes, cutter_tables, facts, machine_places, missing_axes, runtime, shop, top_speed,
    top_tool, unchanged_tools,
};
use crate::legalize::calls::parts;
use crate::legalize::cycles::{
    cycle_arcs, cycle_waits, drill_planes, inherited_words, lone_words, missing_planes, plane_variables,
    spindle_starts, stored_places,
};
use crate::legalize::features::Feature;
use crate::legalize::lathe::{contour_numbers, other_kind};
use crate::legalize::layout::{line_comments, skip_runs};
use crate::legalize::moves::{bare_feeds, first_increments};
use crate::legalize::offsets::{arc_starts, known_tools, missing_length, missing_radius};
use crate::legalize::variables::last_words;

/// Before a block that only seems to be comments is one.
pub(super) const LINE_COMMENTS: Pass = Pass::edits(
    "line-comments",
    "comments after the end of a block, on its line, stand in that block",
    line_comments::run,
)
.brings_nothing();

/// Before what is read is folded away.
pub(super) const READ: &[Pass] = &[
    Pass::rewrites(
        "contour-numbers",
        "numbers that cycles find in their first block stand there alone",
        contour_numbers::run,
    )
    .when(|c, _| contour_numbers::concerns(c)),
    Pass::rewrites("parts", "parts of programs that calls enter become programs", parts::run)
        .when(|c, _| c.has(Feature::Call))
        .adds_programs(),
    Pass::each(
        "skip-runs",
        "blocks with a block skip that follow each other become one way round them",
        skip_runs::together,
    )
    .when(|c, _| c.has(Feature::Skip))
    .changes_flow(),
    Pass::edits(
        "known-tools",
        "comparisons with the tool in the spindle that tool words are go, where it is known",
        known_tools::run,
    )
    .when(|c, _| c.has(Feature::System) && c.op(Op::ToolChange))
    .changes_flow(),
    Pass::edits(
        "last-words",
        "numbers of tool offsets and codes that are read become constants or registers",
        last_words::run,
    )
    .when(last_words::concerns)
    .changes_flow(),
];

pub(super) const SOURCE: &[Pass] = &[
    Pass::reports(
        "source-facts",
        "reports unconfirmed facts of the source that vacant variables depend on",
        facts::of_source,
    )
    .when(|c, _| c.has(Feature::Computed)),
    Pass::edits("other-kind", "refuses programs of the other kind of machine", other_kind::run)
        .when(other_kind::concerns),
    Pass::edits(
        "bare-feeds",
        "feeds without a decimal point get the value that the modes give",
        bare_feeds::run,
    )
    .when(bare_feeds::concerns),
    LASTING_PECKS,
    HELD_HOLES,
    HOLE_CODES,
    INTERPOLATIONS,
    LONE_PASSES,
    Pass::edits(
        "inherited-words",
        "words of a cycle that callers have in force are the cycle's",
        inherited_words::run,
    )
    .when(inherited_words::concerns),
    Pass::edits(
        "stored-places",
        "a place beside a repeat of none is gone to before its cycle",
        stored_places::run,
    )
    .when(stored_places::concerns),
    Pass::reports("cycle-arcs", "refuses arcs under drilling cycles that they do not end", cycle_arcs::run)
        .when(cycle_arcs::concerns),
    Pass::reports("drill-planes", "checks drilling cycles in other planes than G17", drill_planes::run)
        .when(drill_planes::concerns),
    Pass::reports(
        "plane-variables",
        "refuses changes of the variables that a cycle in force has its planes from",
        plane_variables::run,
    )
    .when(plane_variables::concerns),
    Pass::reports(
        "cycle-waits",
        "refuses waits inside drilling cycles whose time is the cycle's too",
        cycle_waits::run,
    )
    .when(cycle_waits::concerns),
    Pass::edits("lone-words", "words of a cycle that the source ignores go", lone_words::run)
        .when(lone_words::concerns),
    Pass::reports(
        "missing-planes",
        "tells of drilling cycles that are told no retract plane",
        missing_planes::run,
    )
    .when(missing_planes::concerns),
    Pass::reports(
        "missing-length",
        "tells of tool lengths whose number no block ever named",
        missing_length::run,
    )
    .when(missing_length::concerns),
    Pass::reports(
        "missing-radius",
        "tells of cutter compensation in programs that name no cutter radius",
        missing_radius::run,
    )
    .when(missing_radius::concerns),
    Pass::reports("arc-starts", "refuses cutter compensation that begins or ends on an arc", arc_starts::run)
        .when(arc_starts::concerns),
    Pass::reports("first-increments", "tells of increments right after a rotation", first_increments::run)
        .when(first_increments::concerns),
    LATER_LENGTHS,
    NAMED_LENGTHS,
    Pass::reports("shop-facts", "reports what parameters of the machines decide", shop::run)
        .when(shop::concerns),
    Pass::edits(
        "machine-places",
        "moves go to the target's places in machine coordinates, or these are asked",
        machine_places::run,
    )
    .when(machine_places::concerns),
    Pass::reports(
        "cutter-tables",
        "tells of cutter tables that hold radii on one machine and diameters on the other",
        cutter_tables::run,
    )
    .when(cutter_tables::concerns),
    Pass::reports("top-speed", "tells of speeds that the target's spindle does not turn", top_speed::run)
        .when(top_speed::concerns),
    Pass::reports("top-tool", "tells of tools that the target's magazine does not hold", top_tool::run)
        .when(top_tool::concerns),
    Pass::reports("missing-axes", "refuses words of axes that the target does not have", missing_axes::run)
        .when(missing_axes::concerns),
    Pass::edits(
        "bare-changes",
        "tool changes for which no tool was named name it, or are told",
        bare_changes::run,
    )
    .when(bare_changes::concerns),
    Pass::reports("unchanged-tools", "tells of tools that no program changes to", unchanged_tools::run)
        .when(unchanged_tools::concerns),
    Pass::reports("changes", "reports moves after tool changes that may leave Z where it was", changes::run)
        .when(changes::concerns),
    Pass::edits(
        "spindle-starts",
        "spindles that the source's cycle turns are turned before it",
        spindle_starts::run,
    )
    .when(spindle_starts::concerns),
    Pass::reports("runtime-assumptions", "reports what holds only for some values of a run", runtime::run)
        .when(|c, _| runtime::concerns(c)),
];
