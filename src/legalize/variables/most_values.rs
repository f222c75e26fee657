//! Numbers that state of the machine is set to, where the target takes fewer of them.
//!
//! Law: a number up to the largest that the target takes means there what it means on the source. A larger one is refused, and of a
//! computed one a person must see that it is none. Counter-example: `#3003=2`, where the target knows 0 and 1.

use crate::canon::Sys;
use crate::diag::{Code, Diagnostic};
use crate::ir::{Expr, Module, Place, StmtKind};
use crate::legalize::Context;

/// Reports what the target does not take, or may not.
pub fn run(module: &Module, context: &mut Context<'_>) {
    for (index, program) in module.programs.iter().enumerate() {
        for stmt in program.blocks.iter().flat_map(|block| &block.stmts) {
            let StmtKind::Assign { target: Place::System(state, _), value } = &stmt.kind else { continue };
            let Some(most) = most(*state, context) else { continue };
            let what = match value.constant() {
                Some(number) if (0.0..=most).contains(&number) => continue,
                _ if *value == Expr::Vacant => continue,
                Some(number) => (Code::NoEquivalent, format!("'{state}' is set to {number}")),
                None => (Code::Conditional, format!("'{state}' is set to a computed number")),
            };
            let title = &context.target.dialect().title;
            let finding = format!("{}, and the {title} takes 0 to {most} only", what.1);
            let help = match what.0 {
                Code::NoEquivalent => {
                    "leave out what the larger number asks for, if the target does without it"
                }
                _ => "make sure that it is never larger here",
            };
            context.add_once(
                index,
                &finding,
                Diagnostic::new(what.0, stmt.site.span, finding.clone()).with_help(help),
            );
        }
    }
}

/// The largest number that the target takes, where the source may take a larger one.
fn most(state: Sys, context: &Context<'_>) -> Option<f64> {
    let most = context.target.system_run(state)?.most?;
    let ours = context.source.system_run(state).and_then(|row| row.most);
    ours.is_none_or(|ours| ours > most).then_some(most)
}
