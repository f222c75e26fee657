//! Which statements may come while something is in force that another statement began.
//!
//! Over-approximates: what a called program begins and does not end on each way to its return may be in force after the call, what
//! is in force at a call may be in force in all that is called, and only a statement of the same program ends it. So a program
//! that is called again finds what it began itself. Counter-example: an end that a block skip may pass over ends nothing.

use super::block_calls::calls_of;
use crate::canon::{Group, Op};
use crate::ir::analysis::dataflow::{Analysis, Direction, Flow, Lattice, solve};
use crate::ir::analysis::{CallGraph, Cfg, reachable};
use crate::ir::{Block, BlockId, Call, Callee, Module, Program, Stmt, StmtKind, TermKind};
use crate::syntax::ProgramName;
use crate::text::Span;
use std::cell::Cell;
use std::collections::{BTreeMap, BTreeSet};

/// Calls `found` with every statement, by program, that may come after one that `sets` and before one that `ends`.
pub fn behind(
    module: &Module,
    sets: impl Fn(&Stmt) -> bool,
    ends: impl Fn(&Stmt) -> bool,
    found: impl FnMut(usize, &Stmt),
) {
    walk(module, false, sets, ends, found);
}

/// The same, where a program that returns and that nothing in the library calls may be entered with it in force: some program of the
/// library begins it, so its callers may too.
pub fn behind_or_entered(
    module: &Module,
    sets: impl Fn(&Stmt) -> bool,
    ends: impl Fn(&Stmt) -> bool,
    found: impl FnMut(usize, &Stmt),
) {
    walk(module, true, sets, ends, found);
}

/// The places, by program, that may come in another plane than that of X and Y: after a code of another one, and before one of that
/// plane. Machines begin in the plane of X and Y, and programs that stand in a machine leave it.
pub fn in_other_planes(module: &Module) -> BTreeSet<(usize, Span)> {
    let has = |stmt: &Stmt, is: &dyn Fn(Op) -> bool| stmt.kind.nc().is_some_and(|nc| nc.ops().any(is));
    let sets = |stmt: &Stmt| has(stmt, &|op| op.group() == Group::Plane && op != Op::PlaneXy);
    // One that is skipped ends nothing.
    let ends = |stmt: &Stmt| stmt.site.skip.is_none() && has(stmt, &|op| op == Op::PlaneXy);
    let mut found = BTreeSet::new();
    behind_or_entered(module, sets, ends, |index, stmt| {
        found.insert((index, stmt.site.span));
    });
    found
}

fn walk(
    module: &Module,
    entered: bool,
    sets: impl Fn(&Stmt) -> bool,
    ends: impl Fn(&Stmt) -> bool,
    mut found: impl FnMut(usize, &Stmt),
) {
    let library = Library::of(module, &sets);
    if !library.any {
        return;
    }
    let step = |stmt: &Stmt, on: bool| {
        let modal = match &stmt.kind {
            StmtKind::ModalCall(call) => library.begins(call),
            _ => false,
        };
        sets(stmt) || modal || (on && !(ends(stmt) && stmt.site.skip.is_none()))
    };
    library.settle(module, &step);
    let entries = library.entries(module, entered, &step);
    for (index, program) in module.programs.iter().enumerate() {
        let starts = library.starts(index, program, entries[index], &step);
        for (block, mut on) in program.blocks.iter().zip(starts) {
            for stmt in &block.stmts {
                if on {
                    found(index, stmt);
                }
                on = step(stmt, on);
            }
        }
    }
}

/// What the programs of a library begin, and which of them a call runs.
struct Library<'m> {
    /// True where some program begins it.
    any: bool,
    /// By program, whether it or what it calls begins it.
    within: Vec<bool>,
    /// By program, whether it may return with it in force where it was entered without.
    leaves: Vec<Cell<bool>>,
    /// Programs by name.
    named: BTreeMap<&'m ProgramName, Vec<usize>>,
}

