//! Which holes are written as moves, where the target has cycles.
//!
//! Law: a cycle is written with all blocks that drill by it, from the one that names it to the one that ends it, over jumps; the other
//! cycles of its program stay. Side condition: no call, and no way in or out of the program, comes between: then all cycles of the
//! programs that it leads through are written. Counter-example: `G83 I5. J1. K2.` with the holes in a subprogram.

use super::drill::{Cycle, Known};
use super::flow::{Flow, step};
use super::moves::has_moves;
use crate::ir::analysis::over_calls::OverCalls;
use crate::ir::{BlockId, Callee, Module, Nc, Program, TermKind};
use std::collections::BTreeSet;

/// For each program, block and statement whether it is written as moves.
pub struct Chosen(Vec<Vec<Vec<bool>>>);

impl Chosen {
    /// All that these programs drill.
    pub fn programs(module: &Module, all: &BTreeSet<usize>) -> Self {
        let program = |(index, program): (usize, &Program)| {
            program.blocks.iter().map(|block| vec![all.contains(&index); block.stmts.len()]).collect()
        };
        Self(module.programs.iter().enumerate().map(program).collect())
    }

    /// The cycles that have such a block and can be written by themselves.
    pub(super) fn cycles(
        module: &Module,
        flow: &Flow<'_>,
        known: &OverCalls<Known>,
        is_such: &dyn Fn(&Nc) -> bool,
    ) -> Self {
        let program = |(index, program): (usize, &Program)| {
            let such = |nc: &Nc| is_such(nc);
            if !program.blocks.iter().flat_map(|block| &block.stmts).filter_map(|s| s.kind.nc()).any(such) {
                return program.blocks.iter().map(|block| vec![false; block.stmts.len()]).collect();
            }
            let mut groups = Groups::default();
            let members = groups.program((index, program), flow, known, is_such);
            let chosen = |group: Option<usize>| {
                let group = groups.of(group?)?;
                Some(group.wanted && !group.bad)
            };
            let block = |block: Vec<Option<usize>>| {
                block.into_iter().map(|group| chosen(group).unwrap_or(false)).collect()
            };
            members.into_iter().map(block).collect()
        };
        Self(module.programs.iter().enumerate().map(program).collect())
    }

    /// Of the statements of a block.
    pub(super) fn at(&self, program: usize, id: BlockId) -> &[bool] {
        self.0.get(program).and_then(|blocks| blocks.get(id.index())).map_or(&[], Vec::as_slice)
    }

    /// True if any statement of a program is chosen.
    pub(super) fn any_in(&self, program: usize) -> bool {
        self.0.get(program).is_some_and(|blocks| blocks.iter().flatten().any(|chosen| *chosen))
    }
}

/// A cycle with its holes.
#[derive(Clone, Copy, Debug, Default)]
struct Group {
    /// True if it has a block that was asked for.
    wanted: bool,
    /// True if it leads out of what is looked at, or no moves are known for it.
    bad: bool,
    /// The group that it turned out to be one with; itself if none.
    root: usize,
}

/// The cycles of a program.
#[derive(Default)]
struct Groups(Vec<Group>);

impl Groups {
    fn fresh(&mut self) -> usize {
        self.0.push(Group { root: self.0.len(), ..Group::default() });
        self.0.len() - 1
    }

    fn root(&self, mut at: usize) -> usize {
        while let Some(group) = self.0.get(at).filter(|group| group.root != at) {
            at = group.root;
        }
        at
    }

    fn of(&self, at: usize) -> Option<&Group> {
        self.0.get(self.root(at))
    }

    fn mark(&mut self, at: Option<usize>, (wanted, bad): (bool, bool)) {
        let Some(root) = at.map(|at| self.root(at)) else { return };
        if let Some(group) = self.0.get_mut(root) {
            group.wanted |= wanted;
            group.bad |= bad;
        }
    }

    fn join(&mut self, a: Option<usize>, b: Option<usize>) {
        let (Some(a), Some(b)) = (a.map(|a| self.root(a)), b.map(|b| self.root(b))) else {
            // A cycle on one side alone, of which the other knows nothing.
            return self.mark(a.or(b), (false, true));
        };
        let Some(Group { wanted, bad, .. }) = self.0.get(b).copied().filter(|_| a != b) else { return };
        if let Some(group) = self.0.get_mut(b) {
            group.root = a;
        }
        self.mark(Some(a), (wanted, bad));
    }

    /// Which group each statement is of, for each block.
    fn program(
        &mut self,
        (index, program): (usize, &Program),
        flow: &Flow<'_>,
        known: &OverCalls<Known>,
        is_such: &dyn Fn(&Nc) -> bool,
    ) -> Vec<Vec<Option<usize>>> {
        let state = |id: BlockId| known.at(index, id);
        let on = |known: Option<&Known>| known.is_some_and(|known| is_on(&known.cycle));
        let heads: Vec<Option<usize>> = program.ids().map(|id| on(state(id)).then(|| self.fresh())).collect();
        let head = |id: BlockId| heads.get(id.index()).copied().flatten();
        // Whoever comes in from elsewhere brings the cycle along.
        let mut ways_in: Vec<BlockId> = vec![BlockId(0)];
        let mut members = Vec::with_capacity(program.blocks.len());
        for (id, block) in program.ids().zip(&program.blocks) {
            let mut of_block = vec![None; block.stmts.len()];
            let (mut at, Some(mut now)) = (head(id), state(id).cloned()) else {
                members.push(of_block);
                continue;
            };
            self.mark(at, (false, !matches!(now.cycle, Cycle::On(_))));
            let mut modal = flow.facts.at(index, id);
            for ((stmt, vacant), slot) in
                block.stmts.iter().zip(flow.vacancies.at(index, id)).zip(&mut of_block)
            {
                modal.step(stmt);
                step(stmt, &mut now, &modal, flow.runs, *vacant);
                if !is_on(&now.cycle) {
                    // What ends a cycle is the last of its blocks.
                    *slot = at.take();
                    continue;
                }
                let group = *at.get_or_insert_with(|| self.fresh());
                *slot = Some(group);
                let nc = stmt.kind.nc();
                let strange = !matches!(now.cycle, Cycle::On(_))
                    || nc.is_some_and(|nc| nc.ops().any(|op| op.is_cycle() && !has_moves(op)));
                self.mark(at, (nc.is_some_and(is_such), strange || stmt.site.skip.is_some()));
            }
            if let TermKind::Call { call, .. } = &block.term.kind
                && let Callee::Block(entry) = &call.callee
            {
                ways_in.push(*entry);
            }
            let leaves = !matches!(
                block.term.kind,
                TermKind::Jump(_) | TermKind::Branch { .. } | TermKind::End { .. }
            );
            self.mark(at, (false, leaves));
            for next in block.term.kind.successors() {
                if at.is_some() || head(next).is_some() {
                    self.join(at, head(next));
                }
            }
            members.push(of_block);
        }
        ways_in.into_iter().for_each(|entry| self.mark(head(entry), (false, true)));
        members
    }
}

/// True where a cycle of the library is in force, or may be.
fn is_on(cycle: &Cycle) -> bool {
    matches!(cycle, Cycle::On(_) | Cycle::Maybe(_) | Cycle::Mixed)
}
