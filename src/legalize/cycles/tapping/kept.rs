//! The feed from before a tap: where the target's own tap feed stands in its place, and what brings it back.
//!
//! It matters only where something cuts by it, or reads it, before a block says a feed. There it is said again, or that place is
//! reported. The holes under the tap are no such place, in whatever program their positions stand.

use super::touched::{Touched, keeps_cycle, roots};
use crate::canon::{Group, Op, Role, Sys};
use crate::dialect::Control;
use crate::ir::analysis::dataflow::Lattice;
use crate::ir::analysis::modal::Modal;
use crate::ir::analysis::over_calls::{Follow, OverCalls, called};
use crate::ir::{
    Block, BlockId, Call, Class, Expr, Module, Place, Program, SourceInfo, Stmt, StmtKind, TermKind, Var,
};
use crate::legalize::ModalFacts;
use crate::legalize::moves::turn_cuts::{cuts, reads_feed};
use crate::legalize::rewrite::highest_temp;
use std::collections::BTreeSet;

/// F by the place of its letter.
const ADDRESS_F: u32 = 6;

/// The feed in force on the target; `tapping` where that of a tap is in force only while a tap is, whose holes have their own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Feed {
    /// That of the source.
    Same,
    /// A register holds that of the source; in force is that of a tap, or the same.
    Held { tapping: bool },
    /// That of a tap may be in force, and nothing holds that of the source.
    Lost { tapping: bool },
}

impl Feed {
    fn is_tapping(self) -> bool {
        match self {
            Self::Same => true,
            Self::Held { tapping } | Self::Lost { tapping } => tapping,
        }
    }

    /// What another program, or another level of this one, knows of it.
    fn elsewhere(self) -> Self {
        match self {
            Self::Held { tapping } => Self::Lost { tapping },
            feed => feed,
        }
    }

    fn set_tapping(&mut self, now: bool) {
        if let Self::Held { tapping } | Self::Lost { tapping } = self {
            *tapping = now;
        }
    }
}

/// What must be done at a statement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Does {
    Nothing,
    /// Before it the feed is read into the register.
    Reads,
    /// It says this feed again.
    Says(f64),
    /// It says the feed that the register holds.
    SaysHeld,
    /// It should say the feed, which is not known.
    Fails,
}

/// How a block ends with another feed than that of the source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ends {
    /// The run ends.
    Run,
    /// What goes on is not known.
    Unknown,
}

/// The feed at the start of every block of a library.
pub struct Kept {
    readable: bool,
    /// True where a tap of the source is known to leave the feed as it was: it is said again where the cycle ends, needed or not.
    at_end: bool,
    /// True where what nobody knows may run in the middle of a tap, or with its feed.
    open: bool,
    /// By program: whether it returns, and whether others call it by its name.
    returns: Vec<bool>,
    called: Vec<bool>,
    /// Blocks that calls enter.
    roots: BTreeSet<(usize, BlockId)>,
    touched: Touched,
    known: Option<OverCalls<Feed>>,
    /// What holds the feed, in those programs that need it.
    registers: Vec<Option<Var>>,
}

impl Kept {
    /// Follows the feed through a library.
    pub fn of(module: &Module, facts: &ModalFacts, target: &Control, at_end: bool) -> Self {
        let mut kept = Self {
            readable: target.system_address(Sys::Address, &[ADDRESS_F]).is_some(),
            at_end,
            open: false,
            returns: module.programs.iter().map(Program::returns).collect(),
            called: called(module),
            roots: roots(module),
            touched: Touched::of(module),
            known: None,
            registers: Vec::new(),
        };
        // What nobody knows finds the feed as it was, unless it runs in the middle of a tap.
        kept.known = Some(OverCalls::of(module, &Follows { kept: &kept, facts }));
        if kept.is_open(module, facts) {
            kept.open = true;
            kept.known = Some(OverCalls::of(module, &Follows { kept: &kept, facts }));
        }
        for (index, program) in module.programs.iter().enumerate() {
            let asks = program.ids().any(|id| {
                let (mut modal, mut feed) = (facts.at(index, id), kept.at(index, id));
                let stmts = program.blocks.get(id.index()).into_iter().flat_map(|block| &block.stmts);
                stmts.into_iter().any(|stmt| kept.step(stmt, &mut modal, &mut feed) == Does::SaysHeld)
            });
            let register = Var { class: Class::Temp, number: highest_temp(program) + 1 };
            kept.registers.push(asks.then_some(register));
        }
        kept
    }

