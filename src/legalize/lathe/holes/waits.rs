//! The last P of any code, which on some controls is the wait of a hole that has none.

use crate::canon::{Op, Role};
use crate::dialect::{Control, Question};
use crate::ir::analysis::over_calls::called;
use crate::ir::analysis::{calls_of, entries};
use crate::ir::{BlockId, Callee, Expr, Module, Nc, NcItem, Program, Stmt, StmtKind, TermKind};
use crate::legalize::features::{Feature, Features};
use std::collections::BTreeSet;
use std::rc::Rc;

/// What is known of it, at a place of a program.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Told {
    /// As a wait in milliseconds, where it is known.
    last: Option<f64>,
    /// True where no code of the run had one.
    none_yet: bool,
    /// True where the cycle of a contour with its P came after the wait that is known.
    doubted: bool,
    /// True where the only P before names a work offset.
    offset: bool,
    /// True where a code of the builder with its P came after the wait that is known.
    builders: bool,
    /// True where a call with its P came after it, which is taken to be none.
    calls: bool,
}

/// What is known of it, and what P is on the source.
#[derive(Clone, Debug, Default)]
pub(super) struct Waits {
    told: Told,
    /// What P is beside the codes of the source.
    roles: Rc<BTreeSet<Role>>,
    /// By program, whether another one may call it.
    called: Rc<Vec<bool>>,
    /// True where P of a code of the builder is none.
    builders_apart: bool,
    /// True where P of a call is none.
    calls_apart: bool,
    /// True where it is not known what calls what.
    any: bool,
}

/// True of a block that names a work offset by P: G54 to G59 need none, and those that P names have numbers from 101 on.
pub(super) fn names_offset(nc: &Nc) -> bool {
    nc.word(Role::WorkOffset).is_some_and(|number| number.constant().is_none_or(|number| number >= 100.0))
}

impl Waits {
    /// What P is on the source, and whether programs of the library hand it on.
    pub fn of(source: &Control, module: &Module) -> Self {
        // P of the cycles of contours names a block, and is no wait (docs/lathe.md S10).
        let of_row = |row: &crate::dialect::CodeMeaning| {
            row.words.get("P").copied().filter(|role| *role != Role::ContourFirst)
        };
        let roles = Rc::new(source.dialect().codes.iter().filter_map(of_row).collect());
        let calls = || module.programs.iter().flat_map(|program| &program.blocks).flat_map(calls_of);
        let any = calls().any(|call| matches!(call.callee, Callee::Computed(_) | Callee::Cycle(_)));
        let called = if any { vec![true; module.programs.len()] } else { called(module) };
        let apart = source.behaviour(Question::HoleWaitBuilders).is_some_and(|row| row.value == "none");
        let calls_apart = source.behaviour(Question::HoleWaitCalls).is_some_and(|row| row.value == "none");
        Self {
            told: Told::default(),
            roles,
            called: Rc::new(called),
            builders_apart: apart,
            calls_apart,
            any,
        }
    }

    /// True where P of a call is taken to be none.
    pub fn calls_apart(&self) -> bool {
        self.calls_apart
    }

    /// Before the first block of a program: one that returns was called, maybe with a P, or begins again after one. Where P of a call is
    /// none, only a caller that nobody knows may have told a wait.
    pub(super) fn begin(&self, (index, program): (usize, &Program)) -> Told {
        let mut kinds = program.blocks.iter().map(|block| &block.term.kind);
        let returns = kinds.any(|kind| matches!(kind, TermKind::Return { .. }));
        if self.calls_apart {
            return Told { none_yet: !returns || !self.any, calls: returns, ..Told::default() };
        }
        let called = self.called.get(index).copied().unwrap_or(true);
        Told { none_yet: !called && !returns, ..Told::default() }
    }

    /// For each block of a program, what all ways to it agree in; nothing after the first where runs may come in from outside at any number.
    pub fn at_blocks(&self, (index, program): (usize, &Program), is_entered: bool) -> Vec<Told> {
        if is_entered {
            let first = std::iter::once(self.begin((index, program)));
            return first.chain(std::iter::repeat(Told::default())).take(program.blocks.len()).collect();
        }
        let mut known: Vec<Option<Told>> = vec![None; program.blocks.len()];
        let mut open = Vec::new();
        for entry in entries(program) {
            come(&mut known, &mut open, entry, Told::default());
        }
        come(&mut known, &mut open, BlockId(0), self.begin((index, program)));
        // What is known of a block only gets less, so this ends.
        while let Some(at) = open.pop() {
            let here = program.blocks.get(at.index()).zip(known.get(at.index()).copied().flatten());
            let Some((block, told)) = here else { continue };
            let mut on = self.clone();
            on.come_in(told);
            block.stmts.iter().for_each(|stmt| on.take(stmt));
            if matches!(block.term.kind, TermKind::Call { .. }) {
                on.told = Told::default();
            }
            for to in block.term.kind.successors() {
                come(&mut known, &mut open, to, on.told);
            }
        }
        known.into_iter().map(Option::unwrap_or_default).collect()
    }

