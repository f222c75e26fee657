//! Which constants a variable may hold at a place, found backwards from there.

use super::Cfg;
use super::cfg::{entries, labelled};
use super::dataflow::reached;
use super::effects::Summaries;
use super::text_ends::is_final;
use crate::canon::Sys;
use crate::ir::{Bank, BlockId, Callee, Expr, Place, Program, Stmt, StmtKind, TermKind, Var};
use std::cell::OnceCell;
use std::collections::BTreeSet;

/// Something that a variable may hold.
#[derive(Clone, Debug, PartialEq)]
pub enum Constant {
    /// A number.
    Number(f64),
    /// Vacant.
    Vacant,
    /// State of the machine with constant subscripts, as it was when it was read: the motion
    /// code kept at a subprogram's head.
    State(Sys, Vec<f64>),
}

/// More than so many are as good as any.
const MOST: usize = 16;

/// More steps back than so many are not taken.
const STEPS: usize = 100_000;

/// As [`Assigned::at`], of a program that nothing else is asked of.
pub fn values_at(
    program: &Program,
    summaries: &Summaries,
    var: Var,
    id: BlockId,
    at: usize,
) -> Option<Vec<Constant>> {
    Assigned::new(program, summaries).at(var, id, at)
}

/// A variable before a statement of a block.
type Asked = (BlockId, usize, Var);

/// True where a write by this computed number, at a statement of a block, surely leaves the variable alone.
pub type Misses<'s> = dyn Fn((BlockId, usize), Bank, &Expr, Var) -> bool + 's;

/// What is assigned in a program.
pub struct Assigned<'s> {
    program: &'s Program,
    summaries: &'s Summaries,
    misses: Option<&'s Misses<'s>>,
    cfg: OnceCell<Cfg>,
    /// Where control comes in from what the graph does not show, anything may be held.
    open: OnceCell<BTreeSet<BlockId>>,
}

impl<'s> Assigned<'s> {
    /// Of a program of the library that `summaries` are of.
    pub fn new(program: &'s Program, summaries: &'s Summaries) -> Self {
        Self { program, summaries, misses: None, cfg: OnceCell::new(), open: OnceCell::new() }
    }

    /// The same, where more is known of computed numbers: without, each may be that of any variable.
    pub fn with(mut self, misses: &'s Misses<'s>) -> Self {
        self.misses = Some(misses);
        self
    }

    /// All that `var` may hold before statement `at` of block `id` (past the last: before its
    /// terminator). None where something else may reach it: what the caller left, an input, a result.
    pub fn at(&self, var: Var, id: BlockId, at: usize) -> Option<Vec<Constant>> {
        let (mut found, mut steps) = (Some(Vec::new()), STEPS);
        reached([(id, at, var)], |place, go| {
            let known = found.take().filter(|_| steps > 0);
            steps = steps.saturating_sub(1);
            found = known.and_then(|known| self.back(place, known, go));
        });
        found
    }

    fn open(&self) -> BTreeSet<BlockId> {
        let mut open: BTreeSet<BlockId> = entries(self.program).chain([BlockId(0)]).collect();
        if self.summaries.come_back_to(self.program) {
            open.extend(labelled(self.program));
        }
        open
    }

    /// Goes back to what gave the variable its value last, or to where that must be asked; none if it is not known.
    fn back(
        &self,
        (id, at, var): Asked,
        mut found: Vec<Constant>,
        go: &mut dyn FnMut(Asked),
    ) -> Option<Vec<Constant>> {
        let stmts = &self.program.block(id)?.stmts;
        let before = stmts.iter().enumerate().take(at);
        // Nobody comes here past an alarm.
        let before = before.rev().take_while(|(_, stmt)| !is_final(stmt));
        let ends = stmts.iter().take(at).any(is_final);
        let held = before.clone().find_map(|(at, stmt)| {
            let effect = effect(stmt, var, self.summaries).filter(|_| !self.misses((id, at), stmt, var));
            effect.map(|effect| (at, effect, stmt.site.skip.is_some()))
        });
        let Some((at, effect, skipped)) = held else {
            if !ends {
                self.ahead(id, var, go)?;
            }
            return Some(found);
        };
        match effect {
            Effect::Constant(constant) if found.contains(&constant) => {}
            Effect::Constant(_) if found.len() == MOST => return None,
            Effect::Constant(constant) => found.push(constant),
            Effect::Copy(from) => go((id, at, from)),
            Effect::Unknown => return None,
        }
        // A skipped one leaves what was held before.
        if skipped {
            go((id, at, var));
        }
        Some(found)
    }

    /// True where a statement writes by a computed number that is not the variable's.
    fn misses(&self, place: (BlockId, usize), stmt: &Stmt, var: Var) -> bool {
        match (&stmt.kind, self.misses) {
            (StmtKind::Assign { target: Place::Indirect(bank, index), .. }, Some(misses)) => {
                misses(place, *bank, index, var)
            }
            _ => false,
        }
    }

    /// Goes back to the ends of the blocks before one.
    fn ahead(&self, id: BlockId, var: Var, go: &mut dyn FnMut(Asked)) -> Option<()> {
        if self.open.get_or_init(|| self.open()).contains(&id) {
            return None;
        }
        for pred in self.cfg.get_or_init(|| Cfg::of(self.program)).preds(id) {
            if let TermKind::Call { call, .. } = &self.program.block(*pred)?.term.kind
                && (matches!(call.callee, Callee::Block(_)) || self.summaries.by_call(call).contains(var))
            {
                return None;
            }
            go((*pred, usize::MAX, var));
        }
        Some(())
    }
}

/// What a statement does to a variable.
enum Effect {
    Constant(Constant),
    Copy(Var),
    Unknown,
}

fn effect(stmt: &Stmt, var: Var, summaries: &Summaries) -> Option<Effect> {
    match &stmt.kind {
        StmtKind::Assign { target: Place::Var(target), value } => (*target == var).then(|| of(value)),
        StmtKind::ClearAll(class) => (*class == var.class).then_some(Effect::Constant(Constant::Number(0.0))),
        StmtKind::Nc(nc) => summaries.by_nc(nc).contains(var).then_some(Effect::Unknown),
        kind => {
            let mut written = super::Vars::default();
            kind.target().iter().for_each(|place| written.write(place));
            written.contains(var).then_some(Effect::Unknown)
        }
    }
}

fn of(value: &Expr) -> Effect {
    match value {
        Expr::Vacant | Expr::System(Sys::Empty, _) => Effect::Constant(Constant::Vacant),
        Expr::Var(from) => Effect::Copy(*from),
        Expr::System(state, subscripts) => {
            let subscripts: Option<Vec<f64>> = subscripts.iter().map(Expr::constant).collect();
            subscripts.map_or(Effect::Unknown, |all| Effect::Constant(Constant::State(*state, all)))
        }
        value => value.constant().map_or(Effect::Unknown, |v| Effect::Constant(Constant::Number(v))),
    }
}
