//! What is in force of every modal group at a place, and what statements do to it.

use super::contour::Contour;
pub use super::length_lost::{LengthLost, Ways};
use super::named::Named;
use super::tool_word::{self, ToolWord};
use super::touches::Touches;
use crate::canon::{Group, Op, Role};
use crate::ir::analysis::dataflow::Lattice;
use crate::ir::{Call, Expr, Nc, NcItem, Stmt, StmtKind};

/// What is in force of one group.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Setting {
    /// This operation; for a work offset and a tool length its number, where that is constant.
    Known(Op, Option<u32>),
    /// Not known, or not the same on all paths.
    Unknown,
}

impl Setting {
    /// What is in force where ways with each of two meet.
    fn join(self, other: Self) -> Self {
        match (self, other) {
            _ if self == other => self,
            // Lengths of two rows are applied alike.
            (Setting::Known(op @ (Op::LengthPlus | Op::LengthMinus), _), Setting::Known(there, _))
                if op == there =>
            {
                Setting::Known(op, None)
            }
            _ => Setting::Unknown,
        }
    }
}

/// The number of the last feed word.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Feed {
    Known(f64),
    Unknown,
}

/// What is in force of every group, the feed, and the modal calls that are open.
#[derive(Clone, Debug, PartialEq)]
pub struct Modal {
    settings: [Setting; Group::ALL.len()],
    /// Whether a drilling cycle is in force, whichever; absent where paths disagree.
    drills: Option<bool>,
    /// True where some way here cancelled all zero shifts and selected none since.
    pub may_be_cancelled: bool,
    /// What some way here did since the tool length was named that may have cancelled it.
    pub length_lost: LengthLost,
    /// True where some way here named a tool length.
    length_named: bool,
    /// True where every way here named the number of one.
    pub length_word: bool,
    feed: Feed,
    /// What the last tool word is to the tool in the spindle.
    pub(crate) tool_word: ToolWord,
    /// True where the last T word of some way here took the offset of a turret away.
    pub turret_none: bool,
    /// What every way here named.
    pub(crate) named: Named,
    /// The open modal calls, innermost last; absent where paths disagree.
    pub calls: Option<Vec<Call>>,
    /// True where nothing in the library leaves another unit than the one that is named.
    pub one_unit: bool,
    /// The contour that a cycle before reads; absent where paths disagree.
    contour: Option<Contour>,
}

impl Modal {
    /// Nothing known: how a main program starts.
    pub fn unknown() -> Self {
        Self {
            settings: [Setting::Unknown; Group::ALL.len()],
            drills: None,
            may_be_cancelled: false,
            length_lost: LengthLost::default(),
            length_named: false,
            length_word: false,
            feed: Feed::Unknown,
            tool_word: ToolWord::Begun,
            turret_none: false,
            named: Named::default(),
            calls: Some(Vec::new()),
            one_unit: false,
            contour: None,
        }
    }

    /// The state in which a program starts that follows others in its file: an end stopped spindle and coolant, or not.
    pub fn at_head(&self) -> Self {
        let mut state = self.clone();
        for group in [Group::Spindle, Group::Coolant] {
            state.settings[group as usize] = Setting::Unknown;
        }
        state
    }

    /// Nothing known but the modal calls that are open, and the unit where nothing leaves another.
    pub(crate) fn unknown_under(state: &Self) -> Self {
        let mut unknown = state.clone();
        unknown.may_be_cancelled = false;
        unknown.forget();
        // What runs there may name a length as the library does.
        unknown.length_lost.is_held |= state.length_named;
        unknown.tool_word = state.tool_word.after_unknown();
        unknown
    }

    /// True if a move may run a modal call.
    pub fn may_call(&self) -> bool {
        self.calls.as_ref().is_none_or(|calls| !calls.is_empty())
    }

    /// Puts an operation in force from the start.
    pub fn start_in(&mut self, op: Op) {
        self.settings[op.group() as usize] = Setting::Known(op, None);
        if op.group() == Group::Cycle {
            self.drills = Some(op.is_cycle());
        }
    }

