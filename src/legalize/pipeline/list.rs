//! The passes, in the order they run in.

use super::cycles::CYCLES;
use super::late::{ENTRY, EXPRESSIONS, LAYOUT, OPERATOR, REGISTERS};
use super::moves::MOVES;
use super::source::{READ, SOURCE};
use super::{Group, Pass};
use crate::canon::{Op, Role};
use crate::dialect::Question;
use crate::legalize::calls::{
    chain, jump_chains, link, main_returns, modal_calls, modal_off, nesting, outline, repeat_loops, repeats,
    text_returns,
};
use crate::legalize::codes::{
    act_speeds, acts, beside_moves, by_number, c_axis, code_chains, forbidden, machine_codes, missing,
    pauses, substitutes, through_coolant,
};
use crate::legalize::expressions::halves;
use crate::legalize::features::Feature;
use crate::legalize::layout::{blanks, counted, heads, scratch, text_ends};
use crate::legalize::moves::{joined, mixed_places, other_start, probed_places, start};
use crate::legalize::offsets::{
    argument_offsets, offset_numbers, offset_rows, position_length, tool_groups, tool_word,
};
use crate::legalize::operator::{formatted, omitted, shown_stops, variable_names};
use crate::legalize::variables::{
    banks, computed_numbers, counted_clears, dates, modal_reads, most_values, output_codes, output_states,
    probe_points, signals, state, subscript_chains, timers, touch_points, vacant_writes,
};
use crate::opt::{
    Branches, CopyPropagation, DeadStores, Fold, Nested, Retarget, Unreachable, WholeParts, WordValues,
};

/// The passes from lowering to emission.
pub const GROUPS: &[Group] = &[
    Group { name: "earlier", heading: "What an earlier conversion left", passes: EARLIER },
    Group { name: "read", heading: "Numbers and codes in force that programs read", passes: READ },
    Group { name: "tidy", heading: "What lowering put in, tidier", passes: TIDY },
    Group { name: "source", heading: "What the programs rest on at the source", passes: SOURCE },
    Group {
        name: "structure",
        heading: "Programs and subroutines that the target can hold",
        passes: STRUCTURE,
    },
    Group { name: "blocks", heading: "When the codes of a block act", passes: BLOCKS },
    Group { name: "calls", heading: "Calls, repeats and returns", passes: CALLS },
    Group { name: "moves", heading: "Moves, coordinates and units", passes: MOVES },
    Group { name: "variables", heading: "Computed variables and the machine's state", passes: VARIABLES },
    Group { name: "cycles", heading: "Stops, waits and drilling cycles", passes: CYCLES },
    Group { name: "lathe", heading: "Cycles and contours of lathes", passes: super::lathe::LATHE },
    Group { name: "codes", heading: "Codes that the target lacks", passes: CODES },
    Group { name: "expressions", heading: "Expressions that the target can read", passes: EXPRESSIONS },
    Group { name: "entry", heading: "What must be done at the start of programs", passes: ENTRY },
    Group { name: "tidy-legal", heading: "What legalization put in, tidier", passes: TIDY_LEGAL },
    Group { name: "registers", heading: "Registers for all variables of the library", passes: REGISTERS },
    Group { name: "operator", heading: "What the operator reads and answers", passes: OPERATOR },
    Group { name: "layout", heading: "Numbers of blocks and programs", passes: LAYOUT },
];

const FOLD: Pass = Pass::tidies(&Fold, "fold", "values that can be computed here are computed");
const RETARGET: Pass =
    Pass::tidies(&Retarget, "retarget", "a value goes straight to the variable that its copy went to");
const BRANCHES: Pass =
    Pass::tidies(&Branches, "branches", "branches with one way, and jumps to jumps, become jumps");
const UNREACHABLE: Pass =
    Pass::tidies(&Unreachable, "unreachable", "blocks that nothing reaches are removed");
const DEAD_STORES: Pass =
    Pass::tidies(&DeadStores, "dead-stores", "temporaries that nothing reads are removed");

