//! Tokens of the text form.

use super::TextError;

/// A token.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Tok<'t> {
    /// Letters, digits, points and underscores, a letter first.
    Word(&'t str),
    /// An unsigned number.
    Number(&'t str),
    /// A quoted text, its escapes resolved.
    Text(String),
    /// A sign.
    Mark(&'t str),
    /// One or more line ends.
    Line,
    /// The end.
    End,
}

/// A token and the byte it starts at.
pub(super) type At<'t> = (Tok<'t>, usize);

const MARKS: &[&str] =
    &["->", "..", "{", "}", "(", ")", "[", "]", ",", ":", "=", "?", "+", "-", "*", "/", "#", "@", "^"];

/// Cuts a text into tokens.
pub(super) fn lex(text: &str) -> Result<Vec<At<'_>>, TextError> {
    let mut out: Vec<At<'_>> = Vec::new();
    let mut at = 0;
    while let Some(next) = text[at..].chars().next() {
        let rest = &text[at..];
        let start = at;
        let token = match next {
            '\n' => {
                at += 1;
                if matches!(out.last(), None | Some((Tok::Line, _))) {
                    continue;
                }
                Tok::Line
            }
            c if c.is_whitespace() => {
                at += c.len_utf8();
                continue;
            }
            ';' => {
                at += rest.find('\n').unwrap_or(rest.len());
                continue;
            }
            '"' => {
                let (string, len) = quoted(rest).ok_or_else(|| error(text, start, "text does not end"))?;
                at += len;
                Tok::Text(string)
            }
            c if c.is_ascii_alphabetic() || c == '_' => {
                let len = rest.find(|c: char| !(c.is_ascii_alphanumeric() || c == '.' || c == '_'));
                let word = &rest[..len.unwrap_or(rest.len())];
                at += word.len();
                Tok::Word(word)
            }
            c if c.is_ascii_digit() => {
                let len = number(rest.as_bytes());
                at += len;
                Tok::Number(&rest[..len])
            }
            _ => {
                let mark = MARKS.iter().find(|m| rest.starts_with(**m));
                let mark = mark.ok_or_else(|| error(text, start, "no token starts so"))?;
                at += mark.len();
                Tok::Mark(mark)
            }
        };
        out.push((token, start));
    }
    if !matches!(out.last(), Some((Tok::Line, _))) {
        out.push((Tok::Line, text.len()));
    }
    out.push((Tok::End, text.len()));
    Ok(out)
}

/// An error at a byte of the text.
pub(super) fn error(text: &str, at: usize, message: impl Into<String>) -> TextError {
    let before = text.get(..at).unwrap_or(text);
    let line = before.matches('\n').count() + 1;
    let column = before.rsplit('\n').next().unwrap_or("").chars().count() + 1;
    TextError { line, column, message: message.into() }
}

/// Length of digits, a fraction and an exponent; `12..30` is 12 and no fraction.
fn number(bytes: &[u8]) -> usize {
    let digits = |from: usize| bytes[from..].iter().take_while(|b| b.is_ascii_digit()).count();
    let mut len = digits(0);
    if bytes.get(len) == Some(&b'.') && bytes.get(len + 1).is_some_and(u8::is_ascii_digit) {
        len += 1 + digits(len + 1);
    }
    if bytes.get(len).is_some_and(|b| matches!(b, b'e' | b'E')) {
        let sign = usize::from(bytes.get(len + 1).is_some_and(|b| matches!(b, b'+' | b'-')));
        let exponent = if len + 1 + sign < bytes.len() { digits(len + 1 + sign) } else { 0 };
        if exponent > 0 {
            len += 1 + sign + exponent;
        }
    }
    len
}

/// The text after an opening quote and the bytes it takes, both quotes included.
fn quoted(rest: &str) -> Option<(String, usize)> {
    let mut out = String::new();
    let mut chars = rest.char_indices().skip(1);
    while let Some((at, c)) = chars.next() {
        match c {
            '"' => return Some((out, at + 1)),
            '\n' => return None,
            '\\' => match chars.next()?.1 {
                'u' => {
                    chars.next().filter(|(_, c)| *c == '{')?;
                    let digits: String = chars.by_ref().map(|(_, c)| c).take_while(|c| *c != '}').collect();
                    out.push(char::from_u32(u32::from_str_radix(&digits, 16).ok()?)?);
                }
                plain => out.push(plain),
            },
            c => out.push(c),
        }
    }
    None
}

/// A text in quotes, so that [`quoted`] reads it back.
pub(super) fn quote(text: &str) -> String {
    let mut out = String::with_capacity(text.len() + 2);
    out.push('"');
    for c in text.chars() {
        match c {
            '"' | '\\' => out.extend(['\\', c]),
            c if c.is_control() => out.push_str(&format!("\\u{{{:x}}}", c as u32)),
            c => out.push(c),
        }
    }
    out.push('"');
    out
}
