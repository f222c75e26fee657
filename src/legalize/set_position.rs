//! Work offsets that are selected behind a position that the program set.
//!
//! Law: the code that says where the tool stands shifts all work offsets on some controls until it is taken back, and on
//! others lasts until an offset is selected. Of controls of two families it is not known that they do the same, so a
//! selection that may come behind such a code is told. Side condition: an offset that is selected before is meant alike.

use super::{Context, calls_of};
use crate::canon::Op;
use crate::diag::{Code, Diagnostic};
use crate::ir::analysis::Cfg;
use crate::ir::{Block, BlockId, Callee, Module, Program, Stmt};
use crate::text::Span;

/// Reports selections behind a set position.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let sets: Vec<bool> = module
        .programs
        .iter()
        .map(|program| {
            program.blocks.iter().flat_map(|block| &block.stmts).any(|stmt| has(stmt, Op::SetPosition))
        })
        .collect();
    let calls = || module.programs.iter().flat_map(|program| &program.blocks).flat_map(calls_of);
    for (index, program) in module.programs.iter().enumerate() {
        let elsewhere = sets.iter().enumerate().any(|(other, sets)| *sets && other != index);
        let called = calls().any(|call| match &call.callee {
            Callee::Program(name) => program.name.as_ref() == Some(name),
            // Any program may be meant.
            Callee::Computed(_) => true,
            Callee::Block(_) | Callee::Cycle(_) => false,
        });
        if let Some(span) = selected(program, elsewhere && called, (sets[index], elsewhere)) {
            let what = "a work offset is selected where a position that was set may be in force: whether that ends it is not known of both controls";
            context.add_once(index, what, Diagnostic::new(Code::Conditional, span, what));
        }
    }
}

fn has(stmt: &Stmt, op: Op) -> bool {
    stmt.kind.nc().is_some_and(|nc| nc.has(op))
}

/// The first selection behind a set position; `before`: one may be in force at the start. The program itself may set
/// one, or others.
fn selected(program: &Program, before: bool, (own, others): (bool, bool)) -> Option<Span> {
    let cfg = Cfg::of(program);
    let behind = |block: &Block, set: bool| {
        set || block.stmts.iter().any(|stmt| has(stmt, Op::SetPosition))
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
            let end = behind(block, starts[at]);
            for to in cfg.succs(BlockId(at as u32)) {
                if let Some(start) = starts.get_mut(to.index()).filter(|start| end && !**start) {
                    *start = true;
                    changed = true;
                }
            }
        }
    }
    program.blocks.iter().zip(starts).find_map(|(block, mut set)| {
        block.stmts.iter().find_map(|stmt| {
            let found = (set && has(stmt, Op::SelectWork)).then_some(stmt.site.span);
            set |= has(stmt, Op::SetPosition);
            found
        })
    })
}
