//! Tools for which the target's magazine has no pocket.
//!
//! Nothing is changed. The profile of the target says how many tools its magazine holds (`"tools"` under `[limits]`); a greater T is an
//! alarm there, or a change by hand. Side conditions: T is a number, and names a pocket or a tool, not a group of tools. One that is
//! computed is not looked at. Counter-example: `T90`, a probe in the last pocket of a large magazine.

use crate::canon::Role;
use crate::diag::{Code, Diagnostic};
use crate::ir::{Expr, Module, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::Features;

/// The limit's name.
const LIMIT: &str = "tools";

/// True if the profile says how many tools the target holds.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    features.role(Role::Tool) && context.target.limit(LIMIT).is_some()
}

/// Tells of the first such tool of each program.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let Some(most) = context.target.limit(LIMIT) else { return };
    for (index, program) in module.programs.iter().enumerate() {
        for stmt in program.blocks.iter().flat_map(|block| &block.stmts) {
            let StmtKind::Nc(nc) = &stmt.kind else { continue };
            let tool = nc.word(Role::Tool).and_then(Expr::constant);
            if let Some(tool) = tool.filter(|tool| *tool > f64::from(most)) {
                let what = format!("tool {tool}: the magazine of the target holds {most} by its profile");
                let help = "give the tool another number here, with its offsets; or change it by hand";
                let finding = Diagnostic::new(Code::Conditional, stmt.site.span, what).with_help(help);
                context.add_once(index, LIMIT, finding);
            }
        }
    }
}
