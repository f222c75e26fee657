//! Blocks of long files, read where a run comes to them: what a file says takes forty times its length.

use super::library::{Cutter, LoadedFile, Section, Sections};
use crate::syntax::{Block, Parser, chunks, parse_part};
use crate::text::Span;
use std::ops::Range;

/// How the blocks of files are read.
#[derive(Debug)]
pub(super) struct ByNeed {
    parser: Parser,
    /// Of each file its pieces.
    files: Vec<Vec<Piece>>,
}

/// Whole lines of a file.
#[derive(Clone, Debug)]
struct Piece {
    lines: Span,
    /// Their blocks among those of the file.
    blocks: Range<usize>,
}

/// Some blocks of a program.
#[derive(Clone, Debug)]
pub(super) struct Stretch {
    /// The first of them in the program.
    pub first: usize,
    /// How many there are.
    pub count: usize,
    /// The lines that are read for them, and how many blocks stand on these before them; none where the file has its
    /// blocks.
    lines: Option<(Span, usize)>,
}

impl Stretch {
    /// All blocks of a program, where the file has them.
    pub fn held(count: usize) -> Self {
        Self { first: 0, count, lines: None }
    }

    /// True where the blocks are there as long as the library is.
    pub fn is_held(&self) -> bool {
        self.lines.is_none()
    }
}

impl ByNeed {
    /// Reads files once, `size` bytes at a time, and keeps where their programs stand.
    pub fn new(files: &[LoadedFile<'_>], parser: Parser, size: usize) -> (Self, Sections) {
        let mut all = Vec::new();
        let sections = Sections::by(files.len(), |file, out| {
            let source = files.get(file).map_or(&[][..], |file| file.parsed.source);
            let (mut cutter, mut pieces) = (Cutter { file, at: 0, open: None }, Vec::new());
            for lines in chunks(source, size) {
                let first = cutter.at;
                cutter.cut(&parse_part(source, lines, 0, parser).blocks, out);
                pieces.push(Piece { lines, blocks: first..cutter.at });
            }
            cutter.end(out);
            all.push(pieces);
        });
        (Self { parser, files: all }, sections)
    }

    /// The stretches in which the blocks of a program are read.
    pub fn stretches(&self, section: &Section) -> Vec<Stretch> {
        let (start, end) = (section.blocks.start, section.blocks.end);
        let pieces = self.files.get(section.file).into_iter().flatten();
        let all = pieces.filter_map(|piece| {
            let (first, last) = (piece.blocks.start.max(start), piece.blocks.end.min(end));
            let lines = Some((piece.lines, first.checked_sub(piece.blocks.start)?));
            Some(Stretch { first: first - start, count: last.checked_sub(first)?, lines })
        });
        all.filter(|stretch| stretch.count > 0).collect()
    }

    /// Calls somebody with the blocks of such a stretch.
    pub fn with_stretch<T>(&self, source: &[u8], stretch: &Stretch, take: impl FnOnce(&[Block]) -> T) -> T {
        let Some((lines, before)) = stretch.lines else { return take(&[]) };
        let read = parse_part(source, lines, 0, self.parser);
        take(read.blocks.get(before..before + stretch.count).unwrap_or_default())
    }
}
