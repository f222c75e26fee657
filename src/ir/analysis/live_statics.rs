//! Live ranges of statics over a whole library: which of them are read later, in whatever program.
//!
//! A call reads what its callee may read before it writes it; what is live after the call stays live through it. A
//! return makes live what any caller needs afterwards of what the program, or what it calls, may write. The rest that
//! is live after a call is nothing to the callee, but for its registers ([`LiveStatics::through`]). A call that repeats
//! is a loop: a return makes live what the next run reads, whether the program writes it or not.

use super::dataflow::{Analysis, Direction, Lattice, States, Worklist, solve};
use super::upward_exposed::roots;
use super::{BitRow, CallGraph, Cfg, Universe, VarSet};
use crate::ir::{Block, BlockId, Call, Callee, Class, Expr, Module, Place, Program, Stmt, TermKind, Var};
use crate::syntax::ProgramName;
use std::collections::{BTreeMap, BTreeSet};

/// Live ranges of the statics of a library.
pub struct LiveStatics {
    universe: Universe,
    names: BTreeMap<ProgramName, usize>,
    /// The programs that runs begin with.
    roots: BTreeSet<usize>,
    /// By program: those that it calls, and that those call.
    reached: Vec<BTreeSet<usize>>,
    /// By program, its callees included: what it may write.
    written: Vec<BitRow>,
    /// By program: what is live at its entry.
    entries: Vec<BitRow>,
    /// By program: what is live after its returns.
    exits: Vec<BitRow>,
    /// By program: all that it reads, for bodies that calls within it enter.
    reads: Vec<BitRow>,
}

impl LiveStatics {
    /// Of a library.
    pub fn of(module: &Module) -> Self {
        let universe = statics(module);
        let names = module.programs.iter().enumerate().filter_map(|(at, p)| Some((p.name.clone()?, at)));
        let none = || vec![universe.none(); module.programs.len()];
        let (written, entries, exits, reads) = (none(), none(), none(), none());
        let names = names.collect();
        let roots = roots(module).into_iter().collect();
        let mut live = Self { universe, names, roots, reached: Vec::new(), written, entries, exits, reads };
        live.summaries(module);
        live.follow(module);
        live
    }

    /// All statics that the library names, in order.
    pub fn universe(&self) -> &Universe {
        &self.universe
    }

    /// The programs that a call may run.
    pub fn callees(&self, caller: usize, call: &Call) -> Vec<usize> {
        match &call.callee {
            Callee::Program(name) => self.names.get(name).copied().into_iter().collect(),
            Callee::Block(_) => vec![caller],
            Callee::Computed(_) => (0..self.written.len()).collect(),
            Callee::Cycle(_) => Vec::new(),
        }
    }

    /// True if the call may come to run a program, by whatever chain of calls.
    pub fn calls(&self, caller: usize, call: &Call, program: usize) -> bool {
        let callees = self.callees(caller, call);
        callees.iter().any(|callee| *callee == program || self.reached[*callee].contains(&program))
    }

    /// What a call may write.
    pub fn written_by(&self, caller: usize, call: &Call) -> BTreeSet<Var> {
        let callees = self.callees(caller, call).into_iter();
        callees.flat_map(|callee| self.universe.members(&self.written[callee])).collect()
    }

    /// The same by places in the universe.
    pub fn written(&self, program: usize) -> &BitRow {
        &self.written[program]
    }

    /// What is live after the call that ends a block.
    pub fn after_call(&self, module: &Module, program: usize, id: BlockId) -> Vec<Var> {
        let states = self.states(&module.programs[program], program);
        states.at(id).map(|row| self.universe.members(row).collect()).unwrap_or_default()
    }

    /// Calls `f` on each block of a program with what is live at its end, before its terminator is counted.
    pub fn each_end(&self, program: &Program, index: usize, f: &mut dyn FnMut(BlockId, &Block, &BitRow)) {
        let states = self.states(program, index);
        for (id, block) in program.ids().zip(&program.blocks) {
            if let Some(row) = states.at(id) {
                f(id, block, row);
            }
        }
    }

