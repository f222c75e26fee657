//! Settings that more than one module asks: the place of the second reference position of other machines, the letters of increments, pecks, and
//! whether the tool in the spindle is changed again.

use super::{Control, Question, Setting, Units};
use crate::canon::{Act, Op, Role};

/// The settings that give it along X, Y and Z, in machine coordinates and the unit of the control.
pub const SECOND_HOME: [&str; 3] =
    ["setting.second_home_x", "setting.second_home_y", "setting.second_home_z"];

/// The setting that says whether U, V, W and H are increments in G code systems that have modes for them.
pub const STEP_LETTERS: &str = "setting.step_letters";

/// The setting that says which M code clamps the C axis for the hole of its block; the code of the next number lets it go.
pub const HOLE_CLAMP: &str = "parameter.5110";

impl Control {
    /// The number of the code that clamps the C axis in a drilling block, and that of the code which lets it go after the hole.
    pub fn hole_clamp_codes(&self) -> Option<[u32; 2]> {
        let number = self.setting(HOLE_CLAMP)?.trim().parse::<u32>().ok()?;
        Some([number, number.checked_add(1)?])
    }

    /// What these two do, as far as a profile says it: the source's may say it of the target's codes ([`Control::meeting`]).
    pub fn hole_clamp(&self) -> [Option<Act>; 2] {
        let Some(codes) = self.hole_clamp_codes() else { return [None; 2] };
        codes.map(|code| {
            let row = self.code('M', f64::from(code), &[]).filter(|row| row.op == Op::Act)?;
            row.fixed.get(&Role::Act).and_then(|act| Act::of(*act))
        })
    }

    /// The setting that says by which letters corners and angles of lines are written, and whether a comma may stand there.
    pub fn corner_setting(&self) -> Option<&Setting> {
        self.setting_of(Question::CornerLetters)
    }

    /// The setting that answers a question.
    pub fn setting_of(&self, question: Question) -> Option<&Setting> {
        let key = question.fact();
        let mut rows = self.dialect().settings.iter();
        rows.find(|row| row.sets.values().any(|sets| sets.contains_key(key)))
    }

    /// True if the word of the tool that is in the spindle changes nothing.
    pub fn skips_same_tool(&self) -> bool {
        self.behaviour(Question::ToolWordAgain).is_some_and(|row| row.value == "skipped")
    }

    /// How far over the last depth a peck of the machine begins, millimetres, as far as its table or its profile says it.
    pub fn peck_clearance(&self) -> Option<f64> {
        self.behaviour(Question::CyclePeckClearance)?.value.parse().ok()
    }

    /// The place along X, Y and Z as far as the profile gives it: millimetres of machine coordinates, X of a lathe a diameter.
    pub fn second_home(&self) -> [Option<f64>; 3] {
        let unit = if self.units() == Some(Units::Inch) { 25.4 } else { 1.0 };
        SECOND_HOME.map(|name| {
            let stated = self.setting(name)?.parse::<f64>().ok();
            stated.filter(|place| place.is_finite()).map(|place| place * unit)
        })
    }
}
