//! The questions of behaviour that tables answer, with the answers there are.
//!
//! A name stands in `dialects/*.toml` and is asked by `Control::behaviour`;
//! one that is not here is refused at loading, so that nobody asks a question
//! that no table can answer.

/// A question of behaviour.
#[derive(Clone, Copy, Debug)]
pub struct Question {
    /// Its name.
    pub name: &'static str,
    /// The answers it may have; empty for any number.
    pub values: &'static [&'static str],
    /// What is asked.
    pub meaning: &'static str,
}

impl Question {
    /// True where the value is an answer.
    pub fn admits(&self, value: &str) -> bool {
        if self.values.is_empty() { value.parse::<f64>().is_ok() } else { self.values.contains(&value) }
    }
}

/// The question with this name.
pub fn find(name: &str) -> Option<&'static Question> {
    ALL.iter().find(|question| question.name == name)
}

const YES: &[&str] = &["true", "false", "unknown"];

/// When a code acts that stands beside a move: with its start, or when it is done.
const WHEN: &[&str] = &["start", "end", "unknown"];

macro_rules! questions {
    ($($name:literal $values:expr, $meaning:literal;)*) => {
        /// Every question.
        pub const ALL: &[Question] =
            &[$(Question { name: $name, values: $values, meaning: $meaning }),*];
    };
}