const EARLIER: &[Pass] = &[
    super::source::LINE_COMMENTS,
    Pass::edits("heads", "heads of an earlier conversion go, as this one writes its own", heads::run),
    Pass::edits(
        "counted-clears",
        "loops by which an earlier conversion set registers in a row are written out",
        counted_clears::run,
    )
    .when(counted_clears::concerns)
    .needs(&["heads"])
    .changes_flow(),
    Pass::edits("counted", "numbers that only count an earlier conversion's blocks go", counted::run)
        .when(counted::concerns)
        .needs(&["heads"]),
    Pass::edits(
        "joined",
        "codes that an earlier conversion wrote before their move go beside it",
        joined::run,
    )
    .when(joined::concerns)
    .needs(&["heads"]),
    Pass::edits("text-ends", "jumps to the end of the text end it", text_ends::run)
        .when(text_ends::concerns)
        .needs(&["heads"])
        .changes_flow(),
    Pass::edits("scratch", "registers that an earlier conversion took are temporaries again", scratch::run)
        .when(scratch::concerns)
        .needs(&["heads"]),
    Pass::edits("shown-stops", "a text that is shown right before a stop is its message", shown_stops::run)
        .when(shown_stops::concerns),
    // A temporary that only another one reads, which nothing reads, is no part of an expression.
    DEAD_STORES.when(scratch::concerns),
    Pass::tidies(
        &WholeParts,
        "whole-parts",
        "the steps by which an earlier conversion took a whole part are a function again",
    )
    .when(scratch::concerns),
    Pass::tidies(
        &Nested,
        "nested",
        "parts of an expression that an earlier conversion put into temporaries go back into it",
    )
    .when(scratch::concerns),
    Pass::tidies(
        &WordValues,
        "word-values",
        "a value goes straight into the word that its temporary was set for",
    )
    .when(scratch::concerns),
    Pass::edits("halves", "halves that an earlier conversion doubled are the numbers again", halves::run)
        .when(halves::concerns)
        .needs(&["heads"]),
];

const TIDY: &[Pass] = &[
    Pass::tidies(
        &CopyPropagation,
        "copy-propagation",
        "reads of a temporary that only holds another value become reads of that value",
    ),
    FOLD,
    RETARGET,
    BRANCHES,
    UNREACHABLE,
    DEAD_STORES,
];

const STRUCTURE: &[Pass] = &[
    Pass::edits("mixed-places", "increments beside places, in one block, become places", mixed_places::run)
        .when(mixed_places::concerns),
    Pass::rewrites("omitted", "output that the target's profile says to leave out goes", omitted::run)
        .when(omitted::concerns),
    super::late::SWITCHES,
    Pass::edits("variable-names", "names of variables go where the target shows none", variable_names::run)
        .when(variable_names::concerns),
    Pass::edits("blanks", "empty blocks that hold nothing back go", blanks::run)
        .when(|_, context| !context.source.is(Question::EmptyBlockHolds)),
    Pass::reports(
        "other-start",
        "asks what the source begins in if only the target says it",
        other_start::run,
    )
    .when(other_start::concerns),
    Pass::edits(
        "start",
        "what the source begins in stands at the heads of programs that rest on it",
        start::run,
    )
    .when(start::concerns),
    Pass::edits("link", "reports calls that leave the library", link::run)
        .when(|c, _| c.has(Feature::Call) || c.has(Feature::Chain)),
    Pass::reports(
        "text-returns",
        "refuses programs that are called and whose text ends without a return",
        text_returns::run,
    )
    .when(|c, _| c.has(Feature::Call) || c.has(Feature::Modal)),
    Pass::rewrites("outline", "subroutines inside a program go where the target wants them", outline::run)
        .when(|c, _| c.has(Feature::LocalCall))
        .needs(&["link"])
        .adds_programs(),
];

