//! Where a statement comes from, out of the block it stood in.

use crate::ir::{Comment, SourceInfo};
use crate::syntax::{Block, Fence, ItemKind};
use crate::text::{Span, decode};

/// The site of a block: its span, sequence number, comments and the block skip
/// at its head (level 1 where none is written).
pub fn site_of(block: &Block, source: &[u8]) -> SourceInfo {
    let blanks = blanks_before(block.span, source);
    let mut site = SourceInfo { span: block.span, blanks, ..SourceInfo::default() };
    let mut words = false;
    for item in &block.items {
        match &item.kind {
            // An inserted block has the number of the one before it, so none of its own.
            ItemKind::Sequence { number, inserted } => site.sequence = (!inserted).then_some(*number).into(),
            ItemKind::Skip(level) if !words => site.skip = Some(level.unwrap_or(1)),
            ItemKind::Comment(comment) => {
                let mut text = comment_text(comment.text, source);
                // The space after a sign that opens a comment to the end of its line is that sign's.
                if matches!(comment.fence, Fence::Apostrophe | Fence::Star) {
                    text.drain(..text.len() - text.trim_start().len());
                }
                site.comments.reserve_exact(1);
                site.comments.push(Comment { text, leading: !words });
            }
            ItemKind::EndOfBlock | ItemKind::MacroMark | ItemKind::Tape => {}
            _ => words = true,
        }
    }
    if !words && goes_on_a_line(block.span, source) {
        site.comments.iter_mut().for_each(|comment| comment.leading = false);
    }
    site
}

/// True for a block that does not begin its line: `(INCHES)` of `G20; (INCHES)`.
fn goes_on_a_line(block: Span, source: &[u8]) -> bool {
    let before = source.get(..block.start as usize).unwrap_or_default();
    let before = before.iter().rev().find(|byte| !matches!(byte, b' ' | b'\t'));
    before.is_some_and(|byte| !matches!(byte, b'\n' | b'\r'))
}

/// How many lines without anything stand right before a block; 255 stand for more.
fn blanks_before(block: Span, source: &[u8]) -> u8 {
    let before = source.get(..block.start as usize).unwrap_or_default();
    let blank = before.iter().rev().take_while(|byte| byte.is_ascii_whitespace());
    let ends = blank.filter(|byte| **byte == b'\n').take(usize::from(u8::MAX) + 1).count();
    u8::try_from(ends.saturating_sub(1)).unwrap_or(u8::MAX)
}

/// The text of a comment, in whatever code it was written.
pub fn comment_text(span: Span, source: &[u8]) -> String {
    decode(span.of(source)).into_owned()
}
