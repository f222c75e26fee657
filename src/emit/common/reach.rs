//! Which sequence numbers computed jumps look for.
//!
//! Law: where the source has no block of a number that a computed jump looks for, the control stops with an alarm; so no
//! block may have such a number that the source does not give it. Numbers that are invented stay out of what the jumps
//! may look for. Where that is not bounded, invented numbers lie above all that the library has, and a jump to one of those
//! is stopped by an alarm before it looks. Counter-example: `GOTO #1` with `#1` = 10, and an invented N10.

use crate::emit::Naming;
use crate::emit::naming::{above, last_sequence};
use crate::ir::analysis::{Numbers, Ranges};
use crate::ir::{Expr, Program, TermKind};

/// What computed jumps to a program's blocks look for.
#[derive(Debug, Default)]
pub(in crate::emit) struct Reach {
    /// By jumps of this program.
    jumps: Numbers,
    /// By jumps, and by returns of other programs.
    all: Numbers,
    /// Where invented numbers start, if nothing bounds the jumps.
    floor: Option<u32>,
}

impl Reach {
    /// The reach of a program's own jumps and of the library's returns, where `most` is the largest number.
    pub fn of(program: &Program, names: &Naming, most: u32) -> Self {
        let mut jumps = Numbers::default();
        if program.blocks.iter().any(|block| matches!(block.term.kind, TermKind::Computed { .. })) {
            let ranges = names.summaries().map(|summaries| Ranges::of_any_inputs(program, summaries));
            for (id, block) in program.ids().zip(&program.blocks) {
                let TermKind::Computed { value, .. } = &block.term.kind else { continue };
                let found = ranges.as_ref().map(|ranges| ranges.at(id, block.stmts.len(), value).numbers());
                jumps.join(&found.unwrap_or_else(|| Numbers::of([(0, u32::MAX)])));
            }
        }
        let mut all = jumps.clone();
        all.join(names.returned_to());
        let open = |numbers: &Numbers| numbers.last().is_some_and(|last| last >= most);
        let own = open(&jumps).then(|| above(last_sequence(program)));
        let floor = names.returns_floor(most).or(own);
        Self { jumps, all, floor }
    }

    /// True where a block may be given this number that the source does not give it.
    pub fn may_be_invented(&self, number: u32) -> bool {
        match self.floor {
            Some(floor) => number >= floor,
            None => !self.all.contains(number),
        }
    }

    /// True where a jump may look for a number that no jump of the source finds here.
    pub fn bars(&self, number: u32) -> bool {
        self.jumps.contains(number)
    }

    /// Where invented numbers start, if a jump may look for any number.
    pub fn floor(&self) -> Option<u32> {
        self.floor
    }
}

/// True where a value is the same when it is read twice.
pub(in crate::emit) fn is_steady(value: &Expr) -> bool {
    let mut steady = true;
    value.walk(&mut |part| steady &= !matches!(part, Expr::System(..) | Expr::Indirect(..)));
    steady
}
