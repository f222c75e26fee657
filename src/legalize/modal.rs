//! What is in force of every modal group at a place, and what statements do to it.

use crate::canon::{Group, Op, Role};
use crate::ir::{Block, BlockId, Call, NcItem, Program, Stmt, StmtKind, TermKind};
use crate::text::Span;
use std::collections::BTreeSet;

/// What is in force of one group.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Setting {
    /// No path leads here.
    #[default]
    Unreached,
    /// This operation; for a work offset its number, where that is constant.
    Known(Op, Option<u32>),
    /// Not known, or not the same on all paths.
    Unknown,
}

/// The number of the last feed word.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Feed {
    #[default]
    Unreached,
    Known(f64),
    Unknown,
}

/// What is in force of every group, the feed, and the modal calls that are open.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Modal {
    settings: [Setting; Group::ALL.len()],
    /// True where some way here cancelled all zero shifts and selected none since.
    pub may_be_cancelled: bool,
    feed: Feed,
    /// The open modal calls, innermost last; absent where paths disagree.
    pub calls: Option<Vec<Call>>,
    /// True where nothing in the library leaves another unit than the one that is named.
    pub one_unit: bool,
}

impl Modal {
    /// Nothing known: how a main program starts.
    pub fn unknown() -> Self {
        Self {
            settings: [Setting::Unknown; Group::ALL.len()],
            may_be_cancelled: false,
            feed: Feed::Unknown,
            calls: Some(Vec::new()),
            one_unit: false,
        }
    }

    /// Nothing known but the modal calls that are open, and the unit where nothing leaves another.
    pub(super) fn unknown_under(state: &Self) -> Self {
        let mut unknown = state.clone();
        unknown.may_be_cancelled = false;
        unknown.forget();
        unknown
    }

    /// Puts an operation in force from the start.
    pub fn start_in(&mut self, op: Op) {
        self.settings[op.group() as usize] = Setting::Known(op, None);
    }

    /// What is in force of a group.
    pub fn of(&self, group: Group) -> Setting {
        self.settings[group as usize]
    }

    /// The operation in force of a group, where it is known.
    pub fn op(&self, group: Group) -> Option<Op> {
        match self.of(group) {
            Setting::Known(op, _) => Some(op),
            _ => None,
        }
    }

    /// The number of the last feed word, where it is known and counts the same as it did there.
    pub fn feed(&self) -> Option<f64> {
        match self.feed {
            Feed::Known(feed) => Some(feed),
            _ => None,
        }
    }

    /// True when no path leads here.
    pub fn is_unreached(&self) -> bool {
        self.of(Group::Motion) == Setting::Unreached
    }

    /// Takes a statement's effect.
    pub fn step(&mut self, stmt: &Stmt) {
        let before = stmt.site.skip.map(|_| self.clone());
        match &stmt.kind {
            StmtKind::Nc(nc) => {
                let mut feed = None;
                for item in &nc.items {
                    match item {
                        NcItem::Op(op) => self.set(*op, nc.word(Role::WorkOffset).and_then(|e| e.constant())),
                        // A computed code may be any of its letter.
                        NcItem::Code('G', _) => self.forget(),
                        NcItem::Word(Role::Feed, value) => feed = feed.or(Some(value)),
                        NcItem::Code(..) | NcItem::Word(..) => {}
                    }
                }
                // Behind the unit and the feed mode, which it counts in, wherever they stand.
                if let Some(feed) = feed {
                    self.feed = feed.constant().map_or(Feed::Unknown, Feed::Known);
                }
                if self.calls.as_ref().is_none_or(|calls| !calls.is_empty()) && nc.moves() {
                    // The modal call runs now, and may leave anything in force.
                    self.forget();
                }
            }
            StmtKind::ModalCall(call) => self.calls.iter_mut().for_each(|calls| calls.push((**call).clone())),
            StmtKind::ModalCallOff => self.calls.iter_mut().for_each(|calls| drop(calls.pop())),
            _ => {}
        }
        if let Some(before) = before {
            self.join(&before);
        }
    }

    /// False for a statement that leaves everything as it is.
    pub(super) fn may_step(stmt: &Stmt) -> bool {
        matches!(stmt.kind, StmtKind::Nc(_) | StmtKind::ModalCall(_) | StmtKind::ModalCallOff)
    }

    fn forget(&mut self) {
        let unit = self.of(Group::Units);
        self.settings = [Setting::Unknown; Group::ALL.len()];
        if self.one_unit {
            self.settings[Group::Units as usize] = unit;
        }
        self.feed = Feed::Unknown;
    }

    fn set(&mut self, op: Op, number: Option<f64>) {
        if matches!(op.group(), Group::Units | Group::FeedMode) && self.op(op.group()) != Some(op) {
            self.feed = Feed::Unknown;
        }
        let number = number.filter(|_| op == Op::SelectWork).map(|n| n as u32);
        if op.group() != Group::OneShot {
            self.settings[op.group() as usize] = Setting::Known(op, number);
        }
        if op.group() == Group::WorkOffset {
            self.may_be_cancelled = op == Op::ShiftCancel;
        }
        if op.group() == Group::Motion {
            self.settings[Group::Cycle as usize] = Setting::Known(Op::CycleOff, None);
        }
    }

    /// Joins the state of another path; true where that changed anything.
    pub(super) fn join(&mut self, other: &Modal) -> bool {
        if other.is_unreached() {
            return false;
        }
        if self.is_unreached() {
            *self = other.clone();
            return true;
        }
        let mut changed = false;
        self.one_unit |= other.one_unit;
        for (mine, theirs) in self.settings.iter_mut().zip(&other.settings) {
            if *mine != *theirs && *mine != Setting::Unknown {
                *mine = Setting::Unknown;
                changed = true;
            }
        }
        if self.feed != other.feed && self.feed != Feed::Unknown {
            self.feed = Feed::Unknown;
            changed = true;
        }
        if other.may_be_cancelled && !self.may_be_cancelled {
            self.may_be_cancelled = true;
            changed = true;
        }
        if self.calls != other.calls && self.calls.is_some() {
            self.calls = None;
            changed = true;
        }
        changed
    }
}

/// Every call of a block: modal ones and the terminator's.
pub fn calls_of(block: &Block) -> impl Iterator<Item = &Call> {
    let modal = block.stmts.iter().filter_map(|stmt| match &stmt.kind {
        StmtKind::ModalCall(call) => Some(&**call),
        _ => None,
    });
    modal.chain(match &block.term.kind {
        TermKind::Call { call, .. } => Some(&**call),
        _ => None,
    })
}

/// Where a call of [`calls_of`] stands.
pub fn span_of(block: &Block, call: &Call) -> Span {
    let modal = block.stmts.iter().find(|stmt| matches!(&stmt.kind, StmtKind::ModalCall(c) if **c == *call));
    modal.map_or(block.term.site.span, |stmt| stmt.site.span)
}

/// The blocks that a routine entered at `entry` can run, calls stepped over.
pub fn reachable(program: &Program, entry: BlockId) -> BTreeSet<BlockId> {
    let mut seen = vec![false; program.blocks.len()];
    let mut work = vec![entry];
    while let Some(id) = work.pop() {
        if let Some(block) = program.block(id)
            && !std::mem::replace(&mut seen[id.index()], true)
        {
            work.extend(block.term.kind.successors());
        }
    }
    program.ids().filter(|id| seen[id.index()]).collect()
}