questions! {
    "vacancy" YES, "a variable may be vacant, which is not zero";
    "vacant.word.dropped" YES, "a word whose value is a vacant variable counts as not programmed";
    "vacant.eq.zero" YES, "a vacant variable equals zero under EQ and NE";
    "vacant.compares.as.zero" YES, "GT, GE, LT and LE take a vacant variable for zero";
    "vacant.arithmetic.zero" YES, "arithmetic takes a vacant operand for zero";
    "bracket.vacant.word" &["dropped", "zero", "unknown"], "what a word does whose bracket holds one vacant variable";
    "bracket.copies.vacancy" YES, "#2=[#1] copies vacancy as #2=#1 does";
    "goto.forward.first" YES, "a jump looks forward first, then from the head of the program";
    "goto.computed" YES, "a jump may go to a computed number";
    "goto.missing.alarms" YES, "a jump to a label or number that no block has stops the program with an alarm";
    "goto.first.label" YES, "of labels that stand twice a jump always finds the first one";
    "sequence.anywhere" YES, "N may stand anywhere in its block";
    "sub.ends.at.next" YES, "a subroutine at the head of a program ends where the next one begins";
    "sub.area.entered" YES, "what stands before the subroutines at the head runs, then the main part";
    "end.alone" YES, "the code that closes the subroutines ends a program that has none";
    "cycle.end.ends.program" YES, "the code that ends a called cycle ends any other program too";
    "call.after.words" YES, "a subroutine that is called beside words runs when the words are done";
    "m99.p.jumps.here" YES, "M99 P jumps in the running program; false where it returns to that block of the caller";
    "m99.main.restarts" YES, "M99 in the main program starts it again";
    "m99.block.moves.first" YES, "the words beside M99 act before the return";
    "program.end.closes.subs" YES, "M30 ends the subroutines at the head of a program that has them";
    "arguments.mixed.later.wins" YES, "of arguments of both kinds for one local variable the later one counts";
    "arguments.order.ijk" &["true", "repeated", "false", "unknown"], "I, J and K go by place: where they are repeated or out of order, only where one of them stands twice, or never";
    "arguments.repeated.order" &["place", "count", "unknown"], "which local a repeated I, J or K sets: the next of its column after the letter before it, or that of the set that its own count gives";
    "call.arguments.last" YES, "the call's words must stand before its arguments";
    "call.repeat.reloads.arguments" YES, "each repeat of a call sets the arguments again";
    "call.words.alone" YES, "no other words may stand in the block of a macro call";
    "call.modal.block.calls" YES, "the block that starts a modal call calls at once";
    "call.modal.sets.locals.once" YES, "a modal call sets its arguments in its own block only";
    "call.modal.nested" YES, "modal calls nest: the inner runs for moves of the outer macro";
    "call.alias.nested" YES, "codes that call programs do so inside such programs too";
    "locals.shared.by.subprogram" YES, "a subprogram sees and changes its caller's locals";
    "comparison.is.value" YES, "a comparison is a value, one or zero";
    "number.is.condition" YES, "a number is a condition: true when it is not zero";
    "condition.and.or" YES, "AND, OR and XOR join conditions";
    "condition.register" YES, "jumps test a register that arithmetic and tests set";
    "then.words" YES, "words of NC code may stand behind THEN";
    "statement.shares.block" YES, "several statements, or a statement and words, may share a block";
    "assign.shares.block" YES, "several assignments may share a block";
    "mod.rounds.operands" YES, "MOD rounds its operands to whole numbers first";
    "mod.sign" &["dividend", "unknown"], "whose sign the remainder has";
    "bits.of.fraction" &["round", "truncate", "unknown"], "what bit operators do with a fraction";
    "bits.width" &["32", "unknown"], "how many bits bit operators have";
    "equal.tolerance" &[], "how far apart numbers may be that count as equal";
    "round.half.away" YES, "ROUND takes halves away from zero";
    "round.in.address" &["increment", "whole", "unknown"], "to what ROUND rounds inside a word";
    "round.places.default" &["unknown", "0", "1", "2", "3", "4", "5"], "places that the rounding function keeps by default";
    "fix.toward.zero" YES, "FIX (INT) goes toward zero for negative numbers";
    "word.rounds.to.increment" YES, "a computed value is rounded to the least increment of its address";
    "scale.bare" &["units", "unknown"], "what a scale factor without a decimal point counts";
    "integer.word.rounds" YES, "a computed value in a whole-number word is rounded to the nearest";
    "word.bare.expression" &["value", "increments", "unknown"], "what a computed value without a point counts in a word";
    "sign.before.variable" YES, "a variable in a word needs a sign before it, which multiplies";
    "atan2.range" &["0..360", "-180..180", "none", "unknown"], "the range of the two-argument arc tangent";
    "atan.range" &["-90..90", "unknown"], "the range of the one-argument arc tangent";
    "asin.range" &["-90..90", "270..90", "none", "unknown"], "the range of the arc sine";
    "acos.range" &["0..180", "none", "unknown"], "the range of the arc cosine";
    "angle.limit" &["none", "360", "unknown"], "how far from zero the argument of a sine may lie";
    "angles.unit" &["degrees", "modal"], "the unit of angles: degrees, or degrees and radians as last set";
    "divide.by.zero" &["alarm", "unknown"], "what a division by zero does";
    "sqrt.of.negative" &["alarm", "unknown"], "what the root of a negative number does";
    "arc.radius.negative" &["long", "short", "unknown"], "the arc that a negative radius means";
    "arc.radius.positive" &["long", "short", "unknown"], "the arc that a positive radius means";
    "arc.without.centre" &["error", "straight", "unknown"], "a block under a modal arc without centre and radius";
    "arc.centre" &["incremental", "absolute", "unknown"], "from where I, J and K count";
    "repeat.counts" &["total", "extra"], "whether the number of a repeated call counts the first time";
    "repeat.zero" &["none", "once", "unknown"], "what a repeat of zero does";
    "dwell.bare" &["ms", "seconds", "unknown"], "what P of a dwell counts without a decimal point";
    "dwell.point" &["ms", "seconds", "error", "unknown"], "what P of a dwell counts with a decimal point";
    "dwell.expression" &["ms", "seconds", "unknown"], "what P of a dwell counts when it is computed";
    "cycle.planes.frozen" YES, "the planes of a drilling cycle keep the meaning of the block that gave them";
    "cycle.l0.stores" YES, "a cycle with L0 is stored and not run";
    "cycle.runs.without.axes" YES, "a cycle's own block runs it even without a position";
    "cycle.tap.feed" &["feed", "lead", "unknown"], "what the words of a tapping cycle mean: feed and speed, or speed and lead";
    "cycle.variable.retract" &[], "number of the variable that a drilling cycle takes its retract plane from";
    "cycle.variable.depth" &[], "number of the variable that a drilling cycle takes its depth from";
    "cycle.ends.by.motion" YES, "a rapid, feed or arc code ends the drilling cycle in force";
    "motion.after.cycle" &["kept", "unknown"], "the interpolation in force when a drilling cycle has ended";
    "cycle.block.runs" YES, "a drilling cycle's own block drills at the position in it";
    "cycle.r0.kept" YES, "a drilling cycle takes its retract plane from the variable that holds it";
    "rotation.runs.cycle" YES, "a rotation inside an active cycle runs the cycle at the turned place";
    "rotation.direction" &["ccw", "cw", "unknown"], "which way a positive rotation turns";
    "m.codes.per.block" &["1", "3", "any", "unknown"], "how many M codes a block may have";
    "m.forward.acts" WHEN, "when the code that turns the spindle clockwise acts, beside a move";
    "m.start.acts" WHEN, "when a code that starts spindle or coolant acts, beside a move";
    "m.stop.acts" WHEN, "when a code that stops spindle or coolant acts, beside a move";
    "m.change.acts" WHEN, "when a tool change acts, beside a move";
    "m.other.acts" WHEN, "when any other M code acts, beside a move";
    "s.acts" WHEN, "when a new spindle speed acts, beside a move";
    "stop.ends.spindle" YES, "a program stop stops the spindle, and the program has to start it again";
    "stop.ends.coolant" YES, "a program stop switches coolant off, and the program has to switch it on again";
    "message.ends.spindle" YES, "a stop with a message, or a question, stops the spindle";
    "message.ends.coolant" YES, "a stop with a message, or a question, switches coolant off";
    "change.ends.spindle" YES, "a tool change leaves the spindle stopped";
    "change.ends.coolant" YES, "a tool change leaves coolant off";
    "end.ends.spindle" YES, "the end of the program stops the spindle";
    "end.ends.coolant" YES, "the end of the program switches coolant off";
    "one.g.per.group" YES, "of the G codes of one group in a block the last counts, or it is an error";
    "word.twice" YES, "of a letter that stands twice in a block the last value counts";
    "block.assigns.first" YES, "words use the values that their own block gave to variables before them";
    "repeat.moves" YES, "a repeat word on a move runs the block so many times";
    "reference.length" &["kept", "cancelled", "cancelled.along", "unknown"], "whether a return to the reference position keeps the tool length, cancels it until it is named again, or does so only where the axis of the length moves";
    "machine.move.length" &["kept", "cancelled.along", "unknown"], "whether the tool length is back after a move in machine coordinates, or is cancelled until it is named again where its axis moved";
    "position.length" &["added", "left.out", "unknown"], "whether the present position and the touched one, read in the program's coordinates, hold the tool length too: the place of the spindle, or of the tip";
    "cycle.r.word" YES, "a word R beside a drilling cycle is the retract plane, as R0 is";
    "mirror.about" &["word", "zero", "unknown"], "about what an axis is mirrored: the coordinate in its word, or the work zero";
    "shape.frame.codes" &["kept", "unknown"], "whether a change of plane or of work offset, a set position, a move in machine coordinates and a return to the reference position may stand while coordinates are turned, scaled or mirrored, and do then what they do without";
    "scale.reaches.cycle" YES, "scaling reaches the planes and the pecks of a drilling cycle";
    "shift.local.is.external" YES, "the local shift and the shift of all work offsets are one register";
    "set.position.ends.local" YES, "a code that sets the position ends the local shift of its axes";
    "end.clears.local" YES, "the end of the program clears the local shift";
    "reference.all.axes" YES, "a return to the reference position without axes moves all of them";
    "integer.divides" YES, "the quotient of two whole-number constants is cut to a whole number";
    "skip.midblock" YES, "a block skip in mid-block skips the rest of the block";
    "skip.levels" YES, "a block skip may have a number";
    "words.and.statements.apart" YES, "plain words and words with variables may not share a block";
    "initial.value" &["zero", "vacant", "kept", "unknown"], "what a variable holds that nothing has set";
    "common.at.power.on" &["vacant", "kept", "unknown"], "what common variables hold after power-on";
    "position.frame" &["work", "machine", "unknown"], "the frame of the position variables";
    "radius.offset.table" &["radius", "diameter", "setting", "unknown"], "what the cutter table holds";
    "offset.active.immediately" YES, "a work offset that is written while selected counts at once";
    "radius.offset.active.tool" YES, "cutter compensation without an offset word takes the active tool's";
    "length.word.picks.radius" YES, "the word of the length offset picks the cutter radius of the same row too";
    "units.without.code" &["metric", "inch", "setting", "unknown"], "the units of a program that has no code for them";
    "tool.change.word" &["m6", "t", "unknown"], "the word that changes the tool";
    "tool.word.again" &["changes", "skipped", "unknown"], "what a word that changes the tool does for the tool in the spindle";
    "tool.word.selects.length" YES, "the tool word brings its length offset into force";
    "spindle.range.suffix" YES, "a fraction of S picks the gear range and is no speed";
    "clear.all" YES, "one statement clears all variables";
    "output.needs.port" YES, "formatted output needs a port that is open";
    "print.screen" YES, "a statement prints on the screen";
    "text.letters" &["ascii", "upper", "unknown"], "the letters that a comment or a message may have: those of ASCII, or capitals alone";
    "message.shows.comment" YES, "the comment behind a stop is shown to the operator";
    "alarm.offset" &[], "what is added to the number of an alarm on the screen";
    "alarm.max" &[], "the largest number of an alarm";
    "lookahead.runs.early" YES, "macro statements run while earlier moves are still to come";
    "system.read.waits" YES, "reading a position waits until the machine is there";
    "call.shows.return.stack" YES, "a jump out of a subroutine leaves its return behind";
    "end.clears.locals" YES, "the end of the program makes locals vacant";
    "end.cancels.length" YES, "the end of the program cancels length offsets";
    "lathe.x.diameter" YES, "X is a diameter";
    "modal.offset.one" YES, "the modal variable of motion is the code plus one";
    "index.of.fraction" &["round", "truncate", "unknown"], "what a computed subscript with a fraction means";
    "indirect.double" YES, "## is read as #[#]";
    "case.free" YES, "lower-case letters are read as upper-case ones";
    "comment.nests" YES, "comments nest";
    "step.drops.fraction" YES, "INC and DEC throw away the fraction";
    "load.sets.condition" YES, "a plain assignment sets the condition register";
    "input.default.zero" YES, "an empty answer of the operator is zero";
    "print.format" &["unknown"], "digits of printed numbers";
}