    /// What is known here.
    pub(super) fn told(&self) -> Told {
        self.told
    }

    /// At a block to which other ways may lead.
    pub fn come_in(&mut self, told: Told) {
        self.told = told;
    }

    /// The wait, where it is known.
    pub fn last(&self) -> Option<Expr> {
        self.told.last.map(Expr::Number)
    }

    /// True where a block's number stood as P after the wait that is known.
    pub fn is_doubted(&self) -> bool {
        self.told.doubted
    }

    /// True where the only P before names a work offset.
    pub fn is_offset(&self) -> bool {
        self.told.offset
    }

    /// True where no code of the run had a P that may be a wait.
    pub fn none_yet(&self) -> bool {
        self.told.none_yet
    }

    /// True where a code of the builder had a P since, which is taken to be no wait.
    pub fn after_builders(&self) -> bool {
        self.told.builders
    }

    /// True where a call had a P since, which is taken to be no wait.
    pub fn after_calls(&self) -> bool {
        self.told.calls
    }

    /// Takes the P of a block: a wait in thousandths or in seconds, or what is none.
    pub fn take(&mut self, stmt: &Stmt) {
        let told = &mut self.told;
        let StmtKind::Nc(nc) = &stmt.kind else {
            // Alarms, messages and outputs have no P; a modal call has one, and may run a program that has.
            if matches!(stmt.kind, StmtKind::ModalCall(_)) {
                *told = Told::default();
            }
            return;
        };
        let wait = |role: Role, by: f64| nc.word(role).map(|wait| wait.constant().map(|wait| wait * by));
        let waits = wait(Role::CycleDwell, 1.0).or(wait(Role::DwellMs, 1.0)).or(wait(Role::DwellS, 1000.0));
        // Where it is the only P, it is taken to be no wait, and that is asked.
        told.offset |= told.none_yet && names_offset(nc);
        let counts = names_offset(nc) && !told.none_yet;
        let apart = |role: Role| self.builders_apart && role.is_act_word();
        let has = |item: &NcItem, wanted: &dyn Fn(Role) -> bool| matches!(item, NcItem::Word(role, _) if wanted(*role) && self.roles.contains(role));
        let other = nc.items.iter().any(|item| match item {
            NcItem::Word(Role::WorkOffset, _) => counts,
            NcItem::Word(..) => has(item, &|role| !apart(role)),
            NcItem::Code(..) => true,
            NcItem::Op(_) => false,
        });
        told.builders |= nc.items.iter().any(|item| has(item, &apart));
        told.doubted |= told.last.is_some() && nc.word(Role::ContourFirst).is_some();
        if waits.is_some() || other {
            let known = waits.flatten().filter(|_| stmt.site.skip.is_none());
            *told = Told { last: known.map(|ms| (ms * 1e6).round() / 1e6), ..Told::default() };
        }
    }
}

impl Told {
    /// What two ways agree in.
    pub(super) fn met(self, other: Self) -> Self {
        let none_yet = self.none_yet && other.none_yet;
        Self {
            last: self.last.filter(|last| other.last == Some(*last)),
            none_yet,
            doubted: self.doubted || other.doubted,
            offset: none_yet && (self.offset || other.offset),
            builders: self.builders || other.builders,
            calls: self.calls || other.calls,
        }
    }

    /// Takes a call.
    pub(super) fn call(&mut self) {
        self.calls = true;
    }
}

/// Takes another way to a block, which is looked at again if less is known of it now.
fn come(known: &mut [Option<Told>], open: &mut Vec<BlockId>, to: BlockId, told: Told) {
    let Some(there) = known.get_mut(to.index()) else { return };
    let met = there.map_or(told, |there| there.met(told));
    if there.replace(met) != Some(met) {
        open.push(to);
    }
}

/// True where another code than that of a hole may have its letter: calls, waits, contours, threads. What such a code becomes on the target may have
/// it too.
pub(super) fn other_waits(features: &Features, by_steps: bool) -> bool {
    const WORDS: [Role; 6] =
        [Role::DwellMs, Role::DwellS, Role::Program, Role::ContourFirst, Role::ThreadInfeed, Role::Sequence];
    let calls = [Feature::Call, Feature::LocalCall, Feature::Modal, Feature::Chain, Feature::ReturnTo];
    calls.into_iter().any(|call| features.has(call))
        || WORDS.iter().any(|role| features.role(*role))
        || !by_steps && features.any_op(Op::is_lathe_cycle)
}
