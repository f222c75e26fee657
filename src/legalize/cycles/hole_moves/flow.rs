//! Which cycle is in force where, over the calls of a library.

use super::chosen::Chosen;
use super::drill::{Cycle, Known, Runs, Told, Value};
use crate::canon::{Group, Op, Role};
use crate::ir::analysis::dataflow::Lattice;
use crate::ir::analysis::over_calls::{Follow, OverCalls};
use crate::ir::analysis::{Modal, ModalFacts, Summaries, Vacancy};
use crate::ir::{Block, BlockId, Module, Nc, Program, Stmt, StmtKind, TermKind};
use std::collections::BTreeSet;

/// How the cycles in force are followed.
pub(super) struct Flow<'f> {
    pub facts: &'f ModalFacts,
    pub runs: Runs,
    /// Whether words of the statements may be vacant.
    pub vacancies: &'f Vacancies,
}

/// For each program, block and statement whether a word of a cycle, or its whole place, may be vacant.
pub(super) struct Vacancies(Vec<Vec<Vec<bool>>>);

impl Vacancies {
    pub fn of(module: &Module, summaries: &Summaries) -> Self {
        Self(module.programs.iter().map(|program| in_program(program, summaries)).collect())
    }

    /// Of the statements of a block.
    pub fn at(&self, program: usize, id: BlockId) -> &[bool] {
        self.0.get(program).and_then(|blocks| blocks.get(id.index())).map_or(&[], Vec::as_slice)
    }
}

fn in_program(program: &Program, summaries: &Summaries) -> Vec<Vec<bool>> {
    let vacancy = Vacancy::of(program, summaries, &BTreeSet::new());
    let of_stmt = |id, at, stmt: &Stmt| {
        let Some(nc) = stmt.kind.nc() else { return false };
        let may = |role| {
            nc.word(role).is_some_and(|word| word.may_be_vacant() && vacancy.may_yield_vacant(id, at, word))
        };
        let told = Told::ALL.into_iter().filter_map(Told::role).any(may);
        let place = [Role::X, Role::Y].into_iter().filter(|role| nc.word(*role).is_some());
        told || place.clone().next().is_some() && place.clone().all(may)
    };
    let of_block = |(id, block): (_, &Block)| {
        block.stmts.iter().enumerate().map(|(at, stmt)| of_stmt(id, at, stmt)).collect()
    };
    program.ids().zip(&program.blocks).map(of_block).collect()
}

/// Takes a statement; `modal` is what is in force after it, and a word of it may be `vacant`.
pub(super) fn step(stmt: &Stmt, known: &mut Known, modal: &Modal, runs: Runs, vacant: bool) {
    let before = stmt.site.skip.map(|_| known.clone());
    match &stmt.kind {
        StmtKind::Nc(nc) => known.step(nc, modal, runs, vacant),
        StmtKind::ModalCall(_) | StmtKind::ModalCallOff => known.lose(),
        _ => {}
    }
    if let Some(before) = before {
        known.join(&before);
    }
}

impl Follow for Flow<'_> {
    type Known = Known;

    fn outside(&self, _: usize) -> Known {
        Known::OUTSIDE
    }

    fn stmts(&self, (program, id): (usize, BlockId), block: &Block, known: &mut Known) {
        let mut modal = self.facts.at(program, id);
        for (stmt, vacant) in block.stmts.iter().zip(self.vacancies.at(program, id)) {
            modal.step(stmt);
            step(stmt, known, &modal, self.runs, *vacant);
        }
    }

    fn lose(&self, known: &mut Known) {
        known.lose();
    }
}

impl Flow<'_> {
    /// What the holes that are written take from registers.
    pub fn held(&self, module: &Module, known: &OverCalls<Known>, chosen: Option<&Chosen>) -> [bool; 6] {
        let mut held = [false; 6];
        for (index, program) in module.programs.iter().enumerate() {
            if chosen.is_some_and(|chosen| !chosen.any_in(index)) {
                continue;
            }
            for (id, block) in program.ids().zip(&program.blocks) {
                let Some(mut known) = known.at(index, id).cloned() else { continue };
                let mut modal = self.facts.at(index, id);
                let mut written = chosen.map(|chosen| chosen.at(index, id).iter().copied());
                for (stmt, vacant) in block.stmts.iter().zip(self.vacancies.at(index, id)) {
                    modal.step(stmt);
                    step(stmt, &mut known, &modal, self.runs, *vacant);
                    if written.as_mut().is_some_and(|written| written.next() != Some(true)) {
                        continue;
                    }
                    let (StmtKind::Nc(nc), Cycle::On(drill)) = (&stmt.kind, &known.cycle) else { continue };
                    if self.runs.drills(nc) || nc.ops().any(Op::is_cycle) {
                        for what in Told::ALL {
                            held[what as usize] |= drill.told(what) == Value::Held;
                        }
                    }
                }
            }
        }
        held
    }
}

/// The only unit that a library names or checks, true for inch.
pub(super) fn named_unit(module: &Module) -> Option<bool> {
    let stmts = module.programs.iter().flat_map(|program| &program.blocks).flat_map(|block| &block.stmts);
    let named = stmts.filter_map(|stmt| stmt.kind.nc()).flat_map(Nc::ops).filter_map(|op| match op {
        Op::Inch | Op::CheckInch => Some(true),
        Op::Metric | Op::CheckMetric => Some(false),
        _ => None,
    });
    let named: BTreeSet<bool> = named.collect();
    named.first().copied().filter(|_| named.len() == 1)
}

/// For each statement of a block whether the next move after it says its interpolation.
pub(super) fn says_motion(block: &Block) -> Vec<bool> {
    let mut says = matches!(block.term.kind, TermKind::End { .. });
    let mut all: Vec<bool> = Vec::with_capacity(block.stmts.len());
    for stmt in block.stmts.iter().rev() {
        all.push(says);
        let Some(nc) = stmt.kind.nc() else { continue };
        if nc.ops().any(|op| op.group() == Group::Motion || op.is_cycle()) {
            says = true;
        } else if nc.names_axis() {
            says = false;
        }
    }
    all.reverse();
    all
}
