//! States of nodes, and which nodes are to be looked at again.

use super::Lattice;
use std::collections::BTreeSet;

/// Nodes that wait to be looked at, each once, in an order.
#[derive(Clone, Debug)]
pub struct Worklist {
    order: Order,
    /// How many nodes there are.
    count: usize,
    /// A bit for each place: whether the node there waits.
    waits: Vec<u64>,
    /// No node waits in the words before this one.
    first: usize,
}

/// Which node comes first.
#[derive(Clone, Debug)]
enum Order {
    /// The first.
    Counted,
    /// The last.
    Turned,
    Ranked {
        /// By node: its place in the order.
        places: Vec<u32>,
        /// By place.
        nodes: Vec<u32>,
    },
}

impl Worklist {
    /// Of nodes with these ranks, the least of which comes first; among equals the first node does.
    pub fn ranked(ranks: Vec<u32>) -> Self {
        let places = places(ranks);
        let mut nodes = vec![0; places.len()];
        (0..).zip(&places).for_each(|(node, place)| nodes[*place as usize] = node);
        let count = places.len();
        Self::by(Order::Ranked { places, nodes }, count)
    }

    /// Of so many nodes, the first of which comes first; the last where it is turned.
    pub fn counted(count: usize, turned: bool) -> Self {
        Self::by(if turned { Order::Turned } else { Order::Counted }, count)
    }

    fn by(order: Order, count: usize) -> Self {
        Self { order, count, waits: vec![0; count.div_ceil(64)], first: 0 }
    }

    /// Lets a node wait.
    pub fn add(&mut self, node: usize) {
        if node >= self.count {
            return;
        }
        let place = match &self.order {
            Order::Counted => node,
            Order::Turned => self.count - 1 - node,
            Order::Ranked { places, .. } => places[node] as usize,
        };
        let word = place / 64;
        self.waits[word] |= 1 << (place % 64);
        self.first = self.first.min(word);
    }

    /// The first node that waits, which does so no more.
    pub fn pop(&mut self) -> Option<usize> {
        while let Some(word) = self.waits.get_mut(self.first) {
            if *word != 0 {
                let place = self.first * 64 + word.trailing_zeros() as usize;
                *word &= *word - 1;
                return match &self.order {
                    Order::Counted => Some(place),
                    Order::Turned => Some(self.count - 1 - place),
                    Order::Ranked { nodes, .. } => nodes.get(place).map(|node| *node as usize),
                };
            }
            self.first += 1;
        }
        None
    }
}

/// The place of each node in the order of ranks; of equals the first node comes first.
fn places(mut ranks: Vec<u32>) -> Vec<u32> {
    let count = ranks.len();
    // By rank, how many places are before those of that rank.
    let mut before = vec![0; count + 2];
    if ranks.iter().any(|rank| *rank as usize > count) {
        let mut nodes: Vec<usize> = (0..count).collect();
        nodes.sort_by_key(|node| ranks[*node]);
        (0..).zip(nodes).for_each(|(place, node)| ranks[node] = place);
        return ranks;
    }
    ranks.iter().for_each(|rank| before[*rank as usize + 1] += 1);
    let mut sum = 0;
    before.iter_mut().for_each(|before| {
        sum += *before;
        *before = sum;
    });
    for rank in &mut ranks {
        let next = &mut before[*rank as usize];
        (*rank, *next) = (*next, *next + 1);
    }
    ranks
}

/// The states of a graph's nodes while they are followed. Whoever follows them takes the next node that waits, and
/// flows what it makes of its state into others.
///
/// Where ranks are a reverse postorder, a node comes after what leads to it.
#[derive(Clone, Debug)]
pub struct Flow<S> {
    /// By node; none if no way leads.
    states: Vec<Option<S>>,
    /// By node: how often something was joined into its state.
    joined: Vec<u32>,
    /// By node: how often states had been settled when it got its own.
    since: Vec<u32>,
    settled: u32,
    work: Worklist,
}

impl<S: Lattice> Flow<S> {
    /// Of so many nodes, the first of which comes first.
    pub fn new(nodes: usize) -> Self {
        Self::counted(nodes, false)
    }

    /// Of so many nodes, the first of which comes first; the last where it is turned.
    pub fn counted(nodes: usize, turned: bool) -> Self {
        Self::by(Worklist::counted(nodes, turned))
    }

    /// Of nodes with these ranks, the least of which comes first.
    pub fn ranked(ranks: Vec<u32>) -> Self {
        Self::by(Worklist::ranked(ranks))
    }

    fn by(work: Worklist) -> Self {
        let (states, joined, since) = (vec![None; work.count], vec![0; work.count], vec![0; work.count]);
        Self { states, joined, since, settled: 0, work }
    }

    /// What has a state keeps it from here on.
    pub fn settle(&mut self) {
        self.settled += 1;
    }

    /// Joins a state into that of a node, which waits where that changed it; true then.
    pub fn flow(&mut self, to: usize, state: &S) -> bool {
        self.flow_by(to, state, |mine, theirs, _| mine.join(theirs))
    }

    /// The same by a join of the caller's own, which is told how often this node's state was joined into before.
    pub fn flow_by(&mut self, to: usize, state: &S, join: impl FnOnce(&mut S, &S, u32) -> bool) -> bool {
        let changed = match self.states.get_mut(to) {
            Some(Some(_)) if self.since[to] < self.settled => false,
            Some(Some(mine)) => {
                let times = self.joined[to];
                self.joined[to] = times.saturating_add(1);
                join(mine, state, times)
            }
            Some(none) => {
                *none = Some(state.clone());
                self.since[to] = self.settled;
                true
            }
            None => false,
        };
        if changed {
            self.work.add(to);
        }
        changed
    }

    /// Lets a node be looked at again, as what else it depends on has changed.
    pub fn again(&mut self, node: usize) {
        self.work.add(node);
    }

    /// The next node that is to be looked at.
    pub fn pop(&mut self) -> Option<usize> {
        self.work.pop()
    }

    /// The state of a node; none if no way led there so far.
    pub fn state(&self, node: usize) -> Option<&S> {
        self.states.get(node)?.as_ref()
    }

    /// The states of all nodes.
    pub fn into_states(self) -> Vec<Option<S>> {
        self.states
    }
}

/// These nodes, and all that ways lead to from them; `ways` calls its last argument with where a node leads.
pub fn reached<N: Copy + Ord>(
    from: impl IntoIterator<Item = N>,
    mut ways: impl FnMut(N, &mut dyn FnMut(N)),
) -> BTreeSet<N> {
    let mut seen: BTreeSet<N> = from.into_iter().collect();
    let mut work: Vec<N> = seen.iter().copied().collect();
    while let Some(node) = work.pop() {
        ways(node, &mut |to| {
            if seen.insert(to) {
                work.push(to);
            }
        });
    }
    seen
}

/// The same of nodes that are counted, by node.
pub fn reached_among(
    count: usize,
    from: impl IntoIterator<Item = usize>,
    mut ways: impl FnMut(usize, &mut dyn FnMut(usize)),
) -> Vec<bool> {
    let mut seen = vec![false; count];
    let mut work: Vec<usize> = Vec::new();
    let mut note = |node: usize, work: &mut Vec<usize>| {
        if seen.get_mut(node).is_some_and(|seen| !std::mem::replace(seen, true)) {
            work.push(node);
        }
    };
    from.into_iter().for_each(|node| note(node, &mut work));
    while let Some(node) = work.pop() {
        ways(node, &mut |to| note(to, &mut work));
    }
    seen
}
