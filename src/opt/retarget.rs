//! Assigns a result where it goes, without a temporary between.
//!
//! **Law.** `t = e` directly before `v = t`, with `t` read nowhere else after it, is `v = e`.
//!
//! **Side condition.** `t` is a temporary, `v` a variable, `e` never vacant, and neither statement
//! may be skipped by the operator. The first has no comment, and no source block of its own.
//!
//! **Counter-example.** `tmp.1 = #2; #3 = tmp.1` with `#2` vacant: `#3` is 0, not vacant.

use super::pass::{Level, Library, Pass};
use crate::ir::analysis::{Liveness, Ways};
use crate::ir::{Block, BlockId, Class, Expr, Place, Program, Stmt, StmtKind, Var};
use std::collections::BTreeSet;

/// The pass.
pub struct Retarget;

impl Pass for Retarget {
    fn name(&self) -> &'static str {
        "retarget"
    }

    fn run(&self, program: &mut Program, library: &Library, _: Level) {
        if !has_pair(program) {
            return;
        }
        let found = pairs(program, library.ways);
        for (block, at) in &found {
            let Some(block) = program.blocks.get_mut(block.index()) else { continue };
            let [first, second, ..] = block.stmts.get_mut(*at..).unwrap_or_default() else { continue };
            if let (StmtKind::Assign { value: from, .. }, StmtKind::Assign { value, .. }) =
                (&mut first.kind, &mut second.kind)
            {
                std::mem::swap(from, value);
            }
        }
        drop_statements(program, &found);
    }
}

/// Takes statements out.
pub(super) fn drop_statements(program: &mut Program, places: &[(BlockId, usize)]) {
    let places: BTreeSet<(BlockId, usize)> = places.iter().copied().collect();
    let mut touched: Vec<BlockId> = places.iter().map(|(id, _)| *id).collect();
    touched.dedup();
    for id in touched {
        let mut at = 0..;
        if let Some(block) = program.blocks.get_mut(id.index()) {
            block.stmts.retain(|_| at.next().is_some_and(|at| !places.contains(&(id, at))));
        }
    }
}

/// True where two statements could be a pair: only then is it worth asking what is live.
fn has_pair(program: &Program) -> bool {
    program.blocks.iter().any(may_have_pair)
}

fn may_have_pair(block: &Block) -> bool {
    block.stmts.windows(2).any(|two| matches!(two, [first, second] if pair(first, second).is_some()))
}

/// Places of the first statements of pairs. No statement is in two of them.
fn pairs(program: &Program, ways: Ways) -> Vec<(BlockId, usize)> {
    let live = Liveness::of(program, ways);
    let mut found: Vec<(BlockId, usize)> = Vec::new();
    for (id, block) in program.ids().zip(&program.blocks).filter(|(_, block)| may_have_pair(block)) {
        let mut taken = usize::MAX;
        live.backward(id, &mut |at, is_live| {
            let Some(before) = at.checked_sub(1) else { return };
            if taken != at
                && let (Some(first), Some(second)) = (block.stmts.get(before), block.stmts.get(at))
                && pair(first, second).is_some_and(|temp| !is_live(&temp))
            {
                taken = before;
                found.push((id, before));
            }
        });
    }
    found
}

/// The temporary between two statements.
fn pair(first: &Stmt, second: &Stmt) -> Option<Var> {
    let StmtKind::Assign { target: Place::Var(temp), value } = &first.kind else { return None };
    let StmtKind::Assign { target: Place::Var(_), value: Expr::Var(read) } = &second.kind else {
        return None;
    };
    let free = first.site.comments.is_empty() && first.site.skip.is_none() && second.site.skip.is_none();
    // Of one source block, or of none.
    let same = first.site.sequence.is_none() || first.site.sequence == second.site.sequence;
    (temp.class == Class::Temp && temp == read && !value.may_be_vacant() && free && same).then_some(*temp)
}
