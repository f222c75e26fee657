//! Matters that no table asks about, because no source says anything of them.
//!
//! The emulated controls act in one way and say so in the trace; conversions that rest on it report it. A machine
//! profile confirms one by its name, once it was tried on the machine: then the emulation's way is the machine's.

/// Every matter by its name, with what the emulated controls do.
pub const ALL: &[(&str, &str)] = &[
    ("machine:address.not.programmed", "an address that was never programmed reads as 0"),
    ("machine:arc.radius.full.circle", "an arc by its radius whose end is its start moves nothing"),
    ("machine:arc.tangent", "an arc tangent to the move before it is taken for a straight move"),
    ("machine:arithmetic.last.digit", "short arithmetic decides as if its last digit were right"),
    ("machine:block.behind.branch", "what stands behind a branch in its block is left out"),
    ("machine:condition.at.start", "a condition that nothing has set is false"),
    ("machine:corner.elsewhere", "a corner beside no cut is left out, and of two in a block both are there"),
    ("machine:cycle.back.bore", "back boring shifts, dives, shifts back, and feeds up"),
    ("machine:cycle.l0.moves", "a position beside a repeat count of 0 is not gone to"),
    ("machine:cycle.other", "a drilling cycle of this control alone moves nothing"),
    ("machine:cycle.shift.direction", "the shift of a boring cycle goes along the plane's first axis"),
    (
        "machine:distance.code.behind.words",
        "an absolute or incremental code behind words counts for the whole block",
    ),
    ("machine:feed.mode.at.start", "a lathe starts in feed per minute"),
    ("machine:jump.into.loop", "a jump into a loop runs on in it"),
    ("machine:lathe.tool.word", "the tool word of a lathe is a tool, and takes no offset of it"),
    ("machine:m99.in.subroutine", "M99 in a subroutine returns from it"),
    ("machine:machine.coordinates.incremental", "machine coordinates are absolute in incremental mode too"),
    ("machine:offset.value.kept", "an offset that is set without a value takes the one of before"),
    ("machine:overflow", "a result that is no number is an alarm"),
    ("machine:plane", "a plane that is none of the three leaves the plane as it is"),
    ("machine:polar.word.left.out", "a polar word that is left out keeps its last value"),
    ("machine:program.runs.out", "a called program without a return returns behind its last block"),
    ("machine:program.without.return", "a called program without a return returns behind its last block"),
    ("machine:reference.from", "the way back from the reference position goes straight to its end"),
    ("machine:return.without.call", "a return without a call ends the program"),
    ("machine:rotation.incremental", "the centre of a rotation counts from the tool in incremental mode"),
    ("machine:start.in.subprogram", "a new start ends the calls that are open"),
    ("machine:sub.area.end.again", "a second end of the subroutines ends the program"),
    ("machine:test.of.code", "a test of a code asks what is in force in its group"),
    ("machine:tool.zero", "the tool in the spindle stays active when tool 0 takes its length away"),
    ("machine:word.without.meaning", "a word that the control has no meaning for says nothing"),
    (
        "numbers:bare_feed",
        "a feed without a decimal point counts what the table says, or units where it says nothing",
    ),
];

/// What the emulated controls do in a matter; none where there is no such.
pub fn meaning(name: &str) -> Option<&'static str> {
    ALL.iter().find(|(found, _)| *found == name).map(|(_, meaning)| *meaning)
}
