//! Numbers: the shortest digits that read back as the same value, never with an exponent.

use super::Emitter;
use crate::diag::Code;
use std::fmt::Write;

/// Largest number of which every smaller whole number is exact.
const EXACT: f64 = 9_007_199_254_740_992.0;

impl Emitter<'_> {
    /// Writes a number, its sign included; with `point` it has a decimal point even when whole.
    pub(super) fn number(&mut self, value: f64, point: bool) {
        if !value.is_finite() {
            return self.unmapped("a number that is not finite");
        }
        let start = self.emitted.text.len();
        if value.is_sign_negative() {
            self.push('-');
        }
        write_digits(&mut self.emitted.text, value.abs());
        if point && value.fract() == 0.0 {
            self.push('.');
        }
        if let Some(most) = self.control.numbers().digits {
            self.limit_digits(start, most as usize);
        }
    }

    /// The zero before the point counts as a digit, so it goes first.
    fn limit_digits(&mut self, start: usize, most: usize) {
        let written = &self.emitted.text[start..];
        let digits = written.bytes().filter(u8::is_ascii_digit).count();
        if digits <= most {
            return;
        }
        let sign = usize::from(written.starts_with('-'));
        if digits == most + 1 && written[sign..].starts_with("0.") {
            self.emitted.text.remove(start + sign);
            return;
        }
        let message = format!("{written} has {digits} digits, the control takes {most}");
        self.refuse(Code::NumberTooLong, message);
    }

    /// Writes a whole number.
    pub(super) fn integer(&mut self, value: u32) {
        write_integer(&mut self.emitted.text, u64::from(value));
    }
}

/// Writes a number that is not negative.
fn write_digits(out: &mut String, value: f64) {
    if value.fract() == 0.0 && value < EXACT {
        return write_integer(out, value as u64);
    }
    // A decimal of at most 15 digits is the value's own where dividing gives the value back,
    // because that division rounds as reading the decimal does.
    let mut scale = 1.0;
    for places in 1..=6 {
        scale *= 10.0;
        let scaled = (value * scale).round();
        if scaled < 1e15 && scaled / scale == value {
            let (scaled, scale) = (scaled as u64, scale as u64);
            write_integer(out, scaled / scale);
            out.push('.');
            return write_padded(out, scaled % scale, places);
        }
    }
    // Writing to a string cannot fail.
    let _ = write!(out, "{value}");
}

fn write_integer(out: &mut String, value: u64) {
    let mut digits = [0u8; 20];
    let mut at = digits.len();
    let mut rest = value;
    while at > 0 {
        at -= 1;
        digits[at] = b'0' + (rest % 10) as u8;
        rest /= 10;
        if rest == 0 {
            break;
        }
    }
    out.extend(digits[at..].iter().map(|&digit| char::from(digit)));
}

/// Writes a whole number with leading zeros.
pub(super) fn write_padded(out: &mut String, value: u64, places: u32) {
    let digits = value.checked_ilog10().map_or(1, |log| log + 1);
    (digits..places).for_each(|_| out.push('0'));
    write_integer(out, value);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn digits(value: f64) -> String {
        let mut out = String::new();
        write_digits(&mut out, value);
        out
    }

    #[test]
    fn numbers_are_written_as_people_write_them() {
        for (value, text) in [
            (0.0, "0"),
            (10.0, "10"),
            (1.5, "1.5"),
            (0.5, "0.5"),
            (0.05, "0.05"),
            (1e-9, "0.000000001"),
            (0.4999999, "0.4999999"),
            (99999999.0, "99999999"),
            (1e21, "1000000000000000000000"),
            (1.0 / 3.0, "0.3333333333333333"),
            (123456.000001, "123456.000001"),
        ] {
            assert_eq!(digits(value), text);
        }
    }

    #[test]
    fn every_number_reads_back() {
        let mut seed = 0x9E37_79B9_7F4A_7C15_u64;
        for _ in 0..200_000 {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let places = 10f64.powi((seed >> 60) as i32 % 8);
            for value in [f64::from((seed >> 32) as u32) / places, f64::from_bits(seed & !(1 << 63))] {
                if value.is_finite() {
                    assert_eq!(digits(value).parse::<f64>(), Ok(value), "seed {seed}");
                    assert!(digits(value).len() <= format!("{value}").len(), "{value} is not the shortest");
                }
            }
        }
    }
}
