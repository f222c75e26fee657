//! Who calls whom, for analyses over all programs.

use super::dataflow::Worklist;
use std::collections::BTreeSet;

/// Programs by index, and whether a call opens a level of locals.
#[derive(Debug)]
pub struct CallGraph {
    callees: Vec<BTreeSet<(usize, bool)>>,
    callers: Vec<Vec<usize>>,
}

impl CallGraph {
    /// The graph of these callees of each program.
    pub fn new(callees: Vec<BTreeSet<(usize, bool)>>) -> Self {
        let mut callers = vec![Vec::new(); callees.len()];
        for (from, callees) in callees.iter().enumerate() {
            callees.iter().for_each(|(to, _)| callers[*to].push(from));
        }
        Self { callees, callers }
    }

    /// Adds to the summary of each program those of its callees, until nothing changes: `join` is given a caller's, a
    /// callee's, and whether the call opens a level of locals, and is true where that changed the caller's. Callees come
    /// first where they can; those that call one another come again until they agree.
    pub fn bottom_up<S: Clone>(&self, summaries: &mut [S], join: impl Fn(&mut S, &S, bool) -> bool) {
        self.fixpoint(|at| {
            let add = |changed, (callee, level): &(usize, bool)| {
                join_at(summaries, at, *callee, |mine, theirs| join(mine, theirs, *level)) || changed
            };
            self.callees[at].iter().fold(false, add)
        });
    }

    /// Adds to what each program is entered with what its callers are, until nothing changes: `join` is given a callee's
    /// state, a caller's, and whether the call opens a level of locals, and is true where that changed the callee's.
    pub fn top_down<S: Clone>(&self, entries: &mut [S], join: impl Fn(&mut S, &S, bool) -> bool) {
        let order = self.callees_first();
        let mut work = Worklist::ranked(ranks(order.iter().rev()));
        order.iter().for_each(|program| work.add(*program));
        while let Some(at) = work.pop() {
            for (callee, level) in &self.callees[at] {
                if join_at(entries, *callee, at, |theirs, mine| join(theirs, mine, *level)) {
                    work.add(*callee);
                }
            }
        }
    }

    /// Calls `step` on every program, and on the callers of one for which it says that something changed,
    /// until nothing does. Callees come first where they can.
    pub fn fixpoint(&self, mut step: impl FnMut(usize) -> bool) {
        // Those that call one another settle before anyone looks at them who does not.
        let order = self.callees_first();
        let mut work = Worklist::ranked(ranks(order.iter()));
        order.iter().for_each(|program| work.add(*program));
        while let Some(program) = work.pop() {
            if step(program) {
                self.callers[program].iter().for_each(|caller| work.add(*caller));
            }
        }
    }

    /// Those that a program calls.
    pub fn callees(&self, program: usize) -> impl Iterator<Item = usize> + '_ {
        self.callees[program].iter().map(|(callee, _)| *callee)
    }

    /// By program, a number that it shares with those that it comes back to: that call it, and that it calls.
    pub fn components(&self) -> Vec<usize> {
        let mut component = vec![usize::MAX; self.callees.len()];
        // Callers first: what leads back to one that is not taken yet comes from its own component.
        for root in self.callees_first().into_iter().rev() {
            let mut work = vec![root];
            while let Some(at) = work.pop() {
                if component[at] == usize::MAX {
                    component[at] = root;
                    work.extend(
                        self.callers[at].iter().copied().filter(|from| component[*from] == usize::MAX),
                    );
                }
            }
        }
        component
    }

    /// All programs, callees before their callers if they do not call one another.
    pub fn callees_first(&self) -> Vec<usize> {
        let mut order = Vec::with_capacity(self.callees.len());
        let mut seen = vec![false; self.callees.len()];
        for root in 0..self.callees.len() {
            if std::mem::replace(&mut seen[root], true) {
                continue;
            }
            let mut stack = vec![(root, self.callees[root].iter())];
            while let Some((at, rest)) = stack.last_mut() {
                match rest.next() {
                    None => {
                        order.push(*at);
                        stack.pop();
                    }
                    Some((to, _)) if !std::mem::replace(&mut seen[*to], true) => {
                        stack.push((*to, self.callees[*to].iter()));
                    }
                    Some(_) => {}
                }
            }
        }
        order
    }
}

/// By program, its place in an order.
fn ranks<'o>(order: impl ExactSizeIterator<Item = &'o usize>) -> Vec<u32> {
    let mut ranks = vec![0; order.len()];
    (0..).zip(order).for_each(|(rank, program)| ranks[*program] = rank);
    ranks
}

/// Joins one of some states into another, or into itself.
fn join_at<S: Clone>(
    states: &mut [S],
    to: usize,
    from: usize,
    join: impl FnOnce(&mut S, &S) -> bool,
) -> bool {
    match states.get_disjoint_mut([to, from]) {
        Ok([mine, theirs]) => join(mine, theirs),
        Err(_) => {
            let theirs = states[from].clone();
            join(&mut states[to], &theirs)
        }
    }
}
