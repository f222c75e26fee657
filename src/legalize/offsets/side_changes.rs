//! Cutter compensation that goes over to the other side.
//!
//! Law: nothing is changed; where the target takes the other side on an arc alone, a straight block that names it while the
//! first is in force is refused. Side condition: the side in force is known. Counter-example: `G41 D1 X5.`, `G42 X20.`

use crate::canon::{Group, Op};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::{Module, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::Features;

/// True if the library compensates on both sides, and the target asks for an arc between.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let row = context.target.behaviour(Question::RadiusSideChanges);
    features.op(Op::RadiusLeft) && features.op(Op::RadiusRight) && row.is_some_and(|row| row.value == "arc")
}

/// Refuses changes on straight moves.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let facts = context.modal_facts(module);
    for (index, program) in module.programs.iter().enumerate() {
        for (id, block) in program.ids().zip(&program.blocks) {
            let mut state = facts.at(index, id);
            for stmt in &block.stmts {
                let before = state.op(Group::RadiusComp);
                state.step(stmt);
                let StmtKind::Nc(nc) = &stmt.kind else { continue };
                let turns = match before {
                    Some(Op::RadiusLeft) => nc.has(Op::RadiusRight),
                    Some(Op::RadiusRight) => nc.has(Op::RadiusLeft),
                    _ => false,
                };
                let arc = matches!(state.op(Group::Motion), Some(Op::ArcCw | Op::ArcCcw));
                if turns && !arc {
                    let what = "the compensation goes over to the other side on a straight move, which the target takes for \
                                a fault: end it with G40 before";
                    context.add(index, Diagnostic::new(Code::NoEquivalent, stmt.site.span, what));
                    context.rests_on_target(index, stmt.site.span, Question::RadiusSideChanges);
                }
            }
        }
    }
}
