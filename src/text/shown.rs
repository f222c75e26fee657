//! Text that people see: control characters are shown, never sent.
//!
//! A comment or a file name may hold what moves a terminal's cursor, recolours it, or turns the direction of writing. A
//! newline in a name could forge a line of a summary.

use std::borrow::Cow;

/// A text on one line: each control character is shown as its escape.
pub fn shown(text: &str) -> Cow<'_, str> {
    replaced(text, |_, _| false)
}

/// A text of several lines: line ends and tabs stay.
pub fn shown_lines(text: &str) -> Cow<'_, str> {
    replaced(text, |c, next| matches!(c, '\n' | '\t') || (c == '\r' && next == Some('\n')))
}

fn replaced(text: &str, stays: impl Fn(char, Option<char>) -> bool) -> Cow<'_, str> {
    if !text.chars().any(acts) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len() + 16);
    let mut chars = text.chars().peekable();
    while let Some(c) = chars.next() {
        if !acts(c) || stays(c, chars.peek().copied()) {
            out.push(c);
        } else {
            out.extend(c.escape_default());
        }
    }
    Cow::Owned(out)
}

/// True for what acts on a terminal in place of being drawn: controls, line separators, marks of direction.
pub fn acts(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{feff}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_acts_is_shown() {
        assert_eq!(
            shown("a\x1b[31mb\u{9b}2J\u{202e}c\nd\te\x7f"),
            r"a\u{1b}[31mb\u{9b}2J\u{202e}c\nd\te\u{7f}"
        );
        assert_eq!(shown_lines("a\r\nb\rc\td\x08\n"), "a\r\nb\\rc\td\\u{8}\n");
        assert!(matches!(shown("Größe Ø5 ü"), Cow::Borrowed(_)));
    }
}
