//! Arithmetic that keeps fewer digits than the control does.

use super::scenario::Scenario;
use std::cell::Cell;

/// The digits of a scenario that keeps fewer: three fewer than a double has. A run that lacks none of these is the same
/// with them.
pub const FEWER_DIGITS: u32 = 13;

/// Keeps so many significant decimal digits of a result.
#[derive(Debug)]
pub struct FewerDigits {
    digits: i32,
    /// True where what needs more is only noted, and kept whole.
    notes: bool,
    /// True where sums, products, quotients and exact functions are kept whole.
    functions_only: bool,
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
        let digits = digits.clamp(1, 17) as i32;
        Self {
            digits,
            notes: false,
            functions_only: false,
            seed: None,
            drawn: Cell::new(0),
            lacked: Cell::new(false),
        }
    }

    /// As a scenario has it, or as the control itself, which keeps so many digits; none for all of a double's.
    pub fn of(scenario: &Scenario, own: Option<u32>) -> Self {
        match (scenario.digits, own) {
            (Some(digits), _) => Self {
                seed: scenario.last_digits,
                functions_only: scenario.functions_only,
                ..Self::new(digits)
            },
            (None, Some(own)) => Self::new(own),
            (None, None) => Self { notes: true, ..Self::new(FEWER_DIGITS) },
        }
    }

    /// What is kept of a result.
    pub fn keep(&self, value: f64) -> f64 {
        self.drawn.set(self.drawn.get().wrapping_add(1));
        if (self.notes && self.lacked.get()) || self.is_short(value) || !value.is_finite() {
            return value;
        }
        let nearest = self.quickly(value).unwrap_or_else(|| self.by_text(value));
        if nearest == value {
            return value;
        }
        self.lacked.set(true);
        if self.notes {
            return value;
        }
        let Some(seed) = self.seed else { return nearest };
        let off = 10f64.powi(-self.digits);
        if self.side(seed) { value + value * off } else { value - value * off }
    }

    /// What is kept of a sum, a product, a quotient, and whatever else comes to the same on all machines that calculate with
    /// doubles.
    pub fn keep_of_operands(&self, value: f64) -> f64 {
        if self.functions_only { value } else { self.keep(value) }
    }

    /// Through decimal text, so that every value kept is the nearest double to its digits.
    fn by_text(&self, value: f64) -> f64 {
        let places = usize::try_from(self.digits - 1).unwrap_or(0);
        format!("{value:.places$e}").parse().unwrap_or(value)
    }

    /// The same by a product and a quotient, where these are known to give it: a whole number of so few digits over a power of
    /// ten that a double holds is rounded once. None near a tie, which the product may have moved, and for other powers.
    fn quickly(&self, value: f64) -> Option<f64> {
        let power = self.digits - 1 - value.abs().log10().floor() as i32;
        if !(0..=22).contains(&power) || self.digits > FEWER_DIGITS as i32 {
            return None;
        }
        let (scale, most) = (10f64.powi(power), 10f64.powi(self.digits));
        let digits = value * scale;
        let is_tie = ((digits - digits.trunc()).abs() - 0.5).abs() < 0.01;
        let has_all = (most / 10.0..most).contains(&digits.abs());
        (has_all && !is_tie).then(|| digits.round() / scale)
    }

    /// True for the nearest double to a number of few digits, up to six of them after the point: an exact quotient is
    /// rounded once, as what is written is.
    fn is_short(&self, value: f64) -> bool {
        let most = 10f64.powi(self.digits.min(15));
        let millionths = (value * 1e6).round();
        (value.fract() == 0.0 && value.abs() < most) || (millionths.abs() < most && millionths / 1e6 == value)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_needs_more_digits_is_noted_and_kept() {
        for short in [0.0, 7.0, -0.5, 0.3, 123_456.789, 9_999_999_999.0, 1e-9, f64::INFINITY] {
            let digits = FewerDigits::of(&Scenario::default(), None);
            assert_eq!((digits.keep(short), digits.lacked()), (short, false));
        }
        for long in [0.1 + 0.2, 1.0 / 3.0, 0.8 - f64::EPSILON, 12_345_678.123_456_7] {
            let digits = FewerDigits::of(&Scenario::default(), None);
            assert_eq!((digits.keep(long), digits.lacked()), (long, true));
        }
    }

    /// Drawn over many magnitudes, and near the powers of ten, where a digit more or less is wanted.
    #[test]
    fn the_quick_way_gives_what_the_text_gives() {
        let mut bits = 0x9e37_79b9_7f4a_7c15_u64;
        let mut quick = 0;
        for at in 0..200_000_i32 {
            bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let part = (bits >> 11) as f64 / (1_u64 << 53) as f64;
            let power = 10f64.powi(at % 30 - 12);
            let near_one = 1.0 + (part - 0.5) * 10f64.powi(-(at % 17));
            let value = [part * power, -part * power, near_one * power][at as usize % 3];
            for digits in [1, 4, 8, FEWER_DIGITS] {
                let fewer = FewerDigits::new(digits);
                if let Some(found) = fewer.quickly(value) {
                    quick += 1;
                    assert_eq!(
                        found.to_bits(),
                        fewer.by_text(value).to_bits(),
                        "{value:e} to {digits} digits"
                    );
                }
            }
        }
        assert!(quick > 400_000, "{quick}");
    }

    #[test]
    fn a_number_of_few_digits_is_kept_by_fewer_digits() {
        for (value, kept) in [(0.3, 0.3), (0.1 + 0.2, 0.3), (1.0 / 3.0, 0.333_333_333_333_3)] {
            assert_eq!(FewerDigits::new(FEWER_DIGITS).keep(value), kept);
        }
    }
}
