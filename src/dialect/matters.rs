//! Matters that no table asks about, because no source says anything of them.
//!
//! The emulated controls act in one way and say so in the trace; conversions that rest on it report it. A machine
//! profile confirms one by its name, once it was tried on the machine: then the emulation's way is the machine's.

/// The one that says which way a boring bar leaves the wall; a setting or a parameter may say another.
pub const SHIFT: &str = "machine:cycle.shift.direction";

/// Every matter by its name, with what the emulated controls do.
pub const ALL: &[(&str, &str)] = &[
    ("machine:address.not.programmed", "an address that was never programmed reads as 0"),
    ("machine:arc.radius.full.circle", "an arc by its radius that ends at its start moves nothing"),
    ("machine:arc.tangent", "an arc tangent to the move before it is taken as a straight move"),
    ("machine:argument.signed", "an argument with a sign before its vacant variable is 0 in the macro"),
    ("machine:arithmetic.last.digit", "short arithmetic decides as if its last digit were right"),
    ("machine:block.behind.branch", "the rest of the block after a branch is left out"),
    ("machine:condition.at.start", "a condition that nothing has set is false"),
    ("machine:corner.elsewhere", "a corner without a cut is left out, and two in one block both count"),
    ("machine:cycle.back.bore", "back boring shifts, dives, shifts back, and feeds up"),
    ("machine:cycle.other", "a drilling cycle of this control alone moves nothing"),
    ("machine:cycle.peck.missing", "a peck cycle that is told no depth of its pecks drills in one go"),
    (
        "machine:cycle.shift.direction",
        "the shift of a boring cycle goes in plus along the plane's first axis",
    ),
    (
        "machine:distance.code.behind.words",
        "an absolute or incremental code after words counts for the whole block",
    ),
    ("machine:feed.mode.at.start", "a lathe starts in feed per turn"),
    ("machine:jump.into.loop", "a jump into a loop goes on inside it"),
    ("machine:lathe.allowance.into.part", "an allowance that points into the part is taken with its sign"),
    (
        "machine:lathe.arc.across",
        "an arc of a lathe in another plane than that of Z and X has X as a diameter, and its centre and radius as radii",
    ),
    ("machine:lathe.code.moves.nothing", "a code of a lathe that only this control has moves nothing"),
    (
        "machine:lathe.contour.modes",
        "modes of the speed and the feed in a contour count where it is finished, and do nothing while it is roughed",
    ),
    ("machine:lathe.contour.moves", "the cycles of contours move as docs/lathe.md says"),
    (
        "machine:lathe.contour.returns",
        "a last block of a contour that goes back along the cut outside the stock is no part of the shape that is roughed",
    ),
    ("machine:lathe.contour.steps", "increments of a contour count from where the finishing began"),
    (
        "machine:lathe.corner.read",
        "what a program reads while a block waits for the next one is as it was before that block",
    ),
    (
        "machine:lathe.face.centre",
        "a way through the centre of the spindle in polar interpolation turns C half round",
    ),
    (
        "machine:lathe.face.place",
        "a place that is read while a face or a side is milled with C is X of its plane, or C as it stood",
    ),
    ("machine:lathe.face.plane", "a code of a plane in polar interpolation does nothing"),
    ("machine:lathe.face.rapid", "a rapid move in polar interpolation goes straight in its plane"),
    ("machine:lathe.feed.after.threads", "a lead by threads an inch stays in force as the feed"),
    ("machine:lathe.groove.moves", "the cycles of grooves and pecks move as docs/lathe.md says"),
    ("machine:lathe.hole.moves", "the drilling cycles of a lathe move as docs/lathe.md says"),
    ("machine:lathe.home.without.axes", "a return without axes takes all axes home at once"),
    ("machine:lathe.machine.rapid", "a move in machine coordinates is rapid"),
    (
        "machine:lathe.motion.after.cycle",
        "after a cycle of a lathe the motion code from before it is in force",
    ),
    ("machine:lathe.nose.path", "the nose radius leaves the programmed path as it is"),
    ("machine:lathe.nose.roughing", "compensation in a contour does nothing while it is roughed"),
    ("machine:lathe.pass.moves", "single passes move as docs/lathe.md says"),
    ("machine:lathe.peck.retract", "a peck of a groove goes back by the clearance of the scenario"),
    ("machine:lathe.position.diameter", "a position of X that is read is a diameter"),
    (
        "machine:lathe.position.steps",
        "a code that sets the position under G91 moves the zero by its words, as U and W do",
    ),
    ("machine:lathe.spindle.stands", "a feed a turn while the spindle stands takes no time"),
    ("machine:lathe.taper.turns", "a taper that turns the infeed round is cut all the same"),
    ("machine:lathe.thread.finishes", "a thread of 0 finishing passes has one"),
    ("machine:lathe.thread.infeed", "a thread without the way of its infeed goes in along one flank"),
    ("machine:lathe.thread.passes", "threads of many passes move as docs/lathe.md says"),
    ("machine:lathe.thread.runout", "a thread without a setting for its run-out has none"),
    ("machine:lathe.thread.settings", "settings of threads that the profile does not give are 0"),
    (
        "machine:lathe.tool.beside.move",
        "the turret turns before the move of its block, and not with it or after it",
    ),
    (
        "machine:lathe.tool.offset",
        "a tool offset of a lathe counts from the next absolute word on, and X of it is a diameter",
    ),
    (
        "machine:lathe.work.shift",
        "the shift of all zeros that G10 P0 writes counts at once, beside the external work offset",
    ),
    ("machine:m99.in.subroutine", "M99 in a subroutine returns from it"),
    ("machine:offset.value.kept", "an offset that is set without a value keeps its earlier value"),
    ("machine:output.half", "a half that output rounds to its places goes away from 0"),
    ("machine:overflow", "a result that is not a number is an alarm"),
    ("machine:plane", "a plane other than the three leaves the plane as it is"),
    (
        "machine:pocket.path",
        "a round pocket feeds down at its centre, goes out and back along half circles, and mills each circle whole",
    ),
    ("machine:polar.word.left.out", "a polar word that is left out keeps its last value"),
    ("machine:program.runs.out", "a called program without a return returns after its last block"),
    ("machine:program.without.return", "a called program without a return returns after its last block"),
    (
        "machine:reference.from",
        "the way back from the reference position goes by the point of the last return",
    ),
    ("machine:return.without.call", "a return without a call ends the program"),
    (
        "machine:shape.from.setting",
        "a rotation without its angle turns by nothing, and a scaling without its factor keeps the size",
    ),
    ("machine:start.in.subprogram", "a new start ends the calls that are open"),
    ("machine:state.larger", "a state takes a larger number than the table says"),
    ("machine:sub.area.end.again", "a second end of the subroutines ends the program"),
    ("machine:test.of.code", "a test of a code asks what is in force in its group"),
    ("machine:tool.change.alone", "a tool change without a tool word takes the tool that was named last"),
    ("machine:tool.zero", "the tool in the spindle stays active when tool 0 takes its length away"),
    ("machine:word.twice", "of an axis word that stands twice in its block the later one counts"),
    ("machine:word.without.meaning", "a word that has no meaning on the control does nothing"),
    (
        "numbers:bare_feed",
        "a feed without a decimal point has the unit that the table gives, or whole units if it gives none",
    ),
];

/// What the emulated controls do in a matter; none if there is no such.
pub fn meaning(name: &str) -> Option<&'static str> {
    ALL.iter().find(|(found, _)| *found == name).map(|(_, meaning)| *meaning)
}
