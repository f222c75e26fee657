//! Ends of polar coordinates in a library that never begins them.

use crate::canon::Op;
use crate::diag::{Code, Diagnostic};
use crate::ir::{Module, NcItem, Stmt, StmtKind};
use crate::legalize::Context;
use crate::legalize::layout::blanks::is_empty;

const OFF: &str = "polar coordinates are ended here, and no program of the library begins them: the code is left out, as the target has no such coordinates";

/// True where no block begins polar coordinates.
pub(super) fn never_begin(module: &Module) -> bool {
    let mut blocks = module.programs.iter().flat_map(|program| &program.blocks);
    !blocks.any(|block| block.stmts.iter().any(|stmt| stmt.kind.has_op(Op::PolarOn)))
}

/// Leaves the ends out.
pub(super) fn leave_out(module: &mut Module, context: &mut Context<'_>) {
    for (index, program) in module.programs.iter_mut().enumerate() {
        for block in &mut program.blocks {
            block.stmts.retain_mut(|stmt| keep(stmt, index, context));
        }
    }
}

/// False where nothing is left of a statement.
fn keep(stmt: &mut Stmt, index: usize, context: &mut Context<'_>) -> bool {
    let StmtKind::Nc(nc) = &mut stmt.kind else { return true };
    if !nc.has(Op::PolarOff) {
        return true;
    }
    nc.items.retain(|item| *item != NcItem::Op(Op::PolarOff));
    let emptied = nc.items.is_empty();
    context.add_once(index, OFF, Diagnostic::new(Code::DoesNothing, stmt.site.span, OFF));
    if emptied {
        stmt.kind = StmtKind::Comment;
    }
    !emptied || !is_empty(stmt)
}
