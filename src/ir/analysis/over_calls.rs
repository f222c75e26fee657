//! What is known at every block of a library, with what callers know when they call and callees leave when they return.
//!
//! A program that nothing calls, and one that ends the run, begin as the outside leaves things. Every other program begins
//! with what all of its callers know in common. A block that no run reaches knows nothing.

use super::dataflow::{Analysis, Direction, Lattice, States, solve};
use super::{Cfg, calls_of, reachable};
use crate::ir::{Block, BlockId, Call, Callee, Module, Program, TermKind};
use crate::syntax::ProgramName;
use foldhash::HashMap;
use std::collections::{BTreeMap, BTreeSet};

/// What is followed.
pub trait Follow {
    /// What is known at a place.
    type Known: Lattice + Clone;

    /// What is known where a run begins at a program.
    fn outside(&self, program: usize) -> Self::Known;

    /// What the statements of a block make of it.
    fn stmts(&self, place: (usize, BlockId), block: &Block, known: &mut Self::Known);

    /// What is known after something that the library does not have has run.
    fn lose(&self, known: &mut Self::Known);

    /// What a caller knows after a call of the library, beyond what its callee leaves whoever calls it.
    fn returned(&self, _program: usize, _call: &Call, _before: &Self::Known, _after: &mut Self::Known) {}
}

/// What is known at a place; none if no run reaches it.
#[derive(Clone, Debug)]
struct Reach<K>(Option<K>);

impl<K: Lattice + Clone> Lattice for Reach<K> {
    fn join(&mut self, other: &Self) -> bool {
        match (&mut self.0, &other.0) {
            (_, None) => false,
            (Some(mine), Some(theirs)) => mine.join(theirs),
            (mine, theirs) => {
                mine.clone_from(theirs);
                true
            }
        }
    }
}

/// A block of a program that runs enter.
type Entry = (usize, BlockId);

struct Rules<'r, F: Follow> {
    index: usize,
    follow: &'r F,
    names: &'r HashMap<ProgramName, usize>,
    entries: &'r BTreeMap<Entry, F::Known>,
    exits: &'r BTreeMap<Entry, F::Known>,
}

impl<F: Follow> Rules<'_, F> {
    /// Where a call goes; none if that is not in the library.
    fn entry(&self, call: &Call) -> Option<Entry> {
        match &call.callee {
            Callee::Block(entry) => Some((self.index, *entry)),
            Callee::Program(name) => Some((*self.names.get(name)?, BlockId(0))),
            Callee::Computed(_) | Callee::Cycle(_) => None,
        }
    }
}

impl<F: Follow> Analysis for Rules<'_, F> {
    type State = Reach<F::Known>;
    const DIRECTION: Direction = Direction::Forward;

    fn entries(&self, cfg: &Cfg) -> Vec<(BlockId, Self::State)> {
        let known = |root: &BlockId| (*root, Reach(self.entries.get(&(self.index, *root)).cloned()));
        cfg.roots().iter().map(known).collect()
    }

    fn block(&self, id: BlockId, block: &Block, state: &mut Self::State) {
        let Some(known) = &mut state.0 else { return };
        self.follow.stmts((self.index, id), block, known);
        if let TermKind::Call { call, .. } = &block.term.kind {
            match self.entry(call) {
                Some(entry) => {
                    let after = self.exits.get(&entry).cloned();
                    let before = std::mem::replace(&mut state.0, after);
                    if let (Some(before), Some(after)) = (before, &mut state.0) {
                        self.follow.returned(self.index, call, &before, after);
                    }
                }
                None => self.follow.lose(known),
            }
        }
    }
}

/// What is known at every block of a library.
pub struct OverCalls<K> {
    states: Vec<States<Reach<K>>>,
}

