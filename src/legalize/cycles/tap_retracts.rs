//! How much faster a tap comes out than it goes in, where the target has no word for it.
//!
//! Law: the word changes the time alone: the thread is the same, and the tap comes out as fast as it went in, or as the target is
//! set to. It is left out, and asked once. Side condition: no code of the target takes the word. Counter-example: a target whose code takes it.

use crate::canon::Role;
use crate::diag::{Code, Diagnostic};
use crate::dialect::Control;
use crate::ir::{Module, NcItem, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::Features;

const LEFT_OUT: &str = "how much faster the tap comes out than it goes in is left out: on the target it comes out as fast as it went in, or as that machine \
     is set to";

/// True where a tap has the word, and no code of the target takes it.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let takes = |control: &Control| control.dialect().codes.iter().any(|row| row.takes(Role::TapRetract));
    features.role(Role::TapRetract) && !takes(context.target)
}

/// Takes the words out; true where there were any.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let is_it = |item: &NcItem| matches!(item, NcItem::Word(Role::TapRetract, _));
    let mut changed = false;
    for (index, program) in module.programs.iter_mut().enumerate() {
        for stmt in program.blocks.iter_mut().flat_map(|block| &mut block.stmts) {
            let StmtKind::Nc(nc) = &mut stmt.kind else { continue };
            if nc.items.iter().any(is_it) {
                nc.items.retain(|item| !is_it(item));
                changed = true;
                let finding = Diagnostic::new(Code::Conditional, stmt.site.span, LEFT_OUT);
                context.add_once(index, LEFT_OUT, finding.asked_once());
            }
        }
    }
    changed
}
