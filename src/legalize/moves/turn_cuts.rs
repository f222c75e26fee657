//! Cuts in feed per turn, for a target without that mode.
//!
//! Law: a cut that feeds p a turn at S turns a minute feeds S * p a minute. Side conditions: the speed is one known number of
//! turns wherever such a feed is told, and the same wherever it cuts; each cut is known to be in one mode, with a feed that
//! was told in that mode; no feed may be vacant, and nothing reads the mode or the feed; all that calls the programs, and all that they
//! call, is in the library. What the operator does with the override of the spindle no longer changes the feed: a note says so.
//! Counter-example: `G95 F.1` and then `S+#1`: the feed in force would stay that of the old speed. Where a side condition
//! fails the mode stays, and is refused as a code that the target lacks.

use super::inverse_feeds::{goes, needs_no_feed};
use crate::canon::{Group, Op, Role, Sys};
use crate::diag::{Code, Diagnostic};
use crate::ir::analysis::dataflow::Lattice;
use crate::ir::analysis::over_calls::{Follow, OverCalls};
use crate::ir::analysis::{ModalFacts, Summaries, Vacancy, calls_of};
use crate::ir::{BinOp, Block, BlockId, Callee, Expr, Module, Nc, NcItem, Program, Stmt, StmtKind, TermKind};
use crate::legalize::cycles::tap_leads::{Speed, Speeds};
use crate::legalize::features::Features;
use crate::legalize::{Context, Modal};
use crate::text::Span;
use std::collections::{BTreeMap, BTreeSet};

const PER_MINUTE: &str = "feeds per turn are written as feeds per minute at the programmed speed: the target has none per turn, so the \
     override of the spindle no longer changes these feeds";

const RETURNS: &str = "a feed per turn is in force at this return, and the target has one per minute in its place: make sure that \
     the caller writes F before it cuts";

/// True if there are feeds per turn, and the target has no code for the mode.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    features.op(Op::FeedPerTurn) && context.target.code_for(Op::FeedPerTurn, &BTreeMap::new()).is_none()
}

/// Says cuts in feed per minute, in all programs that call one another and meet the side conditions.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let facts = context.modal_facts(module);
    let feeds = Feeds { facts: &facts, speeds: OverCalls::of(module, &Speeds) };
    let known = OverCalls::of(module, &feeds);
    let summaries = context.summaries(module);
    let mut changed = false;
    for group in groups(module) {
        let turns = |index: &usize| module.programs.get(*index).is_some_and(has_turns);
        if !group.iter().any(turns) {
            continue;
        }
        let fit = |index: &usize| {
            let look = Look { index: *index, feeds: &feeds, known: &known, group: &group, module };
            module.programs.get(*index).is_some_and(|program| look.fits(program, &summaries))
        };
        if !group.iter().all(fit) {
            continue;
        }
        let mut returns = Vec::new();
        for index in &group {
            let look = Look { index: *index, feeds: &feeds, known: &known, group: &group, module };
            returns.extend(look.returns_by_turn().map(|span| (*index, span)));
        }
        for (index, span) in returns {
            context.add_once(index, RETURNS, Diagnostic::new(Code::Conditional, span, RETURNS));
        }
        for index in &group {
            let Some(program) = module.programs.get_mut(*index) else { continue };
            if let Some(span) = rewrite(program, *index, &feeds) {
                context.add_once(
                    *index,
                    PER_MINUTE,
                    Diagnostic::new(Code::TurnsWrittenOut, span, PER_MINUTE),
                );
            }
            changed = true;
        }
    }
    changed
}

fn has_turns(program: &Program) -> bool {
    let mut stmts = program.blocks.iter().flat_map(|block| &block.stmts);
    stmts.any(|stmt| stmt.kind.has_op(Op::FeedPerTurn))
}

fn by_turn(state: &Modal) -> bool {
    state.op(Group::FeedMode) == Some(Op::FeedPerTurn)
}

/// Programs that call one another, however far; each program is in one group.
fn groups(module: &Module) -> Vec<BTreeSet<usize>> {
    let names: BTreeMap<_, usize> =
        module.programs.iter().enumerate().filter_map(|(at, p)| Some((p.name.as_ref()?, at))).collect();
    let mut group: Vec<usize> = (0..module.programs.len()).collect();
    for (at, program) in module.programs.iter().enumerate() {
        for call in program.blocks.iter().flat_map(calls_of) {
            let Callee::Program(name) = &call.callee else { continue };
            let (Some(other), Some(own)) =
                (names.get(name).and_then(|other| group.get(*other)), group.get(at))
            else {
                continue;
            };
            let (from, to) = (*other, *own);
            group.iter_mut().filter(|one| **one == from).for_each(|one| *one = to);
        }
    }
    let mut all: BTreeMap<usize, BTreeSet<usize>> = BTreeMap::new();
    for (at, one) in group.into_iter().enumerate() {
        all.entry(one).or_default().insert(at);
    }
    all.into_values().collect()
}

