//! Stops with what is ended before them and started again after them.

use crate::canon::Op;
use crate::ir::{Block, Nc, NcItem, SourceInfo, Stmt, StmtKind, Stmts};
use std::collections::BTreeMap;

/// What is started again: the number of the statement that it comes after, its code, and the level of its block skip, where it has one.
pub(super) type Again = (usize, Op, Option<u8>);

/// Puts what ends something before the stops of a block, and after them what is started again.
pub(super) fn lay(block: &mut Block, mut before: BTreeMap<usize, Vec<Op>>, again: &[Again]) {
    let more = before.values().map(Vec::len).sum::<usize>() + before.len() + again.len();
    let mut out = Stmts::with_capacity(block.stmts.len() + more);
    for (at, stmt) in std::mem::take(&mut block.stmts).into_iter().enumerate() {
        let (span, skip) = (stmt.site.span, stmt.site.skip);
        match before.remove(&at) {
            Some(before) => ended(before, stmt, &mut out),
            None => out.push(stmt),
        }
        for (_, op, level) in again.iter().filter(|(stop, ..)| *stop == at) {
            let kind = StmtKind::Nc(Nc { items: vec![NcItem::Op(*op)] });
            let skip = skip.or(*level);
            out.push(Stmt { kind, site: SourceInfo { span, skip, ..SourceInfo::default() } });
        }
    }
    let span = block.term.site.span;
    for op in before.into_values().flatten() {
        let kind = StmtKind::Nc(Nc { items: vec![NcItem::Op(op)] });
        out.push(Stmt { kind, site: SourceInfo { span, ..SourceInfo::default() } });
    }
    block.stmts = out;
}

/// Lays down a stop, and before it what ends what is running; the words beside the stop come first.
fn ended(before: Vec<Op>, mut stmt: Stmt, out: &mut Stmts) {
    let site = SourceInfo { span: stmt.site.span, skip: stmt.site.skip, ..SourceInfo::default() };
    let nc = |items: Vec<NcItem>| StmtKind::Nc(Nc { items });
    if let StmtKind::Nc(block) = &mut stmt.kind
        && !block.has(Op::ToolChange)
    {
        let (stop, words) = std::mem::take(&mut block.items)
            .into_iter()
            .partition(|item| matches!(item, NcItem::Op(Op::Stop | Op::OptionalStop)));
        block.items = stop;
        if !words.is_empty() {
            out.push(Stmt {
                kind: nc(words),
                site: SourceInfo { sequence: stmt.site.sequence.take().into(), ..site.clone() },
            });
        }
    }
    for op in before {
        let sequence = stmt.site.sequence.take().into();
        out.push(Stmt { kind: nc(vec![NcItem::Op(op)]), site: SourceInfo { sequence, ..site.clone() } });
    }
    out.push(stmt);
}
