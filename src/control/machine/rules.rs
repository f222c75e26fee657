//! The facts of a control that the machine acts by, read once.

mod answers;

use super::frame::UnderIncremental;
use super::lathe::Turning;
use super::places::Places;
use super::rigid::Taps;
use crate::canon::{Act, Auxiliary, Op, Pause, Role, Running, Sys};
use crate::control::trace::Trace;
use crate::dialect::{Control, Machine, Question};
pub use answers::{BareChange, LengthAfter, NoCentre, NoPlane, RadiusTable};
use std::collections::BTreeMap;
use std::sync::Arc;

/// A fact: the answer acted by, and its name if nobody confirmed it.
#[derive(Clone, Debug, Default)]
pub struct Fact<T> {
    pub(super) value: T,
    pub(super) unsure: Option<&'static str>,
}

impl<T: Copy> Fact<T> {
    /// The answer, in a place where it matters.
    pub fn ask(&self, trace: &mut Trace) -> T {
        if let Some(name) = self.unsure {
            trace.doubt(name);
        }
        self.value
    }

    /// True if nobody confirmed it.
    pub fn is_unsure(&self) -> bool {
        self.unsure.is_some()
    }

    /// The answer, in a place where it does not matter yet.
    pub fn peek(&self) -> T {
        self.value
    }
}

/// The answer to a question of behaviour. A silent table and an unknown answer give `otherwise`, unsure.
pub fn fact<T>(
    control: &Control,
    question: Question,
    read: impl Fn(&str) -> Option<T>,
    otherwise: T,
) -> Fact<T> {
    let row = control.behaviour(question);
    let known = row.and_then(|row| Some((read(&row.value)?, row.origin.is_settled())));
    let unsure = !known.as_ref().is_some_and(|(_, confirmed)| *confirmed);
    Fact { value: known.map_or(otherwise, |(value, _)| value), unsure: unsure.then(|| question.fact()) }
}

/// The answer to a yes-or-no question.
pub fn yes(control: &Control, question: Question, otherwise: bool) -> Fact<bool> {
    let read = |value: &str| match value {
        "true" => Some(true),
        "false" => Some(false),
        _ => None,
    };
    fact(control, question, read, otherwise)
}

