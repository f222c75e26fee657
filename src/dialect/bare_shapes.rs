//! What a control takes from its settings where a block does not say it, and settings under which codes mean something else.

use super::{Control, Setting};
use crate::canon::{Op, Role};

/// The most that a rotation may turn, degrees.
const TURN: f64 = 360.0;

impl Control {
    /// The setting that an operation takes a word from where its block has none, and its value where there is one.
    pub fn left_out(&self, op: Op, role: Role) -> Option<(&Setting, Option<f64>)> {
        let mut rows = self.dialect().settings.iter();
        let row = rows.find(|row| row.otherwise == Some(role) && row.cycles.contains(&op))?;
        let stated = self.setting(&row.name).and_then(|value| value.parse::<f64>().ok());
        Some((row, stated.map(|value| value / row.whole())))
    }

    /// The angle of a rotation whose block says none, degrees, where the profile has it.
    pub fn bare_angle(&self) -> Option<f64> {
        let (_, angle) = self.left_out(Op::RotateOn, Role::Angle)?;
        angle.filter(|angle| angle.abs() <= TURN)
    }

    /// The factor of a scaling whose block says none, where the profile has one for all axes. A factor of 0 leaves it to those of the
    /// axes.
    pub fn bare_factor(&self) -> Option<f64> {
        let of = |role| self.left_out(Op::ScaleOn, role).and_then(|(_, factor)| factor);
        match of(Role::Scale)? {
            0.0 => {
                let factor = of(Role::ScaleX)?;
                let alike = [Role::ScaleY, Role::ScaleZ].into_iter().all(|role| of(role) == Some(factor));
                Some(factor).filter(|factor| alike && *factor > 0.0)
            }
            factor => Some(factor).filter(|factor| *factor > 0.0),
        }
    }

    /// The settings whose values give codes a meaning that no row has, with those values and the operations that are read and
    /// written as if they had another one; no operations for every move.
    pub fn barred(&self) -> impl Iterator<Item = (&Setting, &str, &[Op])> {
        self.dialect().settings.iter().filter_map(|row| {
            let value = self.setting(&row.name)?;
            Some((row, value, row.bars.get(value)?.as_slice()))
        })
    }
}
