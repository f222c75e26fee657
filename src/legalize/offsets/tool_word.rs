//! Whether the last tool word names the tool in the spindle.
//!
//! Law: after a block that changes the tool both are one, until a tool word stands without a change.
//! Counter-example: `T1 M6`, then `T2`, which makes tool 2 ready while tool 1 is in the spindle.

use crate::canon::Sys;
use crate::diag::{Code, Diagnostic};
use crate::dialect::Control;
use crate::ir::analysis::ModalFacts;
use crate::ir::analysis::tool_word::ToolWord;
use crate::ir::{Block, Expr, Module, Program, TermKind};
use crate::legalize::Context;
use crate::legalize::features::Feature;
use crate::text::Span;

/// The letter number of T in [`Sys::Address`].
pub const ADDRESS_T: u32 = 20;

/// Asks wherever the tool in the spindle is read and the target tells the last tool word in its place: that is the
/// same after a change, is asked once if none was seen since the run began, is for review after what is not known, and an
/// error where a tool may wait for its change.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let may_read = |index| context.may_concern(index, |features| features.has(Feature::System));
    let mut programs = module.programs.iter().enumerate();
    if !stands_in(context.target) || !programs.any(|(index, program)| may_read(index) && reads(program)) {
        return;
    }
    let facts = context.modal_facts(module);
    let waits = ends_waiting(module, &facts);
    for (index, program) in module.programs.iter().enumerate() {
        for (id, block) in program.ids().zip(&program.blocks) {
            let mut state = facts.at(index, id);
            for stmt in &block.stmts {
                if named_in(|look| stmt.kind.exprs(look)) {
                    tell((state.tool_word, waits), index, stmt.site.span, context);
                }
                state.step(stmt);
            }
            if named_in(|look| block.term.kind.exprs(look)) {
                tell((state.tool_word, waits), index, block.term.site.span, context);
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

/// True where some run of the library may end while a tool waits for its change: then that is so when the next one begins.
/// Where none does, what is so when a run begins is one question for all programs.
pub(super) fn ends_waiting(module: &Module, facts: &ModalFacts) -> bool {
    module.programs.iter().enumerate().any(|(index, program)| {
        program.ids().zip(&program.blocks).any(|(id, block)| {
            let ends =
                matches!(block.term.kind, TermKind::End { .. } | TermKind::Stray | TermKind::Return { .. });
            let mut state = facts.at(index, id);
            ends && {
                block.stmts.iter().for_each(|stmt| state.step(stmt));
                state.tool_word == ToolWord::Waits
            }
        })
    })
}

fn reads(program: &Program) -> bool {
    let stmts = |block: &Block| block.stmts.iter().any(|stmt| named_in(|look| stmt.kind.exprs(look)));
    program.blocks.iter().any(|block| stmts(block) || named_in(|look| block.term.kind.exprs(look)))
}

fn tell((tool_word, waits): (ToolWord, bool), index: usize, span: Span, context: &mut Context<'_>) {
    match tool_word {
        ToolWord::Changed => {}
        ToolWord::Begun | ToolWord::Unknown => {
            let what = "on the target this is the last T called, not the tool in the spindle, until M6: \
                        when the program starts, the two must be the same tool";
            let told = Diagnostic::new(Code::Conditional, span, what);
            let begun = tool_word == ToolWord::Begun && !waits;
            context.add_once(index, &format!("tool {begun}"), if begun { told.asked_once() } else { told });
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ir::text::parse;

    /// Whether what is told of the first program is one question for all.
    fn is_asked_once(text: &str) -> Vec<bool> {
        let [source, target] = ["fadal", "fanuc"].map(|name| Control::plain(name).unwrap());
        let module = parse(text).unwrap();
        let mut context = Context::new(&source, &target, module.programs.len());
        run(&module, &mut context);
        context.into_findings()[0].iter().map(|finding| finding.once).collect()
    }

    const READS: &str = "    param.1 = sys tool.active @1..2\n";

    #[test]
    fn what_is_so_when_runs_begin_is_asked_once() {
        let program =
            |name: &str, body: &str| format!("program {name} file 0 {{\nblock0:\n{body}    end\n}}\n");
        assert_eq!(is_asked_once(&program("O1", READS)), [true]);
        // The next run of anything begins while tool 3 waits.
        let waits = program("O2", "    nc tool=3 @3..4\n");
        assert_eq!(is_asked_once(&(program("O1", READS) + &waits)), [false]);
        let called = format!("    call O9 -> block1 @3..4\nblock1:\n{READS}");
        assert_eq!(is_asked_once(&program("O1", &called)), [false], "nobody knows what O9 leaves");
    }
}
