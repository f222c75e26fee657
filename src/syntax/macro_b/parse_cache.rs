//! Remembers what the grammar made of blocks: one that differs from another in digits alone has the same leaves.

use super::Rules;
use super::cache_key::{LONGEST, cache_key};
use super::lexeme::{Lex, Lexeme, Lexemes};
use super::rules::Reading;
use crate::syntax::support::readable;
use crate::text::Span;
use foldhash::{HashMap, HashSet};
use std::cell::RefCell;
use std::thread::LocalKey;

/// A row of leaves: the kind of each, and which byte of the block's likeness ends it.
type Leaves = Box<[(Lex, u8)]>;

/// What is remembered, by likeness.
#[derive(Default)]
pub struct ParseCache {
    /// The leaves of blocks.
    rows: HashMap<Box<[u8]>, Leaves>,
    /// Lines that are sound.
    precheck: HashSet<Box<[u8]>>,
}

/// What each thread remembers of a dialect.
pub type Memory = LocalKey<RefCell<ParseCache>>;

/// Blocks and lines that are remembered at a time.
const REMEMBERED: usize = 8192;

/// Reads the leaves of a block, by the grammar unless it has read one that is alike.
pub fn read(rules: &Rules, source: &[u8], block: Span, row: &mut Lexemes) -> Result<(), Reading> {
    let (mut key, mut ends) = ([0; LONGEST], [0; LONGEST]);
    let Some(cache_key) = cache_key(block.of(source), &mut key, &mut ends) else {
        return (rules.read)(&readable(block.of(source)), block.start, row);
    };
    rules.known.with_borrow_mut(|ParseCache { rows, .. }| {
        if let Some(leaves) = rows.get(cache_key) {
            let mut at = block.start;
            row.extend(leaves.iter().map(|&(kind, last)| {
                let from = std::mem::replace(&mut at, block.start + u32::from(ends[usize::from(last)]));
                Lexeme { kind, span: Span::new(from, at) }
            }));
            return Ok(());
        }
        (rules.read)(&readable(block.of(source)), block.start, row)?;
        if let Some(leaves) = leaves(row, block, &ends[..cache_key.len()]) {
            if rows.len() == REMEMBERED {
                rows.clear();
            }
            rows.insert(cache_key.into(), leaves);
        }
        Ok(())
    })
}

/// True for a line that is as sound as one that was asked for before, or else is found to be so.
pub fn is_sound(rules: &Rules, line: &[u8], find: impl FnOnce() -> bool) -> bool {
    let mut key = [0; LONGEST];
    let Some(cache_key) = cache_key(line, &mut key, &mut [0; LONGEST]) else { return find() };
    if rules.known.with_borrow(|ParseCache { precheck, .. }| precheck.contains(cache_key)) {
        return true;
    }
    let is_sound = find();
    if is_sound {
        rules.known.with_borrow_mut(|ParseCache { precheck, .. }| {
            if precheck.len() == REMEMBERED {
                precheck.clear();
            }
            precheck.insert(cache_key.into());
        });
    }
    is_sound
}

/// The leaves of a block as they are remembered; none if they do not tile it.
fn leaves(row: &Lexemes, block: Span, ends: &[u8]) -> Option<Leaves> {
    let mut leaves = Vec::with_capacity(row.len());
    let mut ends = ends.iter().zip(0..);
    for leaf in row {
        let (_, last) = ends.find(|(end, _)| block.start + u32::from(**end) == leaf.span.end)?;
        leaves.push((leaf.kind, last));
    }
    is_tiled(row, block).then(|| leaves.into())
}

/// True where the leaves tile the block.
pub fn is_tiled(row: &[Lexeme], block: Span) -> bool {
    let mut at = block.start;
    row.iter().all(|leaf| std::mem::replace(&mut at, leaf.span.end) == leaf.span.start) && at == block.end
}
