//! Cuts a file into programs.

use crate::lower::Cut;
use crate::syntax::{Block, Fence, Item, ItemKind, ParsedFile, ProgramName};
use crate::text::Lines;
use std::ops::Range;

/// A program's place in its file.
#[derive(Debug)]
pub struct Piece {
    /// Its name; none if no O word begins it.
    pub name: Option<ProgramName>,
    /// The block with the O word.
    pub head: Option<usize>,
    /// Blocks before the O word that hold its comments.
    pub leading: Vec<usize>,
    /// All its blocks, the one with the O word included.
    pub body: Range<usize>,
}

/// The programs of a file, in order, and whether a `%` frames it.
///
/// A program begins at an O word, or at the first block that does something
/// where none stands before it, and ends before the next one or at `%`. Comments
/// between the head of the file and its first O word belong to that program.
pub fn split(parsed: &ParsedFile<'_>) -> (Vec<Piece>, bool) {
    let mut pieces: Vec<Piece> = Vec::new();
    let mut open = false;
    let mut tape = false;
    let mut pending: Vec<usize> = Vec::new();
    for (index, block) in parsed.blocks.iter().enumerate() {
        // Files that controls punch have the O word of their first program right after the sign, `%O1234`.
        let is_tape = block.items.first().is_some_and(|item| matches!(item.kind, ItemKind::Tape));
        tape |= is_tape;
        open &= !is_tape;
        if let Some(name) = program(block) {
            let leading = std::mem::take(&mut pending);
            pieces.push(Piece { name: Some(name), head: Some(index), leading, body: index..index + 1 });
            open = true;
        } else if is_tape {
            continue;
        } else if open {
            if let Some(piece) = pieces.last_mut() {
                piece.body.end = index + 1;
            }
        } else if block.items.iter().all(is_quiet) && block.errors.is_empty() {
            if !block.items.is_empty() {
                pending.push(index);
            }
        } else {
            let leading = std::mem::take(&mut pending);
            pieces.push(Piece { name: None, head: None, leading, body: index..index + 1 });
            open = true;
        }
    }
    let speaks = |&&index: &&usize| parsed.blocks.get(index).is_some_and(|b| b.items.iter().any(is_comment));
    if pieces.is_empty() && pending.iter().any(|index| speaks(&index)) {
        pieces.push(Piece { name: None, head: None, leading: pending, body: 0..0 });
    }
    (pieces, tape)
}

/// Where a file can be cut; see [`crate::lower::Cuts`].
///
/// Before a line that begins with O and a digit, where a line like it stood before and no `%` since: a program is open
/// there, so that nothing waits for the next one. Not before the first `%`, since what stands there may be no program
/// at all. Names of variables are good for a whole file, so one with SETVN is not cut.
pub fn cuts(source: &[u8], least: usize) -> Vec<Cut> {
    let names = |at: usize| at.checked_sub(3).and_then(|from| source.get(from..at + 2));
    let mut named = memchr::memchr2_iter(b'V', b'v', source).filter_map(names);
    if source.len() <= least || named.any(|word| word.eq_ignore_ascii_case(b"SETVN")) {
        return Vec::new();
    }
    let mut cuts: Vec<Cut> = Vec::new();
    let mut last = 0;
    let mut open = false;
    let mut outside = memchr::memchr(b'%', source).is_some();
    for (lines, line) in Lines::new(source).enumerate() {
        let (at, text) = (line.text.start, line.text.of(source));
        if memchr::memchr(b'%', text).is_some() {
            (open, outside) = (false, false);
        } else if !outside && matches!(text, [b'O' | b'o', b'0'..=b'9', ..]) {
            if open && (at - last) as usize >= least {
                cuts.push(Cut { at, lines });
                last = at;
            }
            open = true;
        }
    }
    cuts
}

fn program(block: &Block) -> Option<ProgramName> {
    // Only a block skip or a comment can stand before it.
    block.items.iter().take(3).find_map(|item| match &item.kind {
        ItemKind::Program(name) => Some(name.clone()),
        _ => None,
    })
}

fn is_quiet(item: &Item) -> bool {
    matches!(item.kind, ItemKind::Comment(_) | ItemKind::EndOfBlock)
}

fn is_comment(item: &Item) -> bool {
    matches!(&item.kind, ItemKind::Comment(comment) if comment.fence != Fence::Outside)
}