const BLOCKS: &[Pass] = &[
    super::lathe::BARE_PASSES,
    Pass::edits_some(
        "code-chains",
        "codes by a computed number become comparisons with each number",
        code_chains::run,
    )
    .when(code_chains::concerns)
    .changes_flow(),
    Pass::reports("tool-groups", "refuses offsets of the tools of a group", tool_groups::run)
        .when(tool_groups::concerns),
    Pass::reports("codes", "looks up codes that are known by number only", by_number::run)
        .when(|c, _| c.has(Feature::Code))
        .needs(&["code-chains"]),
    Pass::rewrites(
        "act-speeds",
        "codes that turn live tools get the S in force, where the target reads a word of their own",
        act_speeds::run,
    )
    .when(act_speeds::concerns)
    .needs(&["code-chains"]),
    Pass::rewrites("c-axis", "the C axis is engaged by the target's code for that", c_axis::run)
        .when(c_axis::concerns)
        .needs(&["code-chains"]),
    Pass::rewrites(
        "builders-codes",
        "builders' codes that the target has not become what the profile says",
        acts::run,
    )
    .when(|c, _| c.op(Op::Act))
    .needs(&["code-chains"]),
    Pass::edits(
        "beside-moves",
        "spindle, coolant and tool change get blocks of their own",
        beside_moves::run,
    )
    .when(|c, _| beside_moves::concerns(c))
    .needs(&["codes"]),
    Pass::edits("pauses", "what the source ends at a stop is ended before it", pauses::run)
        .when(|c, context| pauses::concerns(c, &context.entry))
        .needs(&["beside-moves"]),
    super::lathe::FACES,
];

const CALLS: &[Pass] = &[
    Pass::rewrites("chain", "going on in another program becomes a call and an end", chain::chain)
        .when(|c, _| c.has(Feature::Chain))
        .needs(&["link"])
        .changes_flow(),
    Pass::rewrites("repeats", "repeated moves become loops", repeats::run)
        .when(|c, _| c.role(Role::Repeat))
        .changes_flow(),
    Pass::rewrites("modal-off", "ends of modal calls that were never opened go", modal_off::run)
        .when(|c, context| c.has(Feature::Modal) && context.source.is(Question::CallModalOffAlone))
        .needs(&["chain"]),
    Pass::rewrites("modal-calls", "modal calls become a call after each move", modal_calls::run)
        .when(|c, _| c.has(Feature::Modal))
        .adds_programs()
        .needs(&["outline", "repeats", "modal-off"]),
    Pass::reports(
        "argument-offsets",
        "refuses calls that give tool offsets which the target does not have",
        argument_offsets::run,
    )
    .when(|c, context| c.has(Feature::Call) && offset_numbers::concerns(c, context))
    .needs(&["modal-calls"]),
    // The calls that modal calls become must look at the register too.
    Pass::rewrites(
        "return-to",
        "returns to a sequence number go by a register that the caller looks at",
        chain::return_to,
    )
    .when(|c, _| c.has(Feature::ReturnTo))
    .needs(&["modal-calls"])
    .changes_flow(),
    Pass::rewrites(
        "repeat-loops",
        "calls that run more often than a count says become loops",
        repeat_loops::run,
    )
    .when(repeat_loops::concerns)
    .needs(&["modal-calls", "return-to"])
    .changes_flow(),
    Pass::reports("main-returns", "reports returns of programs that nothing calls", main_returns::run)
        .needs(&["return-to"]),
    Pass::rewrites("jump-chains", "computed jumps become comparisons with each label", jump_chains::run)
        .when(jump_chains::concerns)
        .needs(&["return-to"])
        .changes_flow(),
    super::moves::OFFSET_CHAINS,
    Pass::reports("nesting", "reports calls that nest deeper than the target takes", nesting::run)
        .when(|c, _| c.has(Feature::Call) || c.has(Feature::LocalCall))
        .needs(&["outline", "chain", "modal-calls"]),
];

