//! Removes blocks that control never reaches.
//!
//! **Law.** A block that no way from where control enters leads to does nothing.
//!
//! **Side condition.** At `-O1` only blocks that lowering or legalization put in are removed, and
//! none that a label finds. At `-O2` a label keeps a block only where something may jump to it:
//! every label, when a callee may come back at one.
//!
//! **Counter-example.** A subroutine after `M30` that only `M97 P1000` of another line, a computed
//! jump or `M99 P1000` of a callee reaches: nothing falls into it.

use super::pass::{Level, Library, Pass};
use crate::ir::analysis::dataflow::reached_among;
use crate::ir::{Block, BlockId, Callee, Program, SourceInfo, StmtKind, TermKind};
use crate::syntax::Label;

/// The pass.
pub struct Unreachable;

impl Pass for Unreachable {
    fn name(&self) -> &'static str {
        "unreachable"
    }

    fn run(&self, program: &mut Program, library: &Library, level: Level) {
        let keep = kept(program, level, library.ways.come_back);
        if keep.contains(&false) {
            remove(program, &keep);
        }
    }
}

fn kept(program: &Program, level: Level, come_back: bool) -> Vec<bool> {
    let roots = program.ids().zip(&program.blocks).filter(|(id, block)| {
        let numbered = block.labels.iter().any(|label| matches!(label, Label::Number(_)));
        let root = match level {
            Level::O2 => numbered && (come_back || returns_here(program)),
            _ => !is_introduced(block),
        };
        *id == BlockId(0) || root
    });
    reached_among(program.blocks.len(), roots.map(|(id, _)| id.index()), |at, go| {
        let Some(block) = program.blocks.get(at) else { return };
        block.term.kind.each_successor(&mut |to| go(to.index()));
        entries(block).for_each(|to| go(to.index()));
    })
}

/// True where a subroutine of the program returns to a label of it.
fn returns_here(program: &Program) -> bool {
    program.blocks.iter().any(|block| matches!(block.term.kind, TermKind::Return { to: Some(_) }))
}

fn is_introduced(block: &Block) -> bool {
    let sites = block.stmts.iter().map(|stmt| &stmt.site).chain([&block.term.site]);
    block.labels.is_empty() && sites.into_iter().all(|site| *site == SourceInfo::default())
}

/// The blocks that calls of a block enter.
fn entries(block: &Block) -> impl Iterator<Item = BlockId> + '_ {
    let modal = block.stmts.iter().filter_map(|stmt| match &stmt.kind {
        StmtKind::ModalCall(call) => Some(&call.callee),
        _ => None,
    });
    let called = match &block.term.kind {
        TermKind::Call { call, .. } => Some(&call.callee),
        _ => None,
    };
    modal.chain(called).filter_map(|callee| match callee {
        Callee::Block(entry) => Some(*entry),
        _ => None,
    })
}

/// Leaves the other blocks out and numbers those kept anew, in their order.
fn remove(program: &mut Program, keep: &[bool]) {
    let mut next = 0;
    let place: Vec<BlockId> = keep
        .iter()
        .map(|kept| {
            let id = BlockId(next);
            next += u32::from(*kept);
            id
        })
        .collect();
    let renumber = |id: &mut BlockId| {
        if let Some(to) = place.get(id.index()) {
            *id = *to;
        }
    };
    let mut flags = keep.iter();
    program.blocks.retain(|_| flags.next().copied().unwrap_or(true));
    for block in &mut program.blocks {
        block.term.kind.for_each_target(&mut |id| renumber(id));
        for stmt in &mut block.stmts {
            if let StmtKind::ModalCall(call) = &mut stmt.kind
                && let Callee::Block(entry) = &mut call.callee
            {
                renumber(entry);
            }
        }
    }
}
