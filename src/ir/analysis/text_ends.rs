//! Where the text of a program ends without a code that ends it.

use super::Cfg;
use crate::ir::{BlockId, Program, Stmt, StmtKind, TermKind};
use crate::text::Span;
use std::collections::BTreeSet;

/// The blocks that a run comes to and at whose end the text does: not those that only stand for a label that is missing, nor
/// those that an alarm ends before.
pub fn text_ends<'p>(program: &'p Program, cfg: &'p Cfg) -> impl Iterator<Item = BlockId> + 'p {
    let falls = falls_to(program);
    cfg.order().iter().copied().filter(move |id| {
        program.block(*id).is_some_and(|block| {
            // What only jumps lead to and nothing stands in is a label that is missing.
            let there = !block.stmts.is_empty() || id.index() == 0 || falls.contains(id);
            let stops = block.stmts.iter().any(is_final);
            there && !stops && matches!(block.term.kind, TermKind::Stray)
        })
    })
}

/// True for an alarm of the program, after which nothing goes on: one that the operator may skip, or of number 0, ends nothing.
pub fn is_final(stmt: &Stmt) -> bool {
    match &stmt.kind {
        StmtKind::Alarm { number, .. } => {
            stmt.site.skip.is_none() && number.constant().is_some_and(|number| number >= 1.0)
        }
        _ => false,
    }
}

/// The last place of a program.
pub fn last_place(program: &Program) -> Span {
    let spans = program
        .blocks
        .iter()
        .flat_map(|block| block.stmts.iter().map(|stmt| stmt.site.span).chain([block.term.site.span]));
    spans.max().unwrap_or(program.site.span)
}

/// The blocks that control comes to without a jump.
fn falls_to(program: &Program) -> BTreeSet<BlockId> {
    let to = program.blocks.iter().filter_map(|block| match &block.term.kind {
        TermKind::Jump(to) if block.term.site.span == Span::default() => Some(*to),
        TermKind::Branch { otherwise: to, .. } | TermKind::Call { next: to, .. } => Some(*to),
        _ => None,
    });
    to.collect()
}
