//! Removes what is assigned to temporaries that nothing reads.
//!
//! **Law.** An assignment to a temporary that is read on no way behind it does nothing.
//!
//! **Side condition.** Its value cannot raise an alarm. A comment beside it stays.
//!
//! **Counter-example.** `tmp.1 = SQRT[#1]` stops the machine where `#1` is below 0.

use super::pass::{Level, Pass};
use super::retarget::{drop_statements, has_temps};
use crate::ir::analysis::{Liveness, Ways};
use crate::ir::{Class, Module, Place, Program, StmtKind};

/// The pass.
pub(super) struct DeadTemps;

impl Pass for DeadTemps {
    fn name(&self) -> &'static str {
        "dead.temps"
    }

    fn run(&self, module: &mut Module, _: Level) {
        let ways = Ways::of(module);
        for program in &mut module.programs {
            // What a removed assignment read may be dead in its turn.
            let _ = (0..SWEEPS).find(|_| !has_temps(program) || !sweep(program, ways));
        }
    }
}

/// Chains of dead assignments longer than this, each read by the next, keep their heads.
const SWEEPS: usize = 16;

/// Removes what is dead now; true where that was anything.
fn sweep(program: &mut Program, ways: Ways) -> bool {
    let live = Liveness::of(program, ways);
    let mut dead = Vec::new();
    for (id, block) in program.ids().zip(&program.blocks) {
        live.backward(id, &mut |at, is_live| {
            let kind = block.stmts.get(at).map(|stmt| &stmt.kind);
            if let Some(StmtKind::Assign { target: Place::Var(var), value }) = kind
                && var.class == Class::Temp
                && !value.may_alarm()
                && !is_live(var)
            {
                dead.push((id, at));
            }
        });
    }
    // A comment stays where it was.
    dead.retain(|(id, at)| {
        let stmt = program.blocks.get_mut(id.index()).and_then(|block| block.stmts.get_mut(*at));
        let Some(stmt) = stmt.filter(|stmt| !stmt.site.remarks.is_empty()) else { return true };
        stmt.kind = StmtKind::Remark;
        false
    });
    drop_statements(program, &dead);
    !dead.is_empty()
}
