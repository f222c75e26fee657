//! What lines have in common that are read alike: all but the digits of most of their numbers.

use super::sound::USUAL_DIGITS;
use crate::syntax::LONGEST;

/// The simplest line that is read as this one is, and is as sound as this one: digits in a row are one digit, 0 where
/// all of them are 0 and else 1. A number is left as it is where it is long, or where its value decides about the
/// line: that of a G code or of a loop, and behind a slash, where one digit is read otherwise than several.
pub fn likeness<'k>(line: &[u8], key: &'k mut [u8; LONGEST]) -> Option<&'k [u8]> {
    simplified(line, key, &mut [0; LONGEST])
}

/// The [`likeness`] of a line, and where what each byte of it stands for ends in the line.
pub fn simplified<'k>(line: &[u8], key: &'k mut [u8; LONGEST], ends: &mut [u8; LONGEST]) -> Option<&'k [u8]> {
    if line.len() > LONGEST {
        return None;
    }
    let (mut at, mut length, mut asked_for) = (0, 0, false);
    while let Some(&byte) = line.get(at) {
        if !is_numeric(byte) {
            asked_for = match byte {
                // END ends with it.
                b'G' | b'g' | b'D' | b'd' | b'/' => true,
                // DO, and what may stand between a letter and its number.
                b'O' | b'o' | b'-' | b'+' | b' ' | b'\t' | 0 | 0x7f => asked_for,
                _ => false,
            };
            key[length] = byte;
            ends[length] = at as u8 + 1;
            (at, length) = (at + 1, length + 1);
            continue;
        }
        let (start, first) = (at, length);
        while line.get(at).is_some_and(|byte| is_numeric(*byte)) {
            let digits = line[at..].iter().take_while(|byte| byte.is_ascii_digit());
            let (count, all) = digits.fold((0, 0), |(count, all), digit| (count + 1, all | digit));
            key[length] = match all {
                0 => b'.',
                b'0' => b'0',
                _ => b'1',
            };
            at += count.max(1);
            ends[length] = at as u8;
            length += 1;
        }
        if asked_for || at - start > USUAL_DIGITS {
            length = first + at - start;
            key[first..length].copy_from_slice(&line[start..at]);
            ends[first..length].iter_mut().zip(start + 1..).for_each(|(end, behind)| *end = behind as u8);
        }
    }
    key.get(..length)
}

fn is_numeric(byte: u8) -> bool {
    matches!(byte, b'0'..=b'9' | b'.')
}