impl<K: Lattice + Clone> OverCalls<K> {
    /// Follows all programs and what they call until nothing changes.
    pub fn of<F: Follow<Known = K>>(module: &Module, follow: &F) -> Self {
        let names: HashMap<ProgramName, usize> =
            module.programs.iter().enumerate().filter_map(|(at, p)| Some((p.name.clone()?, at))).collect();
        let called = called(module);
        let (mut entries, mut exits): (BTreeMap<Entry, K>, BTreeMap<Entry, K>) = Default::default();
        for (index, called) in called.iter().enumerate() {
            // A program that ends the run is started by the operator, whoever calls it.
            if !called || !module.programs[index].returns() {
                entries.insert((index, BlockId(0)), follow.outside(index));
            }
        }
        let callers = callers(module, &names);
        let mut bodies: BTreeMap<Entry, Vec<BlockId>> = BTreeMap::new();
        let mut states: Vec<States<Reach<K>>> = module.programs.iter().map(|_| States::default()).collect();
        // A program is looked at again where something that it is entered with, or that its callees leave, has changed.
        let mut waits = vec![true; module.programs.len()];
        while waits.contains(&true) {
            for (index, program) in module.programs.iter().enumerate() {
                if !std::mem::take(&mut waits[index]) {
                    continue;
                }
                let rules = Rules { index, follow, names: &names, entries: &entries, exits: &exits };
                let found = solve(&rules, program, &Cfg::of(program));
                let mut calls: Vec<(Entry, K)> = Vec::new();
                let mut ends: BTreeMap<BlockId, K> = BTreeMap::new();
                for (id, block) in program.ids().zip(&program.blocks) {
                    let Some(mut known) = found.at(id).and_then(|state| state.0.clone()) else { continue };
                    match &block.term.kind {
                        TermKind::Call { call, .. } => {
                            let Some(entry) = rules.entry(call) else { continue };
                            follow.stmts((index, id), block, &mut known);
                            // Its next run begins as it returned.
                            let again = exits.get(&entry).filter(|_| call.count.is_some());
                            calls.extend(again.map(|again| (entry, again.clone())));
                            calls.push((entry, known));
                        }
                        TermKind::Return { .. } => {
                            follow.stmts((index, id), block, &mut known);
                            ends.insert(id, known);
                        }
                        _ => {}
                    }
                }
                for (entry, known) in &calls {
                    waits[entry.0] |= join(&mut entries, *entry, known);
                }
                let own = entries.range((index, BlockId(0))..(index + 1, BlockId(0)));
                let roots: Vec<BlockId> = own.map(|((_, id), _)| *id).filter(|_| !ends.is_empty()).collect();
                for root in roots {
                    let body = bodies.entry((index, root)).or_insert_with(|| returns(program, root));
                    for known in body.iter().filter_map(|id| ends.get(id)) {
                        if join(&mut exits, (index, root), known) {
                            callers[index].iter().for_each(|caller| waits[*caller] = true);
                        }
                    }
                }
                states[index] = found;
            }
        }
        Self { states }
    }

    /// What is known at the start of a block; none if no run reaches it.
    pub fn at(&self, program: usize, id: BlockId) -> Option<&K> {
        self.states.get(program)?.at(id)?.0.as_ref()
    }
}

/// The blocks of a routine that return.
fn returns(program: &Program, entry: BlockId) -> Vec<BlockId> {
    let returns = |id: &BlockId| {
        program.block(*id).is_some_and(|block| matches!(block.term.kind, TermKind::Return { .. }))
    };
    reachable(program, entry).into_iter().filter(returns).collect()
}

/// By program, those that call it, itself where it calls a part of its own.
fn callers(module: &Module, names: &HashMap<ProgramName, usize>) -> Vec<BTreeSet<usize>> {
    let mut callers = vec![BTreeSet::new(); module.programs.len()];
    for (index, program) in module.programs.iter().enumerate() {
        for block in &program.blocks {
            let TermKind::Call { call, .. } = &block.term.kind else { continue };
            let callee = match &call.callee {
                Callee::Block(_) => Some(index),
                Callee::Program(name) => names.get(name).copied(),
                Callee::Computed(_) | Callee::Cycle(_) => None,
            };
            callers.get_mut(callee.unwrap_or(usize::MAX)).into_iter().for_each(|all| {
                all.insert(index);
            });
        }
    }
    callers
}

/// Which programs of a library others call.
pub fn called(module: &Module) -> Vec<bool> {
    let names: HashMap<&ProgramName, usize> =
        module.programs.iter().enumerate().filter_map(|(at, p)| Some((p.name.as_ref()?, at))).collect();
    let mut called = vec![false; module.programs.len()];
    for call in module.programs.iter().flat_map(|program| &program.blocks).flat_map(calls_of) {
        if let Callee::Program(name) = &call.callee
            && let Some(callee) = names.get(name)
        {
            called[*callee] = true;
        }
    }
    called
}

/// Joins what is known on another way; true where that changed anything.
fn join<K: Lattice + Clone>(all: &mut BTreeMap<Entry, K>, entry: Entry, known: &K) -> bool {
    match all.get_mut(&entry) {
        Some(mine) => mine.join(known),
        None => {
            all.insert(entry, known.clone());
            true
        }
    }
}