    /// Whether a drilling cycle is in force, whichever: known also where ways with different cycles meet.
    pub fn drills(&self) -> Option<bool> {
        self.drills
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

    /// True where some way here named a tool length.
    pub(crate) fn names_length(&self) -> bool {
        self.length_named
    }

    /// Takes a statement's effect.
    pub fn step(&mut self, stmt: &Stmt) {
        let number = self.contour.and_then(|_| stmt.site.sequence.get());
        let motion = self.settings[Group::Motion as usize];
        self.contour.iter_mut().for_each(|contour| contour.enter(number, motion));
        self.take(stmt);
        if let Some(motion) = self.contour.and_then(|contour| contour.leave(number)) {
            (self.settings[Group::Motion as usize], self.contour) = (motion, None);
        }
    }

    fn take(&mut self, stmt: &Stmt) {
        // Most blocks only say where to.
        if stmt.kind.nc().is_some_and(only_says_where)
            && !self.may_call()
            && !self.op(Group::Cycle).is_some_and(Op::is_tap)
        {
            return;
        }
        let before = stmt.site.skip.map(|_| self.clone());
        match &stmt.kind {
            StmtKind::Nc(nc) => {
                self.step_words(nc);
                if self.may_call() && nc.moves() {
                    // The modal call runs now, and may leave anything in force.
                    self.forget();
                    self.tool_word = self.tool_word.after_unknown();
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

    /// Takes the effect of a block's codes, without that of a modal call that its move makes.
    pub(crate) fn step_words(&mut self, nc: &Nc) {
        let (mut feed, mut bare) = (None, true);
        for item in &nc.items {
            bare &= matches!(item, NcItem::Word(role, _) if !matches!(role, Role::LengthOffset | Role::Tool | Role::Turret));
            match item {
                NcItem::Op(op) => self.set(*op, nc.word(Role::WorkOffset).and_then(|e| e.constant())),
                // A computed code may be any of its letter.
                NcItem::Code('G', _) => self.forget(),
                NcItem::Code('M', _) => {
                    for group in [Group::Spindle, Group::Coolant] {
                        self.settings[group as usize] = Setting::Unknown;
                    }
                }
                NcItem::Word(Role::Feed, value) => feed = feed.or(Some(value)),
                NcItem::Code(..) | NcItem::Word(..) => {}
            }
        }
        if nc.ops().any(Op::reads_contour) {
            self.contour = Contour::of(nc);
        }
        // Most blocks only say where to: neither codes, nor a length, nor a tool.
        if !bare {
            self.step_length(nc);
            self.tool_word = self.tool_word.after(nc);
            self.turret_none = tool_word::takes_offset(nc).unwrap_or(self.turret_none);
        }
        self.named.step(nc);
        self.step_tap(nc);
        // After the unit and the feed mode, which it counts in, wherever they stand.
        if let Some(feed) = feed {
            self.feed = feed.constant().map_or(Feed::Unknown, Feed::Known);
        }
    }

    /// A tap turns the spindle, also one that stands, and may leave it turning.
    fn step_tap(&mut self, nc: &Nc) {
        // A live tool is none of the spindle's.
        let turns_it = |op: Op| op.is_tap() && !op.is_live_tap();
        let taps = self.op(Group::Cycle).is_some_and(turns_it) && (nc.moves() || nc.ops().any(turns_it));
        let turns = |op| matches!(op, Op::SpindleCw | Op::SpindleCcw);
        if taps && self.op(Group::Spindle).is_some_and(|op| !turns(op)) {
            self.settings[Group::Spindle as usize] = Setting::Unknown;
        }
    }

    /// Which row the tool length is taken from, and what may cancel it.
    fn step_length(&mut self, nc: &Nc) {
        let row = nc.word(Role::LengthOffset);
        self.length_word |= row.is_some();
        let setting = &mut self.settings[Group::LengthComp as usize];
        if let (Setting::Known(op @ (Op::LengthPlus | Op::LengthMinus), _), Some(row)) = (*setting, row) {
            *setting = Setting::Known(op, row.constant().filter(|row| *row >= 0.0).map(|row| row as u32));
        }
        if row.is_some() || nc.ops().any(|op| op.group() == Group::LengthComp) {
            self.length_lost = LengthLost { is_held: !nc.has(Op::LengthOff), ..LengthLost::default() };
        }
        self.length_named |= row.is_some() || nc.has(Op::LengthPlus) || nc.has(Op::LengthMinus);
        let leaves = nc.ops().any(|op| matches!(op, Op::ReferenceReturn | Op::Reference2 | Op::MachineOnce));
        if leaves && nc.word(Role::Z).is_some_and(|value| value.constant().is_some()) {
            (self.length_lost.is_home, self.length_lost.is_held) = (true, false);
        }
        let ways = match self.of(Group::LengthComp) {
            Setting::Known(Op::LengthPlus | Op::LengthMinus, _) => Ways::Every,
            Setting::Unknown if self.length_named => Ways::Some,
            // None is in force that the program knows of.
            _ => return,
        };
        if nc.has(Op::ToolChange) {
            self.length_lost.by_change = ways;
        }
        let depth = nc.word(Role::Z);
        let along = depth.is_some();
        let returns = nc.ops().any(|op| matches!(op, Op::ReferenceReturn | Op::Reference2));
        let lost = &mut self.length_lost;
        // A word whose value is vacant is not there.
        let unsure = depth.is_some_and(|value| match value {
            Expr::Negate(inner) => inner.may_be_vacant(),
            value => value.may_be_vacant(),
        });
        let ways = if unsure { Ways::Some } else { ways };
        lost.by_other_axes = if returns && unsure { Ways::Some } else { lost.by_other_axes };
        match (returns, along || !nc.moves()) {
            (true, true) => lost.by_reference = ways,
            (true, false) => lost.by_other_axes = ways,
            (false, _) if nc.has(Op::MachineOnce) && along => lost.by_machine_move = ways,
            (false, _) => {}
        }
    }

    /// After a call: what its routine does not touch is as it was before the call, whoever else calls it. A modal call that is
    /// open, and a contour that a cycle reads, may change anything at each block.
    pub(super) fn keep(&mut self, before: &Self, touches: &Touches) {
        if touches.all || before.may_call() || before.contour.is_some() {
            return;
        }
        for (at, mine) in self.settings.iter_mut().enumerate().filter(|(at, _)| !touches.groups[*at]) {
            *mine = before.settings[at];
        }
        if !touches.groups[Group::Cycle as usize] {
            self.drills = before.drills;
        }
        if !touches.groups[Group::WorkOffset as usize] {
            self.may_be_cancelled = before.may_be_cancelled;
        }
        if !touches.length {
            self.length_lost = before.length_lost;
            (self.length_named, self.length_word) = (before.length_named, before.length_word);
        }
        if !touches.feed {
            self.feed = before.feed;
        }
        if !touches.tool {
            (self.tool_word, self.turret_none) = (before.tool_word, before.turret_none);
        }
        self.named.keep(before.named, touches);
        self.calls.clone_from(&before.calls);
        self.contour = None;
    }

    /// False for a statement that leaves everything as it is.
    pub(crate) fn may_step(stmt: &Stmt) -> bool {
        matches!(stmt.kind, StmtKind::Nc(_) | StmtKind::ModalCall(_) | StmtKind::ModalCallOff)
    }

    fn forget(&mut self) {
        let unit = self.of(Group::Units);
        self.settings = [Setting::Unknown; Group::ALL.len()];
        self.drills = None;
        if self.one_unit {
            self.settings[Group::Units as usize] = unit;
        }
        self.feed = Feed::Unknown;
        self.named = Named::default();
        self.length_lost.is_home = false;
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
        if matches!(op.group(), Group::Cycle | Group::Motion) {
            self.drills = Some(op.is_cycle());
        }
    }
}

impl Lattice for Modal {
    fn join(&mut self, other: &Self) -> bool {
        let mut changed = false;
        self.one_unit |= other.one_unit;
        for (mine, theirs) in self.settings.iter_mut().zip(&other.settings) {
            let joined = mine.join(*theirs);
            changed |= std::mem::replace(mine, joined) != joined;
        }
        changed |= self.drills.is_some() && self.drills != other.drills;
        self.drills = self.drills.filter(|drills| other.drills == Some(*drills));
        if self.feed != other.feed && self.feed != Feed::Unknown {
            self.feed = Feed::Unknown;
            changed = true;
        }
        if other.may_be_cancelled && !self.may_be_cancelled {
            self.may_be_cancelled = true;
            changed = true;
        }
        changed |= other.turret_none && !self.turret_none;
        self.turret_none |= other.turret_none;
        let tool_word = self.tool_word.join(other.tool_word);
        changed |= std::mem::replace(&mut self.tool_word, tool_word) != tool_word;
        changed |= self.length_lost.join(other.length_lost) | self.named.join(other.named);
        changed |= self.length_word && !other.length_word;
        self.length_word &= other.length_word;
        changed |= other.length_named && !self.length_named;
        self.length_named |= other.length_named;
        if self.contour != other.contour && self.contour.is_some() {
            self.contour = None;
            changed = true;
        }
        if self.calls != other.calls && self.calls.is_some() {
            self.calls = None;
            changed = true;
        }
        changed
    }
}

/// True for words alone that put nothing in force, unless they run a cycle or a modal call.
fn only_says_where(nc: &Nc) -> bool {
    let stays = |role: Role| {
        !matches!(role, Role::LengthOffset | Role::RadiusOffset | Role::Tool | Role::Turret | Role::Feed)
    };
    nc.items.iter().all(|item| matches!(item, NcItem::Word(role, _) if stays(*role)))
}
