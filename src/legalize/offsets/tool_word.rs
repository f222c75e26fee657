//! Whether the last tool word names the tool in the spindle.
//!
//! Law: after a block that changes the tool both are one, until a tool word stands without a change.
//! Counter-example: `T1 M6`, then `T2`, which makes tool 2 ready while tool 1 is in the spindle.

use crate::canon::Sys;
use crate::diag::{Code, Diagnostic};
use crate::dialect::Control;
use crate::ir::analysis::tool_word::ToolWord;
use crate::ir::{Block, Expr, Module, Program};
use crate::legalize::Context;
use crate::legalize::features::Feature;
use crate::text::Span;

/// The letter number of T in [`Sys::Address`].
pub const ADDRESS_T: u32 = 20;

/// Asks wherever the tool in the spindle is read and the target tells the last tool word in its place: that is the
/// same after a change, is for review where none is seen, and an error where a tool may wait for its change.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let may_read = |index| context.may_concern(index, |features| features.has(Feature::System));
    let mut programs = module.programs.iter().enumerate();
    if !stands_in(context.target) || !programs.any(|(index, program)| may_read(index) && reads(program)) {
        return;
    }
    let facts = context.modal_facts(module);
    for (index, program) in module.programs.iter().enumerate() {
        for (id, block) in program.ids().zip(&program.blocks) {
            let mut state = facts.at(index, id);
            for stmt in &block.stmts {
                if named_in(|look| stmt.kind.exprs(look)) {
                    tell(state.tool_word, index, stmt.site.span, context);
                }
                state.step(stmt);
            }
            if named_in(|look| block.term.kind.exprs(look)) {
                tell(state.tool_word, index, block.term.site.span, context);
            }
        }
    }
}

/// True for a control that tells the last tool word, and not the tool in the spindle.
pub fn stands_in(target: &Control) -> bool {
    target.system_run(Sys::ActiveTool).is_none()
        && target.system_address(Sys::Address, &[ADDRESS_T]).is_some()
}

/// True where the tool in the spindle is among the expressions that are shown.
fn named_in(shown: impl FnOnce(&mut dyn FnMut(&Expr))) -> bool {
    let mut found = false;
    shown(&mut |e| e.walk(&mut |e| found |= matches!(e, Expr::System(Sys::ActiveTool, _))));
    found
}

fn reads(program: &Program) -> bool {
    let stmts = |block: &Block| block.stmts.iter().any(|stmt| named_in(|look| stmt.kind.exprs(look)));
    program.blocks.iter().any(|block| stmts(block) || named_in(|look| block.term.kind.exprs(look)))
}

fn tell(tool_word: ToolWord, index: usize, span: Span, context: &mut Context<'_>) {
    match tool_word {
        ToolWord::Changed => {}
        ToolWord::Unknown => {
            let what = "on the target this is the last T called, not the tool in the spindle, until M6: \
                        when the program starts, the two must be the same tool";
            context.add_once(index, "tool", Diagnostic::new(Code::Conditional, span, what));
        }
        ToolWord::Waits => {
            let title = &context.target.dialect().title;
            let what = format!(
                "on {title} this is the last T called, not the tool in the spindle, until M6: keep the \
                 tool's number in a variable at the tool change"
            );
            context.add(index, Diagnostic::new(Code::NoEquivalent, span, what));
        }
    }
}
