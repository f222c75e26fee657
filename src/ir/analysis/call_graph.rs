//! Who calls whom, for analyses over all programs.

use std::collections::{BTreeSet, VecDeque};

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

    /// What a program calls.
    pub fn callees(&self, program: usize) -> &BTreeSet<(usize, bool)> {
        &self.callees[program]
    }

    /// Calls `step` on every program, and on the callers of one for which it says that something changed,
    /// until nothing does. Callees come first where they can.
    pub fn settle(&self, mut step: impl FnMut(usize) -> bool) {
        let mut work: VecDeque<usize> = self.callees_first().into();
        let mut waiting = vec![true; self.callees.len()];
        while let Some(at) = work.pop_front() {
            waiting[at] = false;
            if step(at) {
                for caller in &self.callers[at] {
                    if !std::mem::replace(&mut waiting[*caller], true) {
                        work.push_back(*caller);
                    }
                }
            }
        }
    }

    fn callees_first(&self) -> Vec<usize> {
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
