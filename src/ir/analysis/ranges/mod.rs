//! Which values variables may have at a place, followed forwards from the entry of a program.
//!
//! What is followed are the variables that computed numbers depend on (of variables, blocks, programs), and those that
//! they are made of or compared with. Everything else may be anything, and so may they where a program is entered:
//! only what a program itself assigns and compares bounds them. A loop's bound comes from its condition. A literal at a
//! program's head is an input that an operator edits, so it bounds nothing; but where only what a person would see at
//! once hangs on it, one that the program goes on counting with is taken for what it is ([`Ranges::of`]). Law: a value
//! that a run gives to an expression is one of those found for it, whichever literals stand at the head.
//! Counter-example: a variable that an operator changes by hand while the program stands in a stop.

mod evaluate;
mod followed;
mod numbers;
mod values;

#[cfg(test)]
mod tests;

pub use evaluate::evaluate;
use evaluate::evaluate_of;
pub use numbers::Numbers;
pub use values::Values;

use super::cfg::labelled;
use super::dataflow::{Analysis, Cursor, Direction, Lattice, States, Steps, solve_within};
use super::effects::{Summaries, Vars};
use super::text_ends::is_final;
use super::{Cfg, VarSet};
use crate::canon::{Group, Sys};
use crate::ir::{Bank, Block, BlockId, Callee, Cond, Expr, Place, Program, Stmt, StmtKind, TermKind, Var};
pub(super) use followed::in_numbers;
use followed::{followed, in_codes, in_whole_words, stops, told_of};
use std::borrow::Cow;
use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Most visits to blocks, a variable each; beyond, everything may be anything.
const STEPS: usize = 400_000;

/// A block whose values change more often than this is in a loop that counts.
const PATIENCE: u32 = 5;

/// A block whose values change more often than this tells nothing.
const MOST_CHANGES: u32 = 60;

/// What the followed variables may be, in the order of their places. Most blocks change nothing, and share one.
type State = Arc<Vec<Values>>;

/// The values of a program's variables.
pub struct Ranges<'p> {
    rules: Rules<'p>,
    /// At the start of each block; none if it takes too long to find out.
    starts: Option<States<State>>,
    /// Where the last question was, and the values there.
    cursor: RefCell<Cursor<State>>,
}

/// What statements, and ways between blocks, do to values.
struct Rules<'p> {
    program: &'p Program,
    summaries: &'p Summaries,
    places: BTreeMap<Var, usize>,
    /// The statements that assign an input.
    inputs: BTreeSet<(BlockId, usize)>,
    /// Where bounds may stop.
    stops: Vec<f64>,
    /// True where no work offset but one of the standard six is in force.
    standard: bool,
}

impl Lattice for Vec<Values> {
    fn join(&mut self, other: &Self) -> bool {
        let mut changed = false;
        for (mine, theirs) in self.iter_mut().zip(other).filter(|(mine, theirs)| !mine.has_all_of(theirs)) {
            let joined = mine.join(theirs);
            changed |= *mine != joined;
            *mine = joined;
        }
        changed
    }
}

impl Lattice for State {
    fn join(&mut self, other: &Self) -> bool {
        let adds =
            |(mine, theirs): (&Values, &Values)| !mine.has_all_of(theirs) && mine.join(theirs) != *mine;
        let changes = !Arc::ptr_eq(self, other) && self.iter().zip(&**other).any(adds);
        changes && Arc::make_mut(self).join(other)
    }
}

/// Puts a value in the place of another.
fn set(state: &mut State, at: usize, value: Values) {
    if state[at] != value {
        Arc::make_mut(state)[at] = value;
    }
}

