//! What milling with the C axis on the face of a part (polar interpolation) rests on.

use crate::canon::Op;
use crate::dialect::Question;
use crate::ir::{Module, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::Features;

/// True where a program mills so.
pub fn concerns(features: &Features, _: &Context<'_>) -> bool {
    features.op(Op::PolarPlane)
}

/// Reports that both controls are programmed there in words that no maker's text confirms.
pub fn run(module: &Module, context: &mut Context<'_>) {
    for (index, program) in module.programs.iter().enumerate() {
        for stmt in program.blocks.iter().flat_map(|block| &block.stmts) {
            let StmtKind::Nc(nc) = &stmt.kind else { continue };
            if nc.has(Op::PolarPlane) {
                context.rests_on_source(index, stmt.site.span, Question::PolarWords);
                context.rests_on_target(index, stmt.site.span, Question::PolarWords);
            }
        }
    }
}
