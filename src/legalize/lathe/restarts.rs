//! Where an operator may begin again in the middle of a program: after a stop, at a tool, and at the numbered block that leads to one.

use super::straight::goes_on_to;
use crate::canon::{Op, Role};
use crate::ir::{Nc, NcItem, Program, Stmt, StmtKind};

/// For each statement of each block, whether a run may begin there, with the modes of a reset in force.
///
/// A numbered block leads to a tool where nothing but returns to the reference position stands between.
pub fn restarts(program: &Program) -> Vec<Vec<bool>> {
    let mut found: Vec<Vec<bool>> =
        program.blocks.iter().map(|block| vec![false; block.stmts.len()]).collect();
    let mut leads = false;
    for (at, (block, found)) in program.blocks.iter().zip(&mut found).enumerate().rev() {
        leads &= goes_on_to(&block.term.kind, at + 1);
        for (stmt, found) in block.stmts.iter().zip(found.iter_mut()).rev() {
            let nc = stmt.kind.nc();
            let tool = nc.is_some_and(|nc| nc.word(Role::Turret).is_some());
            leads = tool || leads && !is_stop(stmt) && !nc.is_some_and(goes_elsewhere);
            *found = tool || leads && stmt.site.sequence.get().is_some();
        }
    }
    let mut stopped = false;
    for (stmt, found) in program.blocks.iter().flat_map(|block| &block.stmts).zip(found.iter_mut().flatten())
    {
        *found |= std::mem::replace(&mut stopped, is_stop(stmt));
    }
    found
}

/// True where the run waits for the operator.
fn is_stop(stmt: &Stmt) -> bool {
    match &stmt.kind {
        StmtKind::Nc(nc) => nc.has(Op::Stop) || nc.has(Op::OptionalStop),
        StmtKind::StopMessage { .. } | StmtKind::Input { .. } => true,
        _ => false,
    }
}

/// True for a block that moves an axis other than to a reference position.
fn goes_elsewhere(nc: &Nc) -> bool {
    let returns = [Op::ReferenceReturn, Op::Reference2, Op::MachineOnce].into_iter().any(|op| nc.has(op));
    let still = nc.ops().any(Op::takes_axes) || nc.has(Op::Dwell);
    let words =
        nc.items.iter().any(|item| matches!(item, NcItem::Word(role, _) if role.is_axis() || role.is_step()));
    words && !returns && !still || nc.ops().any(Op::reads_contour)
}
