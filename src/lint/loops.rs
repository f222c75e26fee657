//! Loops that never end.

use super::flow::waits;
use super::looked::{Findings, Looked};
use crate::diag::Code;
use crate::ir::analysis::{Cfg, Vars};
use crate::ir::{BlockId, Callee, Cond, Expr, Place, Program, StmtKind, TermKind, Var};
use crate::text::Span;
use std::collections::{BTreeMap, BTreeSet};

/// A loop that nothing leaves, or whose way out hangs on what nothing in it changes.
pub(super) fn endless(looked: &Looked<'_>, findings: &mut Findings) {
    for (at, program) in looked.programs().filter(|(at, _)| !looked.has_hole(*at)) {
        let back = program.ids().zip(&program.blocks);
        if !back.into_iter().any(|(id, block)| block.term.kind.successors().iter().any(|to| *to <= id)) {
            continue;
        }
        let Some(cfg) = looked.cfg(at) else { continue };
        for ring in rings(cfg, program) {
            if let Some((span, message)) = fault(looked, program, &ring) {
                findings.add(program.file, Code::EndlessLoop, span, message);
            }
        }
    }
}

fn fault(looked: &Looked<'_>, program: &Program, ring: &BTreeSet<BlockId>) -> Option<(Span, &'static str)> {
    let mut written = Vars::default();
    let mut conditions: Vec<(&Cond, Span)> = Vec::new();
    let mut last = Span::default();
    for id in ring {
        let block = program.block(*id)?;
        for stmt in &block.stmts {
            if waits(&stmt.kind) {
                return None;
            }
            stmt.kind.target().into_iter().for_each(|place| written.write(place));
            match &stmt.kind {
                StmtKind::ClearAll(class) => written.classes.insert(*class),
                StmtKind::Nc(nc) => drop(written.join(looked.summaries().by_nc(nc))),
                _ => {}
            }
            last = last.max(stmt.site.span);
        }
        match &block.term.kind {
            TermKind::Call { call, .. } => {
                let named = matches!(&call.callee, Callee::Program(name) if may_not_end(looked, name));
                if !named {
                    return None;
                }
                written.join(looked.summaries().by_call(call));
            }
            TermKind::Branch { cond, then, otherwise }
                if !(ring.contains(then) && ring.contains(otherwise)) =>
            {
                conditions.push((cond, block.term.site.span));
            }
            TermKind::Computed { .. } => return None,
            _ => {}
        }
        last = last.max(block.term.site.span);
    }
    let Some((_, span)) = conditions.first() else {
        return Some((last, "nothing leaves this loop"));
    };
    let same = kept_same(program, ring, &written);
    let still = conditions
        .iter()
        .all(|(cond, _)| is_still(cond, &|var| !written.contains(var) || same.contains(&var)));
    still.then_some((
        *span,
        "nothing in the loop changes what decides whether it ends: it never ends, or never runs",
    ))
}

/// True where a program of the library surely comes back.
fn may_not_end(looked: &Looked<'_>, name: &crate::syntax::ProgramName) -> bool {
    let program = looked.program_of(name).and_then(|at| looked.module.programs.get(at));
    program.is_some_and(|program| {
        let calm = |block: &crate::ir::Block| {
            !matches!(
                block.term.kind,
                TermKind::End { .. } | TermKind::Stray | TermKind::Call { .. } | TermKind::Chain(_)
            ) && !block.stmts.iter().any(|stmt| waits(&stmt.kind))
        };
        program.blocks.iter().all(calm)
    })
}

/// True where the loop leaves everything alone that a condition reads.
fn is_still(cond: &Cond, same: &dyn Fn(Var) -> bool) -> bool {
    let mut still = !cond.has_switch();
    cond.exprs(&mut |e| still &= stays(e, same));
    still
}

/// True where an expression has one value as long as these variables have.
fn stays(e: &Expr, same: &dyn Fn(Var) -> bool) -> bool {
    let mut still = true;
    e.walk(&mut |part| match part {
        Expr::System(..) | Expr::Indirect(..) => still = false,
        Expr::Var(var) => still &= same(*var),
        _ => {}
    });
    still
}

/// The variables that one block of a loop sets, each time to the same.
fn kept_same(program: &Program, ring: &BTreeSet<BlockId>, written: &Vars) -> BTreeSet<Var> {
    let mut sets: BTreeMap<Var, Vec<Option<&Expr>>> = BTreeMap::new();
    for stmt in ring.iter().filter_map(|id| program.block(*id)).flat_map(|block| &block.stmts) {
        if let Some(Place::Var(var)) = stmt.kind.target() {
            let value = match &stmt.kind {
                StmtKind::Assign { value, .. } if stmt.site.skip.is_none() => Some(value),
                _ => None,
            };
            sets.entry(*var).or_default().push(value);
        }
    }
    // What anything else may write is not among them.
    let classes = written.classes;
    sets.retain(|var, all| all.len() == 1 && !classes.contains(var.class));
    let mut same = BTreeSet::new();
    loop {
        let more = sets.iter().filter(|(var, all)| {
            let stay = |value: &Expr| stays(value, &|var| !written.contains(var) || same.contains(&var));
            !same.contains(*var) && all.iter().all(|value| value.is_some_and(stay))
        });
        let more: Vec<Var> = more.map(|(var, _)| *var).collect();
        if more.is_empty() {
            return same;
        }
        same.extend(more);
    }
}

/// The sets of blocks that lead back to one another.
fn rings(cfg: &Cfg, program: &Program) -> Vec<BTreeSet<BlockId>> {
    // Tarjan's, without recursion.
    let count = program.blocks.len();
    let (mut index, mut low) = (vec![usize::MAX; count], vec![usize::MAX; count]);
    let (mut on, mut stack, mut next, mut rings) = (vec![false; count], Vec::new(), 0, Vec::new());
    for root in cfg.order().iter().filter(|id| id.index() < count) {
        if index[root.index()] != usize::MAX {
            continue;
        }
        let mut work: Vec<(usize, usize)> = vec![(root.index(), 0)];
        while let Some((at, way)) = work.last().copied() {
            if way == 0 {
                (index[at], low[at], on[at]) = (next, next, true);
                next += 1;
                stack.push(at);
            }
            let to = cfg.succs(BlockId(at as u32)).get(way).map(|to| to.index());
            if let Some((_, way)) = work.last_mut() {
                *way += 1;
            }
            match to.filter(|to| *to < count) {
                Some(to) if index[to] == usize::MAX => work.push((to, 0)),
                Some(to) if on[to] => low[at] = low[at].min(index[to]),
                Some(_) => {}
                None => {
                    work.pop();
                    if let Some((parent, _)) = work.last() {
                        low[*parent] = low[*parent].min(low[at]);
                    }
                    if low[at] == index[at] {
                        let mut ring = BTreeSet::new();
                        while let Some(one) = stack.pop() {
                            on[one] = false;
                            ring.insert(BlockId(one as u32));
                            if one == at {
                                break;
                            }
                        }
                        let alone = BlockId(at as u32);
                        if ring.len() > 1 || cfg.succs(alone).contains(&alone) {
                            rings.push(ring);
                        }
                    }
                }
            }
        }
    }
    rings
}
