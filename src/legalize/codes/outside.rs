//! Common variables that a program under a limit on reading ahead hands to what is outside it.
//!
//! Law: a limit holds macro statements back until the moves before them are done, so that a robot or an operator sees a common variable
//! change when the machine is there. Where the target has no limit but a block that stops reading ahead, one stands in the place
//! of the limit, and one before each write of a common variable that moves came before and that the program does not read itself.
//! A wait computes nothing. Counter-example: a count that the program reads itself, which nobody else has to see in time.

use crate::ir::{Block, Expr, Place, Program, SourceInfo, Stmt, StmtKind, Stmts, Var};
use std::collections::BTreeSet;

/// The common variables that a program reads.
fn read(program: &Program) -> BTreeSet<Var> {
    let mut found = BTreeSet::new();
    let mut look = |e: &Expr| {
        e.walk(&mut |e| found.extend(var_of(e).filter(|var| var.class.is_numbered())));
    };
    for block in &program.blocks {
        block.stmts.iter().for_each(|stmt| stmt.kind.exprs(&mut look));
        block.term.kind.exprs(&mut look);
    }
    found
}

fn var_of(e: &Expr) -> Option<Var> {
    match e {
        Expr::Var(var) => Some(*var),
        _ => None,
    }
}

/// The common variable that a statement writes.
fn written(stmt: &Stmt) -> Option<Var> {
    match stmt.kind.target() {
        Some(Place::Var(var)) => Some(*var).filter(|var| var.class.is_numbered()),
        _ => None,
    }
}

/// True for a program that reads or writes a common variable.
pub(super) fn shares(program: &Program) -> bool {
    !read(program).is_empty()
        || program.blocks.iter().flat_map(|block| &block.stmts).any(|stmt| written(stmt).is_some())
}

/// Puts the waits into a program that limits how far the control reads ahead.
pub(super) fn hold(program: &mut Program) {
    let own = read(program);
    for block in &mut program.blocks {
        hold_in(block, &own);
    }
}

fn hold_in(block: &mut Block, own: &BTreeSet<Var>) {
    // What came before the block is not looked at.
    let mut waited = false;
    let mut out = Stmts::with_capacity(block.stmts.len());
    for stmt in std::mem::take(&mut block.stmts) {
        let limits = matches!(&stmt.kind, StmtKind::LimitLookahead(to) if to.constant() != Some(0.0));
        let hands_over = written(&stmt).is_some_and(|var| !own.contains(&var));
        if !waited && (limits || hands_over) {
            let site = SourceInfo { span: stmt.site.span, skip: stmt.site.skip, ..SourceInfo::default() };
            out.push(Stmt { kind: StmtKind::Sync, site });
            // One that may be skipped is no wait for what comes after it.
            waited = stmt.site.skip.is_none();
        }
        match &stmt.kind {
            StmtKind::Nc(nc) if !nc.items.is_empty() => waited = false,
            StmtKind::ModalCall(_) => waited = false,
            _ => {}
        }
        out.push(stmt);
    }
    block.stmts = out;
}
