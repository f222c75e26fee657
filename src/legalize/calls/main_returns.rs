//! Returns of programs that nothing calls.
//!
//! Law: M99 gives back to the caller on both controls. In a main program it starts the program again on one of them; if
//! nobody says so of the other, the library is asked once whether the programs that nothing calls are subprograms. Those
//! with the numbers of macros are. Counter-example: a bar feeder's program, which ends in `M99` so that the next part begins.

use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question};
use crate::ir::{Callee, Module, TermKind};
use crate::legalize::{Context, calls_of};
use crate::syntax::ProgramName;
use std::collections::BTreeSet;

/// Reports returns that may begin a main program again.
pub fn run(module: &Module, context: &mut Context<'_>) {
    if !context.source.is(Question::M99MainRestarts) || context.target.is(Question::M99MainRestarts) {
        return;
    }
    let mut called = BTreeSet::new();
    for call in module.programs.iter().flat_map(|program| &program.blocks).flat_map(calls_of) {
        match &call.callee {
            Callee::Program(name) => called.insert(name),
            // Any program may be the one.
            Callee::Computed(_) => return,
            _ => false,
        };
    }
    for (index, program) in module.programs.iter().enumerate() {
        if program.name.as_ref().is_some_and(|name| called.contains(name) || is_macro(name, context.source)) {
            continue;
        }
        let returns = |kind: &TermKind| matches!(kind, TermKind::Return { to: None });
        let Some(block) = program.blocks.iter().find(|block| returns(&block.term.kind)) else { continue };
        let title = &context.target.dialect().title;
        let what = format!(
            "a program that returns, and that nothing in the library calls, is taken to be a subprogram: if it is a main \
             program, M99 starts it again on the source, and nobody says what it does on {title}"
        );
        let help = "write a jump to the start, or an end, in main programs";
        let finding = Diagnostic::new(Code::Conditional, block.term.site.span, what.clone()).with_help(help);
        context.add_once(index, &what, finding.asked_once());
    }
}

/// True for the number of a macro: one of four digits, above those of main programs on its control.
fn is_macro(name: &ProgramName, source: &Control) -> bool {
    let ProgramName::Number(number) = name else { return false };
    source.limit("program.main").is_some_and(|last| (last + 1..=9999).contains(number))
}
