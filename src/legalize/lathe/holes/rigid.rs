//! The code that makes taps rigid, for a target whose taps always are.

use crate::canon::{Op, Role};
use crate::dialect::Control;
use crate::ir::{NcItem, Stmt, StmtKind};
use std::collections::BTreeMap;

/// Takes away what makes taps rigid, for a target whose taps always are; the speed beside it stays, unless it is said `again`.
pub(super) fn drop_rigid(stmt: &mut Stmt, target: &Control, again: Option<f64>) {
    if !stmt.kind.has_op(Op::RigidTaps) || target.code_for(Op::RigidTaps, &BTreeMap::new()).is_some() {
        return;
    }
    let StmtKind::Nc(nc) = &mut stmt.kind else { return };
    nc.items.retain(|item| match item {
        NcItem::Word(Role::Speed, speed) => again.is_none() || speed.constant() != again,
        item => *item != NcItem::Op(Op::RigidTaps),
    });
    if nc.items.is_empty() {
        stmt.kind = StmtKind::Comment;
    }
}
