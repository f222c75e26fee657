//! Which variables every way through a called routine writes.

use super::{Callees, Routine};
use crate::ir::analysis::calls_of;
use crate::ir::analysis::dataflow::{Analysis, Direction, Lattice, solve};
use crate::ir::analysis::{BitRow, Cfg, Universe};
use crate::ir::{Block, BlockId, Call, Module, Place, TermKind};
use std::borrow::Cow;
use std::collections::BTreeMap;

/// What every way through a called routine writes; absent while no way through it is known.
pub(super) struct Written(BTreeMap<Routine, Option<BitRow>>);

impl Written {
    pub(super) fn of(module: &Module, callees: &Callees<'_>, universe: &Universe) -> Self {
        let mut written = Self(BTreeMap::new());
        for (index, program) in module.programs.iter().enumerate() {
            for call in program.blocks.iter().flat_map(calls_of) {
                if let Some(routine) = callees.routine(index, call) {
                    written.0.insert(routine, None);
                }
            }
        }
        // From "all variables" down: each round can only take variables away.
        callees.graph(module).fixpoint(|index| {
            let own = (index, BlockId(0))..(index + 1, BlockId(0));
            let routines: Vec<Routine> = written.0.range(own).map(|(routine, _)| *routine).collect();
            if routines.is_empty() {
                return false;
            }
            let cfg = Cfg::of(&module.programs[index]);
            let mut any = false;
            for routine in routines {
                let now = Ways { written: &written, module, routine, callees, universe }.through(&cfg);
                any |= written.0.insert(routine, now.clone()) != Some(now);
            }
            any
        });
        written
    }

    /// The routines that calls enter.
    pub(super) fn routines(&self) -> impl Iterator<Item = Routine> + '_ {
        self.0.keys().copied()
    }

    /// What is surely written when a call at the end of a block comes back.
    pub(super) fn by_end(&self, routine: Routine, block: &Block) -> Option<&BitRow> {
        match &block.term.kind {
            TermKind::Call { call, .. } if runs(call) => self.0.get(&routine)?.as_ref(),
            _ => None,
        }
    }
}

/// Rows of what every way writes.
#[derive(Clone)]
struct Sure(BitRow);

impl Lattice for Sure {
    fn join(&mut self, other: &Self) -> bool {
        let before = self.0.clone();
        self.0.intersect(&other.0);
        self.0 != before
    }
}

/// The ways through a routine.
struct Ways<'w> {
    written: &'w Written,
    module: &'w Module,
    routine: Routine,
    callees: &'w Callees<'w>,
    universe: &'w Universe,
}

impl Ways<'_> {
    /// What all of them write; none if none comes to a return.
    fn through(&self, cfg: &Cfg) -> Option<BitRow> {
        let program = self.module.programs.get(self.routine.0)?;
        let starts = solve(self, program, cfg);
        let returns = program.ids().zip(&program.blocks).filter_map(|(id, block)| {
            let mut sure =
                starts.at(id).filter(|_| matches!(block.term.kind, TermKind::Return { .. }))?.clone();
            self.block(id, block, &mut sure);
            Some(sure)
        });
        let all = returns.reduce(|mut all, one| {
            all.join(&one);
            all
        });
        all.map(|all| all.0)
    }

    /// What the call at the end of a block surely writes: none where that says nothing, and no row where it is not
    /// known to come back so far.
    fn called(&self, block: &Block) -> Option<Option<&BitRow>> {
        let TermKind::Call { call, .. } = &block.term.kind else { return None };
        let callee = self.callees.routine(self.routine.0, call).filter(|_| runs(call))?;
        self.written.0.get(&callee).map(Option::as_ref)
    }
}

impl Analysis for Ways<'_> {
    type State = Sure;
    const DIRECTION: Direction = Direction::Forward;

    fn entries(&self, _: &Cfg) -> Vec<(BlockId, Sure)> {
        vec![(self.routine.1, Sure(self.universe.none()))]
    }

    fn block(&self, _: BlockId, block: &Block, sure: &mut Sure) {
        for stmt in block.stmts.iter().filter(|stmt| stmt.site.skip.is_none()) {
            if let Some(Place::Var(var)) = stmt.kind.target() {
                self.universe.place(*var).iter().for_each(|at| sure.0.insert(*at));
            }
        }
        if let Some(Some(written)) = self.called(block) {
            sure.0.join(written);
        }
    }

    fn edge<'s>(&self, from: BlockId, _: BlockId, sure: &'s Sure) -> Option<Cow<'s, Sure>> {
        let block = self.module.programs.get(self.routine.0)?.block(from)?;
        (self.called(block) != Some(None)).then_some(Cow::Borrowed(sure))
    }
}

/// True where the call surely runs its callee, and once at least.
fn runs(call: &Call) -> bool {
    call.count.as_ref().is_none_or(|count| count.constant().is_some_and(|n| n >= 1.0))
}