impl Analysis for Rules<'_> {
    type State = State;
    const DIRECTION: Direction = Direction::Forward;

    fn entries(&self, cfg: &Cfg) -> Vec<(BlockId, State)> {
        let come_back = labelled(self.program).filter(|_| self.summaries.come_back_to(self.program));
        let all: BTreeSet<BlockId> = cfg.roots().iter().copied().chain(come_back).collect();
        let any = Arc::new(vec![Values::ANY; self.places.len()]);
        all.into_iter().map(|id| (id, any.clone())).collect()
    }

    fn block(&self, id: BlockId, block: &Block, state: &mut State) {
        self.stmts(id, block, state);
        self.leave(block, state);
    }

    fn edge<'s>(&self, from: BlockId, to: BlockId, state: &'s State) -> Option<Cow<'s, State>> {
        match self.program.block(from).map(|block| &block.term.kind) {
            Some(TermKind::Branch { cond, then, otherwise }) if then != otherwise => {
                self.narrowed(cond, to == *then, state)
            }
            _ => Some(Cow::Borrowed(state)),
        }
    }

    /// A loop that counts goes on to where it may stop, and one that never settles tells nothing.
    fn merge(&self, state: &mut State, other: &State, before: u32) -> bool {
        if Arc::ptr_eq(state, other) {
            return false;
        }
        let mut changed = false;
        for (at, theirs) in other.iter().enumerate() {
            let mine = &state[at];
            if mine.has_all_of(theirs) {
                continue;
            }
            let joined = mine.join(theirs);
            let next = match before {
                _ if joined == *mine => continue,
                0..PATIENCE => joined,
                PATIENCE..MOST_CHANGES => joined.widened(mine, &self.stops),
                _ => Values::ANY,
            };
            changed |= *mine != next;
            set(state, at, next);
        }
        changed
    }
}

impl Steps for Rules<'_> {
    fn stmt(&self, place: (BlockId, usize), stmt: &Stmt, state: &mut State) {
        let skipped = stmt.site.skip.is_some();
        match &stmt.kind {
            // Nobody comes past it.
            _ if is_final(stmt) => Arc::make_mut(state).fill(Values::Few(Vec::new())),
            StmtKind::Assign { target: Place::Var(var), value } => {
                if let Some(at) = self.places.get(var) {
                    let input = self.inputs.contains(&place);
                    let value = if input { Values::ANY } else { self.evaluate(value, state) };
                    let value = if skipped { state[*at].join(&value) } else { value };
                    set(state, *at, value);
                }
            }
            StmtKind::Assign { target: Place::Indirect(bank, index), value } => {
                let value = self.evaluate(value, state);
                self.may_write(*bank, index, &value, state);
            }
            StmtKind::Input { target: Place::Indirect(bank, index), .. } => {
                self.may_write(*bank, index, &Values::ANY, state);
            }
            StmtKind::Input { target: Place::Var(var), .. } => self.forget(state, |other| other == *var),
            StmtKind::ClearAll(class) => {
                for (_, at) in self.places.iter().filter(|(var, _)| var.class == *class) {
                    let value = state[*at].join(&Values::one(0.0));
                    set(state, *at, value);
                }
            }
            StmtKind::Nc(nc) => {
                let written = self.summaries.by_nc(nc);
                self.forget(state, |var| written.contains(var));
            }
            _ => {}
        }
    }
}

impl<'p> Ranges<'p> {
    /// The values in a program of the library that `summaries` are of; a literal at its head is an input unless the
    /// program assigns its variable elsewhere.
    pub fn of(program: &'p Program, summaries: &'p Summaries) -> Self {
        Self::of_offsets(program, summaries, false)
    }

    /// As [`Ranges::of`]; `standard` where no work offset but one of the standard six is in force.
    pub fn of_offsets(program: &'p Program, summaries: &'p Summaries, standard: bool) -> Self {
        let inputs = head_literals(program).into_iter().filter(|(.., var)| assigned(program, *var) == 1);
        let inputs = inputs.map(|(id, at, _)| (id, at)).collect();
        Self::following(program, summaries, inputs, in_numbers(program), standard)
    }

