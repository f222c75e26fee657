//! More M codes in a block than the target takes, and codes that say what the target always does.
//!
//! Law: the M codes of one block act together; given one a block, in the order they were written in, the
//! machine ends in the same state. The first stays with its block; those that stop, and those that act when a
//! move is done, come behind it. Side condition: between two of them the machine may wait for the first to
//! be finished.
//! A code for turns per minute says nothing to a control without constant surface speed, and is left out.

use super::Context;
use crate::canon::Op;
use crate::dialect::Control;
use crate::ir::{Module, Nc, NcItem, Site, Stmt, StmtKind};
use std::collections::BTreeMap;

/// Gives each M code a block of its own, past those that the target takes together.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let target = context.target;
    let most = match target.behaviour("m.codes.per.block").map(|b| b.value.as_str()) {
        Some("3") => 3,
        Some("any") => usize::MAX,
        _ => 1,
    };
    let always_turns = target.code_for(Op::SurfaceSpeed, &BTreeMap::new()).is_none();
    for block in module.programs.iter_mut().flat_map(|program| &mut program.blocks) {
        let mut out = Vec::with_capacity(block.stmts.len());
        for mut stmt in std::mem::take(&mut block.stmts) {
            let mut behind = Vec::new();
            if let StmtKind::Nc(nc) = &mut stmt.kind {
                if always_turns {
                    nc.items.retain(|item| *item != NcItem::Op(Op::TurnsPerMinute));
                }
                behind = split(nc, most, target);
                if nc.items.is_empty() {
                    stmt.kind = StmtKind::Remark;
                }
            }
            let site = Site { span: stmt.site.span, skip: stmt.site.skip, ..Site::default() };
            out.push(stmt);
            let nc = |item| StmtKind::Nc(Nc { items: vec![item] });
            out.extend(behind.into_iter().map(|item| Stmt { kind: nc(item), site: site.clone() }));
        }
        block.stmts = out;
    }
}

/// Takes the M codes past `most` out of a block.
fn split(nc: &mut Nc, most: usize, target: &Control) -> Vec<NcItem> {
    let is_m = |item: &NcItem| match item {
        NcItem::Op(op) => target.code_for(*op, &BTreeMap::new()).is_some_and(|row| row.code.starts_with('M')),
        NcItem::Code(letter, _) => *letter == 'M',
        NcItem::Word(..) => false,
    };
    let mut seen = 0;
    let (kept, behind) = std::mem::take(&mut nc.items).into_iter().partition(|item| {
        seen += usize::from(is_m(item));
        !is_m(item) || seen <= most
    });
    nc.items = kept;
    behind
}
