//! Which modal operation is in force where, as far as the text of the library says.
//!
//! A forward analysis over all programs at once: the state at a program's entry
//! joins the states at all its calls, and the state after a call is the
//! callee's at its returns, but for what the callee does not touch: that is as
//! its caller had it. A return to a sequence number goes on there as well. A
//! computed call enters every program that it may be meant for. What a program starts in that has no known caller or ends the
//! run, and what an unknown callee leaves, is not known.

use super::block_calls::calls_of;
use super::cfg::reachable;
use super::computed_calls::{Callees, computed_calls};
use super::modal::{Modal, Setting};
use super::touches::{Place, Touches, routines};
use crate::canon::Group;
use crate::ir::analysis::dataflow::{Lattice, Routines};
use crate::ir::{
    Block, BlockId, Call, Callee, Expr, Module, NcItem, Program, Stmt, StmtKind, Stmts, TermKind,
};
use crate::syntax::{Label, ProgramName};
use foldhash::HashMap;
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::sync::Arc;

/// The modal state at the start of every block of a library.
#[derive(Clone, Debug)]
pub struct ModalFacts {
    /// By block of all programs, one program after the other; none if no path leads. Most blocks change nothing, and
    /// start in one state.
    entries: Vec<Option<Arc<Modal>>>,
    /// By program, the place of its first block; at last, that of the end.
    firsts: Vec<usize>,
}

impl Lattice for Arc<Modal> {
    fn join(&mut self, other: &Self) -> bool {
        if Arc::ptr_eq(self, other) || self == other {
            return false;
        }
        let mut joined = Modal::clone(self);
        let changed = joined.join(&**other);
        if changed {
            *self = if joined == **other { Arc::clone(other) } else { Arc::new(joined) };
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
        self.entry(program, block).cloned().unwrap_or_else(Modal::unknown)
    }

    /// The same, where a path leads there.
    fn entry(&self, program: usize, block: BlockId) -> Option<&Modal> {
        let own = match self.firsts.get(program..) {
            Some([first, end, ..]) => self.entries.get(*first..*end),
            _ => None,
        };
        own?.get(block.index())?.as_deref()
    }

    /// The unit of a block, where nothing in it may select another: so it is of nearly all.
    pub fn unit_all_through(&self, program: usize, id: BlockId, block: &Block) -> Option<Setting> {
        let entry = self.entry(program, id);
        let keeps = |item: &NcItem| match item {
            NcItem::Op(op) => op.group() != Group::Units,
            NcItem::Code(letter, _) => *letter != 'G',
            NcItem::Word(..) => true,
        };
        let keeps = |stmt: &Stmt| match &stmt.kind {
            StmtKind::Nc(nc) => nc.items.iter().all(keeps),
            kind => !matches!(kind, StmtKind::ModalCall(_) | StmtKind::ModalCallOff),
        };
        let known = entry.is_none_or(|entry| !entry.may_call()) && block.stmts.iter().all(keeps);
        known.then(|| entry.map_or(Setting::Unknown, |entry| entry.of(Group::Units)))
    }

    /// Goes through all statements of a library, each with the index of its program and what is in force before and after it.
    pub fn each(&self, module: &Module, f: &mut dyn FnMut(usize, &Stmt, &Modal, &Modal)) {
        for (index, program) in module.programs.iter().enumerate() {
            for (id, block) in program.ids().zip(&program.blocks) {
                let mut after = self.at(index, id);
                for stmt in &block.stmts {
                    let before = after.clone();
                    after.step(stmt);
                    f(index, stmt, &before, &after);
                }
            }
        }
    }
}

struct Analysis<'m> {
    module: &'m Module,
    /// True where nested modal calls do not enter the program that they name.
    copies: bool,
    by_name: HashMap<&'m ProgramName, usize>,
    computed: BTreeMap<Place, Callees>,
    /// By block of all programs, one program after the other.
    entries: Routines<Arc<Modal>>,
    /// By program, the node of its first block; at last, that of the end.
    firsts: Vec<usize>,
    /// By routine, the blocks that it can run.
    reach: BTreeMap<usize, BTreeSet<BlockId>>,
    /// By routine, what it and all that it calls may change.
    touches: BTreeMap<Place, Touches>,
    /// The last states that were like none of these.
    recent: VecDeque<Arc<Modal>>,
}

