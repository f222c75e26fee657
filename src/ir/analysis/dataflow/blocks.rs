//! Analyses of one program, followed through its control-flow graph.

use super::{Flow, Lattice};
use crate::ir::analysis::Cfg;
use crate::ir::{Block, BlockId, Program, Stmt};
use std::borrow::Cow;

/// Which way an analysis goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// From where a program begins: what has happened.
    Forward,
    /// From where it ends: what will happen.
    Backward,
}

/// What is to be known at each place of a program.
///
/// A block's *head* is where the analysis comes to it: its start where the analysis goes forwards, its end where it
/// goes backwards.
pub trait Analysis {
    /// What is known at a place.
    type State: Lattice;

    /// Which way it goes.
    const DIRECTION: Direction;

    /// True where blocks are best looked at as they stand: their order by the graph costs more than it saves an analysis of few bits.
    const AS_THEY_STAND: bool = false;

    /// What is known at the heads of blocks that control enters from outside, or leaves to it. Blocks that neither
    /// stand here nor are led to are never looked at.
    fn entries(&self, cfg: &Cfg) -> Vec<(BlockId, Self::State)>;

    /// What a block makes of what is known at its head: statements, terminator, and what that calls.
    fn block(&self, id: BlockId, block: &Block, state: &mut Self::State);

    /// What becomes of it on the way from one block to another, as control goes; none if nothing goes that way.
    fn edge<'s>(&self, from: BlockId, to: BlockId, state: &'s Self::State) -> Option<Cow<'s, Self::State>> {
        let _ = (from, to);
        Some(Cow::Borrowed(state))
    }

    /// Joins what is known on another way to a head where so many were joined before; true where that changed
    /// anything. One whose lattice has no finite height gives up something here when there were many.
    fn merge(&self, state: &mut Self::State, other: &Self::State, before: u32) -> bool {
        let _ = before;
        state.join(other)
    }
}

/// An analysis that knows something between the statements of a block too.
pub trait Steps: Analysis {
    /// What a statement makes of what is known before it; going backwards, after it.
    fn stmt(&self, place: (BlockId, usize), stmt: &Stmt, state: &mut Self::State);

    /// What is known at the first statement that the analysis comes to: after the terminator, where it goes backwards.
    fn first(&self, id: BlockId, block: &Block, state: &mut Self::State) {
        let _ = (id, block, state);
    }

    /// All statements of a block, in the order in which the analysis comes to them.
    fn stmts(&self, id: BlockId, block: &Block, state: &mut Self::State) {
        self.first(id, block, state);
        self.each(id, block, state, &mut |_, _| {});
    }

    /// Calls `f` with each statement's number and what is known before it, or (backwards) after it.
    fn each(
        &self,
        id: BlockId,
        block: &Block,
        state: &mut Self::State,
        f: &mut dyn FnMut(usize, &Self::State),
    ) {
        let mut step = |(at, stmt): (usize, &Stmt)| {
            f(at, state);
            self.stmt((id, at), stmt, state);
        };
        let stmts = block.stmts.iter().enumerate();
        match Self::DIRECTION {
            Direction::Forward => stmts.for_each(&mut step),
            Direction::Backward => stmts.rev().for_each(&mut step),
        }
    }
}

/// What an analysis found at the head of each block.
#[derive(Clone, Debug, PartialEq)]
pub struct States<S>(Vec<Option<S>>);

impl<S> Default for States<S> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<S> States<S> {
    /// What is known at a block's head; none if the analysis does not come.
    pub fn at(&self, id: BlockId) -> Option<&S> {
        self.0.get(id.index())?.as_ref()
    }
}

/// Follows an analysis until nothing changes.
pub fn solve<A: Analysis>(analysis: &A, program: &Program, cfg: &Cfg) -> States<A::State> {
    solve_within(analysis, program, cfg, usize::MAX).unwrap_or_default()
}

/// The same; none if it would look at more statements and blocks than so many, each as often as it does.
pub fn solve_within<A: Analysis>(
    analysis: &A,
    program: &Program,
    cfg: &Cfg,
    limit: usize,
) -> Option<States<A::State>> {
    let forward = A::DIRECTION == Direction::Forward;
    let flow =
        if A::AS_THEY_STAND { Flow::counted(cfg.len(), !forward) } else { Flow::ranked(ranks(cfg, forward)) };
    let mut flow = begin(flow, analysis, cfg);
    follow(analysis, program, cfg, &mut flow, limit)?;
    Some(States(flow.into_states()))
}

