//! Which programs calls by a computed number may come to.

use super::calls_of;
use crate::ir::analysis::{Ranges, Summaries, Values};
use crate::ir::{Block, BlockId, Callee, Expr, Module, StmtKind, TermKind};
use crate::syntax::ProgramName;
use std::collections::BTreeMap;

/// What the computed calls of a block may call.
#[derive(Clone, Debug, Default)]
pub struct Callees {
    /// The programs of the library, by index: those with such a number, and where any number may be meant, those that
    /// return.
    pub programs: Vec<usize>,
    /// True where it is known to be one of them.
    pub known: bool,
}

/// The computed calls of a library, by program and block.
pub fn computed_calls(module: &Module) -> BTreeMap<(usize, BlockId), Callees> {
    let computes = |block: &Block| calls_of(block).any(|call| computed(&call.callee).is_some());
    let blocks = module.programs.iter().enumerate().flat_map(|(index, program)| {
        program.ids().zip(&program.blocks).map(move |(id, block)| (index, id, block))
    });
    let blocks: Vec<_> = blocks.filter(|(.., block)| computes(block)).collect();
    if blocks.is_empty() {
        return BTreeMap::new();
    }
    let summaries = Summaries::of(module);
    let mut ranges: BTreeMap<usize, Ranges<'_>> = BTreeMap::new();
    let mut found = BTreeMap::new();
    for (index, id, block) in blocks {
        let ranges = ranges.entry(index).or_insert_with(|| Ranges::of(&module.programs[index], &summaries));
        let mut callees = Callees { programs: Vec::new(), known: true };
        for (at, number) in numbers(block) {
            let values = ranges.at(id, at, number);
            callees.known &= matches!(values, Values::Few(_));
            callees.programs.extend(programs(module, &values));
        }
        callees.programs.sort_unstable();
        callees.programs.dedup();
        found.insert((index, id), callees);
    }
    found
}

fn computed(callee: &Callee) -> Option<&Expr> {
    match callee {
        Callee::Computed(number) => Some(number),
        _ => None,
    }
}

/// The computed numbers that a block calls, and the statements that they stand in.
fn numbers(block: &Block) -> Vec<(usize, &Expr)> {
    let stmts = block.stmts.iter().enumerate().filter_map(|(at, stmt)| match &stmt.kind {
        StmtKind::ModalCall(call) => Some((at, computed(&call.callee)?)),
        _ => None,
    });
    let term = match &block.term.kind {
        TermKind::Call { call, .. } => computed(&call.callee).map(|number| (block.stmts.len(), number)),
        _ => None,
    };
    stmts.chain(term).collect()
}

fn programs(module: &Module, values: &Values) -> Vec<usize> {
    let (numbers, known) = (values.numbers(), matches!(values, Values::Few(_)));
    let meant = |at: &usize| {
        let program = &module.programs[*at];
        let returns =
            || program.blocks.iter().any(|block| matches!(block.term.kind, TermKind::Return { .. }));
        let Some(ProgramName::Number(number)) = program.name else { return false };
        numbers.contains(number) && (known || returns())
    };
    (0..module.programs.len()).filter(meant).collect()
}
