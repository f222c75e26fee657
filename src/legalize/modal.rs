//! Which modal operation is in force where, as far as the text of the library says.
//!
//! A forward analysis over all programs at once: the state at a program's entry
//! joins the states at all its calls, and the state behind a call is the
//! callee's at its returns. What a program without a known caller starts in, and
//! what an unknown callee leaves, is not known.

use crate::canon::{Group, Op, Role};
use crate::ir::{Block, BlockId, Call, Callee, Module, NcItem, Program, Stmt, StmtKind, TermKind};
use crate::syntax::ProgramName;
use crate::text::Span;
use std::collections::{BTreeMap, BTreeSet};

/// What is in force of one group.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Setting {
    /// No path leads here.
    #[default]
    Unreached,
    /// This operation; for a work offset its number, where that is constant.
    Known(Op, Option<u32>),
    /// Not known, or not the same on all paths.
    Unknown,
}

/// The number of the last feed word.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Feed {
    #[default]
    Unreached,
    Known(f64),
    Unknown,
}

/// What is in force of every group, the feed, and the modal calls that are open.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Modal {
    settings: [Setting; Group::ALL.len()],
    /// True where some way here cancelled all zero shifts and selected none since.
    pub may_be_cancelled: bool,
    feed: Feed,
    /// The open modal calls, innermost last; absent where paths disagree.
    pub calls: Option<Vec<Call>>,
}

impl Modal {
    /// Nothing known: how a main program starts.
    pub fn unknown() -> Self {
        Self {
            settings: [Setting::Unknown; Group::ALL.len()],
            may_be_cancelled: false,
            feed: Feed::Unknown,
            calls: Some(Vec::new()),
        }
    }

    /// Puts an operation in force from the start.
    pub fn start_in(&mut self, op: Op) {
        self.settings[op.group() as usize] = Setting::Known(op, None);
    }

    /// What is in force of a group.
    pub fn of(&self, group: Group) -> Setting {
        self.settings[group as usize]
    }

    /// The operation in force of a group, where it is known.
    pub fn op(&self, group: Group) -> Option<Op> {
        match self.of(group) {
            Setting::Known(op, _) => Some(op),
            _ => None,
        }
    }

    /// The number of the last feed word, where it is known and counts the same as it did there.
    pub fn feed(&self) -> Option<f64> {
        match self.feed {
            Feed::Known(feed) => Some(feed),
            _ => None,
        }
    }

    /// True when no path leads here.
    pub fn is_unreached(&self) -> bool {
        self.of(Group::Motion) == Setting::Unreached
    }

    /// Takes a statement's effect.
    pub fn step(&mut self, stmt: &Stmt) {
        let before = stmt.site.skip.map(|_| self.clone());
        match &stmt.kind {
            StmtKind::Nc(nc) => {
                let mut feed = None;
                for item in &nc.items {
                    match item {
                        NcItem::Op(op) => self.set(*op, nc.word(Role::WorkOffset).and_then(|e| e.constant())),
                        // A computed code may be any of its letter.
                        NcItem::Code('G', _) => self.forget(),
                        NcItem::Word(Role::Feed, value) => feed = feed.or(Some(value)),
                        NcItem::Code(..) | NcItem::Word(..) => {}
                    }
                }
                // Behind the unit and the feed mode, which it counts in, wherever they stand.
                if let Some(feed) = feed {
                    self.feed = feed.constant().map_or(Feed::Unknown, Feed::Known);
                }
                if self.calls.as_ref().is_none_or(|calls| !calls.is_empty()) && nc.moves() {
                    // The modal call runs now, and may leave anything in force.
                    self.forget();
                }
            }
            StmtKind::ModalCall(call) => self.calls.iter_mut().for_each(|calls| calls.push(call.clone())),
            StmtKind::ModalCallOff => self.calls.iter_mut().for_each(|calls| drop(calls.pop())),
            _ => {}
        }
        if let Some(before) = before {
            self.join(&before);
        }
    }

    fn forget(&mut self) {
        self.settings = [Setting::Unknown; Group::ALL.len()];
        self.feed = Feed::Unknown;
    }

    fn set(&mut self, op: Op, number: Option<f64>) {
        if matches!(op.group(), Group::Units | Group::FeedMode) && self.op(op.group()) != Some(op) {
            self.feed = Feed::Unknown;
        }
        let number = number.filter(|_| op == Op::SelectWork).map(|n| n as u32);
        if op.group() != Group::OneShot {
            self.settings[op.group() as usize] = Setting::Known(op, number);
        }
        if op.group() == Group::WorkOffset {
            self.may_be_cancelled = op == Op::ShiftCancel;
        }
        if op.group() == Group::Motion {
            self.settings[Group::Cycle as usize] = Setting::Known(Op::CycleOff, None);
        }
    }

