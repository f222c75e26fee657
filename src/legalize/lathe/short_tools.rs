//! T words of a lathe with one or two digits.
//!
//! Nothing is changed. By its digits such a word is an offset without a station; a builder may have made it the tool and its offset, or the
//! station alone, and the profile of the source says so: then it was read as that, and is written with four digits. What is left is an offset alone.
//! Whether both machines take it so is asked of each, once; where they are known to differ it is refused. Side conditions: the number is a
//! constant. Counter-example: `T0`, which has no offset.

use crate::canon::Role;
use crate::dialect::{Machine, Question, turret_parts};
use crate::ir::{Expr, Module, StmtKind};
use crate::legalize::Context;
use crate::legalize::assumptions::shop::rests;
use crate::legalize::features::Features;

/// True for a library with T words between two lathes.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let lathes = [context.source, context.target].iter().all(|one| one.machine() == Machine::Lathe);
    lathes && features.role(Role::Turret) && !context.source.is_same_machine(context.target)
}

/// Looks at each T word.
pub fn run(module: &Module, context: &mut Context<'_>) {
    for (index, program) in module.programs.iter().enumerate() {
        for stmt in program.blocks.iter().flat_map(|block| &block.stmts) {
            let StmtKind::Nc(nc) = &stmt.kind else { continue };
            let parts = nc.word(Role::Turret).and_then(Expr::constant).map(turret_parts);
            if parts.is_some_and(|(station, offset)| station == 0.0 && offset != 0.0) {
                rests(Question::TurretShort, index, stmt.site.span, context);
            }
        }
    }
}
