//! The questions of behaviour that tables answer, with the answers there are.
//!
//! A table says `name` and `value` of a question; code asks `Control::behaviour` by its variant. So a name that is
//! not here is refused at loading, and nobody asks a question that no table can answer.

use super::answers::{Answers, SETTING};
use super::reader::closest;
use Answers::OneOf;
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};
use std::fmt;

const YES: Answers = OneOf(&["true", "false", "unknown"]);

/// When a code acts that stands beside a move: with its start, or when it is done.
const WHEN: Answers = OneOf(&["start", "end", "unknown"]);

const NUMBER: Answers = Answers::Number;

const fn first(words: &[&'static str]) -> Option<&'static str> {
    match words {
        [word, ..] => Some(word),
        [] => None,
    }
}

macro_rules! questions {
    ($($variant:ident $name:literal $answers:expr, $meaning:literal $(, if $needs:literal)?;)*) => {
        /// A question of behaviour.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Question {
            $(#[doc = $meaning] $variant,)*
        }

        impl Question {
            /// Every question.
            pub const ALL: &[Self] = &[$(Self::$variant),*];

            /// Its name in tables: `goto.forward.first`.
            pub const fn name(self) -> &'static str {
                match self { $(Self::$variant => $name,)* }
            }

            /// The fact that its answer is, as diagnostics name it: `behaviour:goto.forward.first`.
            pub const fn fact(self) -> &'static str {
                match self { $(Self::$variant => concat!("behaviour:", $name),)* }
            }

            /// The answers it may have.
            pub const fn answers(self) -> Answers {
                match self { $(Self::$variant => $answers,)* }
            }

            /// What is asked.
            pub const fn meaning(self) -> &'static str {
                match self { $(Self::$variant => $meaning,)* }
            }

            /// What a control must have for the question to arise, as facts of its table with `and` and `or` between
            /// them, or `said`: then a table that is silent says that the control is like most others.
            pub const fn needs(self) -> Option<&'static str> {
                match self { $(Self::$variant => first(&[$($needs)?]),)* }
            }
        }
    };
}

impl Question {
    /// The question with this name.
    pub fn find(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|question| question.name() == name)
    }

    /// True for what a shop says of its programs, whatever the control can do.
    pub const fn is_choice(self) -> bool {
        matches!(
            self,
            Self::Corners
                | Self::LengthOffZero
                | Self::MachineMoveFeed
                | Self::MachinePlaces
                | Self::PowerOffValues
                | Self::StandingResults
                | Self::TapDwell
                | Self::PeckDwell
                | Self::WorkPlaces
                | Self::TapPeck
                | Self::CycleSettings
        )
    }

    /// True for what is set up at each machine, whatever its control does by itself.
    pub const fn is_set_up(self) -> bool {
        matches!(self, Self::RotaryWay | Self::RotaryStart)
    }

    /// True for the answer that a setting gives it, of a question that a table may leave open.
    pub(super) fn may_hang_on_setting(self, value: &str) -> bool {
        value == SETTING && self.answers().admits("unknown")
    }

    /// The question whose answer this fact is.
    pub fn of_fact(fact: &str) -> Option<Self> {
        Self::find(fact.strip_prefix("behaviour:")?)
    }
}

