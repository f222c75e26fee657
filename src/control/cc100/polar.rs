//! Polar words: an angle and a distance from the pole, or from where the machine stands.

use crate::canon::{Op, Role};
use crate::control::machine::Command;
use crate::control::trace::Trace;
use crate::control::words::to_increment;

/// The pole, and the words that stay.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Polar {
    /// The pole, program coordinates and units.
    pub pole: (f64, f64),
    angle: Option<f64>,
    distance: Option<f64>,
}

impl Polar {
    /// Takes the pole of a block, and turns its polar words into X and Y; these are rounded to `increment` where computed
    /// words are.
    pub fn resolve(
        &mut self,
        command: &mut Command,
        incremental: bool,
        increment: Option<f64>,
        trace: &mut Trace,
    ) {
        if command.has(Op::Pole) {
            self.pole =
                (command.word(Role::X).unwrap_or(self.pole.0), command.word(Role::Y).unwrap_or(self.pole.1));
            return;
        }
        let (angle, distance) = (command.word(Role::PolarAngle), command.word(Role::PolarDistance));
        if angle.is_none() && distance.is_none() {
            return;
        }
        if angle.is_none() || distance.is_none() {
            trace.doubt("machine:polar.word.left.out");
        }
        (self.angle, self.distance) = (angle.or(self.angle), distance.or(self.distance));
        let (sin, cos) = self.angle.unwrap_or(0.0).to_radians().sin_cos();
        let distance = self.distance.unwrap_or(0.0);
        let from = if incremental { (0.0, 0.0) } else { self.pole };
        command.words.retain(|(role, _)| !matches!(role, Role::PolarAngle | Role::PolarDistance));
        let place = |value: f64| increment.map_or(value, |increment| to_increment(value, increment));
        command.words.push((Role::X, place(from.0 + distance * cos)));
        command.words.push((Role::Y, place(from.1 + distance * sin)));
    }
}
