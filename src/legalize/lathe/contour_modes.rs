//! Absolute or incremental places in contours that no way of the program leads to: what is in force where their cycles read them.

use super::straight::goes_on_to;
use crate::canon::{Group, Op, Role};
use crate::ir::analysis::dataflow::reached_among;
use crate::ir::analysis::entries;
use crate::ir::{BlockId, Expr, Program, StmtKind};
use crate::legalize::{Modal, ModalFacts};
use std::collections::BTreeMap;

/// What is in force where blocks begin.
pub struct Modes<'f> {
    facts: &'f ModalFacts,
    index: usize,
    /// For each block that only cycles come to, what is in force for it.
    read: Vec<Option<Op>>,
}

impl<'f> Modes<'f> {
    /// Those of a program of the library.
    pub fn of(program: &Program, index: usize, facts: &'f ModalFacts) -> Self {
        let cycles = cycles(program, index, facts);
        let mut modes = Self { facts, index, read: vec![None; program.blocks.len()] };
        let mut carried = None;
        for ((at, block), reached) in program.blocks.iter().enumerate().zip(reached(program)) {
            let begins = block.stmts.iter().find(|stmt| stmt.kind != StmtKind::Comment);
            let number = begins.and_then(|stmt| stmt.site.sequence.get());
            let mode = number.and_then(|number| cycles.get(&number).copied().flatten()).or(carried);
            modes.read[at] = mode.filter(|_| !reached);
            let mut modal = modes.at(at);
            block.stmts.iter().for_each(|stmt| modal.step(stmt));
            let goes_on = !reached && goes_on_to(&block.term.kind, at + 1);
            carried = modal.op(Group::Distance).filter(|_| goes_on);
        }
        modes
    }

    /// What is in force where a block begins.
    pub fn at(&self, at: usize) -> Modal {
        let mut modal = self.facts.at(self.index, BlockId(at as u32));
        if let (Some(Some(mode)), None) = (self.read.get(at), modal.op(Group::Distance)) {
            modal.start_in(*mode);
        }
        modal
    }
}

/// What is in force at the cycles that read a contour, as far as they agree, by the number of its first block.
fn cycles(program: &Program, index: usize, facts: &ModalFacts) -> BTreeMap<u32, Option<Op>> {
    let mut read = BTreeMap::new();
    for (at, block) in program.blocks.iter().enumerate() {
        let mut modal = facts.at(index, BlockId(at as u32));
        for stmt in &block.stmts {
            modal.step(stmt);
            let cycle = stmt.kind.nc().filter(|nc| nc.ops().any(Op::reads_contour));
            let first = cycle.and_then(|nc| nc.word(Role::ContourFirst)).and_then(Expr::constant);
            if let Some(first) = first {
                let mode = modal.op(Group::Distance);
                let known = read.entry(first as u32).or_insert(mode);
                *known = known.filter(|known| Some(*known) == mode);
            }
        }
    }
    read
}

/// For each block, whether any way leads to it from where the program begins, or where a call comes in.
pub fn reached(program: &Program) -> Vec<bool> {
    let begins = entries(program).chain([BlockId(0)]).map(BlockId::index);
    reached_among(program.blocks.len(), begins, |at, go| {
        let block = program.blocks.get(at).into_iter();
        block.flat_map(|block| block.term.kind.successors()).for_each(|to| go(to.index()));
    })
}
