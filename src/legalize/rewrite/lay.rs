//! Lays down what runs before a statement.

use super::PreStatement;
use crate::ir::{BlockId, Builder, Cond, Place, Program, SourceInfo, Stmt, StmtKind, Stmts, TermKind};
use std::collections::VecDeque;

/// Lays the steps down, for a statement of this site.
pub(super) fn lay(builder: &mut Builder, prelude: Vec<PreStatement>, site: &SourceInfo) {
    // A skipped block skips its prelude with it; comments and number stay with the statement.
    // It has no place of its own in the source, so that optimization may tidy it.
    let site = || SourceInfo { skip: site.skip, ..SourceInfo::default() };
    for step in prelude {
        match step {
            PreStatement::Assign(var, value) => {
                builder.push(StmtKind::Assign { target: Place::Var(var), value }, site());
            }
            PreStatement::When(cond, var, value) => {
                let (then, otherwise) = (builder.fresh(), builder.fresh());
                if cond.may_alarm() {
                    unless_skipped(builder, site().skip, otherwise);
                }
                builder
                    .end(TermKind::Branch { cond: Box::new(cond), then, otherwise }, SourceInfo::default());
                builder.start(then);
                builder.push(StmtKind::Assign { target: Place::Var(var), value }, site());
                builder.start(otherwise);
            }
            PreStatement::While(cond, steps) => {
                let (head, body, after) = (builder.fresh(), builder.fresh(), builder.fresh());
                unless_skipped(builder, site().skip, after);
                builder.end(TermKind::Jump(head), SourceInfo::default());
                builder.start(head);
                let kind = TermKind::Branch { cond: Box::new(cond), then: body, otherwise: after };
                builder.end(kind, SourceInfo::default());
                builder.start(body);
                lay(builder, steps, &site());
                builder.end(TermKind::Jump(head), SourceInfo::default());
                builder.start(after);
            }
            PreStatement::Call(call) => {
                let after = builder.fresh();
                unless_skipped(builder, site().skip, after);
                builder.end(TermKind::Call { call: Box::new(call), next: after }, SourceInfo::default());
                builder.start(after);
            }
        }
    }
}

/// Puts assignments before the statements that they are for, the last of a block before its end: by block and statement, in order.
pub(super) fn insert(program: &mut Program, mut preludes: VecDeque<(usize, usize, Vec<PreStatement>)>) {
    while let Some(id) = preludes.front().map(|(id, ..)| *id) {
        let Some(block) = program.blocks.get_mut(id) else { return };
        let own = preludes.partition_point(|(other, ..)| *other == id);
        let more: usize = preludes.iter().take(own).map(|(.., steps)| steps.len()).sum();
        let mut stmts = std::mem::take(&mut block.stmts).into_iter();
        let mut laid = Stmts::with_capacity(stmts.len() + more);
        let mut next = 0;
        for (_, at, steps) in preludes.drain(..own) {
            laid.extend(stmts.by_ref().take(at - next));
            next = at;
            let site = stmts.as_slice().first().map_or(&block.term.site, |stmt| &stmt.site);
            let skip = site.skip;
            laid.extend(steps.into_iter().filter_map(|step| match step {
                PreStatement::Assign(var, value) => Some(Stmt {
                    kind: StmtKind::Assign { target: Place::Var(var), value },
                    site: SourceInfo { skip, ..SourceInfo::default() },
                }),
                _ => None,
            }));
        }
        laid.extend(stmts);
        block.stmts = laid;
    }
}

/// Goes on at `after` while the switch of a skipped block is on: a terminator cannot be skipped itself.
pub(in crate::legalize) fn unless_skipped(builder: &mut Builder, skip: Option<u8>, after: BlockId) {
    if let Some(level) = skip {
        let cond = Cond::Switch(level);
        builder.end_then(SourceInfo::default(), |otherwise| TermKind::Branch {
            cond: Box::new(cond),
            then: after,
            otherwise,
        });
    }
}
