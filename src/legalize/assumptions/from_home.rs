//! Increments from a reference position: places in machine coordinates by another name.
//!
//! A program that goes home and then moves by increments (`G91 G28 X0`, `G0 X-12.`) names a place that hangs on where the machine
//! has its home and how far it goes, as a move in machine coordinates does. Over-approximates: an axis counts as placed from home
//! where some way went there and named no absolute place of it since, calls of the library included. What a program outside the
//! library, a computed call or a modal one leaves is not known, and counts as another place. Counter-example: a place that G92
//! sets at home, from which absolute words then count. C is left out: an angle from its zero is no place of a machine.

use crate::canon::{Group, Op, Role};
use crate::ir::analysis::dataflow::{Analysis, Direction, Lattice, States, solve};
use crate::ir::analysis::{Cfg, ModalFacts};
use crate::ir::{Block, BlockId, Call, Callee, Expr, Module, Nc, NcItem, Program, Stmt, StmtKind, TermKind};
use crate::legalize::{Modal, calls_of, reachable};
use crate::syntax::ProgramName;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// The axes that may be placed from a reference position, by their numbers, as bits.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FromHome(u16);

impl Lattice for FromHome {
    fn join(&mut self, other: &Self) -> bool {
        let before = *self;
        self.0 |= other.0;
        *self != before
    }
}

impl FromHome {
    /// The axes of a block that it moves by increments from there, by their words; `state` is what is in force in it.
    pub fn steps<'n>(self, nc: &'n Nc, state: &Modal) -> impl Iterator<Item = (Role, &'n Expr)> {
        let steps = state.op(Group::Distance) == Some(Op::Incremental);
        let moves = nc.moves() && !goes_home(nc) && !nc.has(Op::MachineOnce);
        nc.items.iter().filter_map(move |item| match item {
            NcItem::Word(role, value)
                if moves
                    && role.axis_number() != Role::C.axis_number()
                    && (role.is_step() || steps)
                    && self.0 & bit(*role).unwrap_or(0) != 0 =>
            {
                Some((*role, value))
            }
            _ => None,
        })
    }

    /// Takes a statement's effect; `state` is what is in force in it, and `modes` is true where a code makes plain words increments.
    pub fn step(&mut self, stmt: &Stmt, state: &Modal, modes: bool) {
        let Some(nc) = stmt.kind.nc().filter(|nc| nc.names_axis() || goes_home(nc)) else { return };
        let before = *self;
        let words = || {
            nc.items.iter().filter_map(|item| match item {
                NcItem::Word(role, value) => bit(*role).map(|bit| (bit, *role, value)),
                _ => None,
            })
        };
        if state.may_call() {
            self.0 = 0;
        } else if goes_home(nc) {
            let named = words().fold(0, |named, (bit, ..)| named | bit);
            self.0 |= if named == 0 { u16::MAX } else { named };
        } else if nc.moves() {
            let once = nc.has(Op::MachineOnce);
            let steps = modes && !once && state.op(Group::Distance) != Some(Op::Absolute);
            for (bit, role, value) in words() {
                // Zero of the machine is its home; other places are asked of their own.
                let home = once && value.constant() == Some(0.0);
                if home {
                    self.0 |= bit;
                } else if !(role.is_step() || steps || value.may_be_vacant()) {
                    self.0 &= !bit;
                }
            }
        }
        if stmt.site.skip.is_some() {
            self.join(&before);
        }
    }
}

/// The bit of an axis.
fn bit(role: Role) -> Option<u16> {
    let number = role.is_axis().then(|| role.axis_number())??;
    1u16.checked_shl(number)
}

fn goes_home(nc: &Nc) -> bool {
    nc.has(Op::ReferenceReturn) || nc.has(Op::Reference2)
}

/// What is placed from home at the start of every block of a library.
pub struct Homes {
    states: Vec<States<FromHome>>,
    /// True where a code of the library makes plain words increments: on some lathes none does, and letters of their own are.
    pub modes: bool,
}