    /// Joins the state of another path; true where that changed anything.
    fn join(&mut self, other: &Modal) -> bool {
        if other.is_unreached() {
            return false;
        }
        if self.is_unreached() {
            *self = other.clone();
            return true;
        }
        let mut changed = false;
        for (mine, theirs) in self.settings.iter_mut().zip(&other.settings) {
            if *mine != *theirs && *mine != Setting::Unknown {
                *mine = Setting::Unknown;
                changed = true;
            }
        }
        if self.feed != other.feed && self.feed != Feed::Unknown {
            self.feed = Feed::Unknown;
            changed = true;
        }
        if other.may_be_cancelled && !self.may_be_cancelled {
            self.may_be_cancelled = true;
            changed = true;
        }
        if self.calls != other.calls && self.calls.is_some() {
            self.calls = None;
            changed = true;
        }
        changed
    }
}

/// The modal state at the start of every block of a library.
#[derive(Clone, Debug)]
pub struct ModalFacts {
    entries: Vec<Vec<Modal>>,
}

impl ModalFacts {
    /// Analyses a library whose runs begin in the state `entry`.
    pub fn of(module: &Module, entry: &Modal) -> Self {
        Analysis::new(module, false).run(entry)
    }

    /// The same where the macro of a modal call that stands inside another is a copy of its own: then its
    /// program runs only where something else calls it.
    pub fn with_copies(module: &Module, entry: &Modal) -> Self {
        Analysis::new(module, true).run(entry)
    }

    /// The state at the start of a block.
    pub fn at(&self, program: usize, block: BlockId) -> Modal {
        let entry = self.entries.get(program).and_then(|p| p.get(block.index()));
        entry.filter(|modal| !modal.is_unreached()).cloned().unwrap_or_else(Modal::unknown)
    }
}

/// A routine: a program entered at a block.
type Routine = (usize, BlockId);

struct Analysis<'m> {
    module: &'m Module,
    /// True where nested modal calls do not enter the program that they name.
    copies: bool,
    by_name: BTreeMap<&'m ProgramName, usize>,
    entries: Vec<Vec<Modal>>,
    exits: BTreeMap<Routine, Modal>,
    /// Call blocks to look at again when a routine's exit changes.
    callers: BTreeMap<Routine, BTreeSet<Routine>>,
    reach: BTreeMap<Routine, BTreeSet<BlockId>>,
    work: BTreeSet<Routine>,
}

impl<'m> Analysis<'m> {
    fn new(module: &'m Module, copies: bool) -> Self {
        Self {
            module,
            copies,
            by_name: module
                .programs
                .iter()
                .enumerate()
                .filter_map(|(i, p)| Some((p.name.as_ref()?, i)))
                .collect(),
            entries: module.programs.iter().map(|p| vec![Modal::default(); p.blocks.len()]).collect(),
            exits: BTreeMap::new(),
            callers: BTreeMap::new(),
            reach: BTreeMap::new(),
            work: BTreeSet::new(),
        }
    }

    fn run(mut self, entry: &Modal) -> ModalFacts {
        let called = self.called_programs();
        for (index, program) in self.module.programs.iter().enumerate() {
            if !called.contains(&index) && !program.blocks.is_empty() {
                self.flow(index, BlockId(0), entry);
            }
        }
        self.drain();
        // Programs that only call one another: nothing outside says how they start.
        for index in 0..self.module.programs.len() {
            if self.entries[index].first().is_some_and(Modal::is_unreached) {
                self.flow(index, BlockId(0), entry);
                self.drain();
            }
        }
        ModalFacts { entries: self.entries }
    }

    fn drain(&mut self) {
        while let Some((program, id)) = self.work.pop_first() {
            self.block(program, id);
        }
    }

    fn called_programs(&self) -> BTreeSet<usize> {
        let calls = self.module.programs.iter().flat_map(|p| &p.blocks).flat_map(calls_of);
        calls.filter_map(|call| self.program_of(&call.callee)).collect()
    }

    fn program_of(&self, callee: &Callee) -> Option<usize> {
        match callee {
            Callee::Program(name) => self.by_name.get(name).copied(),
            _ => None,
        }
    }

    fn flow(&mut self, program: usize, to: BlockId, state: &Modal) {
        let Some(entry) = self.entries[program].get_mut(to.index()) else { return };
        if entry.join(state) {
            self.work.insert((program, to));
        }
    }

