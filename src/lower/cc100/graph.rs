//! How control goes through one program, parts that it calls included.

use crate::ir::analysis::dataflow::{Flow, Lattice, reached_among};
use crate::ir::{Block, Callee, Program, TermKind};
use std::collections::BTreeMap;

/// The ways between blocks. A called part that returns goes on after any call of it, and at its
/// own beginning where a call repeats it;
/// a program with very many calls and blocks is taken to go on after any call at all.
#[derive(Debug)]
pub struct Graph {
    ways: Vec<Vec<usize>>,
}

/// Called parts times blocks up to which returns are told apart.
const MOST: usize = 1 << 22;

impl Graph {
    /// Of a program.
    pub fn of(program: &Program) -> Self {
        let count = program.blocks.len();
        let mut ways: Vec<Vec<usize>> = program.blocks.iter().map(|block| onward(block, true)).collect();
        let mut behind: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for block in &program.blocks {
            if let Some((entry, next)) = called(block) {
                let again = repeats(block).then_some(entry);
                behind.entry(entry).or_default().extend(again.into_iter().chain([next]));
            }
        }
        if behind.len().saturating_mul(count) > MOST {
            let all = std::mem::take(&mut behind).into_values().flatten().collect();
            ways.push(all);
            returns(program, 0..count).for_each(|at| ways[at].push(count));
        }
        for (entry, behind) in behind {
            let hub = ways.len();
            ways.push(behind);
            let part = body(program, entry);
            returns(program, (0..count).filter(|&at| part[at])).for_each(|at| ways[at].push(hub));
        }
        Self { ways }
    }

    /// How many nodes there are: the blocks, then one for the returns of each called part.
    pub fn len(&self) -> usize {
        self.ways.len()
    }

    /// Where control can go from a node.
    pub fn from(&self, node: usize) -> &[usize] {
        self.ways.get(node).map_or(&[], Vec::as_slice)
    }

    /// The ways the other way round.
    pub fn reversed(&self) -> Self {
        let mut ways: Vec<Vec<usize>> = vec![Vec::new(); self.ways.len()];
        for (from, to) in self.ways.iter().enumerate() {
            for &to in to {
                ways[to].push(from);
            }
        }
        Self { ways }
    }

    /// The state at the start of every block, as a forward analysis finds it. The entry
    /// starts in `entry`, and so does a block that nothing leads to, which then changes
    /// nothing where control really comes.
    pub fn forward<S: Lattice>(
        &self,
        program: &Program,
        entry: &S,
        through: impl Fn(&Block, S) -> S,
    ) -> Vec<S> {
        let mut flow = Flow::new(self.ways.len());
        // Which seed reached a node first: what an earlier one reached is settled.
        let mut reached = vec![usize::MAX; self.ways.len()];
        for seed in 0..program.blocks.len() {
            if flow.state(seed).is_some() {
                continue;
            }
            flow.flow(seed, entry);
            reached[seed] = seed;
            while let Some(node) = flow.pop() {
                let Some(state) = flow.state(node).cloned() else { continue };
                let after = match program.blocks.get(node) {
                    Some(block) => through(block, state),
                    None => state,
                };
                for &to in self.from(node) {
                    if reached[to] >= seed {
                        reached[to] = seed;
                        flow.flow(to, &after);
                    }
                }
            }
        }
        let states = flow.into_states().into_iter().take(program.blocks.len());
        states.map(|state| state.unwrap_or_else(|| entry.clone())).collect()
    }
}

/// The called part of this program and where it goes on, for a block that ends in such a call.
pub fn called(block: &Block) -> Option<(usize, usize)> {
    match &block.term.kind {
        TermKind::Call { call, next } => match call.callee {
            Callee::Block(entry) => Some((entry.index(), next.index())),
            _ => None,
        },
        _ => None,
    }
}

/// True for a call that may run more than once.
fn repeats(block: &Block) -> bool {
    matches!(&block.term.kind, TermKind::Call { call, .. } if call.count.is_some())
}

/// The blocks of a called part, or of the main part: all that its entry leads to,
/// calls being passed over.
pub fn body(program: &Program, entry: usize) -> Vec<bool> {
    reached_among(program.blocks.len(), [entry], |at, go| {
        program.blocks.get(at).into_iter().flat_map(|block| onward(block, false)).for_each(go);
    })
}

fn onward(block: &Block, into: bool) -> Vec<usize> {
    match called(block) {
        Some((entry, _)) if into => vec![entry],
        Some((_, next)) => vec![next],
        None => block.term.kind.successors().iter().map(|id| id.index()).collect(),
    }
}

fn returns(program: &Program, among: impl Iterator<Item = usize>) -> impl Iterator<Item = usize> {
    among.filter(|&at| {
        program.blocks.get(at).is_some_and(|block| matches!(block.term.kind, TermKind::Return { .. }))
    })
}