/// States that are kept to be shared.
const RECENT: usize = 16;

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
            entries: Routines::new(firsts.last().copied().unwrap_or_default()),
            firsts,
            reach: BTreeMap::new(),
            touches: BTreeMap::new(),
            recent: VecDeque::new(),
        }
    }

    fn run(mut self, entry: &Modal) -> ModalFacts {
        self.touches = routines(self.module, &self.by_name);
        let called = self.called_programs();
        let (entry, head) = (&Arc::new(entry.clone()), &Arc::new(entry.at_head()));
        for (index, program) in self.module.programs.iter().enumerate() {
            // A program that ends the run is started by the operator too, whoever calls it.
            if !called.contains(&index) || !program.returns() {
                // What stands without a name before the first one may go on with a program that was begun before.
                self.go((index, BlockId(0)), if program.name.is_some() { head } else { entry });
            }
        }
        self.drain();
        // Programs that only call one another: nothing outside says how they start.
        for index in 0..self.module.programs.len() {
            let start = self.node((index, BlockId(0)));
            if start.is_some_and(|start| self.entries.state(start).is_none()) {
                self.go((index, BlockId(0)), entry);
                self.drain();
            }
        }
        ModalFacts { entries: self.entries.into_states(), firsts: self.firsts }
    }

    fn drain(&mut self) {
        while let Some((node, state)) = self.entries.pop() {
            // Programs without blocks begin where the next one does.
            let program = self.firsts.partition_point(|first| *first <= node) - 1;
            self.block((program, BlockId((node - self.firsts[program]) as u32)), state);
        }
    }

    /// The node of a block, if the program has it.
    fn node(&self, (program, id): Place) -> Option<usize> {
        self.module.programs[program].block(id)?;
        Some(self.firsts[program] + id.index())
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

    fn go(&mut self, to: Place, state: &Arc<Modal>) {
        if let Some(node) = self.node(to) {
            self.entries.go(node, state);
        }
    }

    fn block(&mut self, (index, id): Place, entry: Arc<Modal>) {
        let Some(block) = self.module.programs[index].block(id) else { return };
        let mut state = Cow::Borrowed(&*entry);
        for stmt in block.stmts.iter().filter(|stmt| Modal::may_step(stmt)) {
            let nested = state.calls.as_ref().is_some_and(|calls| !calls.is_empty());
            if let StmtKind::ModalCall(call) = &stmt.kind
                && !(self.copies && nested)
            {
                // It runs after moves yet to come, under the modal calls outside its own.
                let inside = Modal::unknown_under(&state);
                self.call((index, id), call, &Arc::new(inside));
            }
            state.to_mut().step(stmt);
        }
        let state = match state {
            Cow::Borrowed(_) => entry,
            Cow::Owned(state) => self.shared(&entry, state),
        };
        match &block.term.kind {
            TermKind::Call { call, next } => {
                if let Some(after) = self.call((index, id), call, &state) {
                    self.go((index, *next), &after);
                }
            }
            TermKind::Return { to } => self.returned((index, id), to.as_ref(), &state),
            kind => kind.each_successor(&mut |to| self.go((index, to), &state)),
        }
    }

    /// A state, in the place of an equal one before it: programs go through few, again and again.
    fn shared(&mut self, before: &Arc<Modal>, state: Modal) -> Arc<Modal> {
        if let Some(same) = [before].into_iter().chain(&self.recent).find(|other| ***other == state) {
            return Arc::clone(same);
        }
        let state = Arc::new(state);
        self.recent.truncate(RECENT - 1);
        self.recent.push_front(Arc::clone(&state));
        state
    }

    /// Enters a callee and yields the state after the call; none if it is not known to return.
    fn call(&mut self, from: Place, call: &Call, state: &Arc<Modal>) -> Option<Arc<Modal>> {
        let entry = match (&call.callee, self.program_of(&call.callee)) {
            (Callee::Block(entry), _) => (from.0, *entry),
            (_, Some(program)) => (program, BlockId(0)),
            (Callee::Computed(_), _) => {
                let callees = self.computed.get(&from).cloned().unwrap_or_default();
                callees.entered(self.module).for_each(|program| self.go((program, BlockId(0)), state));
                let after = Arc::new(Modal::unknown_under(state));
                if callees.programs.iter().any(|program| comes_back(&self.module.programs[*program])) {
                    self.come_back(from.0, None, &after);
                }
                return Some(after);
            }
            _ => return Some(Arc::new(Modal::unknown_under(state))),
        };
        let (routine, caller) = (self.node(entry)?, self.node(from)?);
        if self.entries.call(caller, routine, state) {
            // Its returns may have been looked at before anybody was known to call it.
            let program = &self.module.programs[entry.0];
            let body = self.reach.entry(routine).or_insert_with(|| reachable(program, entry.1));
            let first = self.firsts[entry.0];
            body.iter().for_each(|id| self.entries.again(first + id.index()));
        }
        let after = self.entries.after(routine).cloned();
        if let (Some(after), true) = (&after, call.count.is_some()) {
            // Its next run begins in the state that it left.
            self.go(entry, after);
        }
        let mut after = after?;
        if let Some(touches) = self.touches.get(&entry) {
            let mut kept = Modal::clone(&after);
            kept.keep(state, touches);
            if kept != *after {
                after = self.shared(state, kept);
            }
        }
        Some(after)
    }

    /// A return leaves every routine that the block belongs to; one to a sequence number goes on there in the callers.
    fn returned(&mut self, (index, id): Place, to: Option<&Expr>, state: &Arc<Modal>) {
        for routine in self.entries.called(self.firsts[index]..self.firsts[index + 1]) {
            if !self.reach.get(&routine).is_some_and(|body| body.contains(&id)) {
                continue;
            }
            self.entries.give_back(routine, state);
            if let Some(to) = to {
                let callers = self.entries.callers(routine);
                let callers: BTreeSet<usize> =
                    callers.map(|node| self.firsts.partition_point(|first| *first <= node) - 1).collect();
                callers.into_iter().for_each(|caller| self.come_back(caller, to.constant(), state));
            }
        }
    }

    /// Goes on in a caller at the blocks of a sequence number; of any where it is not known.
    fn come_back(&mut self, caller: usize, number: Option<f64>, state: &Arc<Modal>) {
        let program = &self.module.programs[caller];
        let is_it = |label: &Label| match label {
            Label::Number(n) => number.is_none_or(|number| number == f64::from(*n)),
            _ => false,
        };
        for (id, _) in program.ids().zip(&program.blocks).filter(|(_, block)| block.labels.iter().any(is_it))
        {
            self.go((caller, id), state);
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
    mut change: impl FnMut(usize, &mut Modal, Stmt, &mut Stmts),
) {
    // Most blocks get as many statements as they had, so that each stays where it is in memory.
    let mut out = Stmts::new();
    for (index, program) in module.programs.iter_mut().enumerate() {
        for (at, block) in program.blocks.iter_mut().enumerate() {
            let mut state = facts.at(index, BlockId(at as u32));
            block.stmts.drain(..).for_each(|stmt| change(index, &mut state, stmt, &mut out));
            block.stmts.reserve_exact(out.len());
            block.stmts.append(&mut out);
        }
    }
}

#[cfg(test)]
mod tests;
