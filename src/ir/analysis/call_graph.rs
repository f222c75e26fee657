//! Who calls whom, for analyses over all programs.

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

    /// What a program calls.
    pub fn callees(&self, program: usize) -> &BTreeSet<(usize, bool)> {
        &self.callees[program]
    }

    /// Calls `step` on every program, and on the callers of one for which it says that something changed,
    /// until nothing does. Callees come first where they can.
    pub fn settle(&self, mut step: impl FnMut(usize) -> bool) {
        let order = self.callees_first();
        let mut place = vec![0; order.len()];
        order.iter().enumerate().for_each(|(at, program)| place[*program] = at);
        // Those that call one another settle before anyone looks at them who does not.
        let mut work: BTreeSet<usize> = (0..order.len()).collect();
        while let Some(program) = work.pop_first().map(|at| order[at]) {
            if step(program) {
                work.extend(self.callers[program].iter().map(|caller| place[*caller]));
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
