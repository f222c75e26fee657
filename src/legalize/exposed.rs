//! Which shared variables a program may read before anything in it, or in what it calls, wrote them.

use super::calls_of;
use crate::ir::analysis::{CallGraph, Row, Universe, VarSet};
use crate::ir::{Block, BlockId, Call, Callee, Expr, Module, Place, Program, Stmt, StmtKind, TermKind, Var};
use crate::syntax::ProgramName;
use std::collections::{BTreeMap, BTreeSet};

/// A routine: a program entered at a block.
type Routine = (usize, BlockId);

/// The exposed variables of every routine of a library.
///
/// A backward analysis over all programs until nothing changes. A callee that is called at least once takes
/// off what every way through it writes; one outside the library adds nothing, because a diagnostic of
/// its own speaks of it. A computed call may run any program. The sets may be too large, never too small.
pub struct Exposed {
    universe: Universe,
    /// What is live where a routine is entered.
    entries: BTreeMap<Routine, Row>,
}

impl Exposed {
    /// Analyses a library.
    pub fn of(module: &Module) -> Self {
        Self::among(module, universe(module))
    }

    /// As [`Exposed::of`], of some variables only.
    pub fn among(module: &Module, universe: Universe) -> Self {
        let callees = Callees::of(module);
        let written = Written::of(module, &callees, &universe);
        let (none, everything) = (universe.none(), universe.all());
        let own = (0..module.programs.len()).map(|index| (index, BlockId(0)));
        let routines = written.0.keys().copied().chain(own);
        let mut entries: BTreeMap<Routine, Row> = routines.map(|routine| (routine, none.clone())).collect();
        // Live at the start of each block of one program: what a library of them would take stays small.
        let mut live_in: Vec<Row> = Vec::new();
        callees.graph(module).settle(|index| {
            let program = &module.programs[index];
            let transfer = |block| Transfer::of(block, &universe, |call| callees.called(index, call));
            let transfers: Vec<Transfer> = program.blocks.iter().map(transfer).collect();
            let mut anywhere = none.clone();
            if transfers.iter().any(Transfer::calls_any) {
                let starts = entries.iter().filter(|((_, entry), _)| *entry == BlockId(0));
                starts.for_each(|(_, row)| {
                    anywhere.join(row);
                });
            }
            live_in.clear();
            live_in.resize(program.blocks.len(), none.clone());
            let own = || (index, BlockId(0))..(index + 1, BlockId(0));
            for (routine, row) in entries.range(own()) {
                live_in.get_mut(routine.1.index()).into_iter().for_each(|live| live.clone_from(row));
            }
            let back = seen_before(program);
            let mut changed = true;
            let mut live = none.clone();
            while std::mem::take(&mut changed) {
                for (at, block) in program.blocks.iter().enumerate().rev() {
                    let Transfer { reads, passes, called: callee, modal } = &transfers[at];
                    live.clone_from(&none);
                    for to in block.term.kind.successors() {
                        live.join(live_in.get(to.index()).unwrap_or(&none));
                    }
                    if let Some(Called::One(routine)) = callee
                        && let Some(sure) = written.by_end(*routine, block)
                    {
                        live.subtract(sure);
                    }
                    let called = |live: &mut Row, callee: Called, passes: &Row| {
                        let mut there = match callee {
                            Called::Any => &anywhere,
                            Called::One(routine) => {
                                let own = live_in.get(routine.1.index()).filter(|_| routine.0 == index);
                                own.or_else(|| entries.get(&routine)).unwrap_or(&none)
                            }
                        }
                        .clone();
                        there.intersect(passes);
                        live.join(&there);
                    };
                    callee.iter().for_each(|callee| called(&mut live, *callee, &everything));
                    live.intersect(passes);
                    live.join(reads);
                    // It runs at moves behind it, before what is written later.
                    modal.iter().for_each(|(callee, passes)| called(&mut live, *callee, passes));
                    changed |= live_in[at].join(&live) && back[at];
                }
            }
            let mut any = false;
            for (routine, row) in entries.range_mut(own()) {
                any |= live_in.get(routine.1.index()).is_some_and(|live| row.join(live));
            }
            any
        });
        Self { universe, entries }
    }

    /// True where a variable is exposed at the entry of a program.
    pub fn is_at_entry(&self, program: usize, var: Var) -> bool {
        let row = self.entries.get(&(program, BlockId(0)));
        row.is_some_and(|row| self.universe.place(var).is_some_and(|at| row.has(at)))
    }

