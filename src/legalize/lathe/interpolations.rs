//! Milling on the face of a part while C follows (polar interpolation).
//!
//! Law: the same words move the same way. Side condition: both controls are programmed there in the same words. Counter-example: `X10. C5.` in a
//! plane of a diameter and a length, where the target takes X for a radius and Y for the length.

use crate::canon::Op;
use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::{Module, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::Features;

/// True where a program mills so.
pub fn concerns(features: &Features, _: &Context<'_>) -> bool {
    features.op(Op::PolarPlane)
}

/// Refuses it between controls that are programmed otherwise.
pub fn run(module: &Module, context: &mut Context<'_>) {
    for (index, program) in module.programs.iter().enumerate() {
        for stmt in program.blocks.iter().flat_map(|block| &block.stmts) {
            let StmtKind::Nc(nc) = &stmt.kind else { continue };
            if !nc.has(Op::PolarPlane) {
                continue;
            }
            context.rests_on_source(index, stmt.site.span, Question::PolarWords);
            context.rests_on_target(index, stmt.site.span, Question::PolarWords);
            if !context.agree(Question::PolarWords) {
                let found = Diagnostic::new(Code::NoEquivalent, stmt.site.span, WHAT).with_help(HELP);
                context.add_once(index, WHAT, found);
            }
        }
    }
}

const WHAT: &str = "polar interpolation is programmed in other words on the target: in X as a diameter and C on the one, in X as a radius and Y on \
                    the other, as far as is known, and no source says it for all moves";
const HELP: &str = "let the CAM system write this part for the target, or write it by hand";
