//! A comparison as a value, where the target has comparisons in conditions only.
//!
//! Law: `t = 0`, then `t = 1` where the condition holds, is the truth value.
//! Nothing is assumed of the operands; they are evaluated once, before the
//! statement, as they would have been in it.

use crate::dialect::Question;
use crate::ir::{Expr, Program};
use crate::legalize::features::{Feature, Features};
use crate::legalize::{Context, Position, PreStatement, Rewriter, rewrite_program};

/// True where a comparison is a value, and the target takes none.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    features.has(Feature::Truth) && !context.target.is(Question::ComparisonIsValue)
}

/// Replaces truth values by temporaries that an IF sets.
pub fn run(program: &mut Program, _: usize, _: &mut Context<'_>) -> bool {
    rewrite_program(
        program,
        |e| matches!(e, Expr::Truth(_)),
        &mut |e, _: Position, rewriter: &mut Rewriter<'_>| match e {
            Expr::Truth(cond) => {
                let truth = rewriter.materialize(Expr::Number(0.0));
                rewriter.first(PreStatement::When(*cond, truth, Expr::Number(1.0)));
                Expr::Var(truth)
            }
            other => other,
        },
    )
}
