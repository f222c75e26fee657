//! Removes what is assigned to temporaries that nothing reads.
//!
//! **Law.** An assignment to a temporary that is read on no way after it does nothing.
//!
//! **Side condition.** Its value cannot raise an alarm. A comment beside it stays.
//!
//! **Counter-example.** `tmp.1 = SQRT[#1]` stops the machine where `#1` is below 0.

use super::pass::{Level, Library, Pass};
use super::retarget::drop_statements;
use crate::ir::analysis::{Liveness, Ways};
use crate::ir::{Block, Class, Expr, Place, Program, Stmt, StmtKind, Var};
use std::cell::Cell;

/// The pass.
pub struct DeadStores;

impl Pass for DeadStores {
    fn name(&self) -> &'static str {
        "dead-stores"
    }

    fn run(&self, program: &mut Program, library: &Library, _: Level) {
        // What a removed assignment read may be dead in its turn.
        let _ = (0..SWEEPS).find(|_| !may_have_dead(program) || !sweep(program, library.ways));
    }
}

/// Chains of dead assignments longer than this, each read by the next, keep their heads.
const SWEEPS: usize = 16;

/// Temporaries are read so soon, or it is asked what is live.
const NEAR: usize = 64;

/// The temporary that a statement may be dropped for.
fn assigned(stmt: &Stmt) -> Option<Var> {
    match &stmt.kind {
        StmtKind::Assign { target: Place::Var(var), value } => {
            (var.class == Class::Temp && !value.may_alarm()).then_some(*var)
        }
        _ => None,
    }
}

/// False where every such temporary is read in its own block, as nearly all are: they live.
fn may_have_dead(program: &Program) -> bool {
    program.blocks.iter().any(|block| {
        block
            .stmts
            .iter()
            .enumerate()
            .any(|(at, stmt)| assigned(stmt).is_some_and(|temp| !is_read(temp, block, at + 1)))
    })
}

/// True where a block reads a temporary soon after a statement, or at its end, before it writes it again.
fn is_read(temp: Var, block: &Block, from: usize) -> bool {
    let found = Cell::new(false);
    let mut read = |e: &Expr| e.variables(&mut |var| found.set(found.get() || var == temp));
    for stmt in block.stmts.iter().skip(from).take(NEAR) {
        stmt.kind.exprs(&mut read);
        if found.get() || stmt.kind.target() == Some(&Place::Var(temp)) {
            return found.get();
        }
    }
    block.term.kind.exprs(&mut read);
    found.get()
}

/// Removes what is dead now; true where that was anything.
fn sweep(program: &mut Program, ways: Ways) -> bool {
    let live = Liveness::of(program, ways);
    let mut dead = Vec::new();
    let assigns = |block: &Block| block.stmts.iter().any(|stmt| assigned(stmt).is_some());
    for (id, block) in program.ids().zip(&program.blocks).filter(|(_, block)| assigns(block)) {
        live.backward(id, &mut |at, is_live| {
            if block.stmts.get(at).and_then(assigned).is_some_and(|temp| !is_live(&temp)) {
                dead.push((id, at));
            }
        });
    }
    // A comment stays where it was.
    dead.retain(|(id, at)| {
        let stmt = program.blocks.get_mut(id.index()).and_then(|block| block.stmts.get_mut(*at));
        let Some(stmt) = stmt.filter(|stmt| !stmt.site.comments.is_empty()) else { return true };
        stmt.kind = StmtKind::Comment;
        false
    });
    drop_statements(program, &dead);
    !dead.is_empty()
}
