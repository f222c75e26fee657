//! The last wait over calls, where P of a call is none: what a caller told, and what a callee leaves.

use super::waits::{Told, Waits};
use crate::ir::analysis::dataflow::Lattice;
use crate::ir::analysis::over_calls::{Follow, OverCalls};
use crate::ir::{Block, BlockId, Call, Module, TermKind};

impl Lattice for Told {
    fn join(&mut self, other: &Self) -> bool {
        let was = *self;
        *self = self.met(*other);
        was != *self
    }
}

/// Follows a library.
pub(super) struct Followed<'w> {
    waits: &'w Waits,
    /// By program, what is known where a run begins at it.
    outside: Vec<Told>,
}

impl<'w> Followed<'w> {
    /// What is known at each block of a library.
    pub fn over(waits: &'w Waits, module: &Module) -> OverCalls<Told> {
        let outside = module.programs.iter().enumerate().map(|program| waits.begin(program)).collect();
        OverCalls::of(module, &Self { waits, outside })
    }
}

impl Follow for Followed<'_> {
    type Known = Told;

    fn outside(&self, program: usize) -> Told {
        self.outside.get(program).copied().unwrap_or_default()
    }

    fn stmts(&self, _: (usize, BlockId), block: &Block, known: &mut Told) {
        let mut on = self.waits.clone();
        on.come_in(*known);
        block.stmts.iter().for_each(|stmt| on.take(stmt));
        *known = on.told();
        if matches!(block.term.kind, TermKind::Call { .. } | TermKind::Return { .. }) {
            known.call();
        }
    }

    fn lose(&self, known: &mut Told) {
        *known = Told::default();
    }

    fn returned(&self, _: usize, _: &Call, _: &Told, after: &mut Told) {
        after.call();
    }
}
