//! Numbers as they are written.

use super::super::tree::TENS;
use super::cursor::Reader;
use crate::syntax::{Number, TokenKind};
use crate::text::Span;

/// Digits that a double surely holds exactly.
const EXACT_DIGITS: usize = 15;

/// Digits of whole numbers that 32 bits surely hold.
const WHOLE_DIGITS: usize = 9;

impl<const ITEMS: bool, const TOKENS: bool> Reader<'_, ITEMS, TOKENS> {
    /// Digits with at most one point among them.
    #[inline(always)]
    pub fn number(&mut self) -> Option<(Number, Span)> {
        let text = self.rest();
        let (mantissa, whole) = digits_of(text, 0);
        let point = text.get(whole) == Some(&b'.');
        let (mantissa, places) = if point { digits_of(&text[whole + 1..], mantissa) } else { (mantissa, 0) };
        let digits = whole + places;
        if digits == 0 || digits > EXACT_DIGITS {
            return None;
        }
        // Both numbers are exact, so their quotient is rounded once, as it must be.
        let value = mantissa as f64 / TENS.get(places)?;
        let span = self.take(TokenKind::Number, digits + usize::from(point));
        Some((Number { value, point, digits: digits as u16 }, span))
    }

    /// A whole number that is written as digits only.
    pub fn integer(&mut self) -> Option<u32> {
        let (value, length) = self.digits(0)?;
        self.take(TokenKind::Number, length);
        Some(value)
    }

    /// The number that a `#` and digits name, with the bit after a point where the control has bits.
    pub fn index(&mut self) -> Option<(u32, Option<u32>)> {
        let number = self.integer()?;
        let adjoins = self.at == self.end_of_last;
        if !(self.rules.bits && adjoins && self.byte() == b'.') {
            return Some((number, None));
        }
        let (bit, length) = self.digits(1)?;
        self.take(TokenKind::Number, 1 + length);
        Some((number, Some(bit)))
    }

    /// The value of the digits so many bytes ahead, and how many they are.
    fn digits(&self, ahead: usize) -> Option<(u32, usize)> {
        let text = self.rest().get(ahead..).unwrap_or_default();
        let (value, length) = digits_of(text, 0);
        (1..=WHOLE_DIGITS).contains(&length).then_some((value as u32, length))
    }
}

/// Adds the digits that a text begins with to those before them; also how many they are.
#[inline]
fn digits_of(text: &[u8], mut value: u64) -> (u64, usize) {
    for (length, byte) in text.iter().enumerate() {
        let digit = byte.wrapping_sub(b'0');
        if digit > 9 {
            return (value, length);
        }
        value = value.wrapping_mul(10).wrapping_add(u64::from(digit));
    }
    (value, text.len())
}
