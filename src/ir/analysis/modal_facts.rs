//! Which modal operation is in force where, as far as the text of the library says.
//!
//! A forward analysis over all programs at once: the state at a program's entry
//! joins the states at all its calls, and the state after a call is the
//! callee's at its returns; a return to a sequence number goes on there as well. A
//! computed call enters every program that it may be meant for. What a program without a known caller starts in, and what an
//! unknown callee leaves, is not known.

use super::cfg::reachable;
use super::computed_calls::{Callees, computed_calls};
use super::modal::{Modal, calls_of};
use crate::ir::analysis::dataflow::{Flow, Lattice};
use crate::ir::{BlockId, Call, Callee, Expr, Module, Program, Stmt, StmtKind, TermKind};
use crate::syntax::{Label, ProgramName};
use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

/// The modal state at the start of every block of a library.
#[derive(Clone, Debug)]
pub struct ModalFacts {
    /// By block of all programs, one program after the other; none if no path leads. Most blocks change nothing, and
    /// start in one state.
    entries: Vec<Option<Rc<Modal>>>,
    /// By program, the place of its first block; at last, that of the end.
    firsts: Vec<usize>,
}

impl Lattice for Rc<Modal> {
    fn join(&mut self, other: &Self) -> bool {
        if Rc::ptr_eq(self, other) || self == other {
            return false;
        }
        let mut joined = Modal::clone(self);
        let changed = joined.join(&**other);
        if changed {
            *self = if joined == **other { Rc::clone(other) } else { Rc::new(joined) };
        }
        changed
    }
}

impl ModalFacts {
    /// Analyses a library whose runs begin in the state `entry`.
    pub fn of(module: &Module, entry: &Modal) -> Self {
        Analysis::new(module, false).run(entry)
    }

    /// Nothing known anywhere.
    pub fn unknown() -> Self {
        Self { entries: Vec::new(), firsts: Vec::new() }
    }

    /// The same where the macro of a modal call that stands inside another is a copy of its own: then its
    /// program runs only where something else calls it.
    pub fn with_copies(module: &Module, entry: &Modal) -> Self {
        Analysis::new(module, true).run(entry)
    }

    /// The state at the start of a block.
    pub fn at(&self, program: usize, block: BlockId) -> Modal {
        let own = match self.firsts.get(program..) {
            Some([first, end, ..]) => self.entries.get(*first..*end),
            _ => None,
        };
        let entry = own.and_then(|own| own.get(block.index()));
        entry.and_then(Option::as_deref).cloned().unwrap_or_else(Modal::unknown)
    }
}

/// A routine: a program entered at a block.
type Routine = (usize, BlockId);

struct Analysis<'m> {
    module: &'m Module,
    /// True where nested modal calls do not enter the program that they name.
    copies: bool,
    by_name: BTreeMap<&'m ProgramName, usize>,
    computed: BTreeMap<Routine, Callees>,
    /// By block of all programs, one program after the other.
    entries: Flow<Rc<Modal>>,
    /// By program, the place of its first block; at last, that of the end.
    firsts: Vec<usize>,
    exits: BTreeMap<Routine, Modal>,
    /// Call blocks to look at again when a routine's exit changes.
    callers: BTreeMap<Routine, BTreeSet<Routine>>,
    reach: BTreeMap<Routine, BTreeSet<BlockId>>,
}

impl<'m> Analysis<'m> {
    fn new(module: &'m Module, copies: bool) -> Self {
        let mut firsts = vec![0];
        let counts = module.programs.iter().map(|program| program.blocks.len());
        firsts.extend(counts.scan(0, |place, count| {
            *place += count;
            Some(*place)
        }));
        Self {
            module,
            copies,
            by_name: module
                .programs
                .iter()
                .enumerate()
                .filter_map(|(i, p)| Some((p.name.as_ref()?, i)))
                .collect(),
            computed: computed_calls(module),
            entries: Flow::new(firsts.last().copied().unwrap_or_default()),
            firsts,
            exits: BTreeMap::new(),
            callers: BTreeMap::new(),
            reach: BTreeMap::new(),
        }
    }

