//! Simplifies branches and threads jumps.
//!
//! **Law.** A branch on a constant condition, or with one way, is a jump. A jump to a block that
//! only jumps on is a jump to where that one goes.
//!
//! **Side condition.** Testing the condition raises no alarm. At `-O1` a branch that people wrote
//! stays. A block that is jumped through has no label, comment or sequence number, and blocks that
//! jump in a ring are left.
//!
//! **Counter-examples.** `IF[SQRT[#1] EQ 1]GOTO10` with N10 next stops where `#1` is below 0. A
//! block with a label may be the target of a jump computed elsewhere: it stays where it is, and a
//! reader finds the jump to it.

use super::fold::fold;
use super::pass::{Level, Library, Pass};
use crate::ir::eval::{Memory, holds};
use crate::ir::{Block, BlockId, Callee, Cond, Expr, Program, SourceInfo, StmtKind, TermKind};

/// The pass.
pub struct Branches;

impl Pass for Branches {
    fn name(&self) -> &'static str {
        "branches"
    }

    fn run(&self, program: &mut Program, _: &Library, level: Level) {
        for block in &mut program.blocks {
            if level >= Level::O2 || block.term.site == SourceInfo::default() {
                simplify(&mut block.term.kind);
            }
        }
        thread(program);
    }
}

fn simplify(kind: &mut TermKind) {
    let TermKind::Branch { cond, then, otherwise } = kind else { return };
    if let Some(way) = settled(cond) {
        *kind = TermKind::Jump(if way { *then } else { *otherwise });
    } else if then == otherwise && !cond.may_alarm() {
        *kind = TermKind::Jump(*then);
    }
}

/// Whether a constant condition holds.
fn settled(cond: &Cond) -> Option<bool> {
    let mut cond = cond.clone();
    let mut constant = !cond.has_switch();
    cond.exprs_mut(&mut |e| {
        fold(e);
        constant &= matches!(e, Expr::Number(_) | Expr::Vacant);
    });
    holds(&cond, &Memory::new()).ok().filter(|_| constant)
}

/// Sends every jump through empty blocks on to where they lead.
fn thread(program: &mut Program) {
    let ends: Vec<BlockId> = program.ids().map(|id| end_of(program, id)).collect();
    let end = |id: &mut BlockId| {
        if let Some(to) = ends.get(id.index()) {
            *id = *to;
        }
    };
    for block in &mut program.blocks {
        block.term.kind.for_each_target(&mut |id| end(id));
        for stmt in &mut block.stmts {
            if let StmtKind::ModalCall(call) = &mut stmt.kind
                && let Callee::Block(entry) = &mut call.callee
            {
                end(entry);
            }
        }
    }
}

/// Steps through empty blocks; more than so many are left.
const STEPS: usize = 64;

fn end_of(program: &Program, from: BlockId) -> BlockId {
    let mut at = from;
    for _ in 0..STEPS {
        match program.block(at).and_then(passage) {
            Some(to) if to == from => return from,
            Some(to) => at = to,
            None => return at,
        }
    }
    at
}

/// Where a block leads that does nothing else.
fn passage(block: &Block) -> Option<BlockId> {
    let empty = block.labels.is_empty() && block.stmts.is_empty() && block.term.site == SourceInfo::default();
    match block.term.kind {
        TermKind::Jump(to) if empty => Some(to),
        _ => None,
    }
}
