//! Which cycle is in force where, over the calls of a library.

use super::drill::{Cycle, Known, Runs, Told, Value};
use crate::canon::{Group, Op};
use crate::ir::analysis::dataflow::Lattice;
use crate::ir::analysis::over_calls::{Follow, OverCalls};
use crate::ir::analysis::{Modal, ModalFacts};
use crate::ir::{Block, BlockId, Module, Nc, Stmt, StmtKind, TermKind};
use std::collections::BTreeSet;

/// How the cycles in force are followed.
pub(super) struct Flow<'f> {
    pub facts: &'f ModalFacts,
    pub runs: Runs,
}

/// Takes a statement; `modal` is what is in force after it.
pub(super) fn step(stmt: &Stmt, known: &mut Known, modal: &Modal, runs: Runs) {
    let before = stmt.site.skip.map(|_| known.clone());
    match &stmt.kind {
        StmtKind::Nc(nc) => known.step(nc, modal, runs),
        StmtKind::ModalCall(_) | StmtKind::ModalCallOff => known.lose(),
        _ => {}
    }
    if let Some(before) = before {
        known.join(&before);
    }
}

impl Follow for Flow<'_> {
    type Known = Known;

    fn outside(&self, _: usize) -> Known {
        Known::OUTSIDE
    }

    fn stmts(&self, (program, id): (usize, BlockId), block: &Block, known: &mut Known) {
        let mut modal = self.facts.at(program, id);
        for stmt in &block.stmts {
            modal.step(stmt);
            step(stmt, known, &modal, self.runs);
        }
    }

    fn lose(&self, known: &mut Known) {
        known.lose();
    }
}

impl Flow<'_> {
    /// What holes of the library take from registers.
    pub fn held(&self, module: &Module, known: &OverCalls<Known>) -> [bool; 6] {
        let mut held = [false; 6];
        for (index, program) in module.programs.iter().enumerate() {
            for (id, block) in program.ids().zip(&program.blocks) {
                let Some(mut known) = known.at(index, id).cloned() else { continue };
                let mut modal = self.facts.at(index, id);
                for stmt in &block.stmts {
                    modal.step(stmt);
                    step(stmt, &mut known, &modal, self.runs);
                    let (StmtKind::Nc(nc), Cycle::On(drill)) = (&stmt.kind, &known.cycle) else { continue };
                    if self.runs.drills(nc) || nc.ops().any(Op::is_cycle) {
                        for what in Told::ALL {
                            held[what as usize] |= drill.told(what) == Value::Held;
                        }
                    }
                }
            }
        }
        held
    }
}

/// The only unit that a library names or checks, true for inch.
pub(super) fn named_unit(module: &Module) -> Option<bool> {
    let stmts = module.programs.iter().flat_map(|program| &program.blocks).flat_map(|block| &block.stmts);
    let named = stmts.filter_map(|stmt| stmt.kind.nc()).flat_map(Nc::ops).filter_map(|op| match op {
        Op::Inch | Op::CheckInch => Some(true),
        Op::Metric | Op::CheckMetric => Some(false),
        _ => None,
    });
    let named: BTreeSet<bool> = named.collect();
    named.first().copied().filter(|_| named.len() == 1)
}

/// For each statement of a block whether the next move after it says its interpolation.
pub(super) fn says_motion(block: &Block) -> Vec<bool> {
    let mut says = matches!(block.term.kind, TermKind::End { .. });
    let mut all: Vec<bool> = Vec::with_capacity(block.stmts.len());
    for stmt in block.stmts.iter().rev() {
        all.push(says);
        let Some(nc) = stmt.kind.nc() else { continue };
        if nc.ops().any(|op| op.group() == Group::Motion || op.is_cycle()) {
            says = true;
        } else if nc.names_axis() {
            says = false;
        }
    }
    all.reverse();
    all
}
