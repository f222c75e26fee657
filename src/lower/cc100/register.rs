//! The condition register: which jump looks at what.
//!
//! Lowering notes every setting of the register as an assignment to a marker, and
//! every jump as one on [`REGISTER`]. Here, on the whole program, a jump whose
//! register can only be what one variable still holds becomes a comparison of
//! that variable with zero; it is exact, since the register keeps the sign of
//! what the variable was given last. Where ways with different settings meet, the
//! register itself is assigned, in those places that a jump can see. A test of the
//! machine's state directly before its jump is the jump's condition; where the
//! profile says its outcome, the jump goes or not, and what only it came to is
//! left out. All other markers go.
//!
//! Whether a plain load sets the register no source says. A jump that sees one
//! after the last arithmetic is therefore left to a reviewer.

use super::parts::leaves;
use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::analysis::Cfg;
use crate::ir::analysis::dataflow::{Analysis, Direction, Lattice, reached_among, solve, solve_everywhere};
use crate::ir::{
    Block, BlockId, Class, Cond, Expr, Place, Program, Relation, SourceInfo, Stmt, StmtKind, TermKind, Var,
};
use crate::lower::common::Findings;
use std::borrow::Cow;

/// The condition register.
pub const REGISTER: Var = Var { class: Class::Register, number: 0 };

/// What sets the register.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// Arithmetic, INC and DEC.
    Arithmetic,
    /// TST of a variable.
    Test,
    /// TST of a state of the machine: only zero or not zero is known of it.
    Flag,
    /// A load on a control of which it is known that a load sets the register.
    LoadThatSets,
    /// A load that may set the register or not.
    Load,
}

const SOURCES: [Source; 5] =
    [Source::Arithmetic, Source::Test, Source::Flag, Source::LoadThatSets, Source::Load];

/// The variable whose assignment notes a setting; gone when [`resolve`] is done.
pub fn marker(source: Source) -> Var {
    Var { class: Class::Register, number: 1 + source as u32 }
}

fn source_of(stmt: &Stmt) -> Option<(Source, &Expr)> {
    let StmtKind::Assign { target: Place::Var(var), value } = &stmt.kind else { return None };
    let source = SOURCES.into_iter().find(|source| marker(*source) == *var)?;
    Some((source, value))
}

/// What is known of the register at a place.
#[derive(Clone, Debug, PartialEq)]
struct State {
    /// The variable whose sign it has.
    var: Option<Var>,
    /// One bit a [`Source`] that it may come from, and [`OUTSIDE`].
    from: u8,
}

/// The register may be what it was before the program, or what a called cycle left.
const OUTSIDE: u8 = 1 << 7;

const fn bit(source: Source) -> u8 {
    1 << source as u8
}

impl Lattice for State {
    fn join(&mut self, other: &Self) -> bool {
        let before = (self.var, self.from);
        *self = Self { var: self.var.filter(|_| self.var == other.var), from: self.from | other.from };
        before != (self.var, self.from)
    }
}

impl State {
    fn outside() -> Self {
        Self { var: None, from: OUTSIDE }
    }

    fn may(&self, source: Source) -> bool {
        self.from & bit(source) != 0
    }

    fn step(&mut self, stmt: &Stmt) {
        match source_of(stmt) {
            Some((Source::Load, _)) => self.from |= bit(Source::Load),
            Some((source, value)) => {
                let var = if let Expr::Var(var) = value { Some(*var) } else { None };
                *self = Self { var, from: bit(source) };
            }
            None => {
                if let StmtKind::Assign { target: Place::Var(var), .. } = &stmt.kind
                    && self.var == Some(*var)
                {
                    self.var = None;
                }
            }
        }
    }
}

/// What blocks do to it.
struct Settings;

impl Analysis for Settings {
    type State = State;
    const DIRECTION: Direction = Direction::Forward;

    fn entries(&self, _: &Cfg) -> Vec<(BlockId, State)> {
        vec![(BlockId(0), State::outside())]
    }

    fn block(&self, _: BlockId, block: &Block, state: &mut State) {
        block.stmts.iter().for_each(|stmt| state.step(stmt));
        if leaves(block) {
            *state = State::outside();
        }
    }
}

/// The relation of a jump on the register.
fn jump(block: &Block) -> Option<Relation> {
    match &block.term.kind {
        TermKind::Branch { cond, .. } => match &**cond {
            Cond::Compare(relation, Expr::Var(REGISTER), _) => Some(*relation),
            _ => None,
        },
        _ => None,
    }
}