    /// As [`Ranges::of`]; every literal at the head is an input.
    pub fn of_any_inputs(program: &'p Program, summaries: &'p Summaries) -> Self {
        let inputs = head_literals(program).into_iter().map(|(id, at, _)| (id, at));
        Self::with(program, summaries, inputs.collect())
    }

    /// As [`Ranges::of`], of the variables in words that are whole numbers.
    pub fn of_whole_words(program: &'p Program, summaries: &'p Summaries) -> Self {
        let inputs = head_literals(program).into_iter().filter(|(.., var)| assigned(program, *var) == 1);
        let inputs = inputs.map(|(id, at, _)| (id, at)).collect();
        Self::following(program, summaries, inputs, in_whole_words(program), false)
    }

    /// As [`Ranges::of_any_inputs`], of these variables.
    pub fn of_these(program: &'p Program, summaries: &'p Summaries, vars: BTreeSet<Var>) -> Self {
        let inputs = head_literals(program).into_iter().map(|(id, at, _)| (id, at));
        Self::following(program, summaries, inputs.collect(), vars, false)
    }

    /// As [`Ranges::of_any_inputs`], of the numbers of codes too.
    pub fn of_any_inputs_and_codes(program: &'p Program, summaries: &'p Summaries) -> Self {
        let inputs = head_literals(program).into_iter().map(|(id, at, _)| (id, at));
        Self::following(program, summaries, inputs.collect(), in_codes(program), false)
    }

    /// As [`Ranges::of_any_inputs_and_codes`], where every literal is taken for what it is: nobody edits one.
    pub fn of_constants_and_codes(program: &'p Program, summaries: &'p Summaries) -> Self {
        Self::following(program, summaries, BTreeSet::new(), in_codes(program), false)
    }

    /// As [`Ranges::of_these`], where every literal is taken for what it is.
    pub fn of_constants(program: &'p Program, summaries: &'p Summaries, vars: BTreeSet<Var>) -> Self {
        Self::following(program, summaries, BTreeSet::new(), vars, false)
    }

    fn with(program: &'p Program, summaries: &'p Summaries, inputs: BTreeSet<(BlockId, usize)>) -> Self {
        Self::following(program, summaries, inputs, in_numbers(program), false)
    }

    fn following(
        program: &'p Program,
        summaries: &'p Summaries,
        inputs: BTreeSet<(BlockId, usize)>,
        vars: BTreeSet<Var>,
        standard: bool,
    ) -> Self {
        let followed = followed(program, vars);
        let limit = STEPS.checked_div(followed.len());
        let told = if followed.is_empty() { VarSet::default() } else { told_of(program) };
        let kept = followed.into_iter().filter(|var| told.contains(*var));
        let places: BTreeMap<Var, usize> = kept.enumerate().map(|(at, var)| (var, at)).collect();
        let rules = Rules { program, summaries, places, inputs, stops: stops(program), standard };
        let starts = limit.and_then(|limit| solve_within(&rules, program, &Cfg::of(program), limit));
        Self { rules, starts, cursor: RefCell::default() }
    }

    /// What an expression may be before statement `at` of a block; past the last, before its end.
    pub fn at(&self, id: BlockId, at: usize, expr: &Expr) -> Values {
        let Some(starts) = &self.starts else { return evaluate(expr, &|_| Values::ANY) };
        let mut cursor = self.cursor.borrow_mut();
        let state = cursor.seek(&self.rules, starts, self.rules.program, (id, at));
        state.map_or(Values::Few(Vec::new()), |state| self.rules.evaluate(expr, state))
    }
}