/// What the feed in force counts.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fed {
    /// It is one per minute, or what was in force before.
    Minute,
    /// It was told per turn, at this speed.
    Turn(f64),
    /// It may be either.
    Open,
}

impl Lattice for Fed {
    fn join(&mut self, other: &Self) -> bool {
        let joined = if *self == *other { *self } else { Self::Open };
        std::mem::replace(self, joined) != joined
    }
}

/// The feed in force at every block of a library.
struct Feeds<'f> {
    facts: &'f ModalFacts,
    speeds: OverCalls<Speed>,
}

impl Feeds<'_> {
    /// What is in force at the start of a block.
    fn at(&self, index: usize, id: BlockId) -> (Modal, Speed) {
        (self.facts.at(index, id), self.speeds.at(index, id).copied().unwrap_or(Speed::Unknown))
    }
}

impl Follow for Feeds<'_> {
    type Known = Fed;

    fn outside(&self, _: usize) -> Fed {
        Fed::Minute
    }

    fn stmts(&self, (index, id): (usize, BlockId), block: &Block, fed: &mut Fed) {
        let (mut state, mut speed) = self.at(index, id);
        for stmt in &block.stmts {
            state.step(stmt);
            speed.step(stmt);
            step(stmt, &state, speed, fed);
        }
    }

    fn lose(&self, fed: &mut Fed) {
        *fed = Fed::Open;
    }
}

/// The feed after a statement, with what is in force after it.
fn step(stmt: &Stmt, state: &Modal, speed: Speed, fed: &mut Fed) {
    if stmt.kind.nc().is_none_or(|nc| nc.word(Role::Feed).is_none()) {
        return;
    }
    *fed = match (state.op(Group::FeedMode), speed) {
        _ if stmt.site.skip.is_some() => Fed::Open,
        (Some(Op::FeedPerMinute), _) => Fed::Minute,
        (Some(Op::FeedPerTurn), Speed::Known(speed)) => Fed::Turn(speed),
        _ => Fed::Open,
    };
}

/// Looks whether a program meets the side conditions.
struct Look<'l> {
    index: usize,
    feeds: &'l Feeds<'l>,
    known: &'l OverCalls<Fed>,
    group: &'l BTreeSet<usize>,
    module: &'l Module,
}

impl Look<'_> {
    fn fits(&self, program: &Program, summaries: &Summaries) -> bool {
        // A word that is computed from a vacant variable is not there.
        let vacant = Vacancy::of(program, summaries, &BTreeSet::new()).absent(&|_, role| role == Role::Feed);
        program.ids().zip(&program.blocks).all(|(id, block)| {
            // No run comes here.
            let Some(mut fed) = self.known.at(self.index, id).copied() else { return true };
            let (mut state, mut speed) = self.feeds.at(self.index, id);
            let stmts = block.stmts.iter().enumerate().all(|(at, stmt)| {
                state.step(stmt);
                speed.step(stmt);
                step(stmt, &state, speed, &mut fed);
                let mut reads = false;
                stmt.kind.exprs(&mut |e| reads |= reads_feed(e));
                !reads && is_plain(stmt, &state, speed, fed, vacant.contains(&(id, at)))
            });
            let mut reads = false;
            block.term.kind.exprs(&mut |e| reads |= reads_feed(e));
            stmts && !reads && self.ends_plainly(&block.term.kind, &state)
        })
    }

    /// True where a block in feed per turn goes on in the library, or ends the run.
    fn ends_plainly(&self, term: &TermKind, state: &Modal) -> bool {
        if state.op(Group::FeedMode) == Some(Op::FeedPerMinute) {
            return true;
        }
        let named = |name| {
            let mut all = self.group.iter().filter_map(|index| self.module.programs.get(*index));
            all.any(|program| program.name.as_ref() == Some(name))
        };
        match term {
            TermKind::Call { call, .. } => match &call.callee {
                Callee::Block(_) => true,
                Callee::Program(name) => named(name),
                Callee::Computed(_) | Callee::Cycle(_) => false,
            },
            TermKind::Return { to } => to.is_none() && (!by_turn(state) || self.is_called()),
            TermKind::Chain(_) => false,
            _ => true,
        }
    }

    /// The first return to a caller that nobody knows with a feed in force that was told per turn.
    fn returns_by_turn(&self) -> Option<Span> {
        let program = self.module.programs.get(self.index).filter(|_| !self.is_called())?;
        program.ids().zip(&program.blocks).find_map(|(id, block)| {
            let mut fed = self.known.at(self.index, id).copied()?;
            self.feeds.stmts((self.index, id), block, &mut fed);
            let returns = matches!(block.term.kind, TermKind::Return { .. });
            (returns && fed != Fed::Minute).then_some(block.term.site.span)
        })
    }

    fn is_called(&self) -> bool {
        let name = self.module.programs.get(self.index).and_then(|program| program.name.as_ref());
        let calls = self.module.programs.iter().flat_map(|program| &program.blocks).flat_map(calls_of);
        calls.into_iter().any(|call| matches!(&call.callee, Callee::Program(other) if Some(other) == name))
    }
}

