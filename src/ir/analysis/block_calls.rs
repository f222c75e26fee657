//! The calls that stand in a block.

use crate::ir::{Block, Call, StmtKind, TermKind};
use crate::text::Span;

/// Every call of a block: modal ones and the terminator's.
pub fn calls_of(block: &Block) -> impl Iterator<Item = &Call> {
    let modal = block.stmts.iter().filter_map(|stmt| match &stmt.kind {
        StmtKind::ModalCall(call) => Some(&**call),
        _ => None,
    });
    modal.chain(match &block.term.kind {
        TermKind::Call { call, .. } => Some(&**call),
        _ => None,
    })
}

/// Where a call of [`calls_of`] stands.
pub fn span_of(block: &Block, call: &Call) -> Span {
    let modal = block.stmts.iter().find(|stmt| matches!(&stmt.kind, StmtKind::ModalCall(c) if **c == *call));
    modal.map_or(block.term.site.span, |stmt| stmt.site.span)
}
