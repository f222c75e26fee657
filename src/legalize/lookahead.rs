//! Waiting for the moves, and how far a control reads ahead.
//!
//! Law: a statement that waits until all moves are done is needed only where the target runs macro
//! statements early; there, reading ahead is limited to the least and empty blocks hold it back. Where the
//! target has no such limit, none is set. Both change when a value is read or an output is switched,
//! never what is computed; hence review diagnostics.

use super::Context;
use super::emptied::drop_emptied;
use crate::canon::Op;
use crate::diag::{Code, Diagnostic};
use crate::dialect::Side;
use crate::ir::{Expr, Module, Nc, Site, Stmt, StmtKind};
use std::collections::BTreeMap;

/// Empty blocks behind a limit of one: the control reads two blocks more than it is told.
const HOLD_BACK: usize = 3;

/// Replaces waits and limits that the target has not.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let waits = context.target.statement("wait").is_some();
    let limits = context.target.code_for(Op::LimitLookahead, &BTreeMap::new()).is_some();
    let early = context.target.is("lookahead.runs.early");
    for (index, program) in module.programs.iter_mut().enumerate() {
        for block in &mut program.blocks {
            let mut out = Vec::with_capacity(block.stmts.len());
            for stmt in std::mem::take(&mut block.stmts) {
                let span = stmt.site.span;
                match stmt.kind {
                    StmtKind::Sync if !waits && limits && early => {
                        let what = "the wait is a limit on reading ahead and three empty blocks; the limit stays in force behind it";
                        context.add_once(index, "sync", Diagnostic::new(Code::Conditional, span, what));
                        out.push(Stmt { kind: StmtKind::LimitLookahead(Expr::Number(1.0)), site: stmt.site });
                        let empty =
                            || Stmt { kind: StmtKind::Remark, site: Site { span, ..Site::default() } };
                        out.extend(std::iter::repeat_with(empty).take(HOLD_BACK));
                    }
                    StmtKind::Sync if !waits => {
                        let what = "the source waits here until all moves are done; that the target reads a position only then is not confirmed";
                        if early
                            || !context
                                .target
                                .behaviour("system.read.waits")
                                .is_some_and(|b| b.value == "true" && b.origin.confirmed)
                        {
                            context.unconfirmed(
                                index,
                                Side::Target,
                                span,
                                "behaviour:system.read.waits",
                                what,
                            );
                        }
                        out.push(Stmt { kind: StmtKind::Nc(Nc::default()), site: stmt.site });
                    }
                    StmtKind::LimitLookahead(_) if !limits => {
                        let what = "the target has no limit on reading ahead; what follows may be read or switched sooner";
                        context.add_once(index, "lookahead", Diagnostic::new(Code::Conditional, span, what));
                        out.push(Stmt { kind: StmtKind::Nc(Nc::default()), site: stmt.site });
                    }
                    kind => out.push(Stmt { kind, site: stmt.site }),
                }
            }
            block.stmts = out;
            drop_emptied(block);
        }
    }
}
