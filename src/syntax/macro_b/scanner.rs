//! Reads blocks of plain words and comments without the grammar, several times as fast.
//!
//! It meets the same leaves as the grammar or declines; nothing is understood here.
//! The grammar stays the definition: tests compare the two on every block accepted.

use super::tree::TENS;
use crate::syntax::Number;
use crate::text::Span;

/// What is done with the parts of a block, in their order. Where the scanner declines, what was taken counts for nothing.
pub trait Take {
    /// True where the numbers of words are asked for.
    const NUMBERS: bool = true;
    /// Blanks.
    fn space(&mut self, _: Span) {}
    /// The letter of a sequence number, and its digits.
    fn sequence(&mut self, letter: Span, digits: Span, number: u32);
    /// A letter and its number.
    fn word(&mut self, word: Scanned);
    /// A comment, with its brackets.
    fn comment(&mut self, span: Span);
    /// The sign that ends the block.
    fn end(&mut self, span: Span);
}

/// A word.
#[derive(Clone, Copy)]
pub struct Scanned {
    /// As it is written.
    pub letter: u8,
    /// Where the letter stands.
    pub start: u32,
    /// The sign, if one is written.
    pub sign: Option<u8>,
    /// Where the digits stand.
    pub digits: Span,
    /// The digits without the point among them.
    mantissa: u64,
    /// Where the point stands.
    point: Option<u32>,
}

/// Scans the block at the start of `rest` (up to the end of its line) and says where it
/// ends; none if anything but plain words stands in it.
pub fn scan<T: Take>(source: &[u8], rest: Span, take: &mut T) -> Option<u32> {
    let line = source.get(..rest.end as usize)?;
    let mut at = rest.start as usize;
    while let Some(&byte) = line.get(at) {
        let start = at;
        match byte {
            b'N' | b'n' => {
                at = pass(line, start + 1, |byte| byte.is_ascii_digit());
                let digits = span(start + 1, at);
                take.sequence(span(start, start + 1), digits, sequence(digits.of(line))?);
            }
            b'A'..=b'Z' | b'a'..=b'z' if byte | 0x20 != b'o' => {
                let word = match byte {
                    b'G' | b'g' => word::<true>(line, start, byte)?,
                    _ if T::NUMBERS => word::<true>(line, start, byte)?,
                    _ => word::<false>(line, start, byte)?,
                };
                at = word.digits.end as usize;
                take.word(word);
            }
            b' ' | b'\t' => {
                at = pass(line, at + 1, is_blank);
                take.space(span(start, at));
            }
            b'(' => {
                at = comment(line, start)?;
                take.comment(span(start, at));
            }
            b';' => return end(line, at, take),
            _ => return None,
        }
    }
    Some(rest.end)
}

/// False for most blocks that [`scan`] declines: a statement stands after the sequence number.
pub fn begins_plain(text: &[u8]) -> bool {
    let first = match text {
        [b'N' | b'n', rest @ ..] => &text[1 + pass(rest, 0, |byte| byte.is_ascii_digit())..],
        _ => text,
    };
    match first {
        [letter, next, ..] if letter.is_ascii_alphabetic() => {
            matches!(next, b'0'..=b'9' | b'.' | b'-' | b'+')
        }
        [first, ..] => matches!(first, b' ' | b'\t' | b'(' | b';'),
        [] => true,
    }
}

fn span(start: usize, end: usize) -> Span {
    Span::new(start as u32, end as u32)
}

fn is_blank(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t')
}

/// True for what the grammar sees as it is written.
fn is_plain(byte: u8) -> bool {
    matches!(byte, b' '..=b'~' | b'\t')
}

fn pass(line: &[u8], mut at: usize, keep: impl Fn(u8) -> bool) -> usize {
    while line.get(at).is_some_and(|&byte| keep(byte)) {
        at += 1;
    }
    at
}

/// The number of at least one digit. More digits than one of 32 bits surely holds are the grammar's to judge.
fn sequence(digits: &[u8]) -> Option<u32> {
    let number = || digits.iter().fold(0, |value, digit| value * 10 + u32::from(digit - b'0'));
    (1..=9).contains(&digits.len()).then(number)
}

/// A letter, a sign and a number, directly after one another; the number is worth something with `NUMBERS` only.
#[inline]
fn word<const NUMBERS: bool>(line: &[u8], start: usize, letter: u8) -> Option<Scanned> {
    let sign = line.get(start + 1).copied().filter(|byte| matches!(byte, b'-' | b'+'));
    let from = start + 1 + usize::from(sign.is_some());
    let (mut at, mut mantissa, mut point) = (from, 0u64, None);
    while let Some(&byte) = line.get(at) {
        let digit = byte.wrapping_sub(b'0');
        match digit {
            0..=9 if !NUMBERS => {}
            0..=9 => mantissa = mantissa.wrapping_mul(10).wrapping_add(u64::from(digit)),
            _ if byte == b'.' && point.is_none() => point = Some(at as u32),
            _ => break,
        }
        at += 1;
    }
    // A point alone is no number, and one of very many digits is the grammar's to judge.
    let least = 1 + usize::from(point == Some(from as u32));
    (least..=15).contains(&(at - from)).then_some(Scanned {
        letter,
        start: start as u32,
        sign,
        digits: span(from, at),
        mantissa,
        point,
    })
}

impl Scanned {
    /// Its number, without the sign.
    pub fn number(&self) -> Number {
        let places = self.point.map_or(0, |point| self.digits.end - point - 1);
        let digits = self.digits.len() - usize::from(self.point.is_some());
        // Both numbers are exact, so their quotient is rounded once, as it must be.
        let value = TENS.get(places as usize).map_or(f64::NAN, |ten| self.mantissa as f64 / ten);
        Number { value, point: self.point.is_some(), digits: digits as u16 }
    }

    /// True for a word that can be wrong: a code that calls a macro, or a code, speed or tool with a point.
    pub fn can_be_wrong(&self) -> bool {
        match self.letter.to_ascii_uppercase() {
            b'G' => (65.0..67.0).contains(&self.number().value),
            b'M' | b'S' | b'T' => self.point.is_some(),
            _ => false,
        }
    }
}

/// A comment of plain bytes that is closed and holds no other.
fn comment(line: &[u8], start: usize) -> Option<usize> {
    let text = line.get(start + 1..)?;
    let close = memchr::memchr2(b')', b'(', text)?;
    let plain = text[close] == b')' && text[..close].iter().all(|&byte| is_plain(byte));
    plain.then_some(start + close + 2)
}

/// `;` with the blanks that end the line after it.
fn end(line: &[u8], at: usize, take: &mut impl Take) -> Option<u32> {
    take.end(span(at, at + 1));
    let behind = pass(line, at + 1, is_blank);
    match line.get(behind) {
        // Tape leader after the block counts as blanks; the grammar's side knows it.
        Some(0 | 0x7f) => None,
        None if behind > at + 1 => {
            take.space(span(at + 1, behind));
            Some(behind as u32)
        }
        _ => Some(at as u32 + 1),
    }
}