/// The facts.
#[derive(Clone, Debug)]
pub struct Rules {
    /// Whether each kind of [`Auxiliary`] acts when the move of its block is done.
    late: [Fact<bool>; Auxiliary::ALL.len()],
    /// Whether each kind of stop ends spindle and coolant, and whether that is known.
    ends: [[(Option<bool>, bool); Running::ALL.len()]; Pause::ALL.len()],
    /// The variables that builders' codes set, by the numbers of their names.
    pub sets: BTreeMap<Act, Vec<u32>>,
    /// The word of a builder's code that is S, by its act: without it the last S counts.
    pub speaks: BTreeMap<Act, Role>,
    /// True if a code cancels all zero shifts, or a word that selects them takes 0 for none.
    pub cancels_offsets: bool,
    pub negative_radius_is_long: Fact<bool>,
    pub positive_radius_is_short: Fact<bool>,
    pub no_centre: Fact<NoCentre>,
    pub centre_is_incremental: Fact<bool>,
    pub planes_frozen: Fact<bool>,
    /// How far over the last depth a peck begins, where the machine's profile says it: millimetres.
    pub peck_clearance: Option<f64>,
    /// How it taps.
    pub taps: Taps,
    /// True if the code that ends coolant leaves the one through the spindle on, as the profile says.
    pub through_stays: bool,
    /// Where places in machine coordinates lie on the machine that the programs go to.
    pub places: Arc<Places>,
    pub zero_repeats_stores: Fact<bool>,
    pub zero_repeats_moves: Fact<bool>,
    pub repeats_move: Fact<bool>,
    /// A change between turns and a surface speed without a speed brings back the last one of that mode; else the turns stay.
    pub speed_kept: Fact<bool>,
    /// A block without an axis makes the turning, threading or facing pass in force once more.
    pub pass_alone: Fact<bool>,
    /// A builder's code beside T and a move acts when the turret has turned.
    pub turret_first: Fact<bool>,
    /// The depth of a roughing pass does nothing beside the finishing of a contour.
    pub finish_depth: Fact<()>,
    /// An allowance beside the finishing of a contour does nothing.
    pub finish_allowance: Fact<bool>,
    /// What clamps the C axis in a drilling block, and what lets it go when the tool is back at the plane.
    pub hole_clamp: [Option<Act>; 2],
    pub hole_clamp_acts: Fact<()>,
    /// A G code for its own block, other than a wait, takes away what the pass in force was told.
    pub pass_cleared: Fact<bool>,
    /// Whether a boring cycle goes off the wall along the second axis of the plane, and which way.
    pub cycle_shift: Fact<(bool, f64)>,
    pub cycle_block_runs: Fact<bool>,
    pub cycle_runs_without_axes: Fact<bool>,
    pub cycle_runs_without_words: Fact<bool>,
    pub cycle_runs_by_depth: Fact<bool>,
    pub rotation_runs_cycle: Fact<bool>,
    pub rotation_is_ccw: Fact<bool>,
    /// The angle of a rotation in increments adds to the one in force.
    pub rotation_adds: Fact<bool>,
    /// The angle of a rotation and the factor of a scaling that do not say it.
    pub bare_shapes: [Option<f64>; 2],
    /// A tool length that is written while it is in force counts at once.
    pub length_acts_at_once: Fact<bool>,
    /// Increments right after a rotation turn about where the tool is.
    pub first_increments: Fact<()>,
    /// Drilling cycles run in any plane; else under G17 alone.
    pub cycles_in_any_plane: Fact<bool>,
    /// The tool stays at the depth of a round pocket; else it is back where it began.
    pub pocket_ends_deep: Fact<bool>,
    /// A peck cycle without the depth of its pecks stops with an alarm.
    pub pecks_need_depth: bool,
    /// The retract plane of a drilling cycle that is told none.
    pub no_plane: Fact<NoPlane>,
    /// The time of a wait is that of the cycle in force too.
    pub dwell_is_of_cycle: Fact<bool>,
    /// Words of a cycle are kept in a block that drills nothing.
    pub lone_words_kept: Fact<bool>,
    pub motion_ends_cycle: Fact<bool>,
    /// An arc does, where other codes of motion do.
    pub arc_ends_cycle: Fact<bool>,
    pub offset_acts_at_once: Fact<bool>,
    pub radius_table: Fact<RadiusTable>,
    pub tool_word_changes: Fact<bool>,
    /// The word changes the tool that is in the spindle anew.
    pub tool_word_again: Fact<bool>,
    /// What a change without a tool that was named takes.
    pub bare_change: Fact<BareChange>,
    pub tool_word_selects_length: Fact<bool>,
    pub cutter_takes_tool: Fact<bool>,
    pub length_picks_radius: Fact<bool>,
    /// Where no number of a length was ever named, its code takes that of the tool in the spindle.
    pub unnamed_length_is_tools: Fact<bool>,
    /// Cutter compensation may begin and end on an arc.
    pub radius_starts_on_arc: Fact<bool>,
    /// Blocks without a move may stand between compensated moves.
    pub still_blocks: Fact<bool>,
    pub end_cancels_length: Fact<bool>,
    pub reference_takes_all: Fact<bool>,
    pub under_incremental: Fact<UnderIncremental>,
    pub centre_from_tool: Fact<bool>,
    pub radius_by_length_word: Fact<bool>,
    pub length_after_reference: Fact<LengthAfter>,
    pub length_after_machine_move: Fact<LengthAfter>,
    /// A move in machine coordinates is rapid under any interpolation.
    pub machine_move_is_rapid: bool,
    /// A code of the tool length without a word of Z moves Z by it.
    pub length_moves: bool,
    /// The sign of an absolute angle is the way of its axis.
    pub turns_by_sign: bool,
    /// That of zero too.
    pub zero_has_sign: bool,
    /// A word of a rotary axis alone runs the cycle in force.
    pub cycle_runs_by_rotary: Fact<bool>,
    pub length_after_change: Fact<LengthAfter>,
    pub mirrors_about_word: Fact<bool>,
    /// True if the word of an axis is a sign: minus mirrors it about zero, and plus ends that.
    pub mirrors_by_sign: bool,
    pub mirror_off_names: Fact<bool>,
    pub mirror_off_bare: Fact<()>,
    pub positions_hold_length: Fact<bool>,
    /// What codes of the frame do under a rotation, a scale or a mirror is nowhere another answer.
    pub frame_codes_when_shaped: Fact<()>,
    pub scale_reaches_cycle: Fact<()>,
    pub local_is_external: Fact<bool>,
    pub set_position_ends_local: Fact<bool>,
    pub end_clears_local: Fact<bool>,
    /// True where length and radius share a table.
    pub shared_offsets: bool,
    /// True on a lathe: X is a diameter.
    pub lathe: bool,
    /// A roughing always ends with a pass along the contour; else with a level on its bottom, and along it only with an
    /// allowance for that (K5, K9 of docs/lathe.md).
    pub roughing_along: Fact<bool>,
    /// A peck of a lathe's drilling cycle goes back to its retract plane, or by the clearance; none where nobody says it (Q7).
    pub pecks_to_plane: Fact<bool>,
    /// A face is milled with C in words of X as a diameter and C as a length; else of X as a radius and Y; none if the table does not say it (V1).
    pub face_by_c: Fact<Option<bool>>,
    /// A thread that is cut on both flanks begins with the leading one; none if the table does not know (P6).
    pub leading_first: Fact<Option<bool>>,
    /// The settings of a lathe.
    pub turning: Turning,
}

