//! Blocks of which nothing is left.
//!
//! Law: a block of words without a word does nothing. Its comments stay; its sequence number was no
//! target (a target's number stands among the labels of its block) and goes. A block that people left
//! empty is a remark from the start and is not looked at here.

use crate::ir::{Block, StmtKind};

/// Takes the NC blocks without words out of a block, but for their comments.
pub fn drop_emptied(block: &mut Block) {
    let empty = |kind: &StmtKind| matches!(kind, StmtKind::Nc(nc) if nc.items.is_empty());
    block.stmts.retain(|stmt| !empty(&stmt.kind) || !stmt.site.remarks.is_empty());
    for stmt in block.stmts.iter_mut().filter(|stmt| empty(&stmt.kind)) {
        stmt.kind = StmtKind::Remark;
    }
}
