//! The settings of a lathe, read once.

use crate::canon::{Act, CycleSetting, Op, Role};
use crate::control::machine::INCH;
use crate::control::machine::rules::{Fact, fact};
use crate::dialect::{Axis, Control, Question, Setting, Units};
use std::collections::{BTreeMap, BTreeSet};

/// The settings; lengths in millimetres.
#[derive(Clone, Debug, Default)]
pub struct Turning {
    /// True where parameters stand in for what no block says: a control of which a block before that of a cycle may set it.
    pub two_blocks: bool,
    /// True where threads of many passes have such a block.
    pub thread_form: bool,
    /// True where the feed counts a turn when power comes on; none if no source says it.
    pub feeds_by_turn: Option<bool>,
    /// True where a move in machine coordinates is a rapid under any interpolation (Z4).
    pub machine_rapid: bool,
    /// The unit that a code must agree with (Z10), where the profile says it: true for inches.
    pub inch_set: Option<bool>,
    /// True where the return of the C axis engages it, and a start of the spindle lets it go (Q4).
    pub c_by_return: bool,
    /// P of a call is never the wait of a hole (S10).
    pub calls_are_no_wait: bool,
    /// Q of a hole lasts until its cycle ends, where one code drills with it and without (Q7).
    pub peck_lasts: Fact<bool>,
    /// A code of the builder engages C.
    pub c_by_code: bool,
    /// True where a negative radius of an arc is an alarm (C7).
    pub radius_not_negative: bool,
    /// True where G40 to G42 in a contour that is roughed are an alarm (R7).
    pub nose_alarms: bool,
    /// True where offset 00 takes the wear alone away (T4).
    pub keeps_geometry: bool,
    /// What a T word with digits for the offset alone says: the table of T words reads it.
    pub short_word: Fact<()>,
    /// True where the geometry has the number of the station, and the wear that of the offset (T3).
    pub geometry_by_station: bool,
    /// True where X is written as a radius (C1).
    pub radii: bool,
    /// True where corners are written by C and R without a comma (Q3).
    pub letters: bool,
    /// True where only a word says that a contour has valleys (R6).
    pub valleys_by_word: bool,
    /// How far the end of an arc may lie off its circle (C8).
    pub arc_limit: Option<f64>,
    /// Depth and retract of roughing.
    pub depth: Option<f64>,
    pub retract: Option<f64>,
    /// False where a contour may go beyond the start of the cycle (R11).
    pub checks_start: bool,
    /// Whether roughing leaves out its pass along a contour: of one without valleys, and of one with them (K9).
    pub skips_along: [bool; 2],
    /// How far off the first pass of a repeated contour lies, and how many passes there are.
    pub pattern: [Option<f64>; 3],
    /// Retract of pecks.
    pub peck_retract: Option<f64>,
    /// The least depth, the finishing allowance, the run-out in leads and its angle, of threads.
    pub thread_least: Option<f64>,
    pub thread_allowance: Option<f64>,
    pub run_out: Option<f64>,
    pub run_out_angle: Option<f64>,
    /// Finishing passes of threads.
    pub thread_finishes: Option<f64>,
    /// The angle between the flanks of threads.
    pub thread_angle: Option<f64>,
    /// The angles that threads of many passes may have, degrees; none if every angle may stand (P3).
    pub thread_angles: Option<Vec<f64>>,
    /// True where the machine's profile names a C axis.
    pub has_c: bool,
    /// What a scenario leaves to the machine, on both sides.
    pub left: BTreeSet<CycleSetting>,
    /// The axes that its profile lists, by their places in a position; X and Z where it lists none.
    pub axes: Vec<usize>,
}

/// The places in a position of the axes that a profile lists; of X and Z where it lists none.
fn axes(control: &Control) -> Vec<usize> {
    let listed = control.profile().axes.iter().flatten();
    let places: Vec<usize> = listed.map(|axis| axis.number() as usize - 1).collect();
    if places.is_empty() { vec![0, 2] } else { places }
}

impl Turning {
    /// Those of a control.
    pub fn new(control: &Control) -> Self {
        Self::with(control, &BTreeMap::new(), None)
    }

