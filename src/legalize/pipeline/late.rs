//! The last passes, in the order they run in.

use super::Pass;
use crate::legalize::assumptions::facts;
use crate::legalize::calls::merged;
use crate::legalize::codes::quality_stops;
use crate::legalize::cycles::bare_dwells;
use crate::legalize::expressions::{
    codes_by_variable, conditions, constants, functions, operands, split, truth, whole_words,
};
use crate::legalize::features::Feature;
use crate::legalize::lathe::contours;
use crate::legalize::layout::{blank_lines, macro_lines, program_numbers, sequence_numbers, skip_runs};
use crate::legalize::moves::start;
use crate::legalize::offsets::still_blocks;
use crate::legalize::operator::{letters, messages, ports, questions, renamed, switches};
use crate::legalize::registers::{allocate, clear, frames, interface, outside, standing, temporaries};
use crate::legalize::variables::{computed_numbers, retention, vacancy, vacancy_flags};

/// Before modes of quality are left out.
pub(super) const QUALITY_STOPS: Pass = Pass::edits(
    "quality-stops",
    "what waits for the end of a mode that reads far ahead is held back",
    quality_stops::run,
)
.when(quality_stops::concerns);

/// Beside the output that is left out.
pub(super) const SWITCHES: Pass = Pass::rewrites(
    "switches",
    "writes to the operator's switches go where the target has no variable for them",
    switches::run,
)
.when(switches::concerns);

pub(super) const EXPRESSIONS: &[Pass] = &[
    Pass::rewrites(
        "vacancy-flags",
        "flags say what is vacant, on a target where nothing is",
        vacancy_flags::run,
    )
    .when(vacancy_flags::concerns)
    .changes_flow(),
    Pass::each("bare-dwells", "dwells that may find a feed for their time get one", bare_dwells::run)
        .when(bare_dwells::concerns)
        .needs(&["dwell", "vacancy-flags"]),
    Pass::edits("whole-words", "words that are whole numbers are rounded before them", whole_words::run)
        .when(whole_words::concerns)
        .needs(&["vacancy-flags"]),
    Pass::each("functions", "functions and operators become those of the target", functions::run)
        .when(|c, _| c.has(Feature::Function))
        .changes_flow(),
    Pass::each("truth", "comparisons as values become branches", truth::run)
        .when(truth::concerns)
        .needs(&["functions"])
        .changes_flow(),
    Pass::each("conditions", "AND, OR and NOT of conditions become branches", conditions::run)
        .when(|c, _| c.has(Feature::Compound))
        .needs(&["truth"])
        .changes_flow(),
    Pass::each("constants", "constants of many digits become sums", constants::run)
        .when(|c, _| c.has(Feature::Long))
        .needs(&["functions"]),
    Pass::each("printed-values", "values to be printed go to temporaries", questions::hold_values)
        .when(|c, _| c.has(Feature::Print)),
    Pass::each(
        "operands",
        "operands are computed before where the target takes no expression",
        operands::run,
    )
    .when(operands::concerns)
    .needs(&["functions", "truth", "conditions", "constants", "printed-values"]),
    Pass::each("split-expressions", "expressions are cut to the target's brackets and line", split::run)
        .when(|c, _| c.has(Feature::Computed))
        .needs(&["operands"]),
    Pass::each(
        "codes-by-variable",
        "codes beside words by variables are by a variable too",
        codes_by_variable::run,
    )
    .when(codes_by_variable::concerns)
    .needs(&["operands", "split-expressions"]),
];

pub(super) const ENTRY: &[Pass] = &[
    Pass::rewrites("ports", "output ports are opened and closed", ports::run)
        .when(|c, _| c.has(Feature::Output)),
    Pass::rewrites("vacancy", "variables that are never vacant are set to 0 if they are", vacancy::run)
        .when(vacancy::concerns)
        .changes_flow(),
    Pass::edits("start-alike", "codes at a head go that the target begins in anyway", start::drop_alike)
        .when(|_, context| !context.target.start().is_empty())
        .brings_nothing(),
    Pass::each("skips-apart", "each block of a way round blocks gets its block skip again", skip_runs::apart)
        .when(|c, _| c.has(Feature::Skip))
        .needs(&["skip-runs"])
        .changes_flow(),
];