impl fmt::Display for Question {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl Serialize for Question {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

impl<'de> Deserialize<'de> for Question {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = String::deserialize(deserializer)?;
        Self::find(&name).ok_or_else(|| {
            let near = closest(&name, Self::ALL.iter().map(|known| known.name()));
            let help = near.map_or("add it to src/dialect/questions.rs first".into(), |near| {
                format!("did you mean '{near}'?")
            });
            D::Error::custom(format!("no behaviour is named '{name}' ({help})"))
        })
    }
}

questions! {
    Vacancy "vacancy" YES, "a variable may be vacant, which is not zero";
    VacantWordDropped "vacant.word.dropped" YES, "a word whose value is a vacant variable counts as not programmed", if "behaviour:vacancy";
    VacantEqZero "vacant.eq.zero" YES, "a vacant variable equals zero under EQ and NE", if "behaviour:vacancy";
    VacantComparesAsZero "vacant.compares.as.zero" YES, "GT, GE, LT and LE take a vacant variable as zero", if "behaviour:vacancy";
    VacantArithmeticZero "vacant.arithmetic.zero" YES, "arithmetic takes a vacant operand as zero", if "behaviour:vacancy";
    BracketVacantWord "bracket.vacant.word" OneOf(&["dropped", "zero", "unknown"]), "what a word does if its bracket holds one vacant variable", if "behaviour:vacancy";
    BracketCopiesVacancy "bracket.copies.vacancy" YES, "#2=[#1] copies vacancy as #2=#1 does", if "behaviour:vacancy";
    GotoForwardFirst "goto.forward.first" YES, "a jump looks forward first, then from the head of the program";
    GotoComputed "goto.computed" YES, "a jump may go to a computed number";
    GotoActsLast "goto.acts.last" YES, "a jump acts when all else of its block is done, what stands after it too", if "said";
    GotoMissingAlarms "goto.missing.alarms" YES, "a jump to a label or number that no block has stops the program with an alarm", if "statement:goto.label";
    GotoFirstLabel "goto.first.label" YES, "a jump to a repeated label always finds the first one", if "statement:goto.label";
    SequenceAnywhere "sequence.anywhere" YES, "N may stand anywhere in its block";
    SubEndsAtNext "sub.ends.at.next" YES, "a subroutine at the head of a program ends where the next one begins", if "op:sub.area.end";
    SubAreaEntered "sub.area.entered" YES, "blocks before the subroutines at the head run first, then the \
                                            main part", if "op:sub.area.end";
    SubsInCalled "subs.in.called" YES, "a program that others call may have subroutines of its own", if "statement:call.local";
    EndAlone "end.alone" YES, "the code that closes the subroutines ends a program that has none", if "op:sub.area.end";
    CycleEndEndsProgram "cycle.end.ends.program" YES, "the code that ends a called cycle ends any other program too", if "op:call.cycle";
    CallAfterWords "call.after.words" YES, "a subroutine that is called beside words runs when the words are done";
    M99PJumpsHere "m99.p.jumps.here" YES, "M99 P jumps in the running program; false if it returns to \
                                           that block of the caller", if "statement:return.to.sequence";
    M99PInCalled "m99.p.in.called" YES, "M99 P in a program that others call, or in a subroutine, jumps there too", if "said";
    M99MainRestarts "m99.main.restarts" YES, "M99 in the main program starts it again", if "statement:return.to.sequence";
    M99BlockMovesFirst "m99.block.moves.first" YES, "the words beside M99 act before the return", if "statement:call.macro";
    ArgumentsMixedLaterWins "arguments.mixed.later.wins" YES, "if arguments of both kinds set one local \
                                                               variable, the later one counts", if "statement:call.macro";
    ArgumentsOrderIjk "arguments.order.ijk" OneOf(&["true", "repeated", "false", "unknown"]), "when I, J and K count by place: if they are \
                                                                                               repeated or out of order, only if one of them is \
                                                                                               repeated, or never", if "statement:call.macro";
    ArgumentsRepeatedOrder "arguments.repeated.order" OneOf(&["place", "count", "unknown"]), "which local a repeated I, J or K sets: the next of its column after the letter before it, or that of the set that its own count gives", if "statement:call.macro";
    CallRepeatReloadsArguments "call.repeat.reloads.arguments" YES, "each repeat of a call sets the arguments again", if "statement:call.macro";
    CallModalBlockCalls "call.modal.block.calls" YES, "the block that starts a modal call calls at once", if "statement:call.modal";
    CallModalSetsLocalsOnce "call.modal.sets.locals.once" YES, "a modal call sets its arguments in its own block only", if "statement:call.modal and statement:call.macro";
    CallModalNested "call.modal.nested" YES, "modal calls nest: the inner runs for moves of the outer macro", if "statement:call.modal";
    CallModalOffAlone "call.modal.off.alone" YES, "the end of a modal call does nothing where none is open", if "op:call.modal.off";
    CallAliasNested "call.alias.nested" YES, "codes that call programs do so inside such programs too", if "statement:call.macro";
    LocalsSharedBySubprogram "locals.shared.by.subprogram" YES, "a subprogram sees and changes its caller's locals", if "class:local";
    ComparisonIsValue "comparison.is.value" YES, "a comparison is a value, one or zero";
    NumberIsCondition "number.is.condition" YES, "a number is a condition: true when it is not zero";
    ConditionAndOr "condition.and.or" YES, "AND, OR and XOR join conditions";
    ConditionRegister "condition.register" YES, "jumps test a register that arithmetic and tests set";
    ThenWords "then.words" YES, "words of NC code may follow THEN";
    StatementSharesBlock "statement.shares.block" YES, "several statements, or a statement and words, may share a block";
    AssignSharesBlock "assign.shares.block" YES, "several assignments may share a block";
    ModRoundsOperands "mod.rounds.operands" YES, "MOD rounds its operands to whole numbers first", if "operator:modulo";
    ModSign "mod.sign" OneOf(&["dividend", "unknown"]), "whose sign the remainder has", if "operator:modulo";
    BitsOfFraction "bits.of.fraction" OneOf(&["round", "truncate", "unknown"]), "what bit operators do with a fraction", if "operator:and.bits";
    BitsWidth "bits.width" OneOf(&["32", "unknown"]), "how many bits bit operators have", if "operator:and.bits";
    EqualTolerance "equal.tolerance" NUMBER, "how far apart numbers may be and still count as equal";
    RoundHalfAway "round.half.away" YES, "ROUND takes halves away from zero", if "function:round or function:round.places";
    RoundInAddress "round.in.address" OneOf(&["increment", "whole", "unknown"]), "to what ROUND rounds inside a word", if "function:round and form:word=expression";
    RoundPlacesDefault "round.places.default" OneOf(&["unknown", "0", "1", "2", "3", "4", "5"]), "places that the rounding function keeps by default", if "function:round.places";
    FixTowardZero "fix.toward.zero" YES, "FIX (INT) goes toward zero for negative numbers";
    WordRoundsToIncrement "word.rounds.to.increment" YES, "a computed value is rounded to the least increment of its address";
    ScaleBare "scale.bare" OneOf(&["units", "thousandths", "hundred.thousandths", "unknown"]), "what a scale factor without a decimal point counts", if "role:scale";
    ScalePoint "scale.point" YES, "a scale factor may have a decimal point", if "role:scale";
    IntegerWordRounds "integer.word.rounds" YES, "a computed value in a whole-number word is rounded to the nearest";
    WordBareExpression "word.bare.expression" OneOf(&["value", "increments", "unknown"]), "what a computed value without a point counts in a word";
    Atan2Range "atan2.range" OneOf(&["0..360", "-180..180", "none", "unknown"]), "the range of the two-argument arc tangent";
    AtanRange "atan.range" OneOf(&["-90..90", "unknown"]), "the range of the one-argument arc tangent";
    AsinRange "asin.range" OneOf(&["-90..90", "270..90", "none", "unknown"]), "the range of the arc sine";
    AcosRange "acos.range" OneOf(&["0..180", "none", "unknown"]), "the range of the arc cosine";
    AngleLimit "angle.limit" OneOf(&["none", "360", "unknown"]), "how far from zero the argument of a sine may lie", if "function:sin";
    AnglesUnit "angles.unit" OneOf(&["degrees", "modal"]), "the unit of angles: degrees, or degrees and radians as last set";
    DivideByZero "divide.by.zero" OneOf(&["alarm", "unknown"]), "what a division by zero does";
    SqrtOfNegative "sqrt.of.negative" OneOf(&["alarm", "unknown"]), "what the root of a negative number does";
    ArcRadiusNegative "arc.radius.negative" OneOf(&["long", "short", "unknown"]), "the arc that a negative radius means";
    ArcRadiusPositive "arc.radius.positive" OneOf(&["long", "short", "unknown"]), "the arc that a positive radius means";
    ArcWithoutCentre "arc.without.centre" OneOf(&["error", "straight", "unknown"]), "a block under a modal arc without centre and radius";
    ArcCentre "arc.centre" OneOf(&["incremental", "absolute", "unknown"]), "from where I, J and K count";
    RepeatCounts "repeat.counts" OneOf(&["total", "extra"]), "whether the number of a repeated call counts the first time";
    RepeatZero "repeat.zero" OneOf(&["none", "once", "unknown"]), "what a repeat of zero does", if "role:call.count";
    DwellBare "dwell.bare" OneOf(&["ms", "seconds", "unknown"]), "what P of a dwell counts without a decimal point";
    DwellPoint "dwell.point" OneOf(&["ms", "seconds", "error", "unknown"]), "what P of a dwell counts with a decimal point", if "op:dwell";
    DwellExpression "dwell.expression" OneOf(&["ms", "seconds", "unknown"]), "what P of a dwell counts when it is computed", if "op:dwell";
    DwellWaits "dwell.waits" NUMBER, "the milliseconds of a dwell that waits for cycle start instead", if "said";
    CyclePlanesFrozen "cycle.planes.frozen" YES, "the planes of a drilling cycle keep the meaning of the block that gave them";
    CycleL0Stores "cycle.l0.stores" YES, "a cycle with L0 is stored and not run", if "role:repeat";
    CycleL0Moves "cycle.l0.moves" YES, "a position beside a repeat count of 0 is gone to, and nothing is drilled there", if "role:repeat";
    CycleRepeatLetter "cycle.repeat.letter" OneOf(&["K", "L"]), "the letter by which the count of a drilling cycle is written, where the control reads two", if "said";
    CycleRunsWithoutAxes "cycle.runs.without.axes" YES, "a cycle's own block runs it even without a position";
    CycleRunsWithoutWords "cycle.runs.without.words" YES, "a cycle's own block runs it even without a word of an axis or a retract plane", if "said";
    CycleRunsByDepth "cycle.runs.by.depth" YES, "a block with a new depth or retract plane alone runs the cycle in force";
    CycleRunsByRotary "cycle.runs.by.rotary" YES, "a block with a word of a rotary axis alone runs the cycle in force", if "said";
    CycleStartsSpindle "cycle.starts.spindle" YES, "a drilling cycle starts a spindle that a tool change left standing, and a tap any that stands", if "said";
    CycleTapFeed "cycle.tap.feed" OneOf(&["feed", "lead", "unknown"]), "what the words of a tapping cycle mean: feed and speed, or speed and lead", if "op:cycle.tap";
    TapRigid "tap.rigid" OneOf(&["always", "code", "unknown"]), "whether taps are rigid, so that the feed follows the spindle: always, or by a code before them alone", if "said";
    TapRigidTurns "tap.rigid.turns" YES, "a rigid tap that is a cycle of its own turns a spindle that stands", if "said";
    CycleVariableRetract "cycle.variable.retract" NUMBER, "number of the variable that a drilling cycle takes its retract plane from", if "op:call.cycle";
    CycleVariableDepth "cycle.variable.depth" NUMBER, "number of the variable that a drilling cycle takes its depth from", if "op:call.cycle";
    CycleVariablePeck "cycle.variable.peck" NUMBER, "number of the variable that a peck cycle takes the depth of its pecks from", if "said";
    CycleVariableDwell "cycle.variable.dwell" NUMBER, "number of the variable that a cycle with a dwell takes its seconds from", if "said";
    CycleReturns "cycle.returns" OneOf(&["initial", "retract", "unknown"]), "where a hole of a drilling cycle ends: in the plane that the tool was in when the cycle began, or in the retract plane", if "op:call.cycle";
    CycleEndsByMotion "cycle.ends.by.motion" YES, "a rapid, feed or arc code ends the drilling cycle in force", if "said";
    CyclePlane "cycle.plane" OneOf(&["any", "xy", "unknown"]), "the planes that drilling cycles run in: any, or that of G17 alone", if "said";
    CycleDwellShared "cycle.dwell.shared" YES, "the time of a wait while a drilling cycle is in force is the wait of its next holes too", if "said";
    CycleWordsAlone "cycle.words.alone" OneOf(&["kept", "ignored", "unknown"]), "what words of a drilling cycle do in a block that drills nothing: they are kept for the next holes, or ignored", if "role:cycle.dwell or role:cycle.q";
    CycleEndsByArc "cycle.ends.by.arc" YES, "an arc code ends the drilling cycle in force, where other motion codes do", if "said";
    RoughingEnds "roughing.ends" OneOf(&["along", "levels", "unknown"]), "how the roughing of a contour ends: with a pass along it, always, or level by \
                                                    level, and along it only with an allowance for that pass", if "op:contour.turning";
    RoughingNose "roughing.nose" OneOf(&["ignored", "counts", "unknown"]), "what nose radius compensation (G41, G42) does while a contour is roughed: nothing, or it \
                                                                            changes the allowance", if "op:contour.turning";
    ContourNose "contour.nose" OneOf(&["read", "alarm", "unknown"]), "what G40, G41 and G42 between the blocks of a contour do while it is roughed: they are read, or stop it with an alarm", if "op:contour.turning";
    RoughingValleys "roughing.valleys" OneOf(&["axes", "word"]), "what says that the contour of a roughing has valleys: the axes that its first block names, or a word of the cycle", if "op:contour.turning";
    ThreadFeedIsLead "thread.feed.is.lead" YES, "F of a thread is its lead in feed a minute too", if "op:threading";
    SpeedKept "speed.kept" OneOf(&["mode", "turns", "unknown"]), "the speed after a change between G96 and G97 without S: the last one of that mode, or the turns of the \
                                                                 moment", if "op:threading";
    CAxisEngages "c.axis.engages" OneOf(&["code", "return", "unknown"]), "what engages the C axis of a lathe: a code of the builder (name it 'c.axis.on'), or its return to the \
                                                                        reference position, until the spindle starts", if "op:threading";
    PassAlone "pass.alone" OneOf(&["nothing", "repeats", "unknown"]), "what a block with M, S or T and without an axis does while a turning, threading or facing pass is in \
                                                                     force: the pass once more, or nothing but its own words", if "op:pass.turning";
    PassEmpty "pass.empty" OneOf(&["nothing", "repeats", "unknown"]), "what a block without a word (a comment alone, too), or with F or the taper alone, does while a turning, threading or facing pass is in force: \
                                                                      nothing, or the pass once more", if "op:pass.turning";
    PassData "pass.data" OneOf(&["kept", "cleared", "unknown"]), "what a G code for its own block, other than a wait, does to the words of the turning, threading or facing \
                                                                  pass in force: they stay, or are taken away", if "op:pass.turning";
    FinishDepth "finish.depth" OneOf(&["ignored", "unknown"]), "what the depth of a roughing pass does beside the finishing of a contour: nothing", if "op:contour.finish";
    FinishAllowance "finish.allowance" OneOf(&["ignored", "unknown"]), "what an allowance (U, W) does beside the finishing of a contour: nothing", if "op:contour.finish";
    HoleClamp "hole.clamp" OneOf(&["plane", "unknown"]), "where the code that clamps the C axis in a drilling block acts: when the place of the hole is reached, and \
                                                         the code that lets it go when the tool is back at the retract plane", if "said";
    ThreadAngles "thread.angles" OneOf(&["0.29.30.55.60.80", "any", "unknown"]), "the angles between the flanks of a thread that the cycle of many passes takes, in \
                                                                                whole degrees", if "op:threading";
    ThreadFlanks "thread.flanks" OneOf(&["leading.first", "trailing.first", "unknown"]), "in which order the passes of a thread that is cut on both flanks take them: first the one \
                                                                                        that leads along the thread, or the other", if "role:thread.infeed";
    CornerLetters "corner.letters" OneOf(&["axes", "letters"]), "how a corner without a comma is written: I, K and R, or C, R and A", if "said";
    AxesNumbered "axes.numbered" OneOf(&["profile", "letter", "unknown"]), "the order in which the axes have the numbers of their variables: that of the axes in the profile, or that of the letters X Y Z A B C U V W on every machine", if "said";
    HoleSidePlane "hole.side.plane" OneOf(&["diameter", "unknown"]), "what the retract plane of a cycle that drills along X of a lathe is: a diameter, as X is", if "said";
    HoleWaitBuilders "hole.wait.builders" OneOf(&["none", "unknown"]), "what P of a builder's code, as the speed of a live tool, is to a later hole of a lathe that has no P: no wait", if "said";
    HoleWaitCalls "hole.wait.calls" OneOf(&["none", "unknown"]), "what P of a call (M97, M98, G65, M99) is to a later hole of a lathe that has no P: no wait", if "said";
    HolePeckLasts "hole.peck.lasts" OneOf(&["block", "lasts", "unknown"]), "how long Q of a hole of a lathe counts: in its own block, so that the next holes without Q are drilled in one go, or until the cycle \
                                                                            ends", if "op:hole.face or op:hole.face.peck";
    LogicRank "logic.rank" OneOf(&["listed", "unknown"]), "the order of AND, OR, XOR, NOT and of comparisons without brackets: as the table ranks them, so that A AND B EQ C is A AND [B EQ C] where comparisons come first", if "said";
    ModalGroups "modal.groups" OneOf(&["code", "unknown"]), "what a program reads of the modal groups other than motion: the code itself", if "said";
    OffsetNumbers "offset.numbers" OneOf(&["listed", "unknown"]), "the numbers of tool lengths and cutter radii in a memory of another make: as the table lists them", if "said";
    Corners "corners" OneOf(&["words", "moves"]), "how corners and angles of lines are written in programs for this lathe: by their words, or as moves", if "said";
    PowerOffValues "power.off.values" OneOf(&["used", "unused", "unknown"]), "whether programs for this machine use what variables held when it was last switched off, or how vacant they are after power-on", if "said";
    TapDwell "tap.dwell" OneOf(&["none", "waits"]), "the wait at the bottom that programs tell a tap of this mill: it waits, or the threads need none", if "said";
    PeckDwell "peck.dwell" OneOf(&["none", "waits"]), "the wait at the bottom that programs tell a peck drill of this mill: it waits, or the holes need none", if "said";
    TapPeck "tap.peck" OneOf(&["one.go"]), "how a rigid tap that programs tell pecks goes to its depth on the target: in one go", if "said";
    CycleSettings "cycle.settings" OneOf(&["machine"]), "where the cycles of this lathe take what programs cannot tell them: from settings of the machine, which are right for all of them", if "said";
    LineAngle "line.angle" OneOf(&["from.z", "unknown"]), "from where the angle of a line of a lathe counts: from Z, counter-clockwise", if "role:line.angle";
    XCounts "x.counts" OneOf(&["diameter", "radius"]), "what X of a lathe counts: diameters or radii", if "said";
    TurretNone "turret.offset.none" OneOf(&["all", "wear", "unknown"]), "what offset 00 of a lathe's T word takes away: all of the tool's offset, or its wear alone, so that the geometry stays", if "role:tool.turret";
    TurretShort "turret.short" OneOf(&["offset", "both", "station", "unknown"]), "what a lathe's T word of one or two digits says: the offset alone, and the turret stays \
        (T2 is T0002); the station and the offset of the same number (both: T0202); or the station, without an offset (T0200)", if "role:tool.turret";
    TurretGeometry "turret.geometry" OneOf(&["offset", "tool", "unknown"]), "of which number the geometry of a lathe's tool offset is: the number of the offset in the T word, as the wear is, or that of the station", if "role:tool.turret";
    HolePecks "hole.pecks" OneOf(&["plane", "clearance", "unknown"]), "how far a peck of a lathe's drilling cycle goes back: to its retract plane, or by a \
                                                                        clearance", if "op:hole.face or op:hole.face.peck";
    PolarWords "polar.words" OneOf(&["x.c", "x.y", "unknown"]), "the words of moves on a face while C follows them: X as a diameter and C as a length, or X \
                                                                 as a radius and Y", if "op:interpolation.polar.on";
    MotionAfterCycle "motion.after.cycle" OneOf(&["kept", "unknown"]), "the interpolation in force when a drilling cycle has ended";
    CycleBlockRuns "cycle.block.runs" YES, "a drilling cycle's own block drills at the position in it", if "said";
    PocketEnds "pocket.ends" OneOf(&["depth", "start", "unknown"]), "where the tool is after a round pocket: at its depth, or back at the height where it stood before", if "op:pocket.circle.cw";
    CyclePeckNeeded "cycle.peck.needed" YES, "a peck cycle that is told no depth of its pecks, or 0, stops with an alarm", if "said";
    CycleRMissing "cycle.r.missing" OneOf(&["here", "zero", "alarm", "unknown"]), "the retract plane of a drilling cycle that is told none (R): where the tool is when the cycle begins, 0, or it \
                                                                                is an alarm", if "said";
    CyclePeckClearance "cycle.peck.clearance" NUMBER, "how far over the last depth a peck drill begins its next step, millimetres", if "said";
    CycleR0Kept "cycle.r0.kept" YES, "a drilling cycle takes its retract plane from the variable that holds it";
    RotationRunsCycle "rotation.runs.cycle" YES, "a rotation inside an active cycle runs the cycle at the turned place", if "op:rotate.on";
    RotationDirection "rotation.direction" OneOf(&["ccw", "cw", "unknown"]), "which way a positive rotation turns", if "op:rotate.on";
    RotationIncrements "rotation.increments" OneOf(&["tool", "unknown"]), "the centre of a rotation for increments before the first absolute word after its block: where the tool is", if "op:rotate.on";
    RotationCentreIncremental "rotation.centre.incremental" OneOf(&["tool", "zero", "unknown"]), "from where the centre of a rotation counts under G91: from the tool, or from the zero as under G90", if "said";
    RotationAdds "rotation.adds" YES, "the angle of a rotation under G91 is added to the angle before it", if "op:rotate.on";
    MCodesPerBlock "m.codes.per.block" OneOf(&["1", "3", "any", "unknown"]), "how many M codes a block may have";
    MForwardActs "m.forward.acts" WHEN, "when the code that turns the spindle clockwise acts, beside a move", if "said";
    MStartActs "m.start.acts" WHEN, "when a code that starts spindle or coolant acts, beside a move";
    MStopActs "m.stop.acts" WHEN, "when a code that stops spindle or coolant acts, beside a move";
    MChangeActs "m.change.acts" WHEN, "when a tool change acts, beside a move";
    MOtherActs "m.other.acts" WHEN, "when any other M code acts, beside a move";
    MOtherBesideTurret "m.other.beside.turret" OneOf(&["before", "after", "unknown"]), "whether a builder's code that acts with the start of the move, in a block that turns the turret too, acts before the turret turns or \
                                                                                     when it has turned", if "op:threading";
    SActs "s.acts" WHEN, "when a new spindle speed acts, beside a move";
    CoolantOffThrough "coolant.off.through" YES, "the code that ends coolant ends the coolant through the spindle too", if "said";
    StopEndsSpindle "stop.ends.spindle" YES, "a program stop stops the spindle, and the program has to start it again";
    StopEndsCoolant "stop.ends.coolant" YES, "a program stop switches coolant off, and the program has to switch it on again";
    MessageEndsSpindle "message.ends.spindle" YES, "a stop with a message, or a question, stops the spindle", if "statement:stop.message or statement:input";
    MessageEndsCoolant "message.ends.coolant" YES, "a stop with a message, or a question, switches coolant off", if "statement:stop.message or statement:input";
    ChangeEndsSpindle "change.ends.spindle" YES, "a tool change leaves the spindle stopped";
    ChangeEndsCoolant "change.ends.coolant" YES, "a tool change leaves coolant off";
    EndEndsSpindle "end.ends.spindle" YES, "the end of the program stops the spindle";
    EndEndsCoolant "end.ends.coolant" YES, "the end of the program switches coolant off";
    OneGPerGroup "one.g.per.group" YES, "of G codes of one group in a block the last one counts, or it is \
                                         an error";
    DistanceCode "distance.code" OneOf(&["block", "by.place", "unknown"]), "what a code for places or increments (G90, G91) counts for: its whole block, or the words after it, up to \
                                                                      the next of the two", if "said";
    WordTwice "word.twice" YES, "if a letter is in a block twice, the last value counts";
    BlockAssignsFirst "block.assigns.first" YES, "words use the values that their own block gave to variables before them";
    RepeatMoves "repeat.moves" YES, "a repeat word on a move runs the block so many times", if "role:repeat";
    ReferenceLength "reference.length" OneOf(&["kept", "cancelled", "cancelled.along", "unknown"]), "whether a return to the reference position keeps the tool length, cancels it until it is named again, or does so only where the axis of the length moves", if "op:reference.return";
    StandingResults "standing.results" OneOf(&["same", "other", "unknown"]), "whether programs that stand in this machine (probing macros, say) take work offsets by the numbers that they are called with (S101), and put their results into the variables that the programs read", if "said";
    LengthOffZero "length.off.zero" OneOf(&["home", "offset", "unknown"]), "where a rapid move to Z0 without a tool length goes: home, since work offsets have Z 0 and lengths are measured from there, or to the zero of the work offset", if "said";
    MachinePlaces "machine.places" OneOf(&["same", "home", "other", "unknown"]), "whether the places in machine coordinates that the programs move to are right on this machine too, or are those of another machine; home if zero is meant as the home of each machine, and other places are those of another", if "said";
    WorkPlaces "work.places" OneOf(&["same", "other", "unknown"]), "whether the work offsets that the programs write as numbers are right on this machine too, or are those of another machine", if "said";
    MachineMoveRapid "machine.move.rapid" YES, "a move in machine coordinates is a rapid, whatever interpolation is in force", if "said";
    MachineMoveFeed "machine.move.feed" OneOf(&["feed", "rapid"]), "what becomes of a move in machine coordinates that feeds on the old machine, where this one makes every such move by rapid: a feed, or rapid will do", if "said";
    UnitsAgree "units.agree" YES, "a code for another unit than the control is set to is an alarm", if "said";
    MachineUnderIncremental "machine.under.incremental" OneOf(&["place", "increments", "ignored", "unknown"]), "what the words of a move in machine coordinates are under G91: places as under G90, increments, or nothing, since the code is ignored", if "said";
    MachineMoveLength "machine.move.length" OneOf(&["kept", "cancelled.along", "unknown"]), "whether the tool length is back after a move in machine coordinates, or is cancelled until it is named again where its axis moved", if "op:wcs.machine.once";
    LengthMoves "length.moves" YES, "a code of the tool length without a word of its axis moves the axis by the length", if "said";
    ChangeRetracts "change.retracts" OneOf(&["true", "false", "alarm", "unknown"]), "a tool change takes Z to the tool change position first, wherever the program left it; or leaves it there (false); or stops with an alarm if Z is not there (alarm)", if "said";
    RotaryWay "rotary.way" OneOf(&["turns", "shortest", "sign", "unknown"]), "how a rotary axis goes to an absolute angle: turns and all, the shortest way to the place \
                                                                              within one turn, or the way that the sign says", if "said";
    RotaryZeroSign "rotary.zero.sign" YES, "the sign of an angle that is zero is the way of its axis too: A-0 turns the minus way to 0", if "said";
    RotaryStart "rotary.start" OneOf(&["zero", "unknown"]), "a rotary axis stands at 0 when a program begins and after a return to the reference position, and has one zero under all work \
                                                            offsets: the sign of an angle depends on where the axis stands", if "said";
    RotaryFeed "rotary.feed" OneOf(&["degrees", "surface", "unknown"]), "what a feed per minute is where a rotary axis moves: degrees, or the way of the surface by a \
                                                                         diameter that the control is told", if "said";
    ChangeLength "change.length" OneOf(&["kept", "cancelled", "unknown"]), "whether a tool change keeps the tool length in force, or cancels it until it is named again", if "op:tool.change";
    PositionLength "position.length" OneOf(&["added", "left.out", "unknown"]), "whether the present position and the touched one, read in the program's coordinates, hold the tool length too: the place of the spindle, or of the tip";
    CycleRWord "cycle.r.word" YES, "a word R beside a drilling cycle is the retract plane, as R0 is";
    MirrorOffAxes "mirror.off.axes" OneOf(&["named", "all", "unknown"]), "what the end of mirroring ends that names axes: those, or every axis", if "said";
    MirrorOffBare "mirror.off.bare" OneOf(&["all", "unknown"]), "what the end of mirroring ends that names no axis: every one", if "said";
    MirrorAbout "mirror.about" OneOf(&["word", "zero", "sign", "unknown"]), "the point about which an axis is mirrored: the \
                                                                     coordinate in its word, or the work zero, whatever the word \
                                                                     says or if its sign is minus", if "op:mirror.on";
    ShapeFrameCodes "shape.frame.codes" OneOf(&["kept", "unknown"]), "whether a change of plane or of work offset, a set position, a move in machine coordinates and a return to the reference position may stand while coordinates are turned, scaled or mirrored, and do then what they do without", if "op:mirror.on or op:rotate.on";
    ScaleReachesCycle "scale.reaches.cycle" YES, "scaling reaches the planes and the pecks of a drilling cycle", if "op:scale.on";
    ShiftLocalIsExternal "shift.local.is.external" YES, "the local shift and the shift of all work offsets are one register", if "op:wcs.local";
    SetPositionEndsLocal "set.position.ends.local" YES, "a code that sets the position ends the local shift of its axes", if "op:wcs.local";
    SelectEndsSetPosition "select.ends.set.position" YES, "the choice of a work offset ends a position that was set", if "op:wcs.set.position";
    EndClearsLocal "end.clears.local" YES, "the end of the program clears the local shift", if "said";
    ReferenceTogether "reference.together" YES, "a return of all axes to the reference position moves them at the same time", if "said";
    ReferenceAllAxes "reference.all.axes" YES, "a return to the reference position without axes moves all of them", if "op:reference.return";
    IntegerDivides "integer.divides" YES, "the quotient of two whole-number constants is cut to a whole number";
    SkipMidblock "skip.midblock" YES, "a block skip in mid-block skips the rest of the block";
    SkipLevels "skip.levels" YES, "a block skip may have a number";
    InitialValue "initial.value" OneOf(&["zero", "vacant", "kept", "unknown"]), "what a variable holds if nothing has set it";
    CommonAtPowerOn "common.at.power.on" OneOf(&["vacant", "kept", "unknown"]), "what common variables hold after power-on";
    PositionFrame "position.frame" OneOf(&["work", "machine", "unknown"]), "the frame of the position variables";
    CycleShift "cycle.shift" OneOf(&["x+", "x-", "y+", "y-", "unknown"]), "which way a boring cycle moves the tool off the wall, where its word says only how far", if "op:cycle.bore.back";
    RadiusOffsetTable "radius.offset.table" OneOf(&["radius", "diameter", "setting", "unknown"]), "what the cutter table holds";
    OffsetActiveImmediately "offset.active.immediately" YES, "a work offset that is written while selected counts at once";
    LengthActiveImmediately "length.active.immediately" YES, "a tool length that is written while it is in force counts from the next block on, before its number is named again", if "said";
    RadiusActiveImmediately "radius.active.immediately" YES, "a cutter radius that is written while it is in force counts from the next block on, before its number is named again", if "said";
    RadiusOffsetActiveTool "radius.offset.active.tool" YES, "cutter compensation without an offset word takes the active tool's", if "said";
    RadiusByLengthWord "radius.by.length.word" YES, "the word of the tool length beside a code of the cutter radius names that radius, where the block has no number of a radius", if "said";
    LengthWordPicksRadius "length.word.picks.radius" YES, "the word of the length offset picks the cutter radius of the same row too", if "said";
    RadiusWordNames "radius.word.names" OneOf(&["radius", "unknown"]), "what the number of another tool than the one in the spindle does beside a code of the cutter radius, where its letter changes tools: it names a radius, and changes no tool", if "said";
    LengthNeverNamed "length.never.named" OneOf(&["zero", "tool", "unknown"]), "the tool length that its code takes where no number was ever named: none, or that of the tool in the spindle", if "op:length.plus";
    RadiusStartsOnArc "radius.starts.on.arc" YES, "cutter compensation may begin and end on an arc", if "said";
    OffsetOfGroup "offset.of.group" OneOf(&["offset", "group", "unknown"]), "what offset 99 is (T0199, H99, D99): an offset like others, or with the management of tool life that of the tool of the group that T calls", if "op:threading";
    RadiusStillBlocks "radius.still.blocks" YES, "blocks without a move may stand between moves with cutter compensation, however many", if "said";
    ToolChangeWord "tool.change.word" OneOf(&["m6", "t", "unknown"]), "the word that changes the tool";
    ToolWordAgain "tool.word.again" OneOf(&["changes", "skipped", "unknown"]), "what a word that changes the tool does for the tool in the spindle", if "behaviour:tool.change.word=t";
    ChangeWithoutTool "change.without.tool" OneOf(&["same", "pot", "alarm", "unknown"]), "what a code that changes the tool does where no tool was named since the last change: \
        it takes the tool in the spindle again (same), the one that the last change put back and that waits (pot), or it is an alarm", if "behaviour:tool.change.word=m6";
    ToolWordSelectsLength "tool.word.selects.length" YES, "the tool word brings its length offset into force";
    SpindleRangeSuffix "spindle.range.suffix" YES, "a fraction of S picks the gear range and is not part \
                                                    of the speed";
    ClearAll "clear.all" YES, "one statement clears all variables";
    OutputNeedsPort "output.needs.port" YES, "formatted output needs a port that is open", if "statement:output.formatted";
    TextLetters "text.letters" OneOf(&["ascii", "upper", "unknown"]), "the letters that a comment or a message may have: those of ASCII, or capitals alone";
    MessageShowsComment "message.shows.comment" YES, "the comment after a stop is shown to the operator";
    AlarmOffset "alarm.offset" NUMBER, "what is added to the number of an alarm on the screen", if "statement:alarm";
    AlarmMax "alarm.max" NUMBER, "the largest number of an alarm", if "statement:alarm";
    LookaheadRunsEarly "lookahead.runs.early" YES, "macro statements run while earlier moves are still to come";
    EmptyBlockHolds "empty.block.holds" YES, "an empty block holds back reading ahead";
    SystemReadWaits "system.read.waits" YES, "reading a position waits until the machine is there";
    EndCancelsLength "end.cancels.length" YES, "the end of the program cancels length offsets";
    IndexOfFraction "index.of.fraction" OneOf(&["round", "truncate", "unknown"]), "what a computed subscript with a fraction means";
    StepDropsFraction "step.drops.fraction" YES, "INC and DEC throw away the fraction";
    LoadSetsCondition "load.sets.condition" YES, "a plain assignment sets the condition register";
    InputDefaultZero "input.default.zero" YES, "an empty answer of the operator is zero", if "statement:input";
    PrintFormat "print.format" OneOf(&["unknown"]), "digits of printed numbers";
}
