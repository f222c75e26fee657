//! Feeds in inverse time: F counts how many times a minute the move of its own block could be done.
//!
//! Such an F is for one block. A block that feeds without one is an alarm; a drilling cycle has more than one move, and no
//! source says what F is for it; and the F of the last such block is no feed per minute or per turn for the moves after
//! the mode. A program that rests on one of these is refused, and not at the machine.

use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::ir::analysis::dataflow::Lattice;
use crate::ir::analysis::over_calls::{Follow, OverCalls};
use crate::ir::{Block, BlockId, Module, Nc, NcItem, Stmt, StmtKind};
use crate::legalize::features::Features;
use crate::legalize::{Context, Modal};

/// True if a program feeds in inverse time.
pub fn concerns(features: &Features) -> bool {
    features.op(Op::FeedInverse)
}

/// Refuses what rests on a feed that is none.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let facts = context.modal_facts(module);
    let feeds = OverCalls::of(module, &Feeds);
    for (index, program) in module.programs.iter().enumerate() {
        for (at, block) in program.blocks.iter().enumerate() {
            let id = BlockId(at as u32);
            let mut state = facts.at(index, id);
            let mut feed = feeds.at(index, id).copied().unwrap_or_default();
            for stmt in &block.stmts {
                state.step(stmt);
                feed.step(stmt);
                let StmtKind::Nc(nc) = &stmt.kind else { continue };
                if let Some((what, help)) = wrong(nc, &state, feed) {
                    context.add(
                        index,
                        Diagnostic::new(Code::NoEquivalent, stmt.site.span, what).with_help(help),
                    );
                }
            }
        }
    }
}

type Told = (&'static str, &'static str);

const WITHOUT: Told = (
    "under inverse time feed each block that feeds has an F of its own; without one the control stops with an alarm",
    "write F into the block: 1 divided by the minutes that its move takes",
);

const CYCLE: Told = (
    "no source says what F of a drilling cycle counts under inverse time feed",
    "write G94 and a feed per minute before the cycle, and the code for inverse time after it",
);

const STALE: Told = (
    "the last F counted moves per minute, for inverse time feed; no source says which feed is in force after it",
    "write F again in this block, or before it",
);

/// What is wrong with a block; none for most.
fn wrong(nc: &Nc, state: &Modal, feed: Feed) -> Option<Told> {
    let told = nc.word(Role::Feed).is_some();
    let drills = nc.ops().any(Op::is_cycle) || goes(nc) && state.op(Group::Cycle).is_some_and(Op::is_cycle);
    if drills && feed.inverse {
        return Some(CYCLE);
    }
    match feed {
        _ if told || !(drills || cuts(nc, state)) => None,
        Feed { inverse: true, .. } => Some(WITHOUT),
        Feed { stale: true, .. } => Some(STALE),
        _ => None,
    }
}

/// True where a block moves at a feed.
fn cuts(nc: &Nc, state: &Modal) -> bool {
    let motion = state.op(Group::Motion);
    goes(nc) && motion.is_some_and(|op| op != Op::Rapid) && !nc.ops().any(needs_no_feed)
}

/// True for a code whose block moves at no feed, whatever motion is in force.
pub(in crate::legalize) fn needs_no_feed(op: Op) -> bool {
    op.takes_axes()
        || matches!(op, Op::RapidOnce | Op::MachineOnce | Op::Dwell | Op::Home)
        || matches!(op, Op::ReferenceReturn | Op::Reference2 | Op::ReferenceFrom)
}

/// True where an axis, or the centre of an arc, stands in a block.
pub(in crate::legalize) fn goes(nc: &Nc) -> bool {
    let across = |role: &Role| role.is_axis() || matches!(role, Role::ArcI | Role::ArcJ | Role::ArcK);
    nc.items.iter().any(|item| matches!(item, NcItem::Word(role, _) if across(role)))
}

/// What is known of the feed at a place.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Feed {
    /// True where inverse time may be in force.
    inverse: bool,
    /// True where the last feed may be one of inverse time.
    stale: bool,
}

impl Feed {
    fn step(&mut self, stmt: &Stmt) {
        let StmtKind::Nc(nc) = &stmt.kind else { return };
        let was = *self;
        if nc.has(Op::FeedInverse) {
            *self = Self { inverse: true, stale: true };
        } else if nc.has(Op::FeedPerMinute) || nc.has(Op::FeedPerTurn) {
            self.inverse = false;
        }
        if !self.inverse && nc.word(Role::Feed).is_some() {
            self.stale = false;
        }
        if stmt.site.skip.is_some() {
            self.join(&was);
        }
    }
}

impl Lattice for Feed {
    fn join(&mut self, other: &Self) -> bool {
        let joined = Self { inverse: self.inverse || other.inverse, stale: self.stale || other.stale };
        std::mem::replace(self, joined) != joined
    }
}

/// The feed at every block of a library.
struct Feeds;

impl Follow for Feeds {
    type Known = Feed;

    fn outside(&self, _: usize) -> Feed {
        Feed::default()
    }

    fn stmts(&self, _: (usize, BlockId), block: &Block, feed: &mut Feed) {
        block.stmts.iter().for_each(|stmt| feed.step(stmt));
    }

    // What the library does not have is not taken to feed in inverse time.
    fn lose(&self, _: &mut Feed) {}
}
