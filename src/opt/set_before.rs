//! Temporaries that are set right before the statement that reads them, which two passes put into it.

use crate::ir::{Block, Class, Expr, Place, Stmt, StmtKind, Var};

/// Parts of an expression that is put together, at the most.
pub(super) const MOST_PARTS: usize = 32;

/// The assignments of temporaries directly before a statement, and comments between them.
pub(super) fn run_before(block: &Block, at: usize) -> std::ops::Range<usize> {
    let before = block.stmts.get(..at).unwrap_or_default();
    let passed = |stmt: &&Stmt| set(stmt).is_some() || stmt.kind == StmtKind::Comment;
    let count = before.iter().rev().take_while(passed).count();
    at - count..at
}

/// The temporary that a statement sets, and its value.
pub(super) fn set(stmt: &Stmt) -> Option<(Var, &Expr)> {
    let StmtKind::Assign { target: Place::Var(temp), value } = &stmt.kind else { return None };
    let plain = stmt.site.comments.is_empty() && stmt.site.skip.is_none();
    (plain && temp.class == Class::Temp).then_some((*temp, value))
}

/// True for an expression that is computed, of variables and numbers.
pub(super) fn is_computed(value: &Expr) -> bool {
    let (mut plain, mut any) = (true, false);
    value.walk(&mut |part| {
        any |= matches!(part, Expr::Var(_));
        plain &= !matches!(
            part,
            Expr::System(..) | Expr::Indirect(..) | Expr::Increments(_) | Expr::Vacant | Expr::Truth(_)
        );
    });
    plain && any
}

/// The parts of an expression.
pub(super) fn parts(e: &Expr) -> usize {
    let mut count = 0;
    e.walk(&mut |_| count += 1);
    count
}