/// Follows an analysis to every block: to those that no way leads to from `unreached`, in their order, after all others,
/// of which they change nothing.
pub fn solve_everywhere<A: Analysis>(
    analysis: &A,
    program: &Program,
    cfg: &Cfg,
    unreached: &A::State,
) -> States<A::State> {
    let ranks = ranks(cfg, A::DIRECTION == Direction::Forward);
    solve_everywhere_by(ranks, analysis, program, cfg, unreached)
}

/// The same where these ranks of blocks say which comes first.
pub(crate) fn solve_everywhere_by<A: Analysis>(
    ranks: Vec<u32>,
    analysis: &A,
    program: &Program,
    cfg: &Cfg,
    unreached: &A::State,
) -> States<A::State> {
    let mut flow = begin(Flow::ranked(ranks), analysis, cfg);
    let _ = follow(analysis, program, cfg, &mut flow, usize::MAX);
    for block in 0..program.blocks.len() {
        if flow.state(block).is_none() {
            flow.settle();
            flow.flow(block, unreached);
            let _ = follow(analysis, program, cfg, &mut flow, usize::MAX);
        }
    }
    States(flow.into_states())
}

fn begin<A: Analysis>(mut flow: Flow<A::State>, analysis: &A, cfg: &Cfg) -> Flow<A::State> {
    for (id, state) in analysis.entries(cfg) {
        flow.flow(id.index(), &state);
    }
    flow
}

/// Follows the nodes that wait; none if that takes more statements and blocks than so many.
fn follow<A: Analysis>(
    analysis: &A,
    program: &Program,
    cfg: &Cfg,
    flow: &mut Flow<A::State>,
    limit: usize,
) -> Option<()> {
    let forward = A::DIRECTION == Direction::Forward;
    let mut left = limit;
    while let Some(at) = flow.pop() {
        let id = BlockId(at as u32);
        let Some(mut state) = flow.state(at).cloned() else { continue };
        if let Some(block) = program.block(id) {
            left = left.checked_sub(1 + block.stmts.len())?;
            analysis.block(id, block, &mut state);
        }
        for to in if forward { cfg.succs(id) } else { cfg.preds(id) } {
            let (from, into) = if forward { (id, *to) } else { (*to, id) };
            if let Some(there) = analysis.edge(from, into, &state) {
                flow.flow_by(to.index(), &there, |mine, theirs, times| analysis.merge(mine, theirs, times));
            }
        }
    }
    Some(())
}

/// Reverse postorder; postorder for the way back. Blocks that nothing leads to go last.
fn ranks(cfg: &Cfg, forward: bool) -> Vec<u32> {
    let reached = cfg.order().len() as u32;
    let mut ranks = vec![reached; cfg.len()];
    for (place, id) in (0..).zip(cfg.order()) {
        ranks[id.index()] = if forward { place } else { reached - 1 - place };
    }
    ranks
}

/// What an analysis found, statement by statement.
#[derive(Debug)]
pub struct Cursor<S> {
    place: Option<(BlockId, usize)>,
    state: Option<S>,
}

impl<S> Default for Cursor<S> {
    fn default() -> Self {
        Self { place: None, state: None }
    }
}

impl<S: Lattice> Cursor<S> {
    /// What is known before statement `at` of a block (past the last: before its terminator) by an analysis that goes
    /// forwards; none if control does not come. Questions in the order of statements are cheap.
    pub fn seek<A: Steps<State = S>>(
        &mut self,
        analysis: &A,
        states: &States<S>,
        program: &Program,
        (id, at): (BlockId, usize),
    ) -> Option<&S> {
        let block = program.block(id)?;
        let at = at.min(block.stmts.len());
        let mut from = match self.place {
            Some((here, from)) if here == id && from <= at => from,
            _ => {
                (self.state, self.place) = (states.at(id).cloned(), Some((id, 0)));
                0
            }
        };
        let state = self.state.as_mut()?;
        while let Some(stmt) = block.stmts.get(from).filter(|_| from < at) {
            analysis.stmt((id, from), stmt, state);
            from += 1;
        }
        self.place = Some((id, at));
        self.state.as_ref()
    }
}