impl<'m> Library<'m> {
    fn of(module: &'m Module, sets: &dyn Fn(&Stmt) -> bool) -> Self {
        let stmts = |program: &'m Program| program.blocks.iter().flat_map(|block| &block.stmts);
        let within: Vec<bool> = module.programs.iter().map(|program| stmts(program).any(sets)).collect();
        let mut named: BTreeMap<&ProgramName, Vec<usize>> = BTreeMap::new();
        for (index, program) in module.programs.iter().enumerate() {
            program.name.iter().for_each(|name| named.entry(name).or_default().push(index));
        }
        let any = within.contains(&true);
        let leaves = vec![Cell::new(false); within.len()];
        let mut library = Self { any, within, leaves, named };
        if any {
            library.close(module);
        }
        library
    }

    /// Finds what programs begin through their calls.
    fn close(&mut self, module: &Module) {
        let mut callees = vec![BTreeSet::new(); module.programs.len()];
        for (index, program) in module.programs.iter().enumerate() {
            for call in program.blocks.iter().flat_map(calls_of) {
                match self.callees(call) {
                    Callees::Own => {}
                    Callees::Any | Callees::Outside => self.within[index] = true,
                    Callees::These(these) => callees[index].extend(these.iter().map(|at| (*at, false))),
                }
            }
            let chained = program.blocks.iter().flat_map(|block| self.chained(block));
            callees[index].extend(chained.map(|at| (*at, false)));
        }
        CallGraph::new(callees).bottom_up(&mut self.within, |mine, callee, _| mine.join(callee));
    }

    /// Finds which programs return with it in force: more and more of them, until none is new.
    fn settle(&self, module: &Module, step: &dyn Fn(&Stmt, bool) -> bool) {
        let leaves = |index: usize, program: &Program| {
            let starts = self.starts(index, program, false, step);
            let mut ends =
                program.blocks.iter().zip(starts).filter(|(block, _)| may_return(&block.term.kind));
            ends.any(|(block, start)| {
                let chained = self.chained(block).iter().any(|next| self.leaves[*next].get());
                chained || block.stmts.iter().fold(start, |on, stmt| step(stmt, on))
            })
        };
        let mut is_new = true;
        while std::mem::take(&mut is_new) {
            for (index, program) in module.programs.iter().enumerate() {
                if self.within[index] && !self.leaves[index].get() && leaves(index, program) {
                    self.leaves[index].set(true);
                    is_new = true;
                }
            }
        }
    }

    /// The programs that a block goes on in for good.
    fn chained(&self, block: &Block) -> &[usize] {
        match &block.term.kind {
            TermKind::Chain(name) => self.named.get(name).map_or(&[], Vec::as_slice),
            _ => &[],
        }
    }

