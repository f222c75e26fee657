//! What stands on a block.

use crate::ir::{Comment, SourceInfo};
use crate::lower::common::{comment_text, constant, site_of};
use crate::syntax::{self, Block, ExprKind, Item, ItemKind, Word, for_each_item};
use crate::text::Span;
use smallvec::SmallVec;

/// The words of a block, in order.
pub type Words<'w> = SmallVec<[(&'w Word, Span); 12]>;

/// The site of a block, with the comments after a THEN.
pub fn site(block: &Block, source: &[u8]) -> SourceInfo {
    let mut site = site_of(block, source);
    for item in &block.items {
        if let ItemKind::If { body, .. } = &item.kind {
            for_each_item(body, &mut |item| {
                if let ItemKind::Comment(comment) = &item.kind {
                    let text = comment_text(comment.text, source);
                    site.comments.push(Comment { text, leading: false });
                }
            });
        }
    }
    site
}

/// True for what a block does, as against its number, its comments and its framing.
pub fn acts(item: &Item) -> bool {
    !matches!(
        item.kind,
        ItemKind::Skip(_)
            | ItemKind::Tape
            | ItemKind::EndOfBlock
            | ItemKind::Program(_)
            | ItemKind::Sequence { .. }
            | ItemKind::Comment(_)
    )
}

/// The value of a literal that stands alone, and whether it has a decimal point. In
/// brackets it is an expression, whose numbers count whole units.
pub fn literal(value: &syntax::Expr) -> Option<(f64, bool)> {
    let mut at = value;
    loop {
        match &at.kind {
            ExprKind::Number(number) => {
                return Some((constant(value).filter(|value| value.is_finite())?, number.point));
            }
            ExprKind::Negate(inner) | ExprKind::Plus(inner) => at = inner,
            _ => return None,
        }
    }
}
