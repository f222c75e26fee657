//! Reads a whole file, line by line and in parallel.

use super::{Block, ItemKind, SyntaxError};
use crate::text::{Line, Lines, Span};
use rayon::prelude::*;

/// Reads the blocks of one line of a dialect.
///
/// `source` is the whole file; every span is an offset into it. A parser
/// appends at least one block for any line but an empty one, and their tokens
/// tile the line.
pub type Parser = fn(source: &[u8], line: Span, out: &mut Vec<Block>);

/// A file with its blocks.
#[derive(Clone, Debug)]
pub struct ParsedFile<'s> {
    /// The bytes it was read from.
    pub source: &'s [u8],
    /// How many lines of the source stand before those.
    pub before: usize,
    /// Its lines.
    pub lines: Vec<Line>,
    /// Its blocks, in order; an empty line has none.
    pub blocks: Vec<Block>,
}

impl<'s> ParsedFile<'s> {
    /// A file whose lines nobody has read yet.
    pub fn unread(source: &'s [u8]) -> Self {
        Self { source, before: 0, lines: Vec::new(), blocks: Vec::new() }
    }

    /// The line that a place of it stands in, from 1.
    pub fn line_of(&self, at: u32) -> usize {
        self.before + self.lines.partition_point(|line| line.text.start <= at).max(1)
    }

    /// The file's bytes.
    pub fn print(&self) -> Vec<u8> {
        let mut out = Vec::with_capacity(self.source.len());
        let mut blocks = self.blocks.iter().peekable();
        for line in &self.lines {
            while let Some(block) = blocks.next_if(|block| block.span.start < line.end.end.max(line.text.end))
            {
                block.print(self.source, &mut out);
            }
            out.extend_from_slice(line.end.of(self.source));
        }
        out
    }
}

/// What a file amounts to, without keeping its blocks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ParseTotals {
    /// Blocks read.
    pub blocks: usize,
    /// Blocks that the grammar could not read.
    pub unparsed: usize,
    /// Blocks with any error, those included.
    pub faulty: usize,
    /// True when every block's tokens tile its line.
    pub lossless: bool,
}

/// Bytes of whole lines that one task reads.
const CHUNK: usize = 256 * 1024;

/// Reads all blocks of `source`.
pub fn parse_file(source: &[u8], parser: Parser) -> ParsedFile<'_> {
    let parts: Vec<(Vec<Line>, Vec<Block>)> =
        chunks(source, CHUNK).into_par_iter().map(|chunk| read_lines(source, chunk, parser)).collect();
    let (lines, blocks) =
        (parts.iter().map(|(l, _)| l.len()).sum(), parts.iter().map(|(_, b)| b.len()).sum());
    let mut file = ParsedFile {
        source,
        before: 0,
        lines: Vec::with_capacity(lines),
        blocks: Vec::with_capacity(blocks),
    };
    for (lines, blocks) in parts {
        file.lines.extend(lines);
        file.blocks.extend(blocks);
    }
    file
}

/// Reads the blocks of whole lines of a file, `before` of which stand before them.
pub fn parse_part(source: &[u8], part: Span, before: usize, parser: Parser) -> ParsedFile<'_> {
    let (lines, blocks) = read_lines(source, part, parser);
    ParsedFile { source, before, lines, blocks }
}

fn read_lines(source: &[u8], part: Span, parser: Parser) -> (Vec<Line>, Vec<Block>) {
    let mut lines = Vec::with_capacity(memchr::memchr_iter(b'\n', part.of(source)).count() + 1);
    lines.extend(Lines::within(source, part));
    let mut blocks = Vec::with_capacity(lines.len());
    lines.iter().for_each(|line| parser(source, line.text, &mut blocks));
    (lines, blocks)
}

/// Reads all blocks of `source` and keeps only their count: memory stays flat.
pub fn parse_totals(source: &[u8], parser: Parser) -> ParseTotals {
    fold_lines(source, parser, ParseTotals::none, ParseTotals::add_line, ParseTotals::plus)
}

/// Reads all blocks of `source` and keeps only their faults, in order: memory stays flat. The parser may leave out
/// blocks without fault.
pub fn parse_faults(source: &[u8], parser: Parser) -> Vec<SyntaxError> {
    let add = |faults: &mut Vec<SyntaxError>, _, blocks: &mut [Block]| {
        blocks.iter_mut().for_each(|block| faults.extend(block.errors.drain(..)));
    };
    let join = |mut a: Vec<SyntaxError>, mut b| {
        a.append(&mut b);
        a
    };
    fold_lines(source, parser, Vec::new, add, join)
}

/// Folds the blocks of all lines in parallel; `join` is given neighbours in their order.
fn fold_lines<T: Send>(
    source: &[u8],
    parser: Parser,
    none: impl Fn() -> T + Sync + Send,
    add: impl Fn(&mut T, Line, &mut [Block]) + Sync,
    join: impl Fn(T, T) -> T + Sync + Send,
) -> T {
    let fold = |chunk| {
        let (mut out, mut blocks) = (none(), Vec::new());
        for line in Lines::within(source, chunk) {
            blocks.clear();
            parser(source, line.text, &mut blocks);
            add(&mut out, line, &mut blocks);
        }
        out
    };
    chunks(source, CHUNK).into_par_iter().map(fold).reduce(&none, &join)
}

impl ParseTotals {
    /// Of nothing.
    pub fn none() -> Self {
        Self { lossless: true, ..Self::default() }
    }

    fn add_line(&mut self, line: Line, blocks: &mut [Block]) {
        let mut at = line.text.start;
        for block in blocks.iter() {
            self.blocks += 1;
            if !block.errors.is_empty() {
                self.faulty += 1;
                self.unparsed +=
                    usize::from(block.items.iter().any(|i| matches!(i.kind, ItemKind::Unparsed)));
            }
            self.lossless &= block.span.start == at && block.is_tiled();
            at = block.span.end;
        }
        self.lossless &= at == line.text.end;
    }

    /// Of both.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        Self {
            blocks: self.blocks + other.blocks,
            unparsed: self.unparsed + other.unparsed,
            faulty: self.faulty + other.faulty,
            lossless: self.lossless && other.lossless,
        }
    }
}

/// Cuts `source` after line ends into pieces of about so many bytes.
pub fn chunks(source: &[u8], size: usize) -> Vec<Span> {
    let mut out = Vec::new();
    let mut start = 0;
    while start < source.len() {
        let from = (start + size).min(source.len());
        let end = Lines::behind_line_end(source, from);
        out.push(Span::new(start as u32, end as u32));
        start = end;
    }
    out
}
