//! Programs of a lathe for a mill, and of a mill for a lathe.
//!
//! Law: an axis word goes where it went only if both machines take it for the same. A lathe takes X for a diameter,
//! and U, V and W for increments of X, Y and Z; on a mill U, V and W are axes of their own. So nothing that names an
//! axis is converted from one to the other. Counter-example: `G1 W-.25`, which no other code would show.

use crate::diag::{Code, Diagnostic};
use crate::dialect::Machine;
use crate::ir::{Module, NcItem, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::Features;

fn why(context: &Context<'_>) -> &'static str {
    match context.source.machine() {
        Machine::Lathe => "it cannot turn",
        Machine::Mill => "it takes X for a diameter",
    }
}

/// True where the two machines are of different kinds.
pub fn concerns(_: &Features, context: &Context<'_>) -> bool {
    context.source.machine() != context.target.machine()
}

/// Refuses axis words between a lathe and a mill, at the first one of each program.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let (from, to) = (context.source.machine().name(), context.target.machine().name());
    for (index, program) in module.programs.iter().enumerate() {
        let first = program.blocks.iter().flat_map(|block| &block.stmts).find(|stmt| match &stmt.kind {
            StmtKind::Nc(nc) => {
                nc.items.iter().any(|item| matches!(item, NcItem::Word(role, _) if role.is_axis()))
            }
            _ => false,
        });
        if let Some(stmt) = first {
            let what = format!("the program is for a {from}, and the target is a {to}: {}", why(context));
            context.add(index, Diagnostic::new(Code::NoEquivalent, stmt.site.span, what));
        }
    }
}
