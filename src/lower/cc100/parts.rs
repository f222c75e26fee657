//! Called parts that are left by another door, and returns that nobody waits for.
//!
//! A jump may go from a called part anywhere. Where it lands in the main part, the
//! return is still open, and what the control does with it no source says. The
//! end of a cycle inside a called part would, in the common form, go back to
//! the call of the part and not to the cycle's caller, so it is refused.
//!
//! A file that a conversion wrote as a part of others, and says so at its head, is no program of its own: its return goes
//! to whoever it is pasted into.

use crate::diag::{Code, Diagnostic};
use crate::ir::analysis::dataflow::reached;
use crate::ir::analysis::{own_call, reachable};
use crate::ir::{Block, BlockId, Callee, Program, Stmt, StmtKind, TermKind};
use crate::lower::common::Findings;
use crate::syntax::cc100::PART;
use crate::text::Span;
use std::collections::BTreeSet;

/// True where another program runs after the block.
pub fn leaves(block: &Block) -> bool {
    matches!(&block.term.kind, TermKind::Call { call, .. } if !matches!(call.callee, Callee::Block(_)))
}

/// Takes away the comment at the head of a file that says it is a part of others; true if there is one.
pub fn take_mark(program: &mut Program) -> bool {
    let Some(block) = program.blocks.first_mut() else { return false };
    let head = block.stmts.iter().take_while(|stmt| stmt.kind == StmtKind::Comment).count();
    let marked = |stmt: &Stmt| matches!(stmt.site.comments.as_slice(), [only] if only.text == PART);
    let found = block.stmts.iter().take(head).position(marked);
    found.into_iter().for_each(|at| drop(block.stmts.remove(at)));
    found.is_some()
}

/// Reports the jumps out of called parts. `ends` are the places of a cycle's own ends; `pasted` tells a part of others.
pub fn check(program: &Program, ends: &BTreeSet<Span>, pasted: bool, findings: &mut Findings<'_>) {
    let main = reachable(program, BlockId(0));
    let returns = |block: &&Block| matches!(block.term.kind, TermKind::Return { .. });
    for block in main.iter().filter_map(|id| program.block(*id)).filter(returns) {
        let span = block.term.site.span;
        if !pasted && !ends.contains(&span) {
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
