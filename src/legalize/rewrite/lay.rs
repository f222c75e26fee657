//! Lays down what runs before a statement.

use super::PreStatement;
use crate::ir::{BlockId, Builder, Cond, Place, SourceInfo, StmtKind, TermKind};

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
