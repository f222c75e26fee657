//! Which statements may come while something is in force that another statement began.
//!
//! Over-approximates: what a called program begins may be in force after the call, what a caller began may be in force
//! in every program that something calls, and only a statement of the same program ends it.

use super::calls_of;
use crate::ir::analysis::Cfg;
use crate::ir::{Block, BlockId, Callee, Module, Program, Stmt};

/// Calls `found` with every statement, by program, that may come after one that `sets` and before one that `ends`.
pub fn behind(
    module: &Module,
    sets: impl Fn(&Stmt) -> bool,
    ends: impl Fn(&Stmt) -> bool,
    mut found: impl FnMut(usize, &Stmt),
) {
    let sets_any = |program: &Program| program.blocks.iter().flat_map(|block| &block.stmts).any(&sets);
    let setting: Vec<bool> = module.programs.iter().map(sets_any).collect();
    let calls = || module.programs.iter().flat_map(|program| &program.blocks).flat_map(calls_of);
    for (index, program) in module.programs.iter().enumerate() {
        let others = setting.iter().enumerate().any(|(other, sets)| *sets && other != index);
        let called = calls().any(|call| match &call.callee {
            Callee::Program(name) => program.name.as_ref() == Some(name),
            // Any program may be meant.
            Callee::Computed(_) => true,
            Callee::Block(_) | Callee::Cycle(_) => false,
        });
        let own = setting[index];
        if !own && !others {
            continue;
        }
        let step = |stmt: &Stmt, on: bool| sets(stmt) || (on && !ends(stmt));
        let starts = starts(program, others && called, (own, others), &step);
        for (block, mut on) in program.blocks.iter().zip(starts) {
            for stmt in &block.stmts {
                if on {
                    found(index, stmt);
                }
                on = step(stmt, on);
            }
        }
    }
}

/// By block, whether it may be in force at its start; `before`: at the start of the program. The program itself may
/// begin it, or others.
fn starts(
    program: &Program,
    before: bool,
    (own, others): (bool, bool),
    step: &dyn Fn(&Stmt, bool) -> bool,
) -> Vec<bool> {
    let cfg = Cfg::of(program);
    let end = |block: &Block, on: bool| {
        block.stmts.iter().fold(on, |on, stmt| step(stmt, on))
            || calls_of(block).any(|call| others || own && matches!(call.callee, Callee::Block(_)))
    };
    let mut starts = vec![false; program.blocks.len()];
    // A subroutine is entered from wherever it is called.
    cfg.roots().iter().for_each(|root| starts[root.index()] = before || own && *root != BlockId(0));
    let mut changed = true;
    // Each round makes one more true, or is the last.
    while changed {
        changed = false;
        for (at, block) in program.blocks.iter().enumerate() {
            let end = end(block, starts[at]);
            for to in cfg.succs(BlockId(at as u32)) {
                if let Some(start) = starts.get_mut(to.index()).filter(|start| end && !**start) {
                    *start = true;
                    changed = true;
                }
            }
        }
    }
    starts
}
