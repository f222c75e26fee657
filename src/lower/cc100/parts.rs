//! Called parts that are left by another door, and returns that nobody waits for.
//!
//! A jump may go from a called part anywhere. Where it lands in the main part, the
//! return is still open, and what the control does with it no source says. The
//! end of a cycle inside a called part would, in the common form, go back to
//! the call of the part and not to the cycle's caller, so it is refused.

use crate::diag::{Code, Diagnostic};
use crate::ir::analysis::dataflow::reached;
use crate::ir::analysis::{own_call, reachable};
use crate::ir::{Block, BlockId, Callee, Program, StmtKind, TermKind};
use crate::lower::common::Findings;
use crate::text::Span;
use std::collections::BTreeSet;

/// True where another program runs after the block.
pub fn leaves(block: &Block) -> bool {
    matches!(&block.term.kind, TermKind::Call { call, .. } if !matches!(call.callee, Callee::Block(_)))
}

/// What holds for a part in a file of its own.
const ALONE: &str = "the text begins with a label and ends with a return: it is taken for a part that stands after the end of the \
                     program that calls it, and never run by itself";

/// True for a part that stands alone: its label comes first, and every way from there returns.
fn is_part(program: &Program, main: &BTreeSet<BlockId>) -> bool {
    let begins = |block: &Block| {
        let quiet = block.stmts.iter().all(|stmt| stmt.kind == StmtKind::Comment);
        !block.labels.is_empty() || quiet && matches!(block.term.kind, TermKind::Jump(_))
    };
    let label = program.ids().zip(&program.blocks).find(|(_, block)| !block.labels.is_empty());
    let Some((first, _)) = label else { return false };
    let before = program.blocks.get(..first.index()).unwrap_or_default();
    let blocks = main.iter().filter_map(|id| program.block(*id));
    let ends = |block: &Block| {
        matches!(block.term.kind, TermKind::End { .. } | TermKind::Stray | TermKind::Chain(_))
    };
    main.contains(&first) && before.iter().all(begins) && !blocks.into_iter().any(ends)
}

/// Reports the jumps out of called parts. `ends` are the places of a cycle's own ends.
pub fn check(program: &Program, ends: &BTreeSet<Span>, findings: &mut Findings<'_>) {
    let main = reachable(program, BlockId(0));
    let returns = |block: &&Block| matches!(block.term.kind, TermKind::Return { .. });
    let alone = is_part(program, &main);
    for block in main.iter().filter_map(|id| program.block(*id)).filter(returns) {
        let span = block.term.site.span;
        if ends.contains(&span) {
            continue;
        }
        if alone {
            findings.add(Diagnostic::new(Code::Conditional, span, ALONE));
        } else {
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
