//! Which shared variables a program may read before anything in it, or in what it calls, wrote them.

use super::calls_of;
use crate::ir::{Block, BlockId, Call, Callee, Expr, Module, Place, StmtKind, TermKind, Var};
use crate::syntax::ProgramName;
use std::collections::{BTreeMap, BTreeSet};

type Set = BTreeSet<Var>;

/// A routine: a program entered at a block.
type Routine = (usize, BlockId);

/// The exposed variables of every routine of a library.
///
/// A backward analysis over all programs until nothing changes. A callee that is called at least once takes
/// off what every way through it writes; one outside the library adds nothing, because a diagnostic of
/// its own speaks of it. The sets may be too large, never too small.
pub struct Exposed {
    live_in: Vec<Vec<Set>>,
}

impl Exposed {
    /// Analyses a library.
    pub fn of(module: &Module) -> Self {
        let callees = Callees::of(module);
        let written = Written::of(module, &callees);
        let mut live_in: Vec<Vec<Set>> =
            module.programs.iter().map(|p| vec![Set::new(); p.blocks.len()]).collect();
        let mut changed = true;
        while changed {
            changed = false;
            for (index, program) in module.programs.iter().enumerate() {
                for (at, block) in program.blocks.iter().enumerate().rev() {
                    let mut live = Set::new();
                    for to in block.term.kind.successors() {
                        live.extend(live_in[index].get(to.index()).into_iter().flatten());
                    }
                    if let Some(sure) = written.by_end(index, block, &callees) {
                        live.retain(|var| !sure.contains(var));
                    }
                    for (i, entry) in calls_of(block).filter_map(|call| callees.routine(index, call)) {
                        live.extend(live_in[i].get(entry.index()).into_iter().flatten());
                    }
                    backward(block, &mut live);
                    if live != live_in[index][at] {
                        live_in[index][at] = live;
                        changed = true;
                    }
                }
            }
        }
        Self { live_in }
    }

    /// What is exposed at the entry of a program.
    pub fn at_entry(&self, program: usize) -> &Set {
        static NONE: Set = Set::new();
        self.live_in.get(program).and_then(|p| p.first()).unwrap_or(&NONE)
    }
}

/// Which routine a call runs.
struct Callees<'m>(BTreeMap<&'m ProgramName, usize>);

impl<'m> Callees<'m> {
    fn of(module: &'m Module) -> Self {
        let named = module.programs.iter().enumerate().rev();
        Self(named.filter_map(|(i, p)| Some((p.name.as_ref()?, i))).collect())
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
struct Written(BTreeMap<Routine, Option<Set>>);

impl Written {
    fn of(module: &Module, callees: &Callees<'_>) -> Self {
        let mut written = Self(BTreeMap::new());
        for (index, program) in module.programs.iter().enumerate() {
            for call in program.blocks.iter().flat_map(calls_of) {
                if let Some(routine) = callees.routine(index, call) {
                    written.0.insert(routine, None);
                }
            }
        }
        // From "all variables" down: each round can only take variables away.
        let routines: Vec<Routine> = written.0.keys().copied().collect();
        let mut changed = true;
        while changed {
            changed = false;
            for &routine in &routines {
                let now = written.through(module, routine, callees);
                if written.0.get(&routine) != Some(&now) {
                    written.0.insert(routine, now);
                    changed = true;
                }
            }
        }
        written
    }

    /// What is surely written when a call at the end of a block comes back.
    fn by_end(&self, program: usize, block: &Block, callees: &Callees<'_>) -> Option<&Set> {
        match &block.term.kind {
            TermKind::Call { call, .. } if runs(call) => {
                self.0.get(&callees.routine(program, call)?)?.as_ref()
            }
            _ => None,
        }
    }

    fn through(&self, module: &Module, routine: Routine, callees: &Callees<'_>) -> Option<Set> {
        let program = module.programs.get(routine.0)?;
        let mut at_start: BTreeMap<BlockId, Set> = BTreeMap::from([(routine.1, Set::new())]);
        let mut work = vec![routine.1];
        let mut result: Option<Set> = None;
        while let Some(id) = work.pop() {
            let (Some(block), Some(before)) = (program.block(id), at_start.get(&id)) else { continue };
            let mut after = before.clone();
            for stmt in block.stmts.iter().filter(|stmt| stmt.site.skip.is_none()) {
                if let Some(Place::Var(var)) = stmt.kind.target() {
                    after.insert(*var);
                }
            }
            if let TermKind::Call { call, .. } = &block.term.kind
                && let Some(callee) = callees.routine(routine.0, call).filter(|_| runs(call))
            {
                match self.0.get(&callee) {
                    // It is not known to come back so far.
                    Some(None) => continue,
                    Some(Some(sure)) => after.extend(sure.iter().copied()),
                    None => {}
                }
            }
            if let TermKind::Return { .. } = block.term.kind {
                result = Some(result.map_or_else(|| after.clone(), |so_far| &so_far & &after));
            }
            for to in block.term.kind.successors() {
                match at_start.get_mut(&to) {
                    None => drop(at_start.insert(to, after.clone())),
                    Some(known) => {
                        let both = &*known & &after;
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

fn backward(block: &Block, live: &mut Set) {
    if !matches!(block.term.kind, TermKind::Jump(_)) {
        block.term.kind.exprs(&mut |e| read(e, live));
    }
    for stmt in block.stmts.iter().rev() {
        if let Some(Place::Var(var)) = stmt.kind.target()
            && stmt.site.skip.is_none()
        {
            live.remove(var);
        }
        if let StmtKind::ClearAll(class) = &stmt.kind {
            live.retain(|var| var.class != *class);
        }
        stmt.kind.exprs(&mut |e| read(e, live));
    }
}

fn read(e: &Expr, live: &mut Set) {
    e.walk(&mut |e| {
        if let Expr::Var(var) = e
            && var.class.shared()
        {
            live.insert(*var);
        }
    });
}

/// The programs that nothing in the library calls: where runs begin, or where callers outside it call.
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
    let root = |p: &crate::ir::Program| p.name.as_ref().is_none_or(|name| !called.contains(name));
    module.programs.iter().enumerate().filter(|(_, p)| root(p)).map(|(i, _)| i).collect()
}
