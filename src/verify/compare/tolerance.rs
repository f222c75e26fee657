//! How far apart numbers of two runs may lie.

use crate::dialect::Question;
use crate::verify::sides::Side;

/// How far numbers may lie apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Positions that words rounded: the coarser least increment of the two controls, millimetres.
    pub rounded: f64,
    /// True where both controls round the words that a program computes; else one of them goes where the numbers say.
    both: bool,
    /// What is allowed whatever words round, millimetres.
    least: f64,
}

impl Tolerance {
    /// Of two controls.
    pub fn of(source: &Side<'_>, target: &Side<'_>) -> Self {
        let increment = |side: &Side<'_>| {
            let numbers = side.control.numbers();
            numbers.increment_mm.max(numbers.increment_inch * 25.4)
        };
        let rounds = |side: &Side<'_>| side.control.is(Question::WordRoundsToIncrement);
        Self {
            rounded: increment(source).max(increment(target)) * 1.0001,
            both: rounds(source) && rounds(target),
            least: ARITHMETIC,
        }
    }

    /// The same where places may lie at least so far apart, millimetres. What is no distance changes nothing.
    pub fn at_least(self, allowed: f64) -> Self {
        match allowed > self.least {
            true => Self { rounded: self.rounded.max(allowed), least: allowed, ..self },
            false => self,
        }
    }

    /// How far apart what the words of two events rounded may have put them.
    pub fn between(&self, source: f64, target: f64) -> f64 {
        self.least + self.of_both(source, target)
    }

    /// How far apart two values may lie that are off by so much.
    fn of_both(&self, source: f64, target: f64) -> f64 {
        if self.both { source + target } else { source.max(target) }
    }
}

/// How far apart arithmetic in another order, or by an emulation, may put positions, millimetres.
const ARITHMETIC: f64 = 1e-5;
