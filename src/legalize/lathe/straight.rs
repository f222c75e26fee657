//! Blocks that are come to from the block before them alone: a sequence number that no jump names begins such a block.

use crate::ir::analysis::calls_of;
use crate::ir::analysis::over_calls::called;
use crate::ir::{BlockId, Callee, Module, Program, TermKind};

/// For each block, whether the run comes to it by going on from the block before it, and in no other way.
pub fn entered_straight(program: &Program) -> Vec<bool> {
    let mut ways = vec![0_u32; program.blocks.len()];
    for to in program.blocks.iter().flat_map(|block| block.term.kind.successors()) {
        if let Some(ways) = ways.get_mut(to.index()) {
            *ways += 1;
        }
    }
    let goes_on = |at: usize| {
        let before = at.checked_sub(1).and_then(|before| program.blocks.get(before));
        before.is_some_and(|block| goes_on_to(&block.term.kind, at))
    };
    ways.into_iter().enumerate().map(|(at, ways)| ways == 1 && goes_on(at)).collect()
}

/// True where a block ends by going on at the block of this index.
pub fn goes_on_to(term: &TermKind, at: usize) -> bool {
    matches!(term, TermKind::Jump(to) if *to == BlockId(at as u32))
}

/// True where a program that others of the library call may return to a sequence number of its caller: any block with a number may be come to.
pub fn returns_into(module: &Module) -> bool {
    let called = called(module);
    let mut calls = module.programs.iter().flat_map(|program| &program.blocks).flat_map(calls_of);
    let computed = calls.any(|call| matches!(call.callee, Callee::Computed(_)));
    let returns = |program: &Program| {
        let mut blocks = program.blocks.iter();
        blocks.any(|block| matches!(block.term.kind, TermKind::Return { to: Some(_) }))
    };
    module.programs.iter().zip(called).any(|(program, called)| (called || computed) && returns(program))
}
