//! Reads ordinary blocks by hand, straight from their bytes: many times as fast as the grammar.
//!
//! A block that holds anything unknown here, or a fault of spelling, is declined, and the grammar reads it. What is
//! accepted is read as the grammar does, which tests hold this to.

mod cursor;
mod expressions;
mod items;
mod numbers;

use super::checks;
use super::rules::Rules;
use crate::syntax::{Block, Item, Token};
use crate::text::Span;
use cursor::{Reader, taken};
use std::cell::RefCell;
use thin_vec::ThinVec;

thread_local! {
    /// Room for the items and tokens of a block, which the next block uses again.
    static ROOM: RefCell<(Vec<Item>, Vec<Token>)> = const { RefCell::new((Vec::new(), Vec::new())) };
}

/// Reads the block at the start of `rest`, which reaches to the end of its line, and adds it to `out`; with `TOKENS`,
/// its tokens too. Says where the block ends, or declines it.
pub fn read<const TOKENS: bool>(
    rules: &Rules,
    source: &[u8],
    rest: Span,
    out: &mut Vec<Block>,
) -> Option<u32> {
    ROOM.with_borrow_mut(|(items, tokens)| {
        items.clear();
        tokens.clear();
        let mut reader = Reader::<true, TOKENS>::new(rules, source, rest, items, tokens)?;
        reader.block()?;
        let (end, in_doubt) = (reader.at as u32, reader.in_doubt);
        let mut errors = ThinVec::new();
        if in_doubt {
            checks::check_items(rules, source, items, &mut errors);
        }
        let span = Span::new(rest.start, end);
        out.push(Block { span, tokens: tokens.to_vec(), items: taken(items, 0), errors });
        Some(end)
    })
}

/// Passes over a block in which nothing can be wrong, and says where it ends.
pub fn pass(rules: &Rules, source: &[u8], rest: Span) -> Option<u32> {
    let (mut items, mut tokens) = (Vec::new(), Vec::new());
    let mut reader = Reader::<false, false>::new(rules, source, rest, &mut items, &mut tokens)?;
    reader.block()?;
    Some(reader.at as u32)
}
