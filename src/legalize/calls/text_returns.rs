//! Called programs whose text ends without a return.
//!
//! Law: a called program gives back to its caller by a code that says so. Side condition: one stands on every way to the end
//! of its text. No maker's text that was reached says what a control does without: it may stop with an alarm, or go on in the caller,
//! where it would cut what another control leaves. Counter-example: `O2000`, called by `M98`, whose last block is a move.

use crate::diag::{Code, Diagnostic};
use crate::ir::analysis::{Cfg, last_place, text_ends};
use crate::ir::{Callee, Module, TermKind};
use crate::legalize::{Context, calls_of};
use std::collections::BTreeSet;

/// Refuses called programs that run out of text.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let calls = module.programs.iter().flat_map(|program| &program.blocks).flat_map(calls_of);
    let called: BTreeSet<_> = calls
        .filter_map(|call| match &call.callee {
            Callee::Program(name) => Some(name),
            _ => None,
        })
        .collect();
    for (index, program) in module.programs.iter().enumerate() {
        let strays = || program.blocks.iter().any(|block| block.term.kind == TermKind::Stray);
        if !program.name.as_ref().is_some_and(|name| called.contains(name)) || !strays() {
            continue;
        }
        if text_ends(program, &Cfg::of(program)).next().is_none() {
            continue;
        }
        let what = "other programs call this one, and its text ends without a return: a control stops there with an alarm, or goes on, \
                    and no source says which";
        let finding = Diagnostic::new(Code::NoEquivalent, last_place(program), what);
        context.add(index, finding.with_help("write the code that goes back to the caller (M99) at its end"));
    }
}