/// Gives every jump its condition and takes the markers out.
pub fn resolve(program: &mut Program, findings: &mut Findings<'_>) {
    let cfg = Cfg::parts(program);
    let starts = solve_everywhere(&Settings, program, &cfg, &State::outside());
    let (mut seen, mut passed) = (false, false);
    for (at, block) in (0..).map(BlockId).zip(&mut program.blocks) {
        let Some(relation) = jump(block) else { continue };
        let mut state = starts.at(at).cloned().unwrap_or_else(State::outside);
        Settings.block(at, block, &mut state);
        report(&state, relation, block, findings);
        let tested = tested(block, relation);
        if let Some(jumps) = settled(block, relation)
            && let TermKind::Branch { then, otherwise, .. } = &block.term.kind
        {
            block.term.kind = TermKind::Jump(if jumps { *then } else { *otherwise });
            if block.term.site.comments.is_empty() {
                block.term.site = SourceInfo::default();
            }
            passed = true;
            continue;
        }
        match (state.var, tested, &mut block.term.kind) {
            (Some(var), _, TermKind::Branch { cond, .. }) => {
                **cond = Cond::Compare(relation, Expr::Var(var), Expr::Number(0.0));
            }
            (None, Some(differs), TermKind::Branch { cond, .. }) => **cond = differs,
            _ => seen = true,
        }
    }
    if passed {
        leave_out(program, &cfg);
    }
    let live = if seen { solve(&Seen { program }, program, &cfg) } else { Default::default() };
    for (at, block) in (0..).map(BlockId).zip(&mut program.blocks) {
        settle(block, live.at(at) == Some(&true));
    }
}

/// The condition of a jump that looks at a test of the machine's state directly before it.
fn tested(block: &Block, relation: Relation) -> Option<Cond> {
    let (Source::Flag, Expr::Truth(differs)) = source_of(block.stmts.last()?)? else { return None };
    match relation {
        Relation::Equal => Some(Cond::clone(differs).negated()),
        Relation::NotEqual => Some(Cond::clone(differs)),
        _ => None,
    }
}

/// Whether a jump goes that looks at a test directly before it whose outcome the profile of the machine says.
fn settled(block: &Block, relation: Relation) -> Option<bool> {
    let (Source::Flag, Expr::Number(flag)) = source_of(block.stmts.last()?)? else { return None };
    match relation {
        Relation::Equal => Some(*flag == 0.0),
        Relation::NotEqual => Some(*flag != 0.0),
        _ => None,
    }
}

/// Takes the text out of blocks that only such a jump came to, as the stop of a machine that is set to the other unit.
fn leave_out(program: &mut Program, before: &Cfg) {
    let reached = |program: &Program, cfg: &Cfg| {
        let roots = cfg.roots().iter().map(|root| root.index());
        reached_among(program.blocks.len(), roots, |at, go| {
            cfg.succs(BlockId(at as u32)).iter().for_each(|to| go(to.index()));
        })
    };
    let (was, is) = (reached(program, before), reached(program, &Cfg::parts(program)));
    for (block, (was, is)) in program.blocks.iter_mut().zip(was.into_iter().zip(is)) {
        if was && !is {
            block.labels.clear();
            block.stmts.clear();
            block.term.site = SourceInfo::default();
        }
    }
}

fn report(state: &State, relation: Relation, block: &Block, findings: &mut Findings<'_>) {
    let span = block.term.site.span;
    let control = findings.control();
    if state.from & OUTSIDE != 0 {
        let message = "the condition register may have been set outside this program";
        findings.add(Diagnostic::new(Code::RegisterUnset, span, message));
    }
    if state.may(Source::Flag) && !matches!(relation, Relation::Equal | Relation::NotEqual) {
        let message = "a test of the machine's state tells zero from not zero; no source gives its sign";
        findings.not_understood(span, message);
    }
    if state.may(Source::Arithmetic)
        && let Some(row) = control.behaviour(Question::ConditionRegister)
    {
        findings.rest_on(row, span);
    }
    if state.may(Source::Load) || state.may(Source::LoadThatSets) {
        match control.behaviour(Question::LoadSetsCondition).filter(|row| row.value != "unknown") {
            Some(row) => findings.rest_on(row, span),
            None => {
                let why = "a load between the arithmetic and this jump is taken to leave the register as \
                           it is";
                findings.unconfirmed(Question::LoadSetsCondition.fact().into(), Some(why), span);
            }
        }
    }
}

/// Whether a jump can see the register as it is at the end of each block, before its jump.
struct Seen<'p> {
    program: &'p Program,
}

impl Analysis for Seen<'_> {
    type State = bool;
    const DIRECTION: Direction = Direction::Backward;

    fn entries(&self, _: &Cfg) -> Vec<(BlockId, bool)> {
        let blocks = self.program.ids().zip(&self.program.blocks);
        blocks.filter(|(_, block)| jump(block).is_some()).map(|(id, _)| (id, true)).collect()
    }

    fn block(&self, _: BlockId, block: &Block, seen: &mut bool) {
        *seen &= !block.stmts.iter().any(sets);
    }

    fn edge<'s>(&self, from: BlockId, _: BlockId, seen: &'s bool) -> Option<Cow<'s, bool>> {
        let left = self.program.block(from).is_some_and(leaves);
        (*seen && !left).then_some(Cow::Borrowed(seen))
    }
}

/// True for what gives the register another value for certain.
fn sets(stmt: &Stmt) -> bool {
    source_of(stmt).is_some_and(|(source, _)| source != Source::Load)
}

/// Turns the markers that a jump can see into assignments of the register, and drops the rest.
fn settle(block: &mut Block, live: bool) {
    let last = block.stmts.iter().rposition(sets);
    let mut at = 0;
    block.stmts.retain_mut(|stmt| {
        let here = at;
        at += 1;
        if source_of(stmt).is_none() {
            return true;
        }
        let keep = live && last == Some(here);
        if keep && let StmtKind::Assign { target, .. } = &mut stmt.kind {
            *target = Place::Var(REGISTER);
        }
        keep
    });
}