    /// Takes what is live at the end of a block to before its terminator, then over its statements from the last:
    /// `f` is told what is live after each.
    pub fn backward(
        &self,
        index: usize,
        block: &Block,
        live: &mut BitRow,
        f: &mut dyn FnMut(usize, &Stmt, &BitRow),
    ) {
        self.end(index, block, live);
        for (at, stmt) in block.stmts.iter().enumerate().rev() {
            f(at, stmt, live);
            self.stmt(stmt, live);
        }
    }

    /// By program: what callers need after calls that come to run it.
    pub fn through(&self, module: &Module) -> Vec<BitRow> {
        let mut through = vec![self.universe.none(); module.programs.len()];
        let mut callees = vec![BTreeSet::new(); module.programs.len()];
        for (index, program) in module.programs.iter().enumerate() {
            self.each_end(program, index, &mut |_, block, live| {
                if let TermKind::Call { call, .. } = &block.term.kind {
                    for callee in self.callees(index, call) {
                        through[callee].join(live);
                        callees[index].insert((callee, false));
                    }
                }
            });
        }
        CallGraph::new(callees).top_down(&mut through, |theirs, mine, _| theirs.join(mine));
        through
    }

    fn states(&self, program: &Program, index: usize) -> States<BitRow> {
        solve(&Live { all: self, index, program }, program, &Cfg::of(program))
    }

    fn summaries(&mut self, module: &Module) {
        let mut callees = vec![BTreeSet::new(); module.programs.len()];
        for (index, program) in module.programs.iter().enumerate() {
            for block in &program.blocks {
                let (reads, written) = (&mut self.reads[index], &mut self.written[index]);
                for stmt in &block.stmts {
                    stmt.kind.exprs(&mut |e| read(&self.universe, e, reads));
                    target(stmt)
                        .and_then(|var| self.universe.place(var))
                        .into_iter()
                        .for_each(|at| written.insert(at));
                }
                block.term.kind.exprs(&mut |e| read(&self.universe, e, reads));
                match &block.term.kind {
                    TermKind::Call { call, .. } => {
                        callees[index].extend(self.callees(index, call).into_iter().map(|to| (to, false)));
                    }
                    TermKind::Chain(name) => {
                        callees[index].extend(self.names.get(name).map(|to| (*to, false)));
                    }
                    _ => {}
                }
            }
        }
        self.reached = callees.iter().map(|all| all.iter().map(|(to, _)| *to).collect()).collect();
        let graph = CallGraph::new(callees);
        graph.bottom_up(&mut self.written, |mine, theirs, _| mine.join(theirs));
        graph.bottom_up(&mut self.reads, |mine, theirs, _| mine.join(theirs));
        graph.bottom_up(&mut self.reached, |mine, theirs, _| {
            let before = mine.len();
            mine.extend(theirs.iter().copied());
            mine.len() != before
        });
    }

    /// Follows entries to callers and what is needed after calls to callees, until nothing changes.
    fn follow(&mut self, module: &Module) {
        let count = module.programs.len();
        let mut work = Worklist::counted(count, true);
        (0..count).for_each(|program| work.add(program));
        let mut callers = vec![BTreeSet::new(); count];
        while let Some(index) = work.pop() {
            let program = &module.programs[index];
            let states = self.states(program, index);
            let mut entry = self.universe.none();
            for (id, block) in program.ids().zip(&program.blocks) {
                let Some(after) = states.at(id) else { continue };
                let callees = match &block.term.kind {
                    TermKind::Call { call, .. } => self.callees(index, call),
                    TermKind::Chain(name) => self.names.get(name).copied().into_iter().collect(),
                    _ => Vec::new(),
                };
                let mut needed = after.clone();
                if matches!(block.term.kind, TermKind::Chain(_)) {
                    needed.join(&self.exits[index]);
                }
                for callee in callees {
                    callers[callee].insert(index);
                    let mut here = needed.clone();
                    here.intersect(&self.written[callee]);
                    self.next_run(index, callee, &block.term.kind)
                        .into_iter()
                        .for_each(|row| _ = here.join(row));
                    if Lattice::join(&mut self.exits[callee], &here) {
                        work.add(callee);
                    }
                }
                if id == BlockId(0) {
                    entry = after.clone();
                    self.backward(index, block, &mut entry, &mut |_, _, _| {});
                }
            }
            if self.entries[index].join(&entry) {
                callers[index].iter().for_each(|caller| work.add(*caller));
                if self.roots.contains(&index) {
                    work.add(index);
                }
            }
        }
    }

