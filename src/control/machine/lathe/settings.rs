//! The settings of a lathe, read once.

use crate::canon::Op;
use crate::control::machine::INCH;
use crate::dialect::{Axis, Control, Units};
use std::collections::BTreeMap;

/// The settings; lengths in millimetres.
#[derive(Clone, Debug, Default)]
pub struct Turning {
    /// True where a block before that of a cycle sets what it takes: threads of many passes have one.
    pub two_blocks: bool,
    /// True where the feed counts a turn when power comes on; none if no source says it.
    pub feeds_by_turn: Option<bool>,
    /// True where only a word says that a contour has valleys (R6).
    pub valleys_by_word: bool,
    /// How far the end of an arc may lie off its circle (C8).
    pub arc_limit: Option<f64>,
    /// Depth and retract of roughing.
    pub depth: Option<f64>,
    pub retract: Option<f64>,
    /// Retract of pecks.
    pub peck_retract: Option<f64>,
    /// The least depth, the finishing allowance, the run-out in leads and its angle, of threads.
    pub thread_least: Option<f64>,
    pub thread_allowance: Option<f64>,
    pub run_out: Option<f64>,
    pub run_out_angle: Option<f64>,
    /// True where the machine's profile names a C axis.
    pub has_c: bool,
}

impl Turning {
    /// Those of a control.
    pub fn new(control: &Control) -> Self {
        Self::with(control, &BTreeMap::new())
    }

    /// The same with some settings that are another than the profile says.
    pub fn with(control: &Control, others: &BTreeMap<String, f64>) -> Self {
        let unit = if control.units() == Some(Units::Inch) { INCH } else { 1.0 };
        let stated = |name: &str| control.setting(name).and_then(|value| value.parse::<f64>().ok());
        let number = |name: &str| others.get(name).copied().or_else(|| stated(name));
        let length = |names: [&str; 2]| names.into_iter().find_map(number).map(|value| value * unit);
        Self {
            two_blocks: control.code_for(Op::ThreadingSetup, &Default::default()).is_some(),
            feeds_by_turn: control.setting("setting.lathe_feed").map(|value| value == "turn"),
            valleys_by_word: control.setting("setting.33") == Some("yasnac"),
            arc_limit: length(["parameter.3410", "setting.arc_limit"]),
            depth: length(["parameter.5132", "setting.72"]),
            retract: length(["parameter.5133", "setting.73"]),
            peck_retract: length(["parameter.5139", "setting.22"]),
            thread_least: length(["parameter.5140", "setting.99"]),
            thread_allowance: length(["parameter.5141", "setting.86"]),
            run_out: number("setting.95"),
            run_out_angle: number("setting.96"),
            has_c: control.profile().axes.as_ref().is_some_and(|axes| axes.contains(&Axis::C)),
        }
    }
}
