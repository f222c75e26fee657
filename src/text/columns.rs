//! Columns that count characters, for readers that decode the file.

use super::{LineIndex, Span};

/// Where the lines of a file begin, and which bytes are no character of their own.
///
/// Characters are code points of UTF-8. Bytes that are none are read as editors read them: each wrong byte, or each
/// sequence that breaks off, stands for one replacement character. A byte order mark is no character.
#[derive(Clone, Debug)]
pub struct CodePoints {
    lines: LineIndex,
    /// The bytes that only continue a character, in order.
    within: Vec<u32>,
}

impl CodePoints {
    /// Notes the lines and characters of `source`.
    pub fn new(source: &[u8]) -> Self {
        let mut within = Vec::new();
        let mut at = 0;
        if source.starts_with("\u{feff}".as_bytes()) {
            within.push(0);
        }
        for chunk in source.utf8_chunks() {
            let text = chunk.valid();
            if !text.is_ascii() {
                let inner = |(i, _): &(usize, u8)| !text.is_char_boundary(*i);
                within.extend(text.bytes().enumerate().filter(inner).map(|(i, _)| (at + i) as u32));
            }
            at += text.len();
            within.extend((at as u32..).take(chunk.invalid().len()).skip(1));
            at += chunk.invalid().len();
        }
        Self { lines: LineIndex::new(source), within }
    }

    /// Line and column of the character that a range begins in, and of the one after the range, counted from 1.
    pub fn region(&self, span: Span) -> [(u32, u32); 2] {
        let start = self.place(span.start, self.before(span.start.saturating_add(1)));
        let end = span.end.max(span.start);
        [start, self.place(end, self.before(end))]
    }

    fn place(&self, offset: u32, before: usize) -> (u32, u32) {
        let (line, column) = self.lines.place(offset);
        let inner = before - self.before(offset.saturating_sub(column.saturating_sub(1)));
        (line, column.saturating_sub(inner as u32).max(1))
    }

    /// How many bytes before this one only continue a character.
    fn before(&self, offset: u32) -> usize {
        self.within.partition_point(|&at| at < offset)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn region(source: &[u8], start: u32, end: u32) -> [(u32, u32); 2] {
        CodePoints::new(source).region(Span::new(start, end))
    }

    #[test]
    fn a_column_counts_characters() {
        // Letters of 2, 3 and 4 bytes.
        let text = "G0\nXÜ日😀Y1\rZ".as_bytes();
        assert_eq!(region(text, 3, 4), [(2, 1), (2, 2)]);
        assert_eq!(region(text, 4, 6), [(2, 2), (2, 3)]);
        assert_eq!(region(text, 6, 13), [(2, 3), (2, 5)]);
        assert_eq!(region(text, 13, 15), [(2, 5), (2, 7)]);
        assert_eq!(region(text, 16, 17), [(3, 1), (3, 2)]);
        assert_eq!(region(text, 17, 17), [(3, 2), (3, 2)]);
    }

    /// The start goes back to the character that it is in, the end goes on to the next.
    #[test]
    fn a_part_of_a_character_is_the_character() {
        let text = "A日B".as_bytes();
        for (start, end) in [(1, 2), (1, 3), (2, 3), (2, 4), (3, 4)] {
            assert_eq!(region(text, start, end), [(1, 2), (1, 3)], "{start}..{end}");
        }
        assert_eq!(region(text, 2, 2), [(1, 2), (1, 3)]);
        assert_eq!(region(text, 4, 4), [(1, 3), (1, 3)]);
    }

    /// As the replacement characters of a decoder stand: here Python's `bytes.decode("utf-8", "replace")`.
    #[test]
    fn wrong_bytes_are_replacement_characters() {
        // A lone byte, one that breaks off after two of three, an overlong form, and a lone continuation.
        let text = b"\xDC\xE6\x97A\xC0\xAF\x80B";
        let places = [(0, 1), (1, 2), (3, 3), (4, 4), (5, 5), (6, 6), (7, 7)];
        for (at, column) in places {
            assert_eq!(region(text, at, at)[0], (1, column), "{at}");
        }
        assert_eq!(region(text, 1, 3), [(1, 2), (1, 3)]);
    }

    #[test]
    fn a_byte_order_mark_is_no_character() {
        assert_eq!(region(b"\xEF\xBB\xBFG0\nG1", 3, 5), [(1, 1), (1, 3)]);
        assert_eq!(region(b"\xEF\xBB\xBFG0\nG1", 0, 3), [(1, 1), (1, 1)]);
        assert_eq!(region(b"\xEF\xBB\xBFG0\nG1", 6, 8), [(2, 1), (2, 3)]);
        assert_eq!(region(b"", 0, 0), [(1, 1), (1, 1)]);
    }
}
