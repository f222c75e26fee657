//! Numbers: the shortest digits that read back as the same value, never with an exponent.

use std::io::Write;

/// Largest number of which every smaller whole number is exact.
const EXACT: f64 = 9_007_199_254_740_992.0;

/// Writes a number that is not negative; true where it has a decimal point.
pub(in crate::emit) fn write_digits(out: &mut Vec<u8>, value: f64) -> bool {
    // Signed, because processors turn such to and from floating point in one step.
    if value < EXACT && value as i64 as f64 == value {
        write_integer(out, value as u64);
        return false;
    }
    // A decimal of at most 15 digits is the value's own where dividing gives the value back,
    // because that division rounds as reading the decimal does. Most have four places.
    for (mut places, scale) in [(4, 1e4), (6, 1e6)] {
        let mut scaled = (value * scale + 0.5) as i64;
        if value < 1e9 && scaled as f64 / scale == value {
            while scaled % 10 == 0 {
                (scaled, places) = (scaled / 10, places - 1);
            }
            write_decimal(out, scaled as u64, places);
            return true;
        }
    }
    // Writing to bytes cannot fail.
    let _ = write!(out, "{value}");
    value.fract() != 0.0
}

/// Writes a whole number.
pub(in crate::emit) fn write_integer(out: &mut Vec<u8>, value: u64) {
    write_decimal(out, value, 0);
}

/// Writes a whole number with a point before its last `places` digits, and one digit at least before the point.
fn write_decimal(out: &mut Vec<u8>, value: u64, places: usize) {
    // The most digits that 64 bits have, and a point among them, or a number below one.
    let mut text = [0; 24];
    let (mut at, mut rest) = (text.len(), value);
    for _ in 0..places {
        at -= 1;
        text[at] = b'0' + (rest % 10) as u8;
        rest /= 10;
    }
    if places > 0 {
        at -= 1;
        text[at] = b'.';
    }
    let whole = at;
    // Two digits at a time: half as many divisions.
    while rest >= 10 {
        at -= 2;
        let two = (rest % 100) as u8;
        (text[at], text[at + 1]) = (b'0' + two / 10, b'0' + two % 10);
        rest /= 100;
    }
    if rest > 0 || at == whole {
        at -= 1;
        text[at] = b'0' + rest as u8;
    }
    out.extend_from_slice(&text[at..]);
}

/// Writes a whole number with leading zeros.
pub(in crate::emit) fn write_padded(out: &mut Vec<u8>, value: u64, places: u32) {
    let digits = value.checked_ilog10().map_or(1, |log| log + 1);
    (digits..places).for_each(|_| out.push(b'0'));
    write_integer(out, value);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn digits(value: f64) -> String {
        let mut out = Vec::new();
        write_digits(&mut out, value);
        String::from_utf8(out).unwrap()
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
            (999999999.5, "999999999.5"),
            (12345678901.5, "12345678901.5"),
            (0.000001, "0.000001"),
            (0.0000005, "0.0000005"),
            (0.1 + 0.2, "0.30000000000000004"),
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