impl Homes {
    /// Follows it through a library.
    pub fn of(module: &Module, facts: &ModalFacts) -> Self {
        let programs = module.programs.iter().enumerate();
        let names = programs.clone().filter_map(|(index, program)| Some((program.name.as_ref()?, index)));
        let names = names.collect();
        let graphs: Vec<Cfg> = module.programs.iter().map(Cfg::of).collect();
        let mut stmts =
            module.programs.iter().flat_map(|program| &program.blocks).flat_map(|block| &block.stmts);
        let modes = stmts.any(|stmt| stmt.kind.has_op(Op::Incremental));
        let mut found = Self { states: vec![States::default(); graphs.len()], modes };
        let mut ends = vec![Ends::default(); graphs.len()];
        let mut parts: BTreeMap<(usize, BlockId), Ends> = BTreeMap::new();
        let mut changed = true;
        while std::mem::take(&mut changed) {
            for (index, program) in programs.clone() {
                let rules = Rules { index, facts, names: &names, ends: &ends, parts: &parts, modes };
                let states = solve(&rules, program, &graphs[index]);
                let (mut calls, mut own) = (Vec::new(), ends[index]);
                let mut returns: BTreeMap<BlockId, Ends> = BTreeMap::new();
                for (id, block) in program.ids().zip(&program.blocks) {
                    let Some(mut state) = states.at(id).copied() else { continue };
                    rules.stmts(id, block, &mut state);
                    match &block.term.kind {
                        TermKind::Call { call, .. } => {
                            let sets = rules.ends(call).map_or(0, |ends| ends.sets);
                            own.sets |= sets;
                            returns.entry(id).or_default().sets |= sets;
                            calls.extend(rules.callee(call).map(|callee| (callee, state)));
                        }
                        TermKind::Return { .. } => {
                            own.exit.0 |= state.0;
                            returns.entry(id).or_default().exit = state;
                        }
                        _ => {}
                    }
                }
                own.sets |= program.blocks.iter().fold(0, |all, block| all | homes_of(block));
                let found_parts = parts_of(program, &returns);
                changed |= std::mem::replace(&mut ends[index], own) != own;
                for (callee, state) in calls {
                    changed |= ends[callee].entry.join(&state);
                }
                found.states[index] = states;
                for (entry, part) in found_parts {
                    changed |= parts.insert((index, entry), part) != Some(part);
                }
            }
        }
        found
    }

    /// What is placed from home at the start of a block.
    pub fn at(&self, program: usize, block: BlockId) -> FromHome {
        self.states.get(program).and_then(|states| states.at(block)).copied().unwrap_or_default()
    }
}

/// What the called parts of a program return with, and the axes that they may send home; `ends` is that of blocks that call or return.
fn parts_of(program: &Program, ends: &BTreeMap<BlockId, Ends>) -> Vec<(BlockId, Ends)> {
    let entries = program.blocks.iter().flat_map(calls_of).filter_map(|call| match call.callee {
        Callee::Block(entry) => Some(entry),
        _ => None,
    });
    let part = |entry: BlockId| {
        let mut part = Ends::default();
        for id in reachable(program, entry) {
            part.sets |= program.block(id).map_or(0, homes_of);
            if let Some(end) = ends.get(&id) {
                part.exit.0 |= end.exit.0;
                part.sets |= end.sets;
            }
        }
        (entry, part)
    };
    entries.collect::<BTreeSet<_>>().into_iter().map(part).collect()
}

/// The axes that a block may send home itself.
fn homes_of(block: &Block) -> u16 {
    let named = |nc: &Nc| {
        let all = nc.items.iter().fold(0, |all, item| match item {
            NcItem::Word(role, _) => all | bit(*role).unwrap_or(0),
            _ => all,
        });
        if all == 0 { u16::MAX } else { all }
    };
    let blocks = block.stmts.iter().filter_map(|stmt| stmt.kind.nc());
    blocks.filter(|nc| goes_home(nc) || nc.has(Op::MachineOnce)).fold(0, |all, nc| all | named(nc))
}

/// What a program is entered with and returns with, and the axes that it, or what it calls, may send home.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Ends {
    entry: FromHome,
    exit: FromHome,
    sets: u16,
}

struct Rules<'r> {
    index: usize,
    facts: &'r ModalFacts,
    names: &'r HashMap<&'r ProgramName, usize>,
    ends: &'r [Ends],
    /// Of parts of programs that are called, by their first blocks.
    parts: &'r BTreeMap<(usize, BlockId), Ends>,
    modes: bool,
}

impl Rules<'_> {
    /// The program of the library that a call enters.
    fn callee(&self, call: &Call) -> Option<usize> {
        match &call.callee {
            Callee::Program(name) => self.names.get(name).copied(),
            Callee::Block(_) => Some(self.index),
            _ => None,
        }
    }

    /// What is known of the program that a call runs; none if the library does not have it.
    fn ends(&self, call: &Call) -> Option<Ends> {
        match &call.callee {
            Callee::Block(entry) => Some(self.parts.get(&(self.index, *entry)).copied().unwrap_or_default()),
            _ => self.callee(call).map(|callee| self.ends[callee]),
        }
    }

    fn stmts(&self, id: BlockId, block: &Block, state: &mut FromHome) {
        let mut modal = self.facts.at(self.index, id);
        for stmt in &block.stmts {
            modal.step(stmt);
            if matches!(stmt.kind, StmtKind::Nc(_)) {
                state.step(stmt, &modal, self.modes);
            }
        }
    }
}

impl Analysis for Rules<'_> {
    type State = FromHome;
    const DIRECTION: Direction = Direction::Forward;

    fn entries(&self, cfg: &Cfg) -> Vec<(BlockId, FromHome)> {
        cfg.roots().iter().map(|root| (*root, self.ends[self.index].entry)).collect()
    }

    fn block(&self, id: BlockId, block: &Block, state: &mut FromHome) {
        self.stmts(id, block, state);
        if let TermKind::Call { call, .. } = &block.term.kind {
            // What some other caller had in force does not come back here.
            let kept = |ends: Ends| ends.exit.0 & (state.0 | ends.sets);
            *state = FromHome(self.ends(call).map_or(0, kept));
        }
    }
}
