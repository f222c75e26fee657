//! Which lines of a source stand beside which of its target.

use crate::text::{Lines, Span};
use std::ops::Range;

/// Lines of a gap in which an equal one is looked for.
const NEAR: usize = 200;

/// The lines of a program: where each begins and ends in its file.
pub struct Page<'p> {
    bytes: &'p [u8],
    lines: Vec<Span>,
}

impl<'p> Page<'p> {
    /// The lines of a part of a file.
    pub fn new(bytes: &'p [u8], part: Range<usize>) -> Self {
        let end = part.end.min(bytes.len());
        let start = part.start.min(end);
        let part = Span::new(start as u32, end as u32);
        let mut lines: Vec<Span> = Lines::within(bytes, part).map(|line| line.text).collect();
        // The end of the last line begins no other.
        if lines.last().is_some_and(|line| line.start == line.end) {
            lines.pop();
        }
        Self { bytes, lines }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.lines.len()
    }

    /// The bytes of a line.
    pub fn text(&self, line: usize) -> &'p [u8] {
        self.lines.get(line).map_or(&[], |line| line.of(self.bytes))
    }

    /// The line in which a byte of the file stands; none where that is another program's.
    pub fn line(&self, at: u32) -> Option<usize> {
        let line = self.lines.partition_point(|line| line.start <= at).checked_sub(1)?;
        let last = line + 1 == self.lines.len();
        (!last || at <= self.lines[line].end).then_some(line)
    }
}

/// What stands in a row. Lines count from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Row {
    /// A line and what became of it.
    Both(usize, usize),
    /// A line that nothing stands beside, and the line that it went into.
    Source(usize, Option<usize>),
    /// A line of the target, and the line of the source that it comes from.
    Target(usize, Option<usize>),
}

/// The rows of a program and its conversion, by the blocks that each block came from.
///
/// Lines of both sides keep their order. Where blocks were put into another order, the longest run of them that keeps it
/// stands side by side, and the others say where their counterparts are.
pub fn rows(source: &Page<'_>, target: &Page<'_>, map: &[(Span, Range<usize>)]) -> Vec<Row> {
    let mut came: Vec<Option<usize>> = vec![None; target.len()];
    let mut went: Vec<Option<usize>> = vec![None; source.len()];
    for (span, range) in map.iter().filter(|(_, range)| !range.is_empty()) {
        let Some(from) = source.line(span.start) else { continue };
        let (Some(first), Some(last)) =
            (target.line(range.start as u32), target.line((range.end - 1) as u32))
        else {
            continue;
        };
        came[first..=last].iter_mut().for_each(|line| _ = line.get_or_insert(from));
        went[from].get_or_insert(first);
    }
    let mut beside = kept_order(&came);
    equal_beside(source, target, (&came, &went), &mut beside);
    let mut out = Vec::with_capacity(source.len() + target.len());
    let (mut s, mut t) = (0, 0);
    for (a, b) in beside.into_iter().chain([(source.len(), target.len())]) {
        out.extend((s..a).map(|line| Row::Source(line, went[line])));
        out.extend((t..b).map(|line| Row::Target(line, came[line])));
        if a < source.len() && b < target.len() {
            out.push(Row::Both(a, b));
        }
        (s, t) = (a + 1, b + 1);
    }
    out
}

/// The most lines of the target whose lines of the source come in the same order, each of those once.
fn kept_order(came: &[Option<usize>]) -> Vec<(usize, usize)> {
    // The last line of the best run of each length, and what came before each line in its run.
    let mut ends: Vec<usize> = Vec::new();
    let mut before: Vec<Option<usize>> = vec![None; came.len()];
    for (line, from) in came.iter().enumerate() {
        let Some(from) = from else { continue };
        let length = ends.partition_point(|end| came[*end].is_some_and(|other| other < *from));
        before[line] = length.checked_sub(1).map(|at| ends[at]);
        match ends.get_mut(length) {
            // The first line of several that come from one.
            Some(end) if came[*end] == Some(*from) => {}
            Some(end) => *end = line,
            None => ends.push(line),
        }
    }
    let mut out = Vec::with_capacity(ends.len());
    let mut at = ends.last().copied();
    while let Some(line) = at {
        out.extend(came[line].map(|from| (from, line)));
        at = before[line];
    }
    out.reverse();
    out
}

/// Puts lines that are the same side by side where no block came from the other: comments, and lines between programs.
fn equal_beside(
    source: &Page<'_>,
    target: &Page<'_>,
    (came, went): (&[Option<usize>], &[Option<usize>]),
    beside: &mut Vec<(usize, usize)>,
) {
    let mut found = Vec::new();
    let (mut s, mut t) = (0, 0);
    for (a, b) in beside.iter().copied().chain([(source.len(), target.len())]) {
        let mut next = s;
        for line in (t..b).filter(|line| came[*line].is_none()) {
            let text = target.text(line).trim_ascii();
            let is_same = |at: &usize| went[*at].is_none() && source.text(*at).trim_ascii() == text;
            if let Some(same) = (next..a.min(next + NEAR)).find(is_same) {
                found.push((same, line));
                next = same + 1;
            }
        }
        (s, t) = (a + 1, b + 1);
    }
    beside.extend(found);
    beside.sort_unstable();
}

#[cfg(test)]
mod tests {
    use super::Row::{Both, Source, Target};
    use super::*;

    fn all(source: &str, target: &str, map: &[(Range<u32>, Range<usize>)]) -> Vec<Row> {
        let map: Vec<_> = map.iter().map(|(s, t)| (Span::new(s.start, s.end), t.clone())).collect();
        let (ours, theirs) = (Page::new(source.as_bytes(), 0..99), Page::new(target.as_bytes(), 0..99));
        rows(&ours, &theirs, &map)
    }

    #[test]
    fn blocks_stand_beside_what_they_became() {
        // A line that became two, one that became nothing, and a comment.
        let rows = all("A\nB\n(C)\nD\n", "A\nX\n(C)\nD\n", &[(0..1, 0..4), (8..9, 8..10)]);
        let wanted = [Both(0, 0), Source(1, None), Target(1, Some(0)), Both(2, 2), Both(3, 3)];
        assert_eq!(rows, wanted);
    }

    #[test]
    fn what_was_put_elsewhere_says_where() {
        let rows = all("A\nB\nC\n", "C\nA\nB", &[(4..5, 0..1), (0..1, 2..3), (2..3, 4..5)]);
        assert_eq!(rows, [Target(0, Some(2)), Both(0, 1), Both(1, 2), Source(2, Some(0))]);
    }

    #[test]
    fn nothing_is_lost_of_a_side_without_counterpart() {
        assert_eq!(all("A\nB", "", &[]), [Source(0, None), Source(1, None)]);
        assert_eq!(all("", "A\r\nB\r\n", &[]), [Target(0, None), Target(1, None)]);
        assert_eq!(all("", "", &[(5..9, 7..9)]), []);
    }

    /// The second of two programs of a file.
    #[test]
    fn a_page_is_a_part_of_a_file() {
        let page = Page::new(b"O1\nM30\nO2\nM30\n", 7..14);
        assert_eq!(
            (page.len(), page.text(0), page.line(7), page.line(10)),
            (2, &b"O2"[..], Some(0), Some(1))
        );
        assert_eq!((page.line(3), page.line(15)), (None, None));
    }
}
