//! The passes of moves, coordinates and units, in the order they run in.

use super::Pass;
use super::lathe::is_mill;
use crate::canon::{Op, Role};
use crate::legalize::assumptions::barred;
use crate::legalize::codes::offset_chains;
use crate::legalize::cycles::{
    hole_circles, leadless_taps, pockets, rigid_cycles, rigid_taps, tap_leads, tapping, turn_feeds,
};
use crate::legalize::features::Feature;
use crate::legalize::moves::{
    absolute_places, added_angles, bare_arcs, home, increments, inverse_feeds, long_arcs, machine_feeds,
    machine_moves, off_circle, polar, polar_mode, rapid_once, reference, rotary_turns, rotary_ways,
    rotations, second_home, shaped, shift, short_arcs, turn_cuts, under_increments, unit_agrees, unit_checks,
    units, way_home, word_rounds,
};
use crate::legalize::offsets::{
    active_offsets, external, folded_shifts, kept_length, kept_radius, later_lengths, left_shifts,
    length_radius, named_lengths, no_shifts, one_table, radius_words, set_position, table_writes,
    tool_lengths, tools_at_change, written_tools,
};

/// Where computed codes and jumps are written out.
pub(super) const OFFSET_CHAINS: Pass = Pass::rewrites(
    "offset-chains",
    "computed work offsets become comparisons with each number",
    offset_chains::run,
)
.when(offset_chains::concerns)
.needs(&["jump-chains"])
.changes_flow();

/// Before the tool lengths are asked about.
pub(super) const LATER_LENGTHS: Pass = Pass::edits(
    "later-lengths",
    "lengths whose codes move Z on the target alone go beside the next move along it",
    later_lengths::run,
)
.when(later_lengths::concerns);

/// Where the source moves by them.
pub(super) const NAMED_LENGTHS: Pass = Pass::edits(
    "named-lengths",
    "lengths whose codes move Z on the source alone name the place where Z goes",
    named_lengths::run,
)
.when(named_lengths::concerns);