// What these put in, they put in for something that stood there before.
pub(super) const REGISTERS: &[Pass] = &[
    Pass::rewrites("frames", "locals get registers of their level, on a target without locals", frames::run)
        .when(frames::concerns)
        .needs(&["computed-numbers"])
        .changes_flow(),
    Pass::rewrites(
        "merged",
        "what a program calls becomes a part of it, where calls reach no farther",
        merged::run,
    )
    .when(|_, context| merged::concerns(context.target))
    .needs(&["frames", "outline"])
    .adds_programs(),
    Pass::rewrites("temporaries", "temporaries that are never alive together share one", temporaries::run)
        .when(|c, context| c.has(Feature::Temp) || frames::concerns(c, context))
        .needs(&["frames"])
        .brings_nothing(),
    Pass::rewrites("registers", "every variable gets its register", allocate::run)
        .needs(&["temporaries", "computed-numbers"])
        .brings_nothing(),
    Pass::reports(
        "reached",
        "reports computed numbers that reach a register of another variable",
        computed_numbers::report,
    )
    .needs(&["registers"]),
    Pass::reports(
        "outside",
        "reports variables that nothing here sets, where their number changes",
        outside::run,
    )
    .needs(&["registers"]),
    Pass::reports(
        "interface",
        "says where arguments from outside the library stand, and arguments to programs outside",
        interface::run,
    )
    .when(frames::concerns)
    .needs(&["registers"]),
    Pass::reports(
        "standing",
        "reports variables and registers that programs in the machine may know otherwise",
        standing::run,
    )
    .when(|c, context| c.has(Feature::Call) && !context.target.standing().is_empty())
    .needs(&["registers"]),
    Pass::rewrites("clear", "clearing of a class becomes zeros and loops", clear::run)
        .when(clear::concerns)
        .needs(&["registers"])
        .brings_nothing()
        .changes_flow(),
    Pass::reports("retention", "reports variables that one control keeps over power-off", retention::run)
        .needs(&["registers"]),
];

pub(super) const OPERATOR: &[Pass] = &[
    Pass::rewrites("renamed", "texts that name a variable name its register", renamed::run)
        .needs(&["registers"])
        .brings_nothing(),
    Pass::rewrites(
        "letters",
        "letters that the target may not show become what looks like them",
        letters::run,
    )
    .needs(&["renamed"])
    .brings_nothing(),
    // A question names its register, and takes up the print before it.
    Pass::rewrites(
        "questions",
        "questions become stops at which the operator sets the register",
        questions::questions,
    )
    .when(|c, _| c.has(Feature::Input))
    .needs(&["registers", "letters"])
    .brings_nothing(),
    Pass::rewrites("prints", "prints become formatted output", questions::prints)
        .when(|c, _| c.has(Feature::Print))
        .needs(&["questions", "letters"])
        .brings_nothing(),
    Pass::rewrites("messages", "messages are cut to what the target shows", messages::run)
        .when(|c, _| c.has(Feature::Message) || c.has(Feature::Input))
        .needs(&["questions"])
        .brings_nothing(),
];

pub(super) const LAYOUT: &[Pass] = &[
    Pass::edits("blank-lines", "lines without anything go under cutter compensation", blank_lines::run)
        .when(blank_lines::concerns)
        .brings_nothing(),
    Pass::rewrites(
        "sequence-numbers",
        "sequence numbers stand at the head of what became of their blocks",
        sequence_numbers::run,
    )
    .brings_nothing(),
    // Once more: expressions and registers may have put something into them.
    Pass::reports("contours-written", "checks that the contours of cycles are still whole", contours::run)
        .when(|c, _| contours::concerns(c))
        .needs(&["contours", "sequence-numbers", "split-expressions"]),
    Pass::reports(
        "still-blocks",
        "tells of blocks without a move between compensated moves",
        still_blocks::run,
    )
    .when(still_blocks::concerns)
    .needs(&["split-expressions"]),
    Pass::reports(
        "target-facts",
        "reports unconfirmed facts of the target that programs depend on",
        facts::of_target,
    )
    .needs(&["missing", "split-expressions", "registers", "prints", "messages"]),
    Pass::reports("macro-lines", "reports loops without a move", macro_lines::run)
        .when(|c, _| c.has(Feature::Computed)),
    Pass::reports("program-numbers", "every program gets a number of the target", program_numbers::run)
        .needs(&["outline", "chain"]),
];