    /// What the next run of a callee reads, where the call at the end of a block repeats it.
    fn next_run(&self, caller: usize, callee: usize, kind: &TermKind) -> Option<&BitRow> {
        match kind {
            TermKind::Call { call, .. } if call.repeats() => Some(match call.callee {
                Callee::Block(_) => &self.reads[caller],
                _ => &self.entries[callee],
            }),
            _ => None,
        }
    }

    fn end(&self, index: usize, block: &Block, live: &mut BitRow) {
        match &block.term.kind {
            TermKind::Call { call, .. } => {
                for callee in self.callees(index, call) {
                    let body = matches!(call.callee, Callee::Block(_));
                    live.join(if body { &self.reads[index] } else { &self.entries[callee] });
                }
            }
            TermKind::Chain(name) => {
                if let Some(callee) = self.names.get(name) {
                    live.join(&self.entries[*callee]);
                }
            }
            TermKind::Return { .. } => {
                live.join(&self.exits[index]);
                // One that nobody called starts again.
                if self.roots.contains(&index) {
                    live.join(&self.entries[index]);
                }
            }
            _ => {}
        }
        block.term.kind.exprs(&mut |e| read(&self.universe, e, live));
    }

    fn stmt(&self, stmt: &Stmt, live: &mut BitRow) {
        // Under block skip the old value may survive.
        if let Some(var) = target(stmt).filter(|_| stmt.site.skip.is_none())
            && let Some(at) = self.universe.place(var)
        {
            live.remove(at);
        }
        stmt.kind.exprs(&mut |e| read(&self.universe, e, live));
    }
}

/// The statics that a library names.
pub fn statics(module: &Module) -> Universe {
    let mut all = VarSet::default();
    for program in &module.programs {
        program.variables(&mut |var| {
            if var.class == Class::Static {
                all.insert(var);
            }
        });
    }
    Universe::new(all.iter().collect())
}

/// The static that a statement writes.
fn target(stmt: &Stmt) -> Option<Var> {
    match stmt.kind.target() {
        Some(Place::Var(var)) if var.class == Class::Static => Some(*var),
        _ => None,
    }
}

fn read(universe: &Universe, e: &Expr, live: &mut BitRow) {
    e.variables(&mut |var| {
        if var.class == Class::Static {
            universe.place(var).into_iter().for_each(|at| live.insert(at));
        }
    });
}

/// One program's blocks, by what is known of the others so far.
struct Live<'l> {
    all: &'l LiveStatics,
    index: usize,
    program: &'l Program,
}

impl Analysis for Live<'_> {
    type State = BitRow;
    const DIRECTION: Direction = Direction::Backward;

    fn entries(&self, _: &Cfg) -> Vec<(BlockId, BitRow)> {
        self.program.ids().map(|id| (id, self.all.universe.none())).collect()
    }

    fn block(&self, _: BlockId, block: &Block, live: &mut BitRow) {
        self.all.backward(self.index, block, live, &mut |_, _, _| {});
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ir::text::parse;

    /// What is live after the write of static 2 in a subroutine that reads static 1 before, by how it is called.
    fn live_after_write(count: &str) -> Vec<u32> {
        let text = format!(
            "program O1 {{\nblock0:\n static.1 = 5\n call O2{count} -> block1\nblock1:\n end\n}}\n\
             program O2 {{\nblock0:\n common.1 = static.1\n static.2 = 6\n common.2 = static.2\n return\n}}\n"
        );
        let module = parse(&text).unwrap();
        let live = LiveStatics::of(&module);
        let mut found = Vec::new();
        live.each_end(&module.programs[1], 1, &mut |_, block, end| {
            live.backward(1, block, &mut end.clone(), &mut |at, _, after| {
                if at == 1 {
                    found = live.universe().members(after).map(|var| var.number).collect();
                }
            });
        });
        found
    }

    #[test]
    fn what_the_next_run_of_a_repeated_call_reads_is_live_at_its_end() {
        assert_eq!(live_after_write(""), [2]);
        assert_eq!(live_after_write(" times 1"), [2]);
        assert_eq!(live_after_write(" times 3"), [1, 2]);
        assert_eq!(live_after_write(" times common.3"), [1, 2]);
    }
}
