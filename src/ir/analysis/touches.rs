//! Which modes a routine may change: a call leaves all others as its caller had them.

use super::cfg::reachable;
use crate::canon::{Group, Op, Role};
use crate::ir::{BlockId, Callee, Module, Nc, NcItem, Stmt, StmtKind, TermKind};
use crate::syntax::ProgramName;
use foldhash::HashMap;
use std::collections::{BTreeMap, BTreeSet};

/// A program entered at a block.
pub(super) type Place = (usize, BlockId);

/// The modes that some statements may change.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Touches {
    /// Everything: a computed code, a modal call, or something that the library does not have.
    pub all: bool,
    /// By group, whether another operation may be in force after it.
    pub groups: [bool; Group::ALL.len()],
    /// The number of the last feed word, or what it counts in.
    pub feed: bool,
    /// The tool length: its number, or what may have cancelled it.
    pub length: bool,
    /// The last number of a cutter radius.
    pub radius: bool,
    /// What the last tool word is to the tool in the spindle.
    pub tool: bool,
    /// Which codes were named, beyond those that it names itself.
    pub named: bool,
}

impl Touches {
    /// Everything.
    pub fn all() -> Self {
        Self { all: true, ..Self::default() }
    }

    /// Takes in a statement.
    pub fn add(&mut self, stmt: &Stmt) {
        match &stmt.kind {
            StmtKind::Nc(nc) => self.add_words(nc),
            StmtKind::ModalCall(_) | StmtKind::ModalCallOff => self.all = true,
            _ => {}
        }
    }

    fn add_words(&mut self, nc: &Nc) {
        for item in &nc.items {
            match item {
                NcItem::Op(op) => self.add_op(*op),
                NcItem::Code('M', _) => {
                    self.group(Group::Spindle);
                    self.group(Group::Coolant);
                    self.tool = true;
                }
                NcItem::Code(..) => self.all = true,
                NcItem::Word(Role::Feed, _) => self.feed = true,
                NcItem::Word(Role::LengthOffset, _) => {
                    self.length = true;
                    self.group(Group::LengthComp);
                }
                NcItem::Word(Role::RadiusOffset, _) => self.radius = true,
                NcItem::Word(Role::Tool | Role::Turret, _) => self.tool = true,
                NcItem::Word(..) => {}
            }
        }
        if nc.moves() {
            // A tap that is in force turns the spindle at each place.
            self.group(Group::Spindle);
        }
    }

    fn add_op(&mut self, op: Op) {
        use Op::{
            Builder, CycleOther, MachineOnce, MachineSpecific, ProbeOther, Reference2, ReferenceReturn,
        };
        self.group(op.group());
        self.all |= op.reads_contour();
        self.named |= matches!(op, Builder | CycleOther | MachineSpecific | ProbeOther);
        self.tool |= op == Op::ToolChange;
        self.length |= matches!(op, Op::ToolChange | MachineOnce | Reference2 | ReferenceReturn);
        match op.group() {
            Group::Motion => self.group(Group::Cycle),
            Group::Units | Group::FeedMode => self.feed = true,
            Group::LengthComp => self.length = true,
            Group::RadiusComp => self.radius = true,
            _ => {}
        }
        if op.is_tap() {
            self.group(Group::Spindle);
        }
    }

    fn group(&mut self, group: Group) {
        self.groups[group as usize] = true;
    }

    /// Takes in what another routine may change; true if that is news.
    pub fn join(&mut self, other: &Self) -> bool {
        let before = self.clone();
        self.all |= other.all;
        self.groups.iter_mut().zip(other.groups).for_each(|(mine, theirs)| *mine |= theirs);
        self.feed |= other.feed;
        self.length |= other.length;
        self.radius |= other.radius;
        self.tool |= other.tool;
        self.named |= other.named;
        *self != before
    }
}

/// What each routine of a library that is called, and all that it calls, may change.
pub(super) fn routines(module: &Module, by_name: &HashMap<&ProgramName, usize>) -> BTreeMap<Place, Touches> {
    let entry = |index: usize, callee: &Callee| match callee {
        Callee::Block(entry) => Some((index, *entry)),
        Callee::Program(name) => Some((*by_name.get(name)?, BlockId(0))),
        Callee::Computed(_) | Callee::Cycle(_) => None,
    };
    let programs = module.programs.iter().enumerate();
    let calls = programs.flat_map(|(index, program)| program.blocks.iter().map(move |block| (index, block)));
    let calls = calls.filter_map(|(index, block)| match &block.term.kind {
        TermKind::Call { call, .. } => entry(index, &call.callee),
        _ => None,
    });
    let called: BTreeSet<Place> = calls.collect();
    let mut all = BTreeMap::new();
    let mut callees: Vec<(Place, Place)> = Vec::new();
    for routine in called {
        let (program, mut touches) = (&module.programs[routine.0], Touches::default());
        for block in reachable(program, routine.1).into_iter().filter_map(|id| program.block(id)) {
            block.stmts.iter().for_each(|stmt| touches.add(stmt));
            let TermKind::Call { call, .. } = &block.term.kind else { continue };
            match entry(routine.0, &call.callee) {
                Some(callee) => callees.push((routine, callee)),
                None => touches.all = true,
            }
        }
        all.insert(routine, touches);
    }
    let mut changed = true;
    while std::mem::take(&mut changed) {
        for (routine, callee) in &callees {
            let theirs = all.get(callee).cloned().unwrap_or_else(Touches::all);
            changed |= all.get_mut(routine).is_some_and(|own: &mut Touches| own.join(&theirs));
        }
    }
    all
}