const VARIABLES: &[Pass] = &[
    Pass::edits(
        "subscript-chains",
        "variables by a computed number become comparisons with each number",
        subscript_chains::run,
    )
    .when(subscript_chains::concerns)
    .changes_flow(),
    Pass::reports("banks", "looks up computed numbers of a space of their own", banks::run)
        .when(|c, _| c.has(Feature::Indirect))
        .needs(&["subscript-chains"]),
    Pass::edits_some(
        "computed-numbers",
        "computed numbers of variables reach what they reached",
        computed_numbers::run,
    )
    .when(|c, _| c.has(Feature::Indirect)),
    Pass::rewrites(
        "vacant-writes",
        "words that may be vacant stay away from tables in diameters",
        vacant_writes::run,
    )
    .when(|c, _| (c.op(Op::WriteRadius) || c.op(Op::WriteRadiusWear)) && c.has(Feature::Variable))
    .changes_flow(),
    Pass::rewrites("probe-points", "touch points by number are kept in registers", probe_points::run)
        .changes_flow()
        .when(|c, _| c.role(Role::ProbePoint)),
    Pass::edits("modal-reads", "modal codes that are read become constants or tests", modal_reads::run)
        .when(modal_reads::concerns)
        .changes_flow(),
    Pass::rewrites("timers", "a timer that programs set becomes the seconds since the start", timers::run)
        .when(timers::concerns),
    Pass::each("dates", "dates with and without the century become each other", dates::run)
        .when(dates::concerns)
        .needs(&["computed-numbers"]),
    Pass::reports(
        "most-values",
        "checks numbers that state is set to against the target's largest",
        most_values::run,
    )
    .when(|c, _| c.has(Feature::System)),
    Pass::edits("position-length", "positions hold the tool length as they did", position_length::run)
        .when(|c, _| c.has(Feature::System) || c.has(Feature::Indirect))
        .needs(&["computed-numbers"]),
    Pass::rewrites("probed-places", "probe moves in increments go to places", probed_places::run)
        .when(probed_places::concerns)
        .needs(&["position-length"]),
    Pass::rewrites("touch-points", "places where the probe touched are kept as point 1", touch_points::run)
        .when(touch_points::concerns)
        .needs(&["computed-numbers", "position-length"]),
    Pass::reports(
        "tool-word",
        "checks whether the last tool word is the tool in the spindle",
        tool_word::run,
    )
    .when(|c, _| c.has(Feature::System)),
    Pass::each(
        "offset-rows",
        "work offsets by a computed number are found in the target's runs",
        offset_rows::run,
    )
    .when(offset_rows::concerns)
    .changes_flow(),
    Pass::each("output-codes", "outputs are switched by codes of the target's builder", output_codes::run)
        .when(output_codes::concerns)
        .needs(&["computed-numbers"])
        .changes_flow(),
    Pass::each("output-states", "outputs are switched by the target's variables", output_states::run)
        .when(output_states::concerns)
        .needs(&["output-codes"]),
    Pass::each("signals", "inputs and outputs are on where they were on", signals::run)
        .when(|c, _| c.has(Feature::System))
        .needs(&["output-states"]),
    Pass::edits_some("state", "state of the machine is read and written in the target's form", state::run)
        .when(|c, _| state::concerns(c))
        .needs(&[
            "vacant-writes",
            "modal-reads",
            "timers",
            "position-length",
            "probed-places",
            "tool-word",
            "offset-rows",
            "signals",
        ]),
];

const CODES: &[Pass] = &[
    Pass::rewrites("formatted", "output in a format is printed without one", formatted::run)
        .when(formatted::concerns),
    super::late::QUALITY_STOPS,
    Pass::each("substitutes", "operations become near relatives, for review", substitutes::run)
        .when(|c, _| substitutes::concerns(c)),
    Pass::edits(
        "through-coolant",
        "coolant through the spindle is ended where the end of coolant leaves it on",
        through_coolant::run,
    )
    .when(through_coolant::concerns),
    Pass::each("machine-codes", "a block has no more M codes than the target takes", machine_codes::run)
        .when(machine_codes::concerns)
        .needs(&["substitutes", "beside-moves", "pauses"]),
    Pass::each("missing", "refuses operations that the target has no code for", missing::run)
        .when(missing::concerns)
        .needs(&[
            "substitutes",
            "machine-codes",
            "polar",
            "polar-mode",
            "shift",
            "rapid-once",
            "tapping",
            "state",
            "cycle-words",
        ]),
    Pass::reports("offset-numbers", "refuses offsets that the target does not have", offset_numbers::run)
        .when(|c, context| c.role(Role::WorkOffset) || offset_numbers::concerns(c, context)),
    Pass::reports(
        "forbidden",
        "refuses codes that the target takes for a fault under others",
        forbidden::run,
    )
    .when(forbidden::concerns)
    .needs(&["missing", "cycle-ends", "machine-codes"]),
];

/// Only passes that keep a module such as the target can say it.
const TIDY_LEGAL: &[Pass] = &[FOLD, RETARGET, BRANCHES, UNREACHABLE, DEAD_STORES];
