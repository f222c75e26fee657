//! What can be called in a library, and how deep that nests.

use crate::ir::analysis::CallGraph;
use crate::ir::analysis::computed_calls::computed_calls;
use crate::ir::{BlockId, Callee, Module, StmtKind, TermKind};
use crate::legalize::{reachable, span_of};
use crate::syntax::ProgramName;
use crate::text::Span;
use std::collections::BTreeMap;

/// A program of the module and the block that it is entered at; what is not in the library has no program.
type Entry = (usize, BlockId);

/// Where a call outside the library goes.
const OUTSIDE: Entry = (usize::MAX, BlockId(0));

/// Routines that are told apart by the modal calls in force; where there are more, every program is taken to nest too deep.
const MOST: usize = 20_000;

/// The routines of a library: an entry, under the modal calls that are in force there.
pub(super) struct Routines {
    /// What each calls.
    pub(super) calls: Vec<Vec<Edge>>,
    /// Who calls each.
    callers: Vec<Vec<usize>>,
    /// The routine that each program begins with.
    pub(super) mains: Vec<usize>,
    /// True where there are too many to tell.
    crowded: bool,
}

/// A call.
pub(super) struct Edge {
    /// The routine that is called.
    pub(super) to: usize,
    /// True where it opens a level of locals, as every modal call does.
    pub(super) level: bool,
    /// Where it stands.
    pub(super) span: Span,
}

/// The routines that are known so far.
#[derive(Default)]
struct Found {
    places: BTreeMap<(Entry, Vec<Entry>), usize>,
    order: Vec<(Entry, Vec<Entry>)>,
}

impl Found {
    fn place(&mut self, entry: Entry, under: &[Entry]) -> usize {
        *self.places.entry((entry, under.to_vec())).or_insert_with(|| {
            self.order.push((entry, under.to_vec()));
            self.order.len() - 1
        })
    }
}

impl Routines {
    /// Of a library. More modal calls in force than `most` are as many as that.
    pub(super) fn of(module: &Module, most: u32) -> Self {
        let named: BTreeMap<&ProgramName, usize> =
            module.programs.iter().enumerate().filter_map(|(at, p)| Some((p.name.as_ref()?, at))).collect();
        let mut found = Found::default();
        let computed = computed_calls(module);
        let mains = (0..module.programs.len()).map(|at| found.place((at, BlockId(0)), &[])).collect();
        let mut all = Self { calls: Vec::new(), callers: Vec::new(), mains, crowded: false };
        while let Some((entry, inherited)) = found.order.get(all.calls.len()).cloned() {
            all.crowded |= all.calls.len() >= MOST;
            let (at, first) = entry;
            let Some(program) = module.programs.get(at).filter(|_| !all.crowded) else {
                all.calls.push(Vec::new());
                continue;
            };
            let callee = |callee: &Callee| match callee {
                Callee::Program(name) => named.get(name).map_or(OUTSIDE, |at| (*at, BlockId(0))),
                Callee::Block(id) => (at, *id),
                Callee::Computed(_) | Callee::Cycle(_) => OUTSIDE,
            };
            let mut edges = Vec::new();
            let blocks = || reachable(program, first).into_iter().filter_map(|id| program.block(id));
            let mut under = inherited.clone();
            let mut moved = None;
            for stmt in blocks().flat_map(|block| &block.stmts) {
                match &stmt.kind {
                    StmtKind::ModalCall(call) => {
                        let (to, span) = (callee(&call.callee), stmt.site.span);
                        edges.push(Edge { to: found.place(to, &under), level: true, span });
                        if !under.contains(&to) && under.len() <= most as usize {
                            under.push(to);
                        }
                    }
                    StmtKind::Nc(nc) if nc.moves() => {
                        moved.get_or_insert(stmt.site.span);
                    }
                    _ => {}
                }
            }
            // Its moves call what is in force already, whichever of them is the innermost then.
            if let Some(span) = moved {
                for (depth, to) in inherited.iter().enumerate() {
                    edges.push(Edge { to: found.place(*to, &inherited[..depth]), level: true, span });
                }
            }
            for id in reachable(program, first) {
                let Some(block) = program.block(id) else { continue };
                if let TermKind::Call { call, .. } = &block.term.kind {
                    let (level, span) = (call.level, span_of(block, call));
                    let by_number = matches!(call.callee, Callee::Computed(_));
                    if let Some(callees) = computed.get(&(at, id)).filter(|callees| by_number && callees.all)
                    {
                        for to in &callees.programs {
                            edges.push(Edge { to: found.place((*to, BlockId(0)), &under), level, span });
                        }
                        continue;
                    }
                    edges.push(Edge { to: found.place(callee(&call.callee), &under), level, span });
                    // What is computed may be the very program.
                    if let Callee::Computed(_) = call.callee {
                        edges.push(Edge { to: all.calls.len(), level, span });
                    }
                }
            }
            all.calls.push(edges);
        }
        all.callers = vec![Vec::new(); all.calls.len()];
        for (from, edges) in all.calls.iter().enumerate() {
            edges.iter().for_each(|edge| all.callers[edge.to].push(from));
        }
        all
    }

