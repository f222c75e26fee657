//! Called parts that are left by another door, and returns that nobody waits for.
//!
//! A jump may go from a called part anywhere. Where it lands in the main part, the
//! return is still open, and what the control does with it no source says. The
//! end of a cycle inside a called part would, in the common form, go back to
//! the call of the part and not to the cycle's caller, so it is refused.

use super::graph::{body, called};
use crate::diag::{Code, Diagnostic};
use crate::ir::{Program, TermKind};
use crate::lower::common::Findings;
use crate::text::Span;
use std::collections::BTreeSet;

/// Reports the jumps out of called parts. `ends` are the places of a cycle's own ends.
pub fn check(program: &Program, ends: &BTreeSet<Span>, findings: &mut Findings<'_>) {
    let entries: BTreeSet<usize> =
        program.blocks.iter().filter_map(|b| called(b).map(|(to, _)| to)).collect();
    let main = body(program, 0);
    for (block, _) in program.blocks.iter().zip(&main).filter(|(_, main)| **main) {
        let span = block.term.site.span;
        if matches!(block.term.kind, TermKind::Return { .. }) && !ends.contains(&span) {
            findings.not_understood(span, "no source says what a return does when no part was called");
        }
    }
    // One walk over all called parts together: which of them a block belongs to does not matter.
    let mut seen = vec![false; program.blocks.len()];
    let mut work: Vec<usize> = entries.into_iter().collect();
    while let Some(at) = work.pop() {
        let Some(block) = program.blocks.get(at) else { continue };
        if main[at] || std::mem::replace(&mut seen[at], true) {
            continue;
        }
        let span = block.term.site.span;
        if matches!(block.term.kind, TermKind::Return { .. }) && ends.contains(&span) {
            findings.not_understood(span, "no source says what the end of a cycle does inside a called part");
        }
        for to in block.term.kind.successors() {
            if main.get(to.index()) == Some(&true) {
                let message = "this jump goes from a called part into the main part";
                findings.add(Diagnostic::new(Code::SubroutineLeft, span, message));
            }
            work.push(to.index());
        }
    }
}
