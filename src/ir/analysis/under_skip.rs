//! Parts of a program that a branch on a block-skip switch goes round, and each block of which had that block skip by itself.

use super::Arrivals;
use crate::ir::{Cond, Program, TermKind, Terminator};
use std::ops::Range;

/// The level that a branch on a switch keeps for each of the blocks that it goes round.
pub fn kept_level(term: &Terminator) -> Option<u8> {
    let TermKind::Branch { cond, .. } = &term.kind else { return None };
    term.site.skip.filter(|level| **cond == Cond::Switch(*level))
}

/// The level and the blocks that the end of a block goes round so, if they stand in a row right after it, what comes in comes from
/// that end alone, and nothing in them asks another switch. They are over at the block after them, where the branch goes too.
pub fn part_under_skip(program: &Program, ways: &Arrivals, at: usize) -> Option<(u8, Range<usize>)> {
    let term = &program.blocks.get(at)?.term;
    let level = kept_level(term)?;
    let TermKind::Branch { then, otherwise, .. } = &term.kind else { return None };
    let part = otherwise.index()..then.index();
    if part.start != at + 1 || part.is_empty() {
        return None;
    }
    let is_own = |block: usize| {
        let from = |from: &usize| part.contains(from) || (block == part.start && *from == at);
        let plain = program.blocks.get(block).is_some_and(|block| {
            let own = block.stmts.iter().all(|stmt| stmt.site.skip.is_none_or(|own| own == level));
            own && !matches!(&block.term.kind, TermKind::Branch { cond, .. } if cond.has_switch())
        });
        plain && !ways.is_entered(block) && ways.of(block).iter().all(from)
    };
    part.clone().all(is_own).then_some((level, part))
}
