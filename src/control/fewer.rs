//! Arithmetic that keeps fewer digits than the control does.

use super::scenario::Scenario;
use std::cell::Cell;

/// Keeps so many significant decimal digits of a result.
#[derive(Debug)]
pub struct FewerDigits {
    digits: i32,
    /// Draws to which side a result is off that needs more; none rounds it.
    seed: Option<u64>,
    drawn: Cell<u64>,
    /// True once a result needed more digits.
    lacked: Cell<bool>,
}

impl FewerDigits {
    /// So many of them.
    pub fn new(digits: u32) -> Self {
        // Between 1 and 17.
        Self { digits: digits.clamp(1, 17) as i32, seed: None, drawn: Cell::new(0), lacked: Cell::new(false) }
    }

    /// As a scenario has it; none for all of the control's own.
    pub fn of(scenario: &Scenario) -> Option<Self> {
        scenario.digits.map(|digits| Self { seed: scenario.last_digits, ..Self::new(digits) })
    }

    /// What is kept of a result.
    pub fn keep(&self, value: f64) -> f64 {
        self.drawn.set(self.drawn.get().wrapping_add(1));
        let is_short = value.fract() == 0.0 && value.abs() < 10f64.powi(self.digits);
        if is_short || !value.is_finite() {
            return value;
        }
        // Through decimal text, so that every value kept is the nearest double to its digits.
        let places = usize::try_from(self.digits - 1).unwrap_or(0);
        let nearest = format!("{value:.places$e}").parse().unwrap_or(value);
        if nearest == value {
            return value;
        }
        self.lacked.set(true);
        let Some(seed) = self.seed else { return nearest };
        let off = 10f64.powi(-self.digits);
        if self.side(seed) { value + value * off } else { value - value * off }
    }

    /// True where a result needed more digits than are kept.
    pub fn lacked(&self) -> bool {
        self.lacked.get()
    }

    /// The side of this result: splitmix64 of the seed and of how many results there were, so that opposite seeds are
    /// opposite at each.
    fn side(&self, seed: u64) -> bool {
        let mut bits = (seed >> 1).wrapping_add(self.drawn.get()).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((bits >> 31) ^ seed) & 1 == 1
    }
}
