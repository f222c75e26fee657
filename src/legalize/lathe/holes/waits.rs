//! The last P of any code, which on some controls is the wait of a hole that has none.

use crate::canon::{Op, Role};
use crate::dialect::Control;
use crate::ir::analysis::calls_of;
use crate::ir::analysis::over_calls::called;
use crate::ir::{Callee, Expr, Module, Nc, NcItem, Program, Stmt, StmtKind, TermKind};
use crate::legalize::features::{Feature, Features};
use std::collections::BTreeSet;
use std::rc::Rc;

/// What is known of it.
#[derive(Clone, Debug, Default)]
pub(super) struct Waits {
    /// As a wait in milliseconds, where it is known.
    last: Option<f64>,
    /// True where no code of the run had one.
    none_yet: bool,
    /// What P is beside the codes of the source.
    roles: Rc<BTreeSet<Role>>,
    /// By program, whether another one may call it.
    called: Rc<Vec<bool>>,
    /// True where the cycle of a contour with its P came after the wait that is known.
    doubted: bool,
    /// True where the only P before names a work offset.
    offset: bool,
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
        Self { roles, called: Rc::new(called), ..Self::default() }
    }

    /// Before the first block of a program: one that returns was called, maybe with a P, and one that jumps back may have had one.
    pub fn begin(&self, (index, program): (usize, &Program)) -> Self {
        let kinds = || program.blocks.iter().map(|block| &block.term.kind);
        let returns = kinds().any(|kind| matches!(kind, TermKind::Return { .. }));
        let again = kinds().flat_map(TermKind::successors).any(|to| to.index() == 0);
        let called = self.called.get(index).copied().unwrap_or(true);
        Self { none_yet: !called && !returns && !again, ..self.clone() }
    }

    /// At a block to which other ways may lead; to the first one the program comes.
    pub fn come_in(&mut self, first: bool) {
        (self.last, self.none_yet) = (None, self.none_yet && first);
        self.offset &= self.none_yet;
    }

    /// The wait, where it is known.
    pub fn last(&self) -> Option<Expr> {
        self.last.map(Expr::Number)
    }

    /// True where a block's number stood as P after the wait that is known.
    pub fn is_doubted(&self) -> bool {
        self.doubted
    }

    /// True where the only P before names a work offset.
    pub fn is_offset(&self) -> bool {
        self.offset
    }

    /// True where no code of the run had a P that may be a wait.
    pub fn none_yet(&self) -> bool {
        self.none_yet
    }

    /// Takes the P of a block: a wait in thousandths or in seconds, or what is none.
    pub fn take(&mut self, stmt: &Stmt) {
        let StmtKind::Nc(nc) = &stmt.kind else {
            if !matches!(stmt.kind, StmtKind::Comment | StmtKind::Assign { .. }) {
                self.come_in(false);
            }
            return;
        };
        let wait = |role: Role, by: f64| nc.word(role).map(|wait| wait.constant().map(|wait| wait * by));
        let waits = wait(Role::CycleDwell, 1.0).or(wait(Role::DwellMs, 1.0)).or(wait(Role::DwellS, 1000.0));
        // Where it is the only P, it is taken to be no wait, and that is asked.
        self.offset |= self.none_yet && names_offset(nc);
        let counts = names_offset(nc) && !self.none_yet;
        let other = nc.items.iter().any(|item| match item {
            NcItem::Word(Role::WorkOffset, _) => counts,
            NcItem::Word(role, _) => self.roles.contains(role),
            NcItem::Code(..) => true,
            NcItem::Op(_) => false,
        });
        self.doubted |= self.last.is_some() && nc.word(Role::ContourFirst).is_some();
        if waits.is_some() || other {
            (self.doubted, self.offset) = (false, false);
            let known = waits.flatten().filter(|_| stmt.site.skip.is_none());
            self.last = known.map(|ms| (ms * 1e6).round() / 1e6);
            self.none_yet = false;
        }
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
