//! A loop that has the same block skip on each of its blocks.
//!
//! Law: nobody turns the switch while such a loop runs, so the control passes over the whole loop or runs it as if nothing stood
//! before its blocks. It becomes a branch on the switch round a plain loop; the branch keeps the level, so that each block of the loop
//! gets it again. Side condition: every block from the head to the end that does something has that one block skip, first in it, and
//! only that one. Counter-example: a head with a block skip whose end has none is an end without its head while the switch is on.

use super::block::levels;
use crate::diag::{Code, Diagnostic};
use crate::ir::{Cond, SourceInfo, TermKind};
use crate::lower::macro_b::build::{Lowering, SkippedLoop};
use crate::lower::macro_b::parts::acts;
use crate::syntax::{Block, Item, ItemKind};

const UNCLEAR: &str =
    "a block skip together with a loop or a second skip: it is not certain what the control skips";

const ALL: &str = "put the same block skip before every block of the loop, from its head to its end";

/// True if the block does nothing, or has this block skip alone and before all else.
fn is_under(block: &Block, level: u8) -> bool {
    let items = block.items.as_slice();
    let Some(first) = items.iter().position(acts) else { return true };
    matches!(levels(items, first), (head, middle) if middle.is_empty() && head.as_slice() == [level])
}

impl<'a> Lowering<'a> {
    /// Lowers a block under a block skip that is of a loop; false if it is of none.
    pub(super) fn skipped_loop(&mut self, block: &'a Block, level: u8, site: &SourceInfo) -> bool {
        let items = block.items.as_slice();
        if self.skipped.is_none() {
            let number = items.iter().find_map(|item| match item.kind {
                ItemKind::Do { number, .. } => Some(number),
                _ => None,
            });
            let Some(end) = number.and_then(|number| self.end_of_loop(number, level)) else { return false };
            let before = self.motion;
            let (body, next) = (self.builder.fresh(), self.builder.fresh());
            let cond = Box::new(Cond::Switch(level));
            let aside = SourceInfo { skip: Some(level), ..SourceInfo::default() };
            self.builder.end(TermKind::Branch { cond, then: next, otherwise: body }, aside);
            self.builder.start(body);
            self.skipped = Some(SkippedLoop { level, end, next, before });
        }
        if self.skipped.as_ref().is_none_or(|open| open.level != level) {
            return false;
        }
        self.items(items, site);
        if let Some(open) = self.skipped.take_if(|open| open.end == self.at) {
            self.motion.meet(open.before);
            self.builder.start(open.next);
        }
        true
    }

    /// The block where a loop ends that begins here; none if a block of it is not under the block skip.
    fn end_of_loop(&self, number: u32, level: u8) -> Option<usize> {
        let blocks = self.parsed.blocks.get(self.at..self.end)?;
        for (at, block) in (self.at..).zip(blocks) {
            if !is_under(block, level) {
                return None;
            }
            let ends = |item: &Item| matches!(item.kind, ItemKind::End { number: end } if end == number);
            if block.items.iter().any(ends) {
                return Some(at);
            }
        }
        None
    }

    /// What the control skips is not certain.
    pub(super) fn unclear_skip(&mut self, block: &Block, loops: bool) {
        let told = Diagnostic::new(Code::SkipUnclear, block.span, UNCLEAR);
        self.findings.add(if loops { told.with_help(ALL) } else { told });
    }
}
