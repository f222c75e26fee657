//! Lines without anything, under cutter compensation.
//!
//! Law: such a line is an empty block, and does nothing. Under compensation a control looks ahead for the next move past a few blocks
//! only, and not all of them past the same number. So between programs of two controls the lines go there. Side condition: none. Counter-
//! example: an empty block that was written with its `;`, which is a block of its own and is told as a block without a move.

use crate::canon::{Group, Op};
use crate::ir::{BlockId, Module};
use crate::legalize::features::Features;
use crate::legalize::{Context, Modal};

/// True if the library compensates, and goes to another control.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    context.source.dialect().name != context.target.dialect().name
        && features.any_op(|op| matches!(op, Op::RadiusLeft | Op::RadiusRight))
}

/// Takes the lines out where compensation may be in force; true if there were any.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let facts = context.modal_facts(module);
    let mut changed = false;
    let mut clear = |blanks: &mut u8, state: &Modal| {
        if state.op(Group::RadiusComp) != Some(Op::RadiusOff) {
            changed |= std::mem::take(blanks) > 0;
        }
    };
    for (index, program) in module.programs.iter_mut().enumerate() {
        for (at, block) in program.blocks.iter_mut().enumerate() {
            let mut state = facts.at(index, BlockId(at as u32));
            for stmt in &mut block.stmts {
                clear(&mut stmt.site.blanks, &state);
                state.step(stmt);
            }
            clear(&mut block.term.site.blanks, &state);
        }
    }
    changed
}
