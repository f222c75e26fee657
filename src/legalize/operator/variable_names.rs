//! Names of variables, for a control that shows none.
//!
//! Law: a name that a program gives to a variable is read by nobody but the operator, so a program without it does the
//! same to the part. Each program that gave some tells it in a note. Counter-example: a name that an expression reads
//! (`#[#_NAME]`) is the variable itself, and is resolved before.

use crate::diag::{Code, Diagnostic};
use crate::ir::{Module, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::{Feature, Features};

/// True if the target has no names that programs give, and there may be some.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    features.has(Feature::Variable) && context.target.statement("setvn").is_none()
}

/// Leaves names out.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let mut changed = false;
    for (index, program) in module.programs.iter_mut().enumerate() {
        for stmt in program.blocks.iter_mut().flat_map(|block| &mut block.stmts) {
            let StmtKind::SetNames { names, .. } = &stmt.kind else { continue };
            let what = format!("the target shows no names of variables: {} left out", names.join(", "));
            stmt.kind = StmtKind::Comment;
            changed = true;
            context.add_once(index, "names", Diagnostic::new(Code::NamesDropped, stmt.site.span, what));
        }
    }
    changed
}