/// True where the feed of a statement, told or in force, is known to count turns or not to, and can be said in minutes.
fn is_plain(stmt: &Stmt, state: &Modal, speed: Speed, fed: Fed, vacant: bool) -> bool {
    let nc = match &stmt.kind {
        StmtKind::Nc(nc) => nc,
        StmtKind::ModalCall(_) => return !by_turn(state),
        _ => return true,
    };
    let tells = nc.word(Role::Feed);
    if tells.is_none() && !cuts(nc, state) {
        return !(stmt.site.skip.is_some() && nc.ops().any(|op| op.group() == Group::FeedMode));
    }
    match state.op(Group::FeedMode) {
        Some(Op::FeedPerTurn) => {
            let taps = nc.ops().any(Op::is_tap) || state.op(Group::Cycle).is_some_and(Op::is_tap);
            let codes = nc.items.iter().any(|item| matches!(item, NcItem::Code(..)));
            let Speed::Known(speed) = speed else { return false };
            let counts = |value: &Expr| {
                let mut any = *value == Expr::Vacant;
                value.walk(&mut |e: &Expr| any |= matches!(e, Expr::Increments(_)));
                any
            };
            let skips = stmt.site.skip.is_some() && (tells.is_some() || nc.word(Role::Speed).is_some());
            let open = taps || codes || skips || vacant || tells.is_some_and(counts);
            !open && speed > 0.0 && fed == Fed::Turn(speed)
        }
        Some(Op::FeedInverse) => true,
        Some(_) => fed == Fed::Minute,
        None => false,
    }
}

/// True where a block may cut at the feed in force.
pub(in crate::legalize) fn cuts(nc: &Nc, state: &Modal) -> bool {
    let rapid = state.op(Group::Motion) == Some(Op::Rapid) && state.op(Group::Cycle) == Some(Op::CycleOff);
    nc.ops().any(Op::is_cycle) || goes(nc) && !rapid && !nc.ops().any(needs_no_feed)
}

/// True for what tells the feed in force, or its mode.
pub(in crate::legalize) fn reads_feed(e: &Expr) -> bool {
    let mut reads = false;
    e.walk(&mut |e: &Expr| {
        reads |= match e {
            Expr::System(Sys::Modal | Sys::ModalNow, of) => {
                !of.first().and_then(Expr::constant).is_some_and(|group| (1.0..5.0).contains(&group))
            }
            Expr::System(Sys::CodeTest | Sys::Address | Sys::AddressNow, _) => true,
            _ => false,
        }
    });
    reads
}

/// Puts feed per minute in place of feed per turn; yields the first place where it did.
fn rewrite(program: &mut Program, index: usize, feeds: &Feeds<'_>) -> Option<Span> {
    let mut first = None;
    for (id, block) in (0..).map(BlockId).zip(&mut program.blocks) {
        let (mut state, mut speed) = feeds.at(index, id);
        for stmt in &mut block.stmts {
            state.step(stmt);
            speed.step(stmt);
            let StmtKind::Nc(nc) = &mut stmt.kind else { continue };
            for item in &mut nc.items {
                match item {
                    NcItem::Op(op) if *op == Op::FeedPerTurn => *op = Op::FeedPerMinute,
                    NcItem::Word(Role::Feed, value) if by_turn(&state) => {
                        let Speed::Known(speed) = speed else { continue };
                        first = first.or(Some(stmt.site.span));
                        *value = match value.constant() {
                            Some(feed) => Expr::Number((feed * speed * 1e6).round() / 1e6),
                            None => Expr::binary(BinOp::Mul, value.clone(), Expr::Number(speed)),
                        };
                    }
                    _ => {}
                }
            }
        }
    }
    first
}
