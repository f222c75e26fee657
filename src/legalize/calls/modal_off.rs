//! The end of a modal call where none is open.
//!
//! Law: there the code ends nothing, and is left out: a control may take it for a fault. Side conditions: the source is known
//! to take it for nothing, no modal call is open on any way there, and nothing that the library does not have calls the program: one that returns may be called
//! from anywhere. Counter-example: a subprogram that ends its caller's modal call.

use crate::ir::{Module, Program, StmtKind, TermKind};
use crate::legalize::{Context, replace_statements};

/// Leaves out the codes that end nothing.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let facts = context.modal_facts(module);
    let returns = |program: &Program| {
        program.blocks.iter().any(|block| matches!(block.term.kind, TermKind::Return { .. }))
    };
    let main: Vec<bool> = module.programs.iter().map(|program| !returns(program)).collect();
    replace_statements(module, &facts, |index, state, mut stmt, out| {
        let none = state.calls.as_ref().is_some_and(Vec::is_empty) && main.get(index) == Some(&true);
        state.step(&stmt);
        if none && stmt.kind == StmtKind::ModalCallOff {
            stmt.kind = StmtKind::Comment;
        }
        out.push(stmt);
    });
}
