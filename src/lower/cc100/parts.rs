//! Called parts that are left by another door, and returns that nobody waits for.
//!
//! A jump may go from a called part anywhere. Where it lands in the main part, the
//! return is still open, and what the control does with it no source says. The
//! end of a cycle inside a called part would, in the common form, go back to
//! the call of the part and not to the cycle's caller, so it is refused.

use crate::diag::{Code, Diagnostic};
use crate::ir::analysis::dataflow::reached;
use crate::ir::analysis::{own_call, reachable};
use crate::ir::{Block, BlockId, Callee, Program, TermKind};
use crate::lower::common::Findings;
use crate::text::Span;
use std::collections::BTreeSet;

/// True where another program runs after the block.
pub fn leaves(block: &Block) -> bool {
    matches!(&block.term.kind, TermKind::Call { call, .. } if !matches!(call.callee, Callee::Block(_)))
}

/// Reports the jumps out of called parts. `ends` are the places of a cycle's own ends.
pub fn check(program: &Program, ends: &BTreeSet<Span>, findings: &mut Findings<'_>) {
    let main = reachable(program, BlockId(0));
    let returns = |block: &&Block| matches!(block.term.kind, TermKind::Return { .. });
    for block in main.iter().filter_map(|id| program.block(*id)).filter(returns) {
        let span = block.term.site.span;
        if !ends.contains(&span) {
            findings.not_understood(span, "no source says what a return does when no part was called");
        }
    }
    // One walk over all called parts together: which of them a block belongs to does not matter.
    let entries = program.blocks.iter().filter_map(own_call).map(|(entry, ..)| entry);
    reached(entries, |id, go| {
        let Some(block) = program.block(id).filter(|_| !main.contains(&id)) else { return };
        let span = block.term.site.span;
        if returns(&block) && ends.contains(&span) {
            findings.not_understood(span, "no source says what the end of a cycle does inside a called part");
        }
        for to in block.term.kind.successors() {
            if main.contains(&to) {
                let message = "this jump goes from a called part into the main part";
                findings.add(Diagnostic::new(Code::SubroutineLeft, span, message));
            }
            go(to);
        }
    });
}