pub(super) const MOVES: &[Pass] = &[
    Pass::reports("barred", "refuses what settings of the machines give another meaning", barred::run)
        .when(|_, context| barred::concerns(context)),
    Pass::edits("way-home", "Z0 without a tool length is home where it was", way_home::run)
        .when(way_home::concerns),
    Pass::edits(
        "rotary-ways",
        "angles of rotary axes have the sign of their way, or what was turned",
        rotary_ways::run,
    )
    .when(rotary_ways::concerns),
    Pass::rewrites("polar-mode", "polar coordinates become rectangular ones", polar_mode::run)
        .when(|c, context| (c.op(Op::PolarOn) || c.op(Op::PolarOff)) && polar_mode::concerns(context.target))
        .needs(&["modal-calls"]),
    Pass::rewrites("polar", "polar words become rectangular ones", polar::run)
        .when(|c, _| c.op(Op::Pole) || c.role(Role::PolarAngle) || c.role(Role::PolarDistance))
        .needs(&["polar-mode"]),
    Pass::edits("bare-arcs", "arcs without centre and radius that go straight say so", bare_arcs::run)
        .when(|c, _| c.op(Op::ArcCw) || c.op(Op::ArcCcw)),
    Pass::reports("off-circle", "checks that arcs end on their circle", off_circle::run)
        .when(|c, context| off_circle::concerns(c, context.source)),
    Pass::reports(
        "inverse-feeds",
        "checks that feeds of inverse time are said where they count",
        inverse_feeds::run,
    )
    .when(|c, _| inverse_feeds::concerns(c)),
    Pass::reports("set-position", "checks work offsets selected after a set position", set_position::run)
        .when(set_position::concerns),
    Pass::edits("external", "shifts that share a register on one control are kept apart", external::run)
        .when(|c, _| c.has(Feature::System) || c.op(Op::WriteWork) || c.op(Op::LocalShift)),
    Pass::edits(
        "left-shifts",
        "local shifts end where the source's end of the program ends them",
        left_shifts::run,
    )
    .when(left_shifts::concerns)
    .needs(&["external"]),
    Pass::rewrites(
        "machine-feeds",
        "moves in machine coordinates that feed become increments",
        machine_feeds::run,
    )
    .when(machine_feeds::concerns),
    Pass::rewrites("shaped", "mirrors, rotations and scalings mean the same", shaped::run)
        .when(|c, _| [Op::RotateOn, Op::ScaleOn, Op::MirrorOn, Op::MirrorOff].iter().any(|op| c.op(*op))),
    Pass::reports("added-angles", "tells of angles of rotations that may add up", added_angles::run)
        .when(added_angles::concerns),
    Pass::rewrites(
        "absolute-places",
        "machine coordinates under G91 get G90, where the target's meaning is not known",
        absolute_places::run,
    )
    .when(absolute_places::concerns),
    Pass::reports(
        "under-increments",
        "tells of machine coordinates and centres of rotations under G91",
        under_increments::run,
    )
    .when(under_increments::concerns),
    Pass::edits("increments", "numbers without a decimal point get the target's form", increments::run)
        .when(|c, _| c.has(Feature::Increments)),
    Pass::edits(
        "folded-shifts",
        "local shifts are counted into the coordinates where the target has none",
        folded_shifts::run,
    )
    .when(folded_shifts::concerns)
    .needs(&["increments", "modal-calls"]),
    Pass::edits("no-shifts", "local shifts of 0 need nothing where the target has none", no_shifts::run)
        .when(no_shifts::concerns)
        .needs(&["folded-shifts"]),
    Pass::edits("hole-circles", "holes on a circle get blocks of their own", hole_circles::run)
        .when(|c, _| hole_circles::concerns(c))
        .needs(&["increments"]),
    Pass::rewrites("pockets", "round pockets become arcs, less the radius of their tool", pockets::run)
        .when(|c, _| pockets::concerns(c))
        .needs(&["increments"])
        .changes_flow(),
    Pass::edits("word-rounds", "ROUND in words becomes arithmetic", word_rounds::run)
        .when(word_rounds::concerns),
    Pass::edits(
        "one-table",
        "rows of one number become lengths or radii, where the target holds them apart",
        one_table::run,
    )
    .when(one_table::concerns),
    Pass::rewrites("table-writes", "offset tables are written as state", table_writes::run)
        .when(table_writes::concerns)
        .needs(&["external", "increments", "one-table"])
        .changes_flow(),
    Pass::reports(
        "active-offsets",
        "checks work offsets that are written while selected",
        active_offsets::run,
    )
    .when(active_offsets::concerns)
    .needs(&["table-writes"]),
    Pass::reports(
        "written-tools",
        "tells of lengths and radii that are written while in force",
        written_tools::run,
    )
    .when(written_tools::concerns)
    .needs(&["table-writes"]),
    Pass::edits("units", "programs that name no unit get one", units::run)
        .when(units::concerns)
        .needs(&["increments", "modal-calls"]),
    Pass::rewrites("unit-checks", "a unit that the target cannot select is checked", unit_checks::run)
        .when(unit_checks::concerns)
        .needs(&["units"]),
    Pass::reports("unit-agrees", "tells of the unit that the target is not set to", unit_agrees::run)
        .when(unit_agrees::concerns)
        .needs(&["units"]),
    Pass::rewrites("rotations", "what stands under a rotation is turned", rotations::run)
        .when(|c, context| (c.op(Op::RotateOn) || c.op(Op::RotateOff)) && rotations::concerns(context.target))
        .needs(&["polar", "increments", "modal-calls"]),
    Pass::rewrites(
        "rapid-once",
        "the interpolation is written again after a rapid move that keeps it",
        rapid_once::run,
    )
    .when(|c, _| c.op(Op::RapidOnce)),
    Pass::rewrites(
        "length-radius",
        "radii that a tool length picks stay where they count",
        length_radius::run,
    )
    .when(|c, _| c.role(Role::RadiusOffset)),
    Pass::rewrites(
        "kept-radius",
        "radii that a tool length takes the place of are named again",
        kept_radius::run,
    )
    .when(kept_radius::concerns)
    .needs(&["length-radius"]),
    Pass::edits(
        "rigid-cycles",
        "rigid taps by a cycle of their own are told in the way of the target",
        rigid_cycles::run,
    )
    .when(rigid_cycles::concerns),
    Pass::edits(
        "rigid-taps",
        "the code for rigid taps stands only where taps are rigid by it",
        rigid_taps::run,
    )
    .when(rigid_taps::concerns),
    Pass::edits("turn-feeds", "taps in feed per turn feed per minute", turn_feeds::run)
        .when(|c, context| is_mill(context) && turn_feeds::concerns(c, context)),
    Pass::edits("turn-cuts", "cuts in feed per turn feed per minute", turn_cuts::run)
        .when(|c, context| is_mill(context) && turn_cuts::concerns(c, context))
        .needs(&["turn-feeds"]),
    Pass::reports("leadless-taps", "refuses taps that are told no lead", leadless_taps::run)
        .when(leadless_taps::concerns),
    Pass::rewrites("tapping", "taps by lead get a feed", tapping::run).when(|c, _| c.role(Role::Lead)),
    Pass::rewrites("tap-leads", "taps by feed get a lead", tap_leads::run).when(tap_leads::concerns),
    Pass::rewrites("reference", "returns to the reference position name their axes", reference::run)
        .when(|c, _| c.op(Op::ReferenceReturn)),
    Pass::rewrites("kept-length", "the tool length after a return is written out", kept_length::run)
        .when(|c, _| {
            c.role(Role::LengthOffset)
                && c.any_op(|op| {
                    matches!(op, Op::ReferenceReturn | Op::Reference2 | Op::MachineOnce | Op::ToolChange)
                })
        })
        .needs(&["reference", "increments"]),
    Pass::rewrites(
        "shift",
        "moves under a cancelled zero shift become moves in machine coordinates",
        shift::run,
    )
    .when(|c, _| c.op(Op::ShiftCancel))
    .needs(&["modal-calls"]),
    Pass::rewrites(
        "home",
        "returns to the reference position become moves in machine coordinates",
        home::run,
    )
    .when(|c, context| c.op(Op::ReferenceReturn) && home::concerns(context.target))
    .needs(&["reference", "kept-length"]),
    Pass::rewrites(
        "second-home",
        "returns to the second reference position become moves to the place for it",
        second_home::run,
    )
    .when(|c, context| c.op(Op::Reference2) && second_home::concerns(context.target))
    .needs(&["reference", "kept-length"]),
    Pass::rewrites(
        "machine-moves",
        "moves in machine coordinates cancel the zero shifts, and select them again",
        machine_moves::run,
    )
    .when(|c, context| c.op(Op::MachineOnce) && machine_moves::concerns(context.target))
    .needs(&["home", "shift", "kept-length"]),
    Pass::rewrites(
        "tool-lengths",
        "lengths come with the tools, where the tool word brings them",
        tool_lengths::run,
    )
    .when(|_, context| tool_lengths::concerns(context.target))
    .changes_flow()
    .needs(&["machine-moves"]),
    Pass::rewrites(
        "tools-at-change",
        "tools are named at their change, where the tool word is the change",
        tools_at_change::run,
    )
    .when(|c, context| {
        let named = c.op(Op::ToolChange) || c.role(Role::Tool);
        named && tools_at_change::concerns(context.source, context.target)
    })
    .needs(&["tool-lengths"]),
    Pass::rewrites(
        "radius-words",
        "numbers of cutter radii go to the codes that compensate by them",
        radius_words::run,
    )
    .when(|c, context| {
        (c.role(Role::RadiusOffset) || c.op(Op::RadiusLeft) || c.op(Op::RadiusRight))
            && radius_words::concerns(context.source, context.target)
    })
    .needs(&["length-radius"]),
    Pass::rewrites(
        "short-arcs",
        "arcs are written by their radius, the long ones in pieces",
        short_arcs::run,
    )
    .when(|c, context| (c.op(Op::ArcCw) || c.op(Op::ArcCcw)) && short_arcs::concerns(context.target))
    .changes_flow()
    .needs(&["modal-calls", "units", "bare-arcs"]),
    Pass::rewrites("long-arcs", "longer arcs by their radius are written by their centre", long_arcs::run)
        .when(|c, context| c.role(Role::ArcRadius) && long_arcs::concerns(context.target))
        .needs(&["modal-calls", "units", "bare-arcs"]),
    Pass::rewrites("rotary-turns", "long turns of rotary axes are cut into blocks", rotary_turns::run)
        .when(rotary_turns::concerns)
        .needs(&["rotary-ways", "modal-calls"]),
];
