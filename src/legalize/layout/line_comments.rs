//! Comments that stand after the end of a block, on its line: `G20; (INCHES)`.
//!
//! Law: a block of comments alone does nothing, so the comment may stand in the block before it, as a person reads it. Side condition:
//! no program limits how far it reads ahead, where blocks without words are counted. Counter-example: the comment after a stop
//! or a message, which an operator may be shown.

use crate::canon::Op;
use crate::ir::{Module, Stmt, StmtKind, Stmts};
use crate::legalize::Context;

/// Puts such comments into the blocks before them; true if there were any.
pub fn run(module: &mut Module, _: &mut Context<'_>) -> bool {
    let blocks = || module.programs.iter().flat_map(|program| &program.blocks);
    let limits = |stmt: &Stmt| matches!(stmt.kind, StmtKind::LimitLookahead(_));
    if blocks().flat_map(|block| &block.stmts).any(limits) {
        return false;
    }
    let mut changed = false;
    for block in module.programs.iter_mut().flat_map(|program| &mut program.blocks) {
        if block.stmts.iter().any(goes_on) {
            changed |= join(&mut block.stmts);
        }
    }
    changed
}

fn join(stmts: &mut Stmts) -> bool {
    let before = stmts.len();
    for mut stmt in std::mem::take(stmts) {
        match stmts.last_mut().filter(|last| goes_on(&stmt) && takes(last)) {
            Some(last) => last.site.comments.append(&mut stmt.site.comments),
            None => stmts.push(stmt),
        }
    }
    stmts.len() != before
}

/// True for comments that stood on the line of the block before them.
fn goes_on(stmt: &Stmt) -> bool {
    let site = &stmt.site;
    stmt.kind == StmtKind::Comment
        && site.skip.is_none()
        && site.sequence.is_none()
        && !site.comments.is_empty()
        && site.comments.iter().all(|comment| !comment.leading)
}

/// True for a block whose comments only a person reads.
fn takes(stmt: &Stmt) -> bool {
    match &stmt.kind {
        StmtKind::Nc(nc) => !nc.ops().any(|op| matches!(op, Op::Stop | Op::OptionalStop)),
        StmtKind::Assign { .. } => true,
        _ => false,
    }
}