impl Rules<'_> {
    fn evaluate(&self, expr: &Expr, state: &State) -> Values {
        evaluate_of(expr, &|leaf| match leaf {
            Expr::Var(var) => self.value(*var, state),
            Expr::System(which, subscripts) if self.standard => selected(*which, subscripts),
            _ => Values::ANY,
        })
    }

    fn value(&self, var: Var, state: &State) -> Values {
        self.places.get(&var).and_then(|at| state.get(*at)).cloned().unwrap_or(Values::ANY)
    }

    /// What is known where a condition holds or does not; none if it never does.
    fn narrowed<'s>(&self, cond: &Cond, holds: bool, state: &'s State) -> Option<Cow<'s, State>> {
        if !self.follows(cond) {
            return Some(Cow::Borrowed(state));
        }
        let negated = (!holds).then(|| Cond::Not(Box::new(cond.clone())));
        let mut kept = Cow::Borrowed(state);
        evaluate::narrow(
            negated.as_ref().unwrap_or(cond),
            &|var| self.value(var, state),
            &mut |var, values| {
                if let Some(at) = self.places.get(&var) {
                    let met = kept[*at].meet(&values);
                    if met != kept[*at] {
                        set(kept.to_mut(), *at, met);
                    }
                }
            },
        );
        kept.iter().zip(&**state).all(|(kept, before)| before.is_empty() || !kept.is_empty()).then_some(kept)
    }

    /// True where a condition compares a variable that is followed.
    fn follows(&self, cond: &Cond) -> bool {
        let mut any = false;
        cond.exprs(&mut |e| e.variables(&mut |var| any |= self.places.contains_key(&var)));
        any
    }

    /// A variable with a computed number is written: one of those that the number may name.
    fn may_write(&self, bank: Bank, index: &Expr, value: &Values, state: &mut State) {
        let numbers = self.evaluate(index, state).numbers();
        for (var, at) in &self.places {
            if Vars::bank(bank).contains(&var.class) && numbers.contains(var.number) {
                let value = state[*at].join(value);
                set(state, *at, value);
            }
        }
    }

    /// What a call at the end of a block may change.
    fn leave(&self, block: &Block, state: &mut State) {
        let TermKind::Call { call, .. } = &block.term.kind else { return };
        let written = self.summaries.by_call(call);
        let body = matches!(call.callee, Callee::Block(_));
        self.forget(state, |var| body || written.contains(var));
    }

    fn forget(&self, state: &mut State, which: impl Fn(Var) -> bool) {
        for (_, at) in self.places.iter().filter(|(var, _)| which(**var)) {
            set(state, *at, Values::ANY);
        }
    }
}

/// What state may be where one of the standard work offsets is in force: the number of its code, and none of an additional one.
fn selected(state: Sys, subscripts: &[Expr]) -> Values {
    let of = subscripts.first().and_then(Expr::constant);
    match state {
        Sys::Modal if of.is_some() && of == Group::WorkOffset.number().map(f64::from) => {
            Values::of((54..=59).map(f64::from).collect())
        }
        Sys::Address if of == Some(LAST_P) => Values::Few(Vec::new()),
        _ => Values::ANY,
    }
}

/// The letter P, counted from A as 1: the last P that controls keep is that of an additional work offset.
pub const LAST_P: f64 = 16.0;

/// The literals that are assigned before anything can branch, by block and statement.
pub(super) fn head_literals(program: &Program) -> Vec<(BlockId, usize, Var)> {
    let (mut found, mut seen, mut next) = (Vec::new(), BTreeSet::new(), Some(BlockId(0)));
    while let Some(id) = next.take().filter(|id| seen.insert(*id)) {
        let Some(block) = program.block(id) else { break };
        for (at, stmt) in block.stmts.iter().enumerate() {
            if let StmtKind::Assign { target: Place::Var(var), value } = &stmt.kind
                && value.constant().is_some()
            {
                found.push((id, at, *var));
            }
        }
        if let TermKind::Jump(to) = &block.term.kind {
            next = Some(*to);
        }
    }
    found
}

/// How many statements assign a variable.
fn assigned(program: &Program, var: Var) -> usize {
    let stmts = program.blocks.iter().flat_map(|block| &block.stmts);
    stmts.filter(|stmt| matches!(stmt.kind.target(), Some(Place::Var(other)) if *other == var)).count()
}
