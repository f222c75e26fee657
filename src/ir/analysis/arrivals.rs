//! The ways into each block of a program.

use crate::ir::{Block, BlockId, Call, Callee, Program, StmtKind, TermKind};
use crate::syntax::Label;

/// The ways into each block.
pub struct Arrivals {
    from: Vec<Vec<usize>>,
    entered: Vec<bool>,
}

impl Arrivals {
    /// Collects them; `kept` tells sequence numbers that other programs return to.
    pub fn of_program(program: &Program, kept: impl Fn(u32) -> bool) -> Self {
        let count = program.blocks.len();
        let mut all = Self { from: vec![Vec::new(); count], entered: vec![false; count] };
        all.enter(BlockId(0));
        for (at, block) in program.blocks.iter().enumerate() {
            for to in block.term.kind.successors() {
                if let Some(from) = all.from.get_mut(to.index()) {
                    from.push(at);
                }
            }
            callees(block).for_each(|entry| all.enter(entry));
            if block.labels.iter().any(|label| matches!(label, Label::Number(n) if kept(*n))) {
                all.enter(BlockId(at as u32));
            }
        }
        all
    }

    fn enter(&mut self, block: BlockId) {
        if let Some(entered) = self.entered.get_mut(block.index()) {
            *entered = true;
        }
    }

    /// The blocks that go on at this one.
    pub fn of(&self, block: usize) -> &[usize] {
        self.from.get(block).map_or(&[], Vec::as_slice)
    }

    /// True where control comes in from outside the program or by a call.
    pub fn is_entered(&self, block: usize) -> bool {
        self.entered.get(block).copied().unwrap_or(true)
    }

    /// True if control comes in from this one block only.
    pub fn is_only_from(&self, block: usize, from: usize) -> bool {
        !self.is_entered(block) && self.of(block) == [from]
    }
}

/// The blocks that a block calls.
pub fn callees(block: &Block) -> impl Iterator<Item = BlockId> {
    let entry = |call: &Call| match call.callee {
        Callee::Block(entry) => Some(entry),
        _ => None,
    };
    let modal = block.stmts.iter().filter_map(move |stmt| match &stmt.kind {
        StmtKind::ModalCall(call) => entry(call),
        _ => None,
    });
    modal.chain(match &block.term.kind {
        TermKind::Call { call, .. } => entry(call),
        _ => None,
    })
}
