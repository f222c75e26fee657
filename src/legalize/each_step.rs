//! One thing that statements change, followed over a library beside what is in force.

use crate::ir::analysis::dataflow::Lattice;
use crate::ir::analysis::over_calls::{Follow, OverCalls};
use crate::ir::{Block, BlockId, Module, Stmt};
use crate::legalize::{Modal, ModalFacts};

/// Takes a statement: steps what is in force and what is known, and gives what is to be told.
type Step<K, T> = fn(&Stmt, &mut Modal, &mut K) -> T;

struct Steps<'f, K, T> {
    facts: &'f ModalFacts,
    step: Step<K, T>,
}

impl<K: Lattice + Clone + Default, T> Follow for Steps<'_, K, T> {
    type Known = K;

    fn outside(&self, _: usize) -> K {
        K::default()
    }

    fn stmts(&self, (index, id): (usize, BlockId), block: &Block, known: &mut K) {
        let mut state = self.facts.at(index, id);
        for stmt in &block.stmts {
            (self.step)(stmt, &mut state, known);
        }
    }

    // What the library does not have is taken to leave it as it is.
    fn lose(&self, _: &mut K) {}
}

/// Gives `told` each statement with its program, what was known before it, and what its step says. Runs begin with what is known by
/// default.
pub(in crate::legalize) fn each_step<K: Lattice + Clone + Default, T>(
    module: &Module,
    facts: &ModalFacts,
    step: Step<K, T>,
    mut told: impl FnMut(usize, &Stmt, (K, T)),
) {
    let starts = OverCalls::of(module, &Steps { facts, step });
    for (index, program) in module.programs.iter().enumerate() {
        for (id, block) in program.ids().zip(&program.blocks) {
            let mut state = facts.at(index, id);
            let mut known = starts.at(index, id).cloned().unwrap_or_default();
            for stmt in &block.stmts {
                let before = known.clone();
                let says = step(stmt, &mut state, &mut known);
                told(index, stmt, (before, says));
            }
        }
    }
}