    fn block(&mut self, index: usize, id: BlockId) {
        let Some(block) = self.module.programs[index].block(id) else { return };
        let mut state = self.entries[index][id.index()].clone();
        for stmt in &block.stmts {
            let nested = state.calls.as_ref().is_some_and(|calls| !calls.is_empty());
            if let StmtKind::ModalCall(call) = &stmt.kind
                && !(self.copies && nested)
            {
                // It runs behind moves yet to come, under the modal calls outside its own.
                let inside = Modal { calls: state.calls.clone(), ..Modal::unknown() };
                self.call(index, id, call, &inside);
            }
            state.step(stmt);
        }
        match &block.term.kind {
            TermKind::Call { call, next } => {
                let after = self.call(index, id, call, &state);
                self.flow(index, *next, &after);
            }
            TermKind::Return { .. } => self.returned(index, id, &state),
            kind => kind.successors().into_iter().for_each(|to| self.flow(index, to, &state)),
        }
    }

    /// Enters a callee and yields the state behind the call as known so far.
    fn call(&mut self, index: usize, id: BlockId, call: &Call, state: &Modal) -> Modal {
        let routine = match (&call.callee, self.program_of(&call.callee)) {
            (Callee::Block(entry), _) => (index, *entry),
            (_, Some(program)) => (program, BlockId(0)),
            _ => return Modal { calls: state.calls.clone(), ..Modal::unknown() },
        };
        if self.callers.entry(routine).or_default().insert((index, id)) {
            // Its returns may have been looked at before anybody was known to call it.
            let program = &self.module.programs[routine.0];
            let body = self.reach.entry(routine).or_insert_with(|| reachable(program, routine.1));
            let returns = body.iter().filter(|&&id| !self.entries[routine.0][id.index()].is_unreached());
            self.work.extend(returns.map(|&id| (routine.0, id)));
        }
        self.flow(routine.0, routine.1, state);
        let after = self.exits.get(&routine).cloned().unwrap_or_default();
        if call.count.is_some() {
            // Its next run begins in the state that it left.
            self.flow(routine.0, routine.1, &after);
        }
        after
    }

    /// A return leaves every routine that the block belongs to.
    fn returned(&mut self, index: usize, id: BlockId, state: &Modal) {
        let own = (index, BlockId(0))..(index + 1, BlockId(0));
        let routines: Vec<Routine> = self.callers.range(own).map(|(routine, _)| *routine).collect();
        for routine in routines {
            let program = &self.module.programs[index];
            let body = self.reach.entry(routine).or_insert_with(|| reachable(program, routine.1));
            if body.contains(&id) && self.exits.entry(routine).or_default().join(state) {
                self.work.extend(self.callers[&routine].iter().copied());
            }
        }
    }
}

/// Puts others in the place of statements. `change` gets the program, the state before a statement, which it has to
/// step, the statement, and where those go that stand for it.
pub fn replace_statements(
    module: &mut Module,
    facts: &ModalFacts,
    mut change: impl FnMut(usize, &mut Modal, Stmt, &mut Vec<Stmt>),
) {
    for (index, program) in module.programs.iter_mut().enumerate() {
        for (at, block) in program.blocks.iter_mut().enumerate() {
            let mut state = facts.at(index, BlockId(at as u32));
            let mut out = Vec::with_capacity(block.stmts.len());
            for stmt in std::mem::take(&mut block.stmts) {
                change(index, &mut state, stmt, &mut out);
            }
            block.stmts = out;
        }
    }
}

/// Every call of a block: modal ones and the terminator's.
pub fn calls_of(block: &Block) -> impl Iterator<Item = &Call> {
    let modal = block.stmts.iter().filter_map(|stmt| match &stmt.kind {
        StmtKind::ModalCall(call) => Some(call),
        _ => None,
    });
    modal.chain(match &block.term.kind {
        TermKind::Call { call, .. } => Some(call),
        _ => None,
    })
}

/// Where a call of [`calls_of`] stands.
pub fn span_of(block: &Block, call: &Call) -> Span {
    let modal = block.stmts.iter().find(|stmt| matches!(&stmt.kind, StmtKind::ModalCall(c) if c == call));
    modal.map_or(block.term.site.span, |stmt| stmt.site.span)
}

/// The blocks that a routine entered at `entry` can run, calls stepped over.
pub fn reachable(program: &Program, entry: BlockId) -> BTreeSet<BlockId> {
    let mut seen = BTreeSet::new();
    let mut work = vec![entry];
    while let Some(id) = work.pop() {
        if let Some(block) = program.block(id)
            && seen.insert(id)
        {
            work.extend(block.term.kind.successors());
        }
    }
    seen
}
