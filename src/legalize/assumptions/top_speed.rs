//! Speeds of the spindle that the target cannot turn.
//!
//! Nothing is changed. The profile of the target says how fast its spindle turns (`"spindle.speed"` under `[limits]`); S of more than
//! that stops it with an alarm, or turns more slowly under the same feed. Side conditions: S is a number, and a speed of turns. One
//! that is computed is not looked at. Counter-example: `S13500` on a machine that turns 12000.

use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::ir::{Expr, Module, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::Features;

/// The limit's name.
const LIMIT: &str = "spindle.speed";

/// True if the profile says how fast the target turns.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    features.role(Role::Speed) && context.target.limit(LIMIT).is_some()
}

/// Tells of the first such speed of each program.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let Some(most) = context.target.limit(LIMIT) else { return };
    let facts = context.modal_facts(module);
    for (index, program) in module.programs.iter().enumerate() {
        for (id, block) in program.ids().zip(&program.blocks) {
            let mut state = facts.at(index, id);
            for stmt in &block.stmts {
                state.step(stmt);
                let StmtKind::Nc(nc) = &stmt.kind else { continue };
                let turns = state.op(Group::SpeedMode) != Some(Op::SurfaceSpeed) && !nc.has(Op::LimitSpeed);
                let speed = nc.word(Role::Speed).and_then(Expr::constant).filter(|_| turns);
                if let Some(speed) = speed.filter(|speed| *speed > f64::from(most)) {
                    let what = format!(
                        "a speed of {speed} is too fast for the target, which turns {most} by its profile: it stops with an alarm, or turns \
                         more slowly while the feed stays"
                    );
                    let help = "write a speed that it turns, and the feed for it";
                    let finding = Diagnostic::new(Code::Conditional, stmt.site.span, what).with_help(help);
                    context.add_once(index, LIMIT, finding);
                }
            }
        }
    }
}
