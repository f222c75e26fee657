//! What lines have in common that are read alike: all but the digits of most of their numbers.

use super::precheck::USUAL_DIGITS;

/// Bytes of the longest line that has a likeness.
pub const LONGEST: usize = 64;

/// The simplest line that is read as this one is, and is as sound as this one: digits in a row are one digit, 0 where
/// all of them are 0 and else 1. A number is left as it is where it is long, or where its value decides about the
/// line: that of a G code or of a loop, and after a slash, where one digit is read otherwise than several.
///
/// Also says where in the line ends what each of its bytes stands for. None of a long line.
pub fn cache_key<'k>(line: &[u8], key: &'k mut [u8; LONGEST], ends: &mut [u8; LONGEST]) -> Option<&'k [u8]> {
    if line.len() > LONGEST {
        return None;
    }
    let (mut at, mut length) = (0, 0);
    while let Some(&byte) = line.get(at) {
        if !is_numeric(byte) {
            at += 1;
            (key[length], ends[length]) = (byte, at as u8);
            length += 1;
            continue;
        }
        let (start, first) = (at, length);
        while let Some(mut simple) = line.get(at).copied().filter(|byte| is_numeric(*byte)) {
            at += 1;
            if simple != b'.' {
                while let Some(digit @ b'0'..=b'9') = line.get(at) {
                    simple |= digit;
                    at += 1;
                }
                simple = if simple == b'0' { b'0' } else { b'1' };
            }
            (key[length], ends[length]) = (simple, at as u8);
            length += 1;
        }
        if at - start > USUAL_DIGITS || is_asked_for(&line[..start]) {
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

/// True where the value of the number after this text decides about the line.
fn is_asked_for(mut before: &[u8]) -> bool {
    // What may stand between a letter and its number, and DO.
    while let [rest @ .., b'O' | b'o' | b'-' | b'+' | b' ' | b'\t' | 0 | 0x7f] = before {
        before = rest;
    }
    // END ends with D.
    matches!(before.last(), Some(b'G' | b'g' | b'D' | b'd' | b'/'))
}
