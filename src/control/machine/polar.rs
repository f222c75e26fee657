//! Polar coordinates that a code switches on: the first axis of the plane is a distance, the second an angle.
//!
//! The distance counts from the zero of the program, under G91 from where the tool is; an angle under G91 adds to the last one
//! (page 147 of the manual that the row of the code names). What is left out is what it was last.

use super::command::is_rotary;
use super::{Command, Machine};
use crate::canon::{Group, Op, Role};
use crate::control::scenario::Axes;
use crate::control::trace::Trace;
use crate::control::words::to_increment;

/// What the words were last, since polar coordinates are in force.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Words {
    /// Millimetres from the zero of the program; none after a distance from elsewhere.
    distance: Option<f64>,
    /// Degrees.
    angle: Option<f64>,
}

impl Machine {
    /// Distance and angle in the words of a block.
    fn polar_words(&self, command: &Command) -> [Option<f64>; 2] {
        let (first, second, _) = self.plane.axes();
        let of = |axis, role| {
            let plain = command.axes().find(|(found, _)| *found == axis).map(|(_, value)| value);
            command.word(role).or(plain)
        };
        [of(first, Role::PolarDistance), of(second, Role::PolarAngle)]
    }

    /// Notes what no source says of a block: a word that was not said before.
    pub(super) fn polar_matters(&self, command: &Command, trace: &mut Trace) {
        let Some(last) = self.polar else { return };
        let unsaid = match self.polar_words(command) {
            [None, None] => false,
            [None, Some(_)] => last.distance.is_none() || self.incremental && last.angle.is_none(),
            [Some(_), None] => last.angle.is_none(),
            [Some(_), Some(_)] => self.incremental && last.angle.is_none(),
        };
        if unsaid {
            trace.doubt("machine:polar.word.left.out");
        }
    }

    /// The distance of a block, millimetres, and what it says of polar coordinates; none if it says nothing of them.
    fn polar_place(&self, command: &Command) -> Option<(f64, Words)> {
        let last = self.polar?;
        let words = self.polar_words(command);
        if words == [None, None] {
            return None;
        }
        let (first, second, _) = self.plane.axes();
        let work = self.frame.program(&self.position);
        let from_tool = self.incremental && words[0].is_some();
        let distance = words[0].map(|length| length * self.unit()).or(last.distance);
        let distance = distance.unwrap_or_else(|| work[first].hypot(work[second]));
        let before = last.angle.unwrap_or_else(|| work[second].atan2(work[first]).to_degrees());
        let angle = match words[1] {
            Some(more) if self.incremental => before + more,
            Some(angle) => angle,
            None => before,
        };
        Some((distance, Words { distance: (!from_tool).then_some(distance), angle: Some(angle) }))
    }

    /// Where a block goes: what is worked out ends on a least increment, as a word does.
    pub(super) fn polar_target(&self, command: &Command) -> Axes {
        let (first, second, _) = self.plane.axes();
        let mut work = self.frame.program(&self.position);
        for (axis, value) in command.axes().filter(|(axis, _)| *axis != first && *axis != second) {
            let value = if is_rotary(axis) { value } else { value * self.unit() };
            work[axis] = if self.incremental { work[axis] + value } else { value };
        }
        if let Some((distance, words)) = self.polar_place(command) {
            let pole = if words.distance.is_some() { [0.0; 2] } else { [work[first], work[second]] };
            let (sin, cos) = super::frame::sin_cos(words.angle.unwrap_or(0.0));
            let (least, unit) = (self.least_length(), self.unit());
            let place = |far: f64, pole: f64| to_increment(distance.mul_add(far, pole) / unit, least) * unit;
            (work[first], work[second]) = (place(cos, pole[0]), place(sin, pole[1]));
        }
        self.frame.machine(&work)
    }

    /// Keeps what a block has said, for the next one.
    pub(super) fn keep_polar(&mut self, command: &Command) {
        if let Some((_, words)) = self.polar_place(command) {
            self.polar = Some(words);
        }
    }
}

/// True for a code after which the tool may stand elsewhere from the zero than the last words say.
pub(super) fn ends_words(op: Op) -> bool {
    matches!(op.group(), Group::WorkOffset | Group::Rotation | Group::Scaling | Group::Mirror)
        || matches!(op, Op::MachineOnce | Op::LocalShift | Op::SetPosition | Op::WriteWork | Op::Home)
        || matches!(op, Op::ReferenceReturn | Op::ReferenceFrom | Op::Reference2)
}