impl Rules {
    /// The facts of a control.
    pub fn new(control: &Control) -> Self {
        let word = |yes: &'static str, no: &'static str| {
            move |value: &str| (value == yes || value == no).then_some(value == yes)
        };
        let only = |answer: &'static str| move |value: &str| (value == answer).then_some(());
        let has = |state| control.system_run(state).is_some();
        let table = |value: &str| match value {
            "radius" => Some(RadiusTable::Radius),
            "diameter" => Some(RadiusTable::Diameter),
            _ => None,
        };
        let length_after = |value: &str| match value {
            "kept" => Some(LengthAfter::Kept),
            "cancelled" => Some(LengthAfter::Cancelled),
            "cancelled.along" => Some(LengthAfter::CancelledAlong),
            _ => None,
        };
        let no_centre = |value: &str| match value {
            "error" => Some(NoCentre::Alarm),
            "straight" => Some(NoCentre::Straight),
            _ => None,
        };
        let negative_is_long = fact(control, Question::ArcRadiusNegative, word("long", "short"), true);
        // Where only the minus is known, the plus is the other arc.
        let plus = negative_is_long.peek();
        let late = |kind: Auxiliary| {
            let acts = control.acts(kind);
            Fact { value: acts.late, unsure: (!acts.known).then(|| acts.question.fact()) }
        };
        let after = |question| fact(control, question, length_after, LengthAfter::Kept);
        Self {
            late: Auxiliary::ALL.map(late),
            sets: super::spoken::sets(control),
            speaks: super::spoken::all(control),
            ends: Pause::ALL.map(|pause| {
                Running::ALL.map(|running| {
                    let ends = control.ends(pause, running);
                    (ends.answer, ends.known)
                })
            }),
            cancels_offsets: control.code_for(Op::ShiftCancel, &BTreeMap::new()).is_some()
                || control.word_for(Op::SelectWork).is_some(),
            positive_radius_is_short: fact(control, Question::ArcRadiusPositive, word("short", "long"), plus),
            negative_radius_is_long: negative_is_long,
            no_centre: fact(control, Question::ArcWithoutCentre, no_centre, NoCentre::Alarm),
            centre_is_incremental: fact(control, Question::ArcCentre, word("incremental", "absolute"), true),
            taps: Taps::of(control),
            peck_clearance: control.peck_clearance(),
            planes_frozen: yes(control, Question::CyclePlanesFrozen, true),
            zero_repeats_stores: yes(control, Question::CycleL0Stores, true),
            repeats_move: yes(control, Question::RepeatMoves, false),
            zero_repeats_moves: yes(control, Question::CycleL0Moves, false),
            speed_kept: fact(control, Question::SpeedKept, word("mode", "turns"), true),
            through_stays: answers::are(control, Question::CoolantOffThrough, "false"),
            places: Arc::new(Places::of(control)),
            pass_alone: fact(control, Question::PassAlone, word("repeats", "nothing"), false),
            turret_first: fact(control, Question::MOtherBesideTurret, word("after", "before"), false),
            finish_depth: fact(control, Question::FinishDepth, only("ignored"), ()),
            finish_allowance: answers::ignored(control, Question::FinishAllowance),
            hole_clamp: control.hole_clamp(),
            hole_clamp_acts: fact(control, Question::HoleClamp, only("plane"), ()),
            pass_cleared: fact(control, Question::PassData, word("cleared", "kept"), false),
            cycle_shift: super::expand::shift_of(control),
            cycle_block_runs: yes(control, Question::CycleBlockRuns, true)
                .or_silent(control, Question::CycleBlockRuns),
            cycle_runs_without_axes: yes(control, Question::CycleRunsWithoutAxes, false),
            cycle_runs_without_words: yes(control, control.of_wordless_cycles(), false),
            cycle_runs_by_depth: yes(control, Question::CycleRunsByDepth, false),
            rotation_runs_cycle: yes(control, Question::RotationRunsCycle, false),
            rotation_adds: yes(control, Question::RotationAdds, false)
                .or_silent(control, Question::RotationAdds),
            bare_shapes: [control.bare_angle(), control.bare_factor()],
            length_acts_at_once: yes(control, Question::LengthActiveImmediately, true)
                .or_silent(control, Question::LengthActiveImmediately),
            first_increments: fact(control, Question::RotationIncrements, only("tool"), ())
                .or_silent(control, Question::RotationIncrements),
            rotation_is_ccw: fact(control, Question::RotationDirection, word("ccw", "cw"), true),
            pocket_ends_deep: fact(control, Question::PocketEnds, word("depth", "start"), true),
            pecks_need_depth: control.is(Question::CyclePeckNeeded),
            cycles_in_any_plane: fact(control, Question::CyclePlane, word("any", "xy"), true)
                .or_silent(control, Question::CyclePlane),
            dwell_is_of_cycle: fact(
                control,
                Question::CycleDwellShared,
                |value| Some(value != "false"),
                false,
            )
            .or_silent(control, Question::CycleDwellShared),
            lone_words_kept: fact(control, Question::CycleWordsAlone, word("kept", "ignored"), true)
                .or_silent(control, Question::CycleWordsAlone),
            motion_ends_cycle: yes(control, Question::CycleEndsByMotion, true)
                .or_silent(control, Question::CycleEndsByMotion),
            arc_ends_cycle: fact(control, Question::CycleEndsByArc, |value| Some(value == "true"), true)
                .or_silent(control, Question::CycleEndsByArc),
            offset_acts_at_once: yes(control, Question::OffsetActiveImmediately, true),
            // Where it is a setting nobody stated, as conversions take it.
            radius_table: fact(control, Question::RadiusOffsetTable, table, RadiusTable::Diameter),
            tool_word_changes: fact(control, Question::ToolChangeWord, |value| Some(value == "t"), false),
            tool_word_again: answers::tool_again(control),
            no_plane: answers::no_plane(control),
            bare_change: answers::bare_change(control),
            tool_word_selects_length: yes(control, Question::ToolWordSelectsLength, false),
            cutter_takes_tool: yes(control, Question::RadiusOffsetActiveTool, false),
            length_picks_radius: yes(control, Question::LengthWordPicksRadius, false),
            unnamed_length_is_tools: fact(control, Question::LengthNeverNamed, word("tool", "zero"), false)
                .or_silent(control, Question::LengthNeverNamed),
            radius_starts_on_arc: yes(control, Question::RadiusStartsOnArc, true)
                .or_silent(control, Question::RadiusStartsOnArc),
            still_blocks: yes(control, Question::RadiusStillBlocks, true)
                .or_silent(control, Question::RadiusStillBlocks),
            end_cancels_length: yes(control, Question::EndCancelsLength, false),
            reference_takes_all: yes(control, Question::ReferenceAllAxes, false),
            under_incremental: fact(
                control,
                Question::MachineUnderIncremental,
                UnderIncremental::read,
                UnderIncremental::Place,
            )
            .or_silent(control, Question::MachineUnderIncremental),
            centre_from_tool: fact(control, Question::RotationCentreIncremental, word("tool", "zero"), true)
                .or_silent(control, Question::RotationCentreIncremental),
            radius_by_length_word: yes(control, Question::RadiusByLengthWord, false)
                .or_silent(control, Question::RadiusByLengthWord),
            length_after_reference: after(Question::ReferenceLength),
            length_after_machine_move: after(Question::MachineMoveLength),
            machine_move_is_rapid: control.is(Question::MachineMoveRapid),
            length_moves: control.is(Question::LengthMoves),
            turns_by_sign: answers::turns_by_sign(control),
            zero_has_sign: answers::zero_has_sign(control),
            cycle_runs_by_rotary: yes(control, Question::CycleRunsByRotary, true)
                .or_silent(control, Question::CycleRunsByRotary),
            length_after_change: after(Question::ChangeLength).or_silent(control, Question::ChangeLength),
            positions_hold_length: fact(control, Question::PositionLength, word("added", "left.out"), false),
            mirror_off_names: fact(control, Question::MirrorOffAxes, word("named", "all"), true)
                .or_silent(control, Question::MirrorOffAxes),
            mirror_off_bare: fact(control, Question::MirrorOffBare, only("all"), ()),
            mirrors_by_sign: answers::are(control, Question::MirrorAbout, "sign"),
            mirrors_about_word: fact(control, Question::MirrorAbout, word("word", "zero"), true),
            frame_codes_when_shaped: fact(control, Question::ShapeFrameCodes, only("kept"), ()),
            scale_reaches_cycle: fact(control, Question::ScaleReachesCycle, only("true"), ()),
            local_is_external: yes(control, Question::ShiftLocalIsExternal, false)
                .or_silent(control, Question::ShiftLocalIsExternal),
            set_position_ends_local: yes(control, Question::SetPositionEndsLocal, false),
            end_clears_local: yes(control, Question::EndClearsLocal, false),
            shared_offsets: has(Sys::ToolOffset) && !has(Sys::LengthGeometry),
            lathe: control.machine() == Machine::Lathe,
            roughing_along: fact(control, Question::RoughingEnds, word("along", "levels"), true),
            pecks_to_plane: fact(
                control,
                Question::HolePecks,
                |value| ["plane", "clearance"].contains(&value).then_some(value == "plane"),
                true,
            ),
            face_by_c: fact(
                control,
                Question::PolarWords,
                |value| ["x.c", "x.y"].contains(&value).then_some(Some(value == "x.c")),
                None,
            ),
            leading_first: fact(
                control,
                Question::ThreadFlanks,
                |value| {
                    ["leading.first", "trailing.first"]
                        .contains(&value)
                        .then_some(Some(value == "leading.first"))
                },
                None,
            ),
            turning: Turning::new(control),
        }
    }

    /// Whether a stop ends what is running, and whether that is known.
    pub fn ends(&self, pause: Pause, running: Running) -> (Option<bool>, bool) {
        self.ends[pause as usize][running as usize]
    }

    /// Whether an operation of a kind acts when the move of its block is done.
    pub fn acts_late(&self, kind: Auxiliary) -> &Fact<bool> {
        &self.late[kind as usize]
    }
}

impl<T> Fact<T> {
    /// Sure where the table does not ask: then the control is like all others.
    fn or_silent(mut self, control: &Control, question: Question) -> Self {
        if control.behaviour(question).is_none() {
            self.unsure = None;
        }
        self
    }
}
