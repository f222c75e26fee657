//! Cuts a file into lines.

use super::Span;
use memchr::memchr2;

/// The largest file that is read, in bytes: offsets are 32 bits wide.
pub const MAX_FILE: usize = u32::MAX as usize - 1;

/// One line: its text and the line end that closes it (empty at the end of a
/// file without one).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Line {
    /// The bytes before the line end.
    pub text: Span,
    /// The line end: CRLF, LF or a lone CR.
    pub end: Span,
}

/// Iterates over the lines of a file; their texts and ends tile it.
#[derive(Clone, Debug)]
pub struct Lines<'s> {
    source: &'s [u8],
    at: usize,
}

impl<'s> Lines<'s> {
    /// Cuts `source`, which must not be longer than [`MAX_FILE`].
    pub fn new(source: &'s [u8]) -> Self {
        assert!(!crate::CHECKED || source.len() <= MAX_FILE);
        Self { source, at: 0 }
    }

    /// Cuts a part of `source` that starts at the start of a line; spans count from the start of `source`.
    pub fn within(source: &'s [u8], part: Span) -> Self {
        let end = source.len().min(part.end as usize);
        Self { source: &source[..end], at: part.start as usize }
    }

    /// Where the line that `at` lies in ends, its line end included.
    pub fn behind_line_end(source: &[u8], at: usize) -> usize {
        let rest = source.get(at..).unwrap_or_default();
        let (stop, length) = next_end(rest);
        at + stop + length
    }
}

/// Where the first line end stands, and how long it is.
fn next_end(rest: &[u8]) -> (usize, usize) {
    match memchr2(b'\n', b'\r', rest) {
        None => (rest.len(), 0),
        // A CRLF is one line end.
        Some(i) if rest[i] == b'\r' && rest.get(i + 1) == Some(&b'\n') => (i, 2),
        Some(i) => (i, 1),
    }
}

impl Iterator for Lines<'_> {
    type Item = Line;

    fn next(&mut self) -> Option<Line> {
        let rest = self.source.get(self.at..).filter(|rest| !rest.is_empty())?;
        let start = self.at;
        let (length, end) = next_end(rest);
        let (stop, close) = (start + length, start + length + end);
        self.at = close;
        Some(Line { text: Span::new(start as u32, stop as u32), end: Span::new(stop as u32, close as u32) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut(source: &str) -> Vec<(&str, &str)> {
        Lines::new(source.as_bytes())
            .map(|line| (&source[line.text.range()], &source[line.end.range()]))
            .collect()
    }

    #[test]
    fn every_line_end_is_kept() {
        assert_eq!(cut("A\r\nB\nC\rD"), [("A", "\r\n"), ("B", "\n"), ("C", "\r"), ("D", "")]);
        assert_eq!(cut("\n\r\r\n"), [("", "\n"), ("", "\r"), ("", "\r\n")]);
        assert_eq!(cut(""), []);
    }
}
