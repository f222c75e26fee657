//! Which shared variables a program may read before anything in it, or in what it calls, wrote them.

mod written;

use super::block_calls::calls_of;
use crate::ir::analysis::dataflow::{Analysis, Direction, solve};
use crate::ir::analysis::{BitRow, CallGraph, Cfg, Universe, VarSet};
use crate::ir::{Block, BlockId, Call, Callee, Expr, Module, Place, Program, Stmt, StmtKind, TermKind, Var};
use crate::syntax::ProgramName;
use foldhash::{HashMap, HashSet};
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use written::Written;

/// A routine: a program entered at a block.
type Routine = (usize, BlockId);

/// The exposed variables of every routine of a library.
///
/// A backward analysis over all programs until nothing changes. A callee that is called at least once takes
/// off what every way through it writes; one outside the library adds nothing, because a diagnostic of
/// its own speaks of it. A computed call may run any program. The sets may be too large, never too small.
pub struct UpwardExposed {
    universe: Universe,
    /// What is live where a routine is entered.
    entries: BTreeMap<Routine, BitRow>,
}

impl UpwardExposed {
    /// Analyses a library.
    pub fn of(module: &Module) -> Self {
        Self::among(module, universe(module))
    }

    /// As [`UpwardExposed::of`], of some variables only.
    pub fn among(module: &Module, universe: Universe) -> Self {
        let callees = Callees::of(module);
        let written = Written::of(module, &callees, &universe);
        let (none, everything) = (universe.none(), universe.all());
        let own = (0..module.programs.len()).map(|index| (index, BlockId(0)));
        let routines = written.routines().chain(own);
        let mut entries: BTreeMap<Routine, BitRow> =
            routines.map(|routine| (routine, none.clone())).collect();
        callees.graph(module).fixpoint(|index| {
            let program = &module.programs[index];
            let rows = [&none, &everything];
            let transfer = |block| Transfer::of(block, rows, &universe, |call| callees.called(index, call));
            let transfers: Vec<Transfer> = program.blocks.iter().map(transfer).collect();
            let mut anywhere = none.clone();
            if transfers.iter().any(Transfer::calls_any) {
                let starts = entries.iter().filter(|((_, entry), _)| *entry == BlockId(0));
                starts.for_each(|(_, row)| {
                    anywhere.join(row);
                });
            }
            // What each block has at its end of a library of them would take much: one program's are kept at a time.
            let live = Live {
                program,
                transfers: &transfers,
                entries: &entries,
                anywhere,
                written: &written,
                none: &none,
            };
            let ends = solve(&live, program, &Cfg::of(program));
            let own = || (index, BlockId(0))..(index + 1, BlockId(0));
            let found: Vec<BitRow> = (entries.range(own()))
                .map(|((_, id), _)| {
                    let mut start = ends.at(*id).unwrap_or(&none).clone();
                    program.block(*id).iter().for_each(|block| live.block(*id, block, &mut start));
                    start
                })
                .collect();
            let rows = entries.range_mut(own()).zip(&found);
            rows.fold(false, |changed, ((_, row), live)| row.join(live) || changed)
        });
        Self { universe, entries }
    }

    /// Tells of variables whether they are exposed at the entry of a program.
    pub fn at_entry_of(&self, program: usize) -> impl Fn(Var) -> bool {
        let row = self.entries.get(&(program, BlockId(0)));
        move |var| row.is_some_and(|row| self.universe.place(var).is_some_and(|at| row.has(at)))
    }

    /// What is exposed at the entry of a program.
    pub fn at_entry(&self, program: usize) -> BTreeSet<Var> {
        let row = self.entries.get(&(program, BlockId(0)));
        row.into_iter().flat_map(|row| self.universe.members(row)).collect()
    }
}

/// What is live at the end of each block of a program, where its calls enter what is known to be live there so far.
struct Live<'l> {
    program: &'l Program,
    transfers: &'l [Transfer],
    entries: &'l BTreeMap<Routine, BitRow>,
    /// What is live where any program is entered.
    anywhere: BitRow,
    written: &'l Written,
    none: &'l BitRow,
}

impl Live<'_> {
    fn called(&self, callee: Called) -> Option<&BitRow> {
        match callee {
            Called::Any => Some(&self.anywhere),
            Called::One(routine) => self.entries.get(&routine),
        }
    }
}

impl Analysis for Live<'_> {
    type State = BitRow;
    const DIRECTION: Direction = Direction::Backward;
    const AS_THEY_STAND: bool = true;

    fn entries(&self, _: &Cfg) -> Vec<(BlockId, BitRow)> {
        self.program.ids().map(|id| (id, self.none.clone())).collect()
    }

    fn block(&self, id: BlockId, _: &Block, live: &mut BitRow) {
        let Some(Transfer { reads, passes, called, modal }) = self.transfers.get(id.index()) else { return };
        called.iter().filter_map(|callee| self.called(*callee)).for_each(|there| {
            live.join(there);
        });
        live.intersect(passes);
        live.join(reads);
        // It runs at moves after it, before what is written later.
        for (callee, passes) in modal {
            let mut there = self.called(*callee).cloned().unwrap_or_default();
            there.intersect(passes);
            live.join(&there);
        }
    }

    /// What a call surely writes is not live before it for what comes after it.
    fn edge<'s>(&self, from: BlockId, _: BlockId, live: &'s BitRow) -> Option<Cow<'s, BitRow>> {
        let called = self.transfers.get(from.index()).and_then(|transfer| transfer.called);
        let sure = match (called, self.program.block(from)) {
            (Some(Called::One(routine)), Some(block)) => self.written.by_end(routine, block),
            _ => None,
        };
        let Some(sure) = sure else { return Some(Cow::Borrowed(live)) };
        let mut live = live.clone();
        live.subtract(sure);
        Some(Cow::Owned(live))
    }
}