    /// True where something that nobody knows runs with another feed than that of the source.
    fn is_open(&self, module: &Module, facts: &ModalFacts) -> bool {
        module.programs.iter().enumerate().any(|(index, program)| {
            program.ids().zip(&program.blocks).any(|(id, block)| {
                if !self.is_reached(index, id) {
                    return false;
                }
                let (mut modal, mut feed) = (facts.at(index, id), self.at(index, id));
                let calls = block.stmts.iter().any(|stmt| {
                    self.step(stmt, &mut modal, &mut feed);
                    feed != Feed::Same && calls_by_moving(stmt, &modal)
                });
                calls || feed != Feed::Same && self.touched.is_unknown(&block.term.kind)
            })
        })
    }

    fn is_reached(&self, program: usize, id: BlockId) -> bool {
        self.known.as_ref().is_some_and(|known| known.at(program, id).is_some())
    }

    /// The feed at the start of a block; that of the source where no run comes.
    pub fn at(&self, program: usize, id: BlockId) -> Feed {
        let known = self.known.as_ref().and_then(|known| known.at(program, id).copied());
        self.entered(program, id, known.unwrap_or(Feed::Same))
    }

    /// The same where a block may be entered by calls: a register is of one level of one program.
    fn entered(&self, program: usize, id: BlockId, feed: Feed) -> Feed {
        if self.open && id == BlockId(0) && self.returns.get(program) == Some(&true) {
            return Feed::Lost { tapping: false };
        }
        if self.roots.contains(&(program, id)) { feed.elsewhere() } else { feed }
    }

    /// What holds the feed in a program.
    pub fn register(&self, program: usize) -> Option<Var> {
        self.registers.get(program).copied().flatten()
    }

    /// The statement that reads the feed into a register before another one.
    pub fn reading(register: Var, stmt: &Stmt) -> Stmt {
        let read = Expr::System(Sys::Address, [Expr::Number(f64::from(ADDRESS_F))].into());
        let kind = StmtKind::Assign { target: Place::Var(register), value: read };
        Stmt { kind, site: SourceInfo { span: stmt.site.span, ..SourceInfo::default() } }
    }

    /// Goes on after a statement, and says what must be done at it.
    pub fn step(&self, stmt: &Stmt, modal: &mut Modal, feed: &mut Feed) -> Does {
        let (was, known) = (modal.op(Group::Cycle), modal.feed());
        modal.step(stmt);
        let reads = *feed != Feed::Same && says(|f| stmt.kind.exprs(f));
        let StmtKind::Nc(nc) = &stmt.kind else {
            return if reads { fail(feed) } else { Does::Nothing };
        };
        let skipped = stmt.site.skip.is_some();
        let now = modal.op(Group::Cycle);
        let tapping = now.map_or(keeps_cycle(nc) && was.is_none() && feed.is_tapping(), Op::is_tap);
        // What was read counts something else in another unit or feed mode.
        let other = nc.ops().any(|op| matches!(op.group(), Group::Units | Group::FeedMode));
        let mut does = Does::Nothing;
        if nc.ops().any(Op::is_tap) {
            if *feed == Feed::Same && nc.word(Role::Lead).is_some() {
                (*feed, does) = match self.readable {
                    true => (Feed::Held { tapping }, Does::Reads),
                    false => (Feed::Lost { tapping }, Does::Nothing),
                };
            } else if nc.word(Role::Lead).is_none() && !skipped {
                // A tap by feed has its own, or that from before.
                if *feed != Feed::Same && nc.word(Role::Feed).is_none() {
                    does = known.map_or(Does::Fails, Does::Says);
                }
                *feed = Feed::Same;
            }
        } else if nc.word(Role::Feed).is_some() {
            *feed = match *feed {
                Feed::Same => Feed::Same,
                _ if skipped => Feed::Lost { tapping },
                _ => Feed::Same,
            };
        } else if *feed != Feed::Same {
            let ends = was.is_none_or(Op::is_tap) && now.is_some_and(|op| !op.is_tap());
            let needed = !tapping && cuts(nc, modal);
            does = match (known, *feed) {
                _ if !ends && !needed => Does::Nothing,
                (Some(feed), _) => Does::Says(feed),
                (None, Feed::Held { .. }) if !other && (needed || self.at_end) => Does::SaysHeld,
                _ if needed => Does::Fails,
                _ => Does::Nothing,
            };
            // Who reads that it is missing writes it.
            if does != Does::Nothing && !skipped {
                *feed = Feed::Same;
            }
        }
        if reads {
            does = fail(feed);
        }
        feed.set_tapping(tapping);
        if matches!(feed, Feed::Held { .. }) && other || self.open && calls_by_moving(stmt, modal) {
            *feed = Feed::Lost { tapping: tapping && !self.open };
        }
        does
    }