    fn run(mut self, entry: &Modal) -> ModalFacts {
        let called = self.called_programs();
        let (entry, head) = (&Rc::new(entry.clone()), &Rc::new(entry.at_head()));
        for (index, program) in self.module.programs.iter().enumerate() {
            if !called.contains(&index) && !program.blocks.is_empty() {
                // What stands without a name before the first one may go on with a program that was begun before.
                self.flow(index, BlockId(0), if program.name.is_some() { head } else { entry });
            }
        }
        self.drain();
        // Programs that only call one another: nothing outside says how they start.
        for index in 0..self.module.programs.len() {
            if !self.module.programs[index].blocks.is_empty() && self.state(index, BlockId(0)).is_none() {
                self.flow(index, BlockId(0), entry);
                self.drain();
            }
        }
        ModalFacts { entries: self.entries.into_states(), firsts: self.firsts }
    }

    fn drain(&mut self) {
        while let Some(place) = self.entries.pop() {
            // Programs without blocks begin where the next one does.
            let program = self.firsts.partition_point(|first| *first <= place) - 1;
            self.block(program, BlockId((place - self.firsts[program]) as u32));
        }
    }

    fn state(&self, program: usize, id: BlockId) -> Option<&Rc<Modal>> {
        self.entries.state(self.firsts[program] + id.index())
    }

    fn called_programs(&self) -> BTreeSet<usize> {
        let calls = self.module.programs.iter().flat_map(|p| &p.blocks).flat_map(calls_of);
        let computed = self.computed.values().filter(|callees| callees.known);
        let computed = computed.flat_map(|callees| callees.programs.iter().copied());
        calls.filter_map(|call| self.program_of(&call.callee)).chain(computed).collect()
    }

    fn program_of(&self, callee: &Callee) -> Option<usize> {
        match callee {
            Callee::Program(name) => self.by_name.get(name).copied(),
            _ => None,
        }
    }

    fn flow(&mut self, program: usize, to: BlockId, state: &Rc<Modal>) {
        if self.module.programs[program].block(to).is_some() && !state.is_unreached() {
            self.entries.flow(self.firsts[program] + to.index(), state);
        }
    }

    fn block(&mut self, index: usize, id: BlockId) {
        let Some(block) = self.module.programs[index].block(id) else { return };
        let Some(entry) = self.state(index, id).cloned() else { return };
        let mut state = Rc::clone(&entry);
        for stmt in block.stmts.iter().filter(|stmt| Modal::may_step(stmt)) {
            let nested = state.calls.as_ref().is_some_and(|calls| !calls.is_empty());
            if let StmtKind::ModalCall(call) = &stmt.kind
                && !(self.copies && nested)
            {
                // It runs after moves yet to come, under the modal calls outside its own.
                let inside = Modal::unknown_under(&state);
                self.call(index, id, call, &Rc::new(inside));
            }
            Rc::make_mut(&mut state).step(stmt);
        }
        if !Rc::ptr_eq(&state, &entry) && state == entry {
            state = entry;
        }
        match &block.term.kind {
            TermKind::Call { call, next } => {
                let after = self.call(index, id, call, &state);
                self.flow(index, *next, &after);
            }
            TermKind::Return { to } => self.returned(index, id, to.as_ref(), &state),
            kind => kind.successors().into_iter().for_each(|to| self.flow(index, to, &state)),
        }
    }