    fn callees(&self, call: &Call) -> Callees<'_> {
        match &call.callee {
            Callee::Block(_) => Callees::Own,
            // Any program may be meant.
            Callee::Computed(_) => Callees::Any,
            Callee::Cycle(_) => Callees::Outside,
            Callee::Program(name) => Callees::These(self.named.get(name).map_or(&[], Vec::as_slice)),
        }
    }

    /// The programs that some call or end of another names.
    fn called(&self, module: &Module) -> BTreeSet<usize> {
        let blocks = || module.programs.iter().flat_map(|program| &program.blocks);
        let named = blocks().flat_map(calls_of).flat_map(|call| match self.callees(call) {
            Callees::These(these) => these,
            Callees::Own | Callees::Any | Callees::Outside => &[],
        });
        named.chain(blocks().flat_map(|block| self.chained(block))).copied().collect()
    }

    /// True where something that a call runs may leave it in force. Of a subroutine of the same program its blocks tell.
    fn begins(&self, call: &Call) -> bool {
        match self.callees(call) {
            Callees::Own => false,
            Callees::Any => self.leaves.iter().any(Cell::get),
            Callees::Outside => self.any,
            Callees::These(callees) => callees.iter().any(|callee| self.leaves[*callee].get()),
        }
    }

    /// By program, whether it may be in force where it is called.
    fn entries(&self, module: &Module, entered: bool, step: &dyn Fn(&Stmt, bool) -> bool) -> Vec<bool> {
        let count = module.programs.len();
        let mut entries = Flow::new(count);
        let called = if entered { self.called(module) } else { BTreeSet::new() };
        // Each program comes twice at the most: as it is, and where it is entered so.
        for (index, program) in module.programs.iter().enumerate() {
            entries.flow(index, &(entered && returns(program) && !called.contains(&index)));
        }
        while let Some(index) = entries.pop() {
            let Some(program) = module.programs.get(index) else { continue };
            let before = entries.state(index).copied().unwrap_or_default();
            let starts = self.starts(index, program, before, step);
            let mut enter = |callee: usize| {
                entries.flow(callee, &true);
            };
            for (block, start) in program.blocks.iter().zip(starts) {
                let on = block.stmts.iter().fold(start, |on, stmt| step(stmt, on));
                self.chained(block).iter().copied().filter(|_| on).for_each(&mut enter);
                for call in calls_of(block) {
                    let last =
                        matches!(&block.term.kind, TermKind::Call { call: last, .. } if **last == *call);
                    // A modal call runs at moves to come, and a repeat is entered from the one before it.
                    let again = !last || call.count.is_some() && self.begins(call);
                    if !(on || again && self.any) {
                        continue;
                    }
                    match self.callees(call) {
                        Callees::Own | Callees::Outside => {}
                        // One that ends the run is no subprogram.
                        Callees::Any => {
                            let sub = |at: &usize| returns(&module.programs[*at]);
                            (0..count).filter(sub).for_each(&mut enter);
                        }
                        Callees::These(callees) => callees.iter().copied().for_each(&mut enter),
                    }
                }
            }
        }
        entries.into_states().into_iter().map(Option::unwrap_or_default).collect()
    }

    /// By block, whether it may be in force at its start; `before`: at the start of the program.
    fn starts(
        &self,
        index: usize,
        program: &Program,
        before: bool,
        step: &dyn Fn(&Stmt, bool) -> bool,
    ) -> Vec<bool> {
        let within = self.within[index];
        if !before && !within {
            return vec![false; program.blocks.len()];
        }
        let starts = solve(&InForce { library: self, within, before, step }, program, &Cfg::of(program));
        program.ids().map(|id| starts.at(id).copied().unwrap_or_default()).collect()
    }
}

/// What the blocks of a program do to whether it is in force.
struct InForce<'a, 'm> {
    library: &'a Library<'m>,
    /// True where the program, or what it calls, begins it.
    within: bool,
    /// True where it may be in force at the start of the program.
    before: bool,
    step: &'a dyn Fn(&Stmt, bool) -> bool,
}

impl Analysis for InForce<'_, '_> {
    type State = bool;
    const DIRECTION: Direction = Direction::Forward;

    fn entries(&self, cfg: &Cfg) -> Vec<(BlockId, bool)> {
        // A subroutine is entered from wherever it is called.
        let entered = |root: BlockId| self.before || self.within && root != BlockId(0);
        let roots = cfg.roots().iter().map(|root| (*root, entered(*root)));
        // What no way leads to counts too.
        (0..cfg.len() as u32).map(|id| (BlockId(id), false)).chain(roots).collect()
    }

    fn block(&self, _: BlockId, block: &Block, on: &mut bool) {
        let library = self.library;
        let called =
            |call: &Call| library.begins(call) || self.within && matches!(call.callee, Callee::Block(_));
        *on = block.stmts.iter().fold(*on, |on, stmt| (self.step)(stmt, on)) || calls_of(block).any(called);
    }
}

/// What a call may run.
enum Callees<'a> {
    /// A subroutine of the program itself.
    Own,
    /// Any program.
    Any,
    /// What stands outside the library, which may begin anything.
    Outside,
    /// These programs.
    These(&'a [usize]),
}

/// True for the end of a block from which control may go back to a caller.
fn may_return(kind: &TermKind) -> bool {
    !matches!(
        kind,
        TermKind::Jump(_)
            | TermKind::Branch { .. }
            | TermKind::Computed { .. }
            | TermKind::Call { .. }
            | TermKind::End { .. }
    )
}

/// True for a program that may return to a caller, and not from a subroutine of its own alone.
fn returns(program: &Program) -> bool {
    let own = reachable(program, BlockId(0)).into_iter().filter_map(|id| program.block(id));
    own.into_iter().any(|block| matches!(block.term.kind, TermKind::Return { .. }))
}