    /// How a block ends, where that leaves another feed than that of the source.
    pub fn ends(&self, program: usize, id: BlockId, term: &TermKind, feed: Feed) -> Option<Ends> {
        if feed == Feed::Same || !self.is_reached(program, id) {
            return None;
        }
        match term {
            TermKind::End { .. } | TermKind::Stray => Some(Ends::Run),
            TermKind::Return { .. } => (self.called.get(program) != Some(&true)).then_some(Ends::Unknown),
            term if self.touched.is_unknown(term) || says(|f| term.exprs(f)) => Some(Ends::Unknown),
            _ => None,
        }
    }
}

/// A place where the feed is missing: who reads that writes it.
fn fail(feed: &mut Feed) -> Does {
    *feed = Feed::Same;
    Does::Fails
}

/// True where an expression reads the feed.
fn says(exprs: impl FnOnce(&mut dyn FnMut(&Expr))) -> bool {
    let mut reads = false;
    exprs(&mut |e| reads |= reads_feed(e));
    reads
}

impl Lattice for Feed {
    fn join(&mut self, other: &Self) -> bool {
        let tapping = self.is_tapping() && other.is_tapping();
        let joined = match (*self, *other) {
            (Self::Same, Self::Same) => Self::Same,
            (Self::Held { .. }, Self::Held { .. }) => Self::Held { tapping },
            _ => Self::Lost { tapping },
        };
        std::mem::replace(self, joined) != joined
    }
}

/// What the blocks of a library do to the feed.
struct Follows<'f> {
    kept: &'f Kept,
    facts: &'f ModalFacts,
}

impl Follow for Follows<'_> {
    type Known = Feed;

    fn outside(&self, _: usize) -> Feed {
        Feed::Same
    }

    fn stmts(&self, (index, id): (usize, BlockId), block: &Block, feed: &mut Feed) {
        let mut modal = self.facts.at(index, id);
        *feed = self.kept.entered(index, id, *feed);
        for stmt in &block.stmts {
            self.kept.step(stmt, &mut modal, feed);
        }
    }

    fn lose(&self, feed: &mut Feed) {
        if *feed != Feed::Same || self.kept.open {
            *feed = Feed::Lost { tapping: false };
        }
    }

    fn returned(&self, program: usize, call: &Call, before: &Feed, after: &mut Feed) {
        // Where only positions stand, all stays as it was.
        *after = if self.kept.touched.touches(program, call) { after.elsewhere() } else { *before };
    }
}

/// True for a block that moves where a modal call may be open.
fn calls_by_moving(stmt: &Stmt, modal: &Modal) -> bool {
    modal.may_call() && matches!(&stmt.kind, StmtKind::Nc(nc) if nc.names_axis())
}
