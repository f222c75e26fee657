//! Returns of programs that nothing calls.
//!
//! Law: M99 gives back to the caller on both controls. In a main program it starts the program again on one of them; where
//! nobody says so of the other, a program that nothing in the library calls is for review. Counter-example: a bar feeder's
//! program, which ends in `M99` so that the next part begins.

use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::{Callee, Module, TermKind};
use crate::legalize::{Context, calls_of};
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
        if program.name.as_ref().is_some_and(|name| called.contains(name)) {
            continue;
        }
        let returns = |kind: &TermKind| matches!(kind, TermKind::Return { to: None });
        let Some(block) = program.blocks.iter().find(|block| returns(&block.term.kind)) else { continue };
        let title = &context.target.dialect().title;
        let what = format!(
            "nothing in the library calls this program: if it is a main program, M99 starts it again on the source, and \
             nobody says what it does on {title}"
        );
        let help = "write a jump to the start, or an end, in a main program";
        let finding = Diagnostic::new(Code::Conditional, block.term.site.span, what.clone()).with_help(help);
        context.add_once(index, &what, finding);
    }
}
