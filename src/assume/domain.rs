//! Arguments of functions.

/// Arguments that an emulation of a function holds for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Domain {
    /// From one number to another.
    Range(f64, f64),
    /// Whole numbers of so many decimal digits.
    Digits(u32),
    /// Words of so many decimal digits, four bits each.
    Bcd(u32),
    /// A base in the first range, to a power whose product with the base's logarithm is in the second.
    Power([f64; 2], [f64; 2]),
}

impl Domain {
    /// True for arguments of the domain; of a function with one argument the second counts for nothing.
    pub fn contains(&self, [a, b]: [f64; 2]) -> bool {
        let within = |[from, to]: [f64; 2], value: f64| (from..=to).contains(&value);
        match *self {
            Self::Range(from, to) => within([from, to], a),
            Self::Digits(digits) => a.fract() == 0.0 && a >= 0.0 && a < 10f64.powi(digits as i32),
            Self::Bcd(digits) => {
                let digit = |at: u32| (a as u64 >> (4 * at)) & 15 <= 9;
                let fits = a >= 0.0 && a < 16f64.powi(digits as i32);
                a.fract() == 0.0 && fits && (0..digits).all(digit)
            }
            Self::Power(base, power) => within(base, a) && within(power, b * a.ln()),
        }
    }

    /// The ends of the domain, and numbers on both sides of them.
    pub fn telling_numbers(&self) -> Vec<f64> {
        let about = |from: f64, to: f64| {
            let step = |end: f64| (end.abs() * 0.5).max(1.0);
            vec![from - step(from), from, f64::midpoint(from, to), to, to + step(to)]
        };
        match *self {
            Self::Range(from, to) | Self::Power([from, to], _) => about(from, to),
            Self::Digits(digits) => {
                let end = 10f64.powi(digits as i32);
                vec![-1.0, 0.0, 0.5, 9.0, 10.0, end - 1.0, end]
            }
            Self::Bcd(digits) => {
                let nines = (0..digits).fold(0.0, |sum, _| sum * 16.0 + 9.0);
                vec![-1.0, 0.0, 0.5, 9.0, 10.0, 16.0, nines, nines + 1.0]
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arguments_are_inside_or_not() {
        let inside = |domain: Domain, a: f64, b: f64| domain.contains([a, b]);
        for (a, whether) in [(-20.0, true), (20.0, true), (20.5, false), (f64::NAN, false)] {
            assert_eq!(inside(Domain::Range(-20.0, 20.0), a, 0.0), whether, "{a}");
        }
        for (a, whether) in [(0.0, true), (99_999_999.0, true), (1e8, false), (1.5, false), (-1.0, false)] {
            assert_eq!(inside(Domain::Digits(8), a, 0.0), whether, "{a}");
        }
        for (a, whether) in [
            (9.0, true),
            (10.0, false),
            (16.0, true),
            (f64::from(0x9999_9999u32), true),
            (4294967296.0, false),
        ] {
            assert_eq!(inside(Domain::Bcd(8), a, 0.0), whether, "{a}");
        }
        let power = Domain::Power([1e-9, 1e9], [-20.0, 20.0]);
        // 10 to the power of 8 is e to 18.4; of 9 it is e to 20.7.
        assert!(inside(power, 10.0, 8.0) && !inside(power, 10.0, 9.0) && !inside(power, 0.0, 1.0));
    }

    #[test]
    fn both_sides_of_each_end_are_tried() {
        let domain = Domain::Range(-20.0, 20.0);
        let told = domain.telling_numbers();
        assert_eq!(told, [-30.0, -20.0, 0.0, 20.0, 30.0]);
    }
}
