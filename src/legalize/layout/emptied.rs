//! Blocks of which nothing is left.
//!
//! Law: a block of words without a word does nothing. Its comments stay; its sequence number was no
//! target (a target's number stands among the labels of its block) and goes. A block that people left
//! empty is a comment from the start and is not looked at here.

use crate::ir::{Block, StmtKind};

/// Takes the NC blocks without words out of a block, but for their comments; true where there are any.
pub fn drop_emptied(block: &mut Block) -> bool {
    let empty = |kind: &StmtKind| matches!(kind, StmtKind::Nc(nc) if nc.items.is_empty());
    if !block.stmts.iter().any(|stmt| empty(&stmt.kind)) {
        return false;
    }
    block.stmts.retain(|stmt| !empty(&stmt.kind) || !stmt.site.comments.is_empty());
    for stmt in block.stmts.iter_mut().filter(|stmt| empty(&stmt.kind)) {
        stmt.kind = StmtKind::Comment;
    }
    true
}