/// The shared variables that programs read.
fn universe(module: &Module) -> Universe {
    let mut all = VarSet::default();
    for block in module.programs.iter().flat_map(|program| &program.blocks) {
        let mut note = |e: &Expr| {
            read(e, &mut |var| {
                all.insert(var);
            })
        };
        block.stmts.iter().for_each(|stmt| stmt.kind.exprs(&mut note));
        block.term.kind.exprs(&mut note);
    }
    Universe::new(all.iter().collect())
}

/// What a call runs.
#[derive(Clone, Copy)]
enum Called {
    One(Routine),
    /// Whichever program has a computed number.
    Any,
}

/// Which routine a call runs.
struct Callees<'m>(HashMap<&'m ProgramName, usize>);

impl<'m> Callees<'m> {
    fn of(module: &'m Module) -> Self {
        let named = module.programs.iter().enumerate().rev();
        Self(named.filter_map(|(i, p)| Some((p.name.as_ref()?, i))).collect())
    }

    /// Which program calls which.
    fn graph(&self, module: &Module) -> CallGraph {
        let of = |(index, program): (usize, &Program)| {
            let calls = || program.blocks.iter().flat_map(calls_of);
            if calls().any(|call| matches!(call.callee, Callee::Computed(_))) {
                return (0..module.programs.len()).map(|callee| (callee, false)).collect();
            }
            let routines = calls().filter_map(|call| self.routine(index, call));
            routines.map(|(callee, _)| (callee, false)).collect()
        };
        CallGraph::new(module.programs.iter().enumerate().map(of).collect())
    }

    fn called(&self, program: usize, call: &Call) -> Option<Called> {
        match &call.callee {
            Callee::Computed(_) => Some(Called::Any),
            _ => self.routine(program, call).map(Called::One),
        }
    }

    fn routine(&self, program: usize, call: &Call) -> Option<Routine> {
        match &call.callee {
            Callee::Program(name) => self.0.get(name).map(|&i| (i, BlockId(0))),
            Callee::Block(entry) => Some((program, *entry)),
            _ => None,
        }
    }
}

/// What a block makes of what is live after it.
struct Transfer {
    /// What it makes of nothing.
    reads: BitRow,
    /// What it makes of everything.
    passes: BitRow,
    /// What its end calls.
    called: Option<Called>,
    /// The modal calls that it starts, and what the statements before each make of everything.
    modal: Vec<(Called, BitRow)>,
}

impl Transfer {
    fn calls_any(&self) -> bool {
        let all = self.called.iter().chain(self.modal.iter().map(|(callee, _)| callee));
        all.into_iter().any(|callee| matches!(callee, Called::Any))
    }

    /// `rows` are none of the variables, and all.
    fn of(
        block: &Block,
        rows: [&BitRow; 2],
        universe: &Universe,
        callee: impl Fn(&Call) -> Option<Called>,
    ) -> Self {
        let mut rows = rows.map(Clone::clone);
        block.term.kind.exprs(&mut |e| note(e, &mut rows, universe));
        backward(&block.stmts, &mut rows, universe);
        let modal = block.stmts.iter().enumerate().filter_map(|(at, stmt)| {
            let StmtKind::ModalCall(call) = &stmt.kind else { return None };
            let mut before = [universe.all()];
            backward(&block.stmts[..at], &mut before, universe);
            let [before] = before;
            Some((callee(call)?, before))
        });
        let modal = modal.collect();
        let called = match &block.term.kind {
            TermKind::Call { call, .. } => callee(call),
            _ => None,
        };
        let [reads, passes] = rows;
        Self { reads, passes, called, modal }
    }
}

fn note(e: &Expr, rows: &mut [BitRow], universe: &Universe) {
    read(e, &mut |var| {
        if let Some(at) = universe.place(var) {
            rows.iter_mut().for_each(|row| row.insert(at));
        }
    });
}

fn backward(stmts: &[Stmt], rows: &mut [BitRow], universe: &Universe) {
    for stmt in stmts.iter().rev() {
        if let Some(Place::Var(var)) = stmt.kind.target()
            && stmt.site.skip.is_none()
            && let Some(at) = universe.place(*var)
        {
            rows.iter_mut().for_each(|row| row.remove(at));
        }
        if let StmtKind::ClearAll(class) = &stmt.kind {
            let cleared = universe.classes(|c| c == *class);
            rows.iter_mut().for_each(|row| row.subtract(&cleared));
        }
        stmt.kind.exprs(&mut |e| note(e, rows, universe));
    }
}

fn read(e: &Expr, f: &mut dyn FnMut(Var)) {
    e.variables(&mut |var| {
        if var.class.shared() {
            f(var);
        }
    });
}

/// The programs that nothing in the library calls by name: where runs begin, or where callers outside it call. One that
/// computed calls run is begun by itself too.
pub fn roots(module: &Module) -> Vec<usize> {
    let mut called: HashSet<&ProgramName> = HashSet::default();
    for program in &module.programs {
        for block in &program.blocks {
            for call in calls_of(block) {
                if let Callee::Program(name) = &call.callee {
                    called.insert(name);
                }
            }
            if let TermKind::Chain(name) = &block.term.kind {
                called.insert(name);
            }
        }
    }
    let root = |p: &Program| p.name.as_ref().is_none_or(|name| !called.contains(name));
    module.programs.iter().enumerate().filter(|(_, p)| root(p)).map(|(i, _)| i).collect()
}
