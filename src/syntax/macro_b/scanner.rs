//! Reads blocks of plain words and comments without the grammar, several times as fast.
//!
//! It yields the same leaves as the grammar or declines; nothing is understood here.
//! The grammar stays the definition: tests compare the two on every block accepted.

use super::blocks::end_leaf;
use super::lexeme::{Lex, Lexeme, Row};
use crate::text::Span;

/// Scans the block at the start of `rest` (up to the end of its line) and says where it
/// ends; none where anything but plain words stands in it.
pub fn scan(source: &[u8], rest: Span, row: &mut Row) -> Option<u32> {
    let line = source.get(..rest.end as usize)?;
    let mut at = rest.start as usize;
    while let Some(&byte) = line.get(at) {
        let start = at;
        let kind = match byte {
            b' ' | b'\t' => {
                at = pass(line, at + 1, |byte| matches!(byte, b' ' | b'\t'));
                Lex::Space
            }
            b'N' | b'n' => {
                push(row, Lex::SequenceLetter, start, start + 1);
                at = digits(line, start + 1)?;
                push(row, Lex::Integer, start + 1, at);
                continue;
            }
            b'A'..=b'Z' | b'a'..=b'z' if byte | 0x20 != b'o' => {
                push(row, Lex::Letter, start, start + 1);
                at = value(line, start + 1, row)?;
                continue;
            }
            b'(' => {
                at = comment(line, start)?;
                Lex::Comment
            }
            b';' => return end(line, at, row),
            _ => return None,
        };
        push(row, kind, start, at);
    }
    Some(rest.end)
}

/// True for what the grammar sees as it is written.
fn is_plain(byte: u8) -> bool {
    matches!(byte, b' '..=b'~' | b'\t')
}

fn push(row: &mut Row, kind: Lex, start: usize, end: usize) {
    row.push(Lexeme { kind, span: Span::new(start as u32, end as u32) });
}

fn pass(line: &[u8], mut at: usize, keep: impl Fn(u8) -> bool) -> usize {
    while line.get(at).is_some_and(|&byte| keep(byte)) {
        at += 1;
    }
    at
}

/// At least one digit.
fn digits(line: &[u8], at: usize) -> Option<usize> {
    let end = pass(line, at, |byte| byte.is_ascii_digit());
    // More digits than a number of 32 bits surely holds are the grammar's to judge.
    (end > at && end - at <= 9).then_some(end)
}

/// A sign and a number, directly behind the letter.
fn value(line: &[u8], mut at: usize, row: &mut Row) -> Option<usize> {
    if matches!(line.get(at), Some(b'-' | b'+')) {
        push(row, Lex::Sign, at, at + 1);
        at += 1;
    }
    let whole = pass(line, at, |byte| byte.is_ascii_digit());
    let end = match line.get(whole) {
        Some(b'.') => pass(line, whole + 1, |byte| byte.is_ascii_digit()),
        _ => whole,
    };
    // A point alone is no number, and one of very many digits is the grammar's to judge.
    let length = end - at;
    if length < 1 + usize::from(end > whole && whole == at) || length > 15 {
        return None;
    }
    push(row, Lex::Number, at, end);
    Some(end)
}

/// A comment of plain bytes that is closed and holds no other.
fn comment(line: &[u8], start: usize) -> Option<usize> {
    let text = line.get(start + 1..)?;
    let close = memchr::memchr2(b')', b'(', text)?;
    let plain = text[close] == b')' && text[..close].iter().all(|&byte| is_plain(byte));
    plain.then_some(start + close + 2)
}

/// `;` with the blanks that end the line behind it.
fn end(line: &[u8], at: usize, row: &mut Row) -> Option<u32> {
    row.push(end_leaf(at as u32));
    let behind = pass(line, at + 1, |byte| matches!(byte, b' ' | b'\t'));
    match line.get(behind) {
        // Tape leader behind the block counts as blanks; the grammar's side knows it.
        Some(0 | 0x7f) => None,
        None if behind > at + 1 => {
            push(row, Lex::Space, at + 1, behind);
            Some(behind as u32)
        }
        _ => Some(at as u32 + 1),
    }
}
