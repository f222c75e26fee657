//! What programmers wrote beside a code: the comment of its block, or of the block before.

use crate::dialect::Control;
use crate::library::Input;
use crate::syntax::{Block, ItemKind, parse_file};
use crate::text::Span;
use std::collections::BTreeMap;

/// Letters of a comment that count.
const LONGEST: usize = 60;

/// The comments beside these places of a file, and the text of each place's block.
pub(super) fn beside(input: &Input, control: &Control, places: &[Span]) -> Vec<(Option<String>, String)> {
    let parsed = parse_file(&input.bytes, control.entry().parse);
    let look = |place: &Span| {
        let at = parsed.blocks.partition_point(|block| block.span.end <= place.start);
        let Some(block) = parsed.blocks.get(at) else { return (None, String::new()) };
        let before = at.checked_sub(1).and_then(|at| parsed.blocks.get(at));
        // A comment with a block of its own is about what follows.
        let above = before.filter(|block| is_comment(block));
        let comment = comment(block, &input.bytes);
        (
            comment.or_else(|| above.and_then(|block| self::comment(block, &input.bytes))),
            line(block, &input.bytes),
        )
    };
    places.iter().map(look).collect()
}

fn is_comment(block: &Block) -> bool {
    let aside = |kind: &ItemKind| matches!(kind, ItemKind::Comment(_) | ItemKind::Sequence { .. });
    block.items.iter().all(|item| aside(&item.kind))
}

fn comment(block: &Block, bytes: &[u8]) -> Option<String> {
    let texts = block.items.iter().filter_map(|item| match &item.kind {
        ItemKind::Comment(comment) => Some(comment.text.of(bytes)),
        _ => None,
    });
    let text = texts.map(|text| String::from_utf8_lossy(text).into_owned()).collect::<Vec<_>>().join(" ");
    let text: String = text.split_whitespace().collect::<Vec<_>>().join(" ").chars().take(LONGEST).collect();
    (!text.is_empty()).then(|| text.to_uppercase())
}

fn line(block: &Block, bytes: &[u8]) -> String {
    String::from_utf8_lossy(block.span.of(bytes)).trim().chars().take(LONGEST).collect()
}

/// The comment that stands beside most of them, and beside how many.
pub(super) fn most(comments: impl Iterator<Item = String>) -> Option<(String, usize)> {
    let mut count: BTreeMap<String, usize> = BTreeMap::new();
    comments.for_each(|comment| *count.entry(comment).or_default() += 1);
    // Of equals the first in order.
    count.into_iter().rev().max_by_key(|(_, times)| *times)
}