    /// The same with some settings that are another than the profile says, and set to another unit where one is given (true for
    /// inches). What a length is then that only the profile gives, no source says: a number may stay, or be converted.
    pub fn with(control: &Control, others: &BTreeMap<String, f64>, set_to_inch: Option<bool>) -> Self {
        let answer = |question| control.behaviour(question).map(|row| row.value.as_str());
        let agrees = answer(Question::UnitsAgree) == Some("true");
        let profile = control.units().map(|units| units == Units::Inch);
        let set_to_inch = set_to_inch.filter(|_| agrees);
        let turned = profile.is_some() && set_to_inch.is_some_and(|inch| profile != Some(inch));
        let inch = set_to_inch.or(profile).unwrap_or(false);
        let unit = if inch { INCH } else { 1.0 };
        let stated = |name: &str| control.setting(name).and_then(|value| value.parse::<f64>().ok());
        let number = |name: &str| others.get(name).copied().or_else(|| stated(name));
        let told = |name: &str| control.told(name).and_then(|(row, _)| number(&row.name));
        // The setting that cycles take a word from: always, or where no block says it.
        let given = |role: Role, cycles: &[Op]| {
            let gives = |row: &&Setting| row.gives == Some(role) || row.otherwise == Some(role);
            let rows = control.dialect().settings.iter().filter(gives);
            let mut rows = rows.filter(|row| row.cycles.iter().any(|op| cycles.contains(op)));
            let of = |row: &Setting| {
                let own = stated(&row.name).filter(|value| !(turned && role.is_length() && *value != 0.0));
                others.get(&row.name).copied().or(own)
            };
            rows.find_map(|row| of(row).map(|value| value / row.whole()))
        };
        let length = |role: Role, cycles: &[Op]| given(role, cycles).map(|value| value * unit);
        let (rough, pecks) = ([Op::RoughTurning, Op::RoughFacing], [Op::Groove, Op::FaceGroove]);
        let stand_in = |row: &Setting| row.otherwise == Some(Role::ThreadLeast);
        Self {
            two_blocks: control.dialect().settings.iter().any(stand_in),
            thread_form: control.code_for(Op::ThreadingSetup, &Default::default()).is_some(),
            feeds_by_turn: control
                .told("lathe.feed")
                .and_then(|(_, value)| value)
                .map(|value| value == "turn"),
            machine_rapid: answer(Question::MachineMoveRapid) != Some("false"),
            radius_not_negative: (control.dialect().forbidden.iter())
                .any(|row| row.negative && row.words.contains(&Role::ArcRadius)),
            inch_set: set_to_inch.or(profile).filter(|_| agrees),
            calls_are_no_wait: answer(Question::HoleWaitCalls) == Some("none"),
            peck_lasts: fact(
                control,
                Question::HolePeckLasts,
                |value| ["lasts", "block"].contains(&value).then_some(value == "lasts"),
                false,
            ),
            c_by_code: control.code_of(Act::named(Act::C_AXIS[0])).is_some(),
            c_by_return: answer(Question::CAxisEngages) == Some("return"),
            nose_alarms: answer(Question::ContourNose) == Some("alarm"),
            keeps_geometry: answer(Question::TurretNone) == Some("wear"),
            short_word: fact(control, Question::TurretShort, |value| (value != "unknown").then_some(()), ()),
            geometry_by_station: answer(Question::TurretGeometry) == Some("tool"),
            radii: answer(Question::XCounts) == Some("radius"),
            letters: answer(Question::CornerLetters) == Some("letters"),
            valleys_by_word: answer(Question::RoughingValleys) == Some("word"),
            arc_limit: told("arc.limit").map(|value| value * unit),
            depth: length(Role::CutDepth, &rough),
            retract: length(Role::CutRetract, &rough),
            checks_start: control.told("contour.start.checked").and_then(|(_, value)| value) != Some("0"),
            skips_along: [false, true].map(|valleys| control.skips_along(valleys).is_some()),
            pattern: [
                length(Role::PatternX, &[Op::Pattern]),
                length(Role::PatternZ, &[Op::Pattern]),
                given(Role::Passes, &[Op::Pattern]),
            ],
            peck_retract: length(Role::CutRetract, &pecks),
            thread_least: length(Role::ThreadLeast, &[Op::Threading]),
            thread_allowance: length(Role::ThreadAllowance, &[Op::Threading]),
            run_out: given(Role::ThreadRunOut, &[Op::Threading]),
            run_out_angle: told("thread.run.out.angle"),
            thread_finishes: given(Role::ThreadFinishes, &[Op::Threading]),
            thread_angle: given(Role::ThreadAngle, &[Op::Threading]),
            thread_angles: answer(Question::ThreadAngles)
                .filter(|list| !["any", "unknown"].contains(list))
                .map(|list| list.split('.').filter_map(|angle| angle.parse().ok()).collect()),
            left: BTreeSet::new(),
            axes: axes(control),
            has_c: control.profile().axes.as_ref().is_some_and(|axes| axes.contains(&Axis::C)),
        }
    }
}
