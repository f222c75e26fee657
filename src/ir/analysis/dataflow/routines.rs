//! Texts in which routines are called.

use super::{Flow, Lattice};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// The states of a text's nodes while they are followed, where some of the nodes begin routines. A routine is entered
/// with the states of all its calls, and each call goes on with the states of all its returns.
///
/// A routine is named by the node that it is entered at.
#[derive(Clone, Debug)]
pub struct Routines<S> {
    nodes: Flow<S>,
    /// By routine, what it returns with.
    returned: BTreeMap<usize, S>,
    /// By routine, the nodes that call it.
    callers: BTreeMap<usize, BTreeSet<usize>>,
    closed: bool,
}

impl<S: Lattice> Routines<S> {
    /// Of so many nodes, the first of which comes first.
    pub fn new(nodes: usize) -> Self {
        Self::by(Flow::new(nodes))
    }

    /// Of nodes with these ranks, the least of which comes first.
    pub fn ranked(ranks: Vec<u32>) -> Self {
        Self::by(Flow::ranked(ranks))
    }

    fn by(nodes: Flow<S>) -> Self {
        Self { nodes, returned: BTreeMap::new(), callers: BTreeMap::new(), closed: false }
    }

    /// The next node that is to be looked at, and its state.
    pub fn pop(&mut self) -> Option<(usize, S)> {
        loop {
            let node = self.nodes.pop()?;
            if let Some(state) = self.nodes.state(node) {
                return Some((node, state.clone()));
            }
        }
    }

    /// Control comes to a node.
    pub fn go(&mut self, to: usize, state: &S) {
        if !self.closed {
            self.nodes.flow(to, state);
        }
    }

    /// A node calls a routine; true if it was not known to.
    pub fn call(&mut self, from: usize, routine: usize, state: &S) -> bool {
        self.go(routine, state);
        !self.closed && self.callers.entry(routine).or_default().insert(from)
    }

    /// What a routine returns with; none if it is not known to return.
    pub fn after(&self, routine: usize) -> Option<&S> {
        self.returned.get(&routine)
    }

    /// A routine returns: what calls it is to be looked at again where that is news.
    pub fn give_back(&mut self, routine: usize, state: &S) {
        if self.closed {
            return;
        }
        let changed = match self.returned.get_mut(&routine) {
            Some(returned) => returned.join(state),
            None => self.returned.insert(routine, state.clone()).is_none(),
        };
        if changed {
            self.callers.get(&routine).into_iter().flatten().for_each(|caller| self.nodes.again(*caller));
        }
    }

    /// Looks at a node again, if control came to it.
    pub fn again(&mut self, node: usize) {
        if self.state(node).is_some() {
            self.nodes.again(node);
        }
    }

    /// The nodes that are known to call a routine.
    pub fn callers(&self, routine: usize) -> impl Iterator<Item = usize> + '_ {
        self.callers.get(&routine).into_iter().flatten().copied()
    }

    /// The routines among some nodes that are known to be called.
    pub fn called(&self, among: Range<usize>) -> Vec<usize> {
        self.callers.range(among).map(|(routine, _)| *routine).collect()
    }

    /// The state of a node; none if control did not come so far.
    pub fn state(&self, node: usize) -> Option<&S> {
        self.nodes.state(node)
    }

    /// All is followed: nothing goes anywhere any more, whatever is asked.
    pub fn close(&mut self) {
        self.closed = true;
    }

    /// The states of all nodes.
    pub fn into_states(self) -> Vec<Option<S>> {
        self.nodes.into_states()
    }
}
