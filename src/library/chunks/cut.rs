//! Cuts a long file into runs of lines, so that what a word means never depends on a line of another run.
//!
//! A run ends before a line that names an interpolation; where none comes for long, before any line while it is sure
//! which line named the one in force.

use crate::canon::{Group, Op};
use crate::dialect::Control;
use crate::text::{Line, Lines, Span};

/// A run of lines.
pub struct Piece {
    /// The line before them that named the interpolation in force, where none of theirs does before it is needed.
    pub head: Option<Line>,
    /// They.
    pub lines: Span,
}

/// Cuts a file into runs of lines.
pub struct Pieces<'s> {
    source: &'s [u8],
    control: &'s Control,
    /// Where the next one starts.
    at: usize,
    /// The line that named the interpolation in force there; none if that is not sure.
    mode: Option<Line>,
    size: usize,
}

impl<'s> Pieces<'s> {
    /// Cuts into runs of about `size` bytes.
    pub fn new(source: &'s [u8], control: &'s Control, size: usize) -> Self {
        Self { source, control, at: 0, mode: None, size }
    }
}

impl Iterator for Pieces<'_> {
    type Item = Piece;

    fn next(&mut self) -> Option<Piece> {
        let (source, control, start) = (self.source, self.control, self.at);
        let names = |line: Line| names_interpolation(line.text.of(source), control);
        let lines = |from: usize, to: usize| Lines::within(source, Span::new(from as u32, to as u32));
        let first = lines(start, source.len()).next()?;
        let head = self.mode.filter(|_| names(first) != Some(true));
        let pass = |mode: Option<Line>, line: Line| match names(line) {
            Some(true) => Some(line),
            Some(false) => mode,
            None => None,
        };
        // Where the piece is long enough, and where it is so long that any line will do whose mode is sure.
        let least = Lines::behind_line_end(source, start + self.size);
        let most = Lines::behind_line_end(source, start + 2 * self.size).max(least);
        let named = lines(least, most).find(|line| names(*line) == Some(true));
        (self.at, self.mode) = match named {
            Some(line) => (line.text.start as usize, None),
            None => {
                let mut mode = lines(start, most).fold(self.mode, pass);
                let mut rest = lines(most, source.len());
                let cut = rest.find(|line| {
                    let cut = mode.is_some() || names(*line) == Some(true);
                    if !cut {
                        mode = pass(mode, *line);
                    }
                    cut
                });
                (cut.map_or(source.len(), |line| line.text.start as usize), mode)
            }
        };
        Some(Piece { head, lines: Span::new(start as u32, self.at as u32) })
    }
}

/// True for a line that names an interpolation, false for one that leaves it in force; none if a look at its bytes
/// cannot tell: comments, skipped blocks, heads of programs, codes that are unknown or belong to cycles.
fn names_interpolation(line: &[u8], control: &Control) -> Option<bool> {
    let head = control.names().program.as_deref().and_then(|name| name.bytes().next());
    let begins = |byte: &u8| head.is_some_and(|head| byte.eq_ignore_ascii_case(&head));
    if line.iter().any(|byte| matches!(byte, b'(' | b'/' | b'%' | b':') || begins(byte)) {
        return None;
    }
    let mut named = false;
    for (at, _) in line.iter().enumerate().filter(|(_, byte)| byte.eq_ignore_ascii_case(&b'G')) {
        let rest = &line[at + 1..];
        let digits = rest.iter().take_while(|byte| byte.is_ascii_digit() || **byte == b'.').count();
        let number = std::str::from_utf8(&rest[..digits]).ok()?.parse().ok()?;
        let op = control.code('G', number, &[])?.op;
        match op.group() {
            Group::Motion if matches!(op, Op::Rapid | Op::Linear | Op::ArcCw | Op::ArcCcw) => named = true,
            Group::Motion | Group::Cycle => return None,
            _ => {}
        }
    }
    Some(named)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_are_cut_where_an_interpolation_is_sure() {
        let control = crate::dialect::registry::all().iter().filter(|entry| entry.emit.is_some());
        let mut control = control.filter_map(|entry| Control::plain(entry.name));
        let control = control.find(|control| control.is(crate::dialect::Question::Vacancy)).unwrap();
        for (line, named) in [
            ("N10 G01 X1.", Some(true)),
            ("g0x1", Some(true)),
            ("G00", Some(true)),
            ("G0", Some(true)),
            ("G3 X1. R2.", Some(true)),
            ("X1. G03", Some(true)),
            ("G17 G1", Some(true)),
            ("G17", Some(false)),
            ("G10 L2", None),
            ("X1. Y2.", Some(false)),
            ("", Some(false)),
            ("/G1 X1.", None),
            ("(G1) X1.", None),
            ("O1234", None),
            ("%", None),
            ("G81 X1.", None),
            ("G1.1", None),
            ("G", None),
        ] {
            assert_eq!(names_interpolation(line.as_bytes(), &control), named, "{line}");
        }
    }
}
