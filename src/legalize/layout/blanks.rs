//! Empty blocks that hold nothing back.
//!
//! Law: an empty block does nothing. On a control where it holds back reading ahead it may stand there for that, and
//! stays; what an empty block or a statement without effect of another control leaves behind is left out.

use crate::ir::{Module, Stmt, StmtKind};
use crate::legalize::Context;

/// Leaves empty blocks out; true if there were any.
pub fn run(module: &mut Module, _: &mut Context<'_>) -> bool {
    let mut changed = false;
    for block in module.programs.iter_mut().flat_map(|program| &mut program.blocks) {
        let before = block.stmts.len();
        block.stmts.retain(|stmt| !is_empty(stmt));
        changed |= block.stmts.len() != before;
    }
    changed
}

/// True for a block without a word, a sequence number or a comment.
pub(in crate::legalize) fn is_empty(stmt: &Stmt) -> bool {
    let site = &stmt.site;
    stmt.kind == StmtKind::Comment && site.comments.is_empty() && !site.sequence.is_some()
}
