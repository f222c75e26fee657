//! Whether what runs at a stop is known: an earlier stop or tool change may have ended it.

use super::{ends, kinds::pause_of};
use crate::canon::{Pause, Running};
use crate::dialect::Control;
use crate::ir::{BlockId, Module, Program, Stmt, StmtKind, TermKind};
use std::collections::BTreeSet;

/// For each program, true where a stop or a tool change of it may end it for the source, and some way comes to another stop, or
/// leaves the program, before the program says what runs.
pub(super) fn lost(module: &Module, source: &Control) -> Vec<[bool; 2]> {
    let of = |program: &Program| Running::ALL.map(|running| is_lost(program, running, source));
    module.programs.iter().map(of).collect()
}

fn is_lost(program: &Program, running: Running, source: &Control) -> bool {
    let may_end = |(pause, _)| source.ends(pause, running).answer != Some(false);
    program.ids().zip(&program.blocks).any(|(id, block)| {
        let mut stops = block.stmts.iter().enumerate().filter(|(_, stmt)| {
            let stops = pause_of(&stmt.kind).filter(|(pause, _)| *pause != Pause::Message);
            !says(stmt, running) && stops.is_some_and(may_end)
        });
        stops.any(|(at, _)| is_left(program, (id, at + 1), running))
    })
}

fn says(stmt: &Stmt, running: Running) -> bool {
    let (group, _) = ends(running);
    // What a block skip may leave out says nothing for sure.
    let sure = stmt.site.skip.is_none();
    sure && matches!(&stmt.kind, StmtKind::Nc(nc) if nc.ops().any(|op| op.group() == group))
}

/// True where some way from a statement comes to a stop, or leaves the program, before anything is said.
fn is_left(program: &Program, (from, first): (BlockId, usize), running: Running) -> bool {
    let (mut work, mut seen) = (vec![(from, first)], BTreeSet::new());
    while let Some((id, first)) = work.pop() {
        let Some(block) = program.block(id) else { return true };
        let mut rest = block.stmts.iter().skip(first);
        let next = rest.find(|stmt| says(stmt, running) || pause_of(&stmt.kind).is_some());
        match next {
            Some(stmt) if says(stmt, running) => continue,
            Some(_) => return true,
            None => {}
        }
        match &block.term.kind {
            TermKind::End { .. } => {}
            TermKind::Return { .. } | TermKind::Call { .. } | TermKind::Chain(_) | TermKind::Stray => {
                return true;
            }
            kind => {
                work.extend(kind.successors().into_iter().filter(|id| seen.insert(*id)).map(|id| (id, 0)))
            }
        }
    }
    false
}