    /// How deep calls nest from each routine, up to `most`: that is where circles end.
    pub(super) fn depths(&self, most: u32, counted: &[bool; 2]) -> Vec<u32> {
        if self.crowded {
            return vec![most; self.calls.len()];
        }
        let callees = |edges: &Vec<Edge>| edges.iter().map(|edge| (edge.to, edge.level)).collect();
        let mut depths = vec![0; self.calls.len()];
        CallGraph::new(self.calls.iter().map(callees).collect()).bottom_up(
            &mut depths,
            |mine, callee, level| {
                let deep = (callee + u32::from(counted[usize::from(level)])).min(most);
                let before = *mine;
                *mine = before.max(deep);
                *mine != before
            },
        );
        depths
    }

    /// The length of the longest chain of calls from each routine, where calls in a circle count for nothing.
    pub(super) fn longest(&self, counted: &[bool; 2]) -> Vec<u32> {
        let circles = self.circles();
        let mut circle_of = vec![0; self.calls.len()];
        for (at, circle) in circles.iter().enumerate() {
            circle.iter().for_each(|routine| circle_of[*routine] = at);
        }
        let mut depths = vec![0; circles.len()];
        // Callers come before what they call.
        for (at, circle) in circles.iter().enumerate().rev() {
            let edges = circle.iter().flat_map(|routine| &self.calls[*routine]);
            let out = edges.filter(|edge| circle_of[edge.to] != at);
            let below =
                |edge: &Edge| depths[circle_of[edge.to]] + u32::from(counted[usize::from(edge.level)]);
            depths[at] = out.map(below).max().unwrap_or(0);
        }
        circle_of.into_iter().map(|circle| depths[circle]).collect()
    }

    /// The routines in sets of those that call each other, callers before what they call (Kosaraju's way).
    fn circles(&self) -> Vec<Vec<usize>> {
        let mut order = Vec::new();
        let mut seen = vec![false; self.calls.len()];
        for start in 0..self.calls.len() {
            let mut path = Vec::new();
            if !std::mem::replace(&mut seen[start], true) {
                path.push((start, 0));
            }
            while let Some((at, next)) = path.last_mut() {
                match self.calls[*at].get(*next).map(|edge| edge.to) {
                    Some(to) => {
                        *next += 1;
                        if !std::mem::replace(&mut seen[to], true) {
                            path.push((to, 0));
                        }
                    }
                    None => {
                        order.push(*at);
                        path.pop();
                    }
                }
            }
        }
        let mut circles = Vec::new();
        let mut taken = vec![false; self.calls.len()];
        for start in order.into_iter().rev() {
            let mut circle = Vec::new();
            let mut work = vec![start];
            while let Some(at) = work.pop() {
                if !std::mem::replace(&mut taken[at], true) {
                    circle.push(at);
                    work.extend(&self.callers[at]);
                }
            }
            circles.push(circle);
        }
        circles
    }
}