    /// What is exposed at the entry of a program.
    pub fn at_entry(&self, program: usize) -> BTreeSet<Var> {
        let row = self.entries.get(&(program, BlockId(0)));
        row.into_iter().flat_map(|row| self.universe.members(row)).collect()
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
struct Callees<'m>(BTreeMap<&'m ProgramName, usize>);

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

/// What every way through a called routine writes; absent while no way through it is known.
struct Written(BTreeMap<Routine, Option<Row>>);

impl Written {
    fn of(module: &Module, callees: &Callees<'_>, universe: &Universe) -> Self {
        let mut written = Self(BTreeMap::new());
        for (index, program) in module.programs.iter().enumerate() {
            for call in program.blocks.iter().flat_map(calls_of) {
                if let Some(routine) = callees.routine(index, call) {
                    written.0.insert(routine, None);
                }
            }
        }
        // From "all variables" down: each round can only take variables away.
        callees.graph(module).settle(|index| {
            let own = (index, BlockId(0))..(index + 1, BlockId(0));
            let routines: Vec<Routine> = written.0.range(own).map(|(routine, _)| *routine).collect();
            let mut any = false;
            let mut changed = true;
            while std::mem::take(&mut changed) {
                for &routine in &routines {
                    let now = written.through(module, routine, callees, universe);
                    if written.0.get(&routine) != Some(&now) {
                        written.0.insert(routine, now);
                        changed = true;
                    }
                }
                any |= changed;
            }
            any
        });
        written
    }

    /// What is surely written when a call at the end of a block comes back.
    fn by_end(&self, routine: Routine, block: &Block) -> Option<&Row> {
        match &block.term.kind {
            TermKind::Call { call, .. } if runs(call) => self.0.get(&routine)?.as_ref(),
            _ => None,
        }
    }

    fn through(
        &self,
        module: &Module,
        routine: Routine,
        callees: &Callees<'_>,
        universe: &Universe,
    ) -> Option<Row> {
        let program = module.programs.get(routine.0)?;
        let mut at_start: BTreeMap<BlockId, Row> = BTreeMap::from([(routine.1, universe.none())]);
        let mut work = vec![routine.1];
        let mut result: Option<Row> = None;
        while let Some(id) = work.pop() {
            let (Some(block), Some(before)) = (program.block(id), at_start.get(&id)) else { continue };
            let mut after = before.clone();
            for stmt in block.stmts.iter().filter(|stmt| stmt.site.skip.is_none()) {
                if let Some(Place::Var(var)) = stmt.kind.target() {
                    universe.place(*var).iter().for_each(|at| after.insert(*at));
                }
            }
            if let TermKind::Call { call, .. } = &block.term.kind
                && let Some(callee) = callees.routine(routine.0, call).filter(|_| runs(call))
            {
                match self.0.get(&callee) {
                    // It is not known to come back so far.
                    Some(None) => continue,
                    Some(Some(sure)) => {
                        after.join(sure);
                    }
                    None => {}
                }
            }
            if let TermKind::Return { .. } = block.term.kind {
                match &mut result {
                    None => result = Some(after.clone()),
                    Some(so_far) => so_far.intersect(&after),
                }
            }
            for to in block.term.kind.successors() {
                match at_start.get_mut(&to) {
                    None => drop(at_start.insert(to, after.clone())),
                    Some(known) => {
                        let mut both = known.clone();
                        both.intersect(&after);
                        if both == *known {
                            continue;
                        }
                        *known = both;
                    }
                }
                work.push(to);
            }
        }
        result
    }
}

/// True where the call surely runs its callee, and once at least.
fn runs(call: &Call) -> bool {
    call.count.as_ref().is_none_or(|count| count.constant().is_some_and(|n| n >= 1.0))
}

/// By block: true where what is live at its start says something of a block that stands behind it or of itself.
fn seen_before(program: &Program) -> Vec<bool> {
    let mut seen = vec![false; program.blocks.len()];
    let mut note = |to: BlockId| seen.get_mut(to.index()).into_iter().for_each(|seen| *seen = true);
    for (at, block) in program.blocks.iter().enumerate() {
        block.term.kind.successors().into_iter().filter(|to| to.index() <= at).for_each(&mut note);
        calls_of(block).for_each(|call| match &call.callee {
            Callee::Block(entry) => note(*entry),
            // It may be the program itself.
            Callee::Program(name) if program.name.as_ref() == Some(name) => note(BlockId(0)),
            _ => {}
        });
    }
    seen
}

/// What a block makes of what is live behind it.
struct Transfer {
    /// What it makes of nothing.
    reads: Row,
    /// What it makes of everything.
    passes: Row,
    /// What its end calls.
    called: Option<Called>,
    /// The modal calls that it starts, and what the statements before each make of everything.
    modal: Vec<(Called, Row)>,
}

impl Transfer {
    fn calls_any(&self) -> bool {
        let all = self.called.iter().chain(self.modal.iter().map(|(callee, _)| callee));
        all.into_iter().any(|callee| matches!(callee, Called::Any))
    }

    fn of(block: &Block, universe: &Universe, callee: impl Fn(&Call) -> Option<Called>) -> Self {
        let mut rows = [universe.none(), universe.all()];
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

fn note(e: &Expr, rows: &mut [Row], universe: &Universe) {
    read(e, &mut |var| {
        if let Some(at) = universe.place(var) {
            rows.iter_mut().for_each(|row| row.insert(at));
        }
    });
}

fn backward(stmts: &[Stmt], rows: &mut [Row], universe: &Universe) {
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
    let mut called: BTreeSet<&ProgramName> = BTreeSet::new();
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