    /// Enters a callee and yields the state after the call as known so far.
    fn call(&mut self, index: usize, id: BlockId, call: &Call, state: &Rc<Modal>) -> Rc<Modal> {
        let routine = match (&call.callee, self.program_of(&call.callee)) {
            (Callee::Block(entry), _) => (index, *entry),
            (_, Some(program)) => (program, BlockId(0)),
            (Callee::Computed(_), _) => {
                let callees = self.computed.get(&(index, id)).cloned().unwrap_or_default();
                callees.entered(self.module).for_each(|program| self.flow(program, BlockId(0), state));
                let after = Rc::new(Modal::unknown_under(state));
                if callees.programs.iter().any(|program| comes_back(&self.module.programs[*program])) {
                    self.come_back(index, None, &after);
                }
                return after;
            }
            _ => return Rc::new(Modal::unknown_under(state)),
        };
        if self.callers.entry(routine).or_default().insert((index, id)) {
            // Its returns may have been looked at before anybody was known to call it.
            let program = &self.module.programs[routine.0];
            let body = self.reach.entry(routine).or_insert_with(|| reachable(program, routine.1));
            let (first, entries) = (self.firsts[routine.0], &mut self.entries);
            for place in body.iter().map(|id| first + id.index()) {
                if entries.state(place).is_some() {
                    entries.again(place);
                }
            }
        }
        self.flow(routine.0, routine.1, state);
        let after = Rc::new(self.exits.get(&routine).cloned().unwrap_or_default());
        if call.count.is_some() {
            // Its next run begins in the state that it left.
            self.flow(routine.0, routine.1, &after);
        }
        after
    }

    /// A return leaves every routine that the block belongs to; one to a sequence number goes on there in the callers.
    fn returned(&mut self, index: usize, id: BlockId, to: Option<&Expr>, state: &Rc<Modal>) {
        let own = (index, BlockId(0))..(index + 1, BlockId(0));
        let routines: Vec<Routine> = self.callers.range(own).map(|(routine, _)| *routine).collect();
        for routine in routines {
            let program = &self.module.programs[index];
            let body = self.reach.entry(routine).or_insert_with(|| reachable(program, routine.1));
            if !body.contains(&id) {
                continue;
            }
            if self.exits.entry(routine).or_default().join(state) {
                let callers = self.callers.get(&routine).into_iter().flatten();
                callers.for_each(|(caller, id)| self.entries.again(self.firsts[*caller] + id.index()));
            }
            if let Some(to) = to {
                let callers: BTreeSet<usize> = self.callers[&routine].iter().map(|caller| caller.0).collect();
                callers.into_iter().for_each(|caller| self.come_back(caller, to.constant(), state));
            }
        }
    }

    /// Goes on in a caller at the blocks of a sequence number; of any where it is not known.
    fn come_back(&mut self, caller: usize, number: Option<f64>, state: &Rc<Modal>) {
        let module = self.module;
        let program = &module.programs[caller];
        let is_it = |label: &Label| match label {
            Label::Number(n) => number.is_none_or(|number| number == f64::from(*n)),
            _ => false,
        };
        for (id, _) in program.ids().zip(&program.blocks).filter(|(_, block)| block.labels.iter().any(is_it))
        {
            self.flow(caller, id, state);
        }
    }
}

/// True where a program may return to a sequence number of its caller.
fn comes_back(program: &Program) -> bool {
    program.blocks.iter().any(|block| matches!(block.term.kind, TermKind::Return { to: Some(_) }))
}

/// Puts others in the place of statements. `change` gets the program, the state before a statement, which it has to
/// step, the statement, and where those go that stand for it.
pub fn replace_statements(
    module: &mut Module,
    facts: &ModalFacts,
    mut change: impl FnMut(usize, &mut Modal, Stmt, &mut Vec<Stmt>),
) {
    // Most blocks get as many statements as they had, so that each stays where it is in memory.
    let mut out = Vec::new();
    for (index, program) in module.programs.iter_mut().enumerate() {
        for (at, block) in program.blocks.iter_mut().enumerate() {
            let mut state = facts.at(index, BlockId(at as u32));
            block.stmts.drain(..).for_each(|stmt| change(index, &mut state, stmt, &mut out));
            block.stmts.reserve_exact(out.len());
            block.stmts.append(&mut out);
        }
    }
}
