//! Where rotary axes stand, in the coordinates of the program, as far as its text tells.
//!
//! An angle is what its axis has turned by, whole turns too: after `A90.` and an increment of 360 it is 450. A program that
//! others call and that names an angle begins with none known, as it may be run by itself. At the start of others, after a
//! return to the reference position and under another work offset the axes are taken to stand at 0, or where they stood.

use super::rotary_ways::zero_sign;
use crate::canon::{Group, Op, Role, Sys};
use crate::dialect::{Control, Question};
use crate::ir::analysis::dataflow::Lattice;
use crate::ir::analysis::over_calls::{Follow, OverCalls, called};
use crate::ir::analysis::{calls_of, reachable};
use crate::ir::{Block, BlockId, Call, Callee, Expr, Module, Nc, NcItem, Place, Program, Stmt, StmtKind};
use crate::legalize::{Modal, ModalFacts};
use std::collections::{BTreeMap, BTreeSet};

/// The rotary axes.
pub(in crate::legalize) const AXES: [Role; 3] = [Role::A, Role::B, Role::C];

/// Angles that are told apart at one place, at the most.
const MOST: usize = 12;

/// How a rotary axis goes to an angle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::legalize) enum Way {
    /// Turns and all.
    Turns,
    /// The shorter way to the place within one turn.
    Shortest,
    /// To the place within one turn, the way that the sign says.
    Sign,
}

impl Way {
    /// That of a control; one that is silent, or of which nobody knows, is taken to turn.
    pub(in crate::legalize) fn of(control: &Control) -> Self {
        match control.behaviour(Question::RotaryWay).map(|row| row.value.as_str()) {
            Some("sign") => Self::Sign,
            Some("shortest") => Self::Shortest,
            _ => Self::Turns,
        }
    }

    /// True between two controls whose angles are written anew: one of the two goes by the sign, or the source is known to turn back by
    /// all turns and the target to take the shorter way, or the other way round.
    pub(in crate::legalize) fn differ(source: &Control, target: &Control) -> bool {
        let is = |control: &Control, way: &str| {
            control.behaviour(Question::RotaryWay).is_some_and(|row| row.value == way)
        };
        let by_sign = [source, target].map(|control| Self::of(control) == Self::Sign);
        let pair = |ours, theirs| is(source, ours) && is(target, theirs);
        by_sign[0] != by_sign[1] || pair("turns", "shortest") || pair("shortest", "turns")
    }

    /// How far an axis turns from a place by a word, in the same parts of a degree; none where that is not known.
    pub(in crate::legalize) fn turn(self, from: i64, word: f64) -> Option<i64> {
        let ahead = (parts(word.abs()) - from).rem_euclid(TURN);
        match self {
            Self::Turns => Some(parts(word) - from),
            Self::Sign if ahead == 0 => Some(0),
            Self::Sign if word.is_sign_negative() => Some(ahead - TURN),
            Self::Sign => Some(ahead),
            Self::Shortest => match (parts(word) - from).rem_euclid(TURN) {
                ahead if 2 * ahead < TURN => Some(ahead),
                ahead if 2 * ahead > TURN => Some(ahead - TURN),
                _ => None,
            },
        }
    }
}

/// A turn, in millionths of a degree.
pub(in crate::legalize) const TURN: i64 = 360_000_000;

/// An angle in millionths of a degree.
pub(in crate::legalize) fn parts(degrees: f64) -> i64 {
    (degrees * 1e6).round() as i64
}

/// Where an axis may stand.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::legalize) struct Stands {
    /// The angles that it may have; none where that is not known.
    pub at: Option<BTreeSet<i64>>,
    /// True where these are places within one turn, and how many whole turns it made is not known.
    pub loose: bool,
    /// True where that rests on where the axis stands when a program begins, or on work offsets that are alike.
    pub assumed: bool,
}

impl Stands {
    fn at(angle: i64, assumed: bool) -> Self {
        Self { at: Some(BTreeSet::from([angle])), loose: false, assumed }
    }

    const UNKNOWN: Self = Self { at: None, loose: false, assumed: false };

    /// Where a word takes it: from each angle by how far.
    pub(in crate::legalize) fn turns(&self, way: Way, word: f64) -> Option<Vec<(i64, i64)>> {
        self.at
            .as_ref()
            .filter(|_| !self.loose || way != Way::Turns)?
            .iter()
            .map(|from| Some((*from, way.turn(*from, word)?)))
            .collect()
    }

    /// The same, with few angles: of many only the places within one turn are kept, and of many of these none.
    fn few(self) -> Self {
        let within =
            |at: BTreeSet<i64>| at.into_iter().map(|at| at.rem_euclid(TURN)).collect::<BTreeSet<_>>();
        let loose = self.loose || self.at.as_ref().is_some_and(|at| at.len() > MOST);
        let at = if loose { self.at.map(within) } else { self.at };
        let at = at.filter(|at| at.len() <= MOST);
        Self { loose: loose && at.is_some(), at, assumed: self.assumed }
    }
}

/// Where all of them may stand.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::legalize) struct Places([Stands; 3]);

impl Lattice for Places {
    fn join(&mut self, other: &Self) -> bool {
        let mut changed = false;
        for (mine, theirs) in self.0.iter_mut().zip(&other.0) {
            let before = mine.clone();
            let at = match (mine.at.take(), &theirs.at) {
                (Some(mine), Some(theirs)) => Some(mine.union(theirs).copied().collect()),
                _ => None,
            };
            let (loose, assumed) = (mine.loose || theirs.loose, mine.assumed || theirs.assumed);
            *mine = Stands { at, loose, assumed }.few();
            changed |= *mine != before;
        }
        changed
    }
}

impl Places {
    /// Where an axis stands.
    pub(in crate::legalize) fn of(&self, axis: usize) -> &Stands {
        self.0.get(axis).unwrap_or(&Stands::UNKNOWN)
    }

    fn start() -> Self {
        Self(std::array::from_fn(|_| Stands::at(0, true)))
    }

    fn forget(&mut self) {
        *self = Self(std::array::from_fn(|_| Stands::UNKNOWN));
    }

    /// Takes a statement; `before` and `after` are what is in force around it.
    pub(in crate::legalize) fn step(
        &mut self,
        stmt: &Stmt,
        (before, after): (&Modal, &Modal),
        way: Way,
        control: &Control,
    ) {
        let kept = stmt.site.skip.map(|_| self.clone());
        match &stmt.kind {
            StmtKind::Nc(nc) => {
                let incremental = after.op(Group::Distance).map(|op| op == Op::Incremental);
                self.words(nc, incremental, way, control);
                if before.may_call() && nc.moves() {
                    self.forget();
                }
            }
            StmtKind::Assign { target: Place::System(Sys::WorkOffset, subscripts), .. } => {
                let axis = subscripts.last().and_then(Expr::constant);
                if axis.is_none_or(|axis| axis > 3.0) {
                    self.forget();
                }
            }
            _ => {}
        }
        if let Some(kept) = kept {
            self.join(&kept);
        }
    }

    fn words(&mut self, nc: &Nc, incremental: Option<bool>, way: Way, control: &Control) {
        for (axis, role) in AXES.into_iter().enumerate() {
            let Some(word) = nc.word(role) else { continue };
            let mine = &mut self.0[axis];
            let value = degrees(word, control);
            *mine = match (value, incremental) {
                (Some(value), _) if nc.has(Op::SetPosition) => Stands::at(parts(value), false),
                _ if is_aside(nc) || nc.word(Role::Repeat).is_some() => Stands::UNKNOWN,
                (Some(value), Some(true)) => {
                    let by = parts(value);
                    let at = mine.at.take().map(|at| at.iter().map(|at| at.saturating_add(by)).collect());
                    Stands { at, loose: mine.loose, assumed: mine.assumed }.few()
                }
                (Some(value), Some(false)) => {
                    let at = mine.turns(way, value);
                    let at = at.map(|all| all.iter().map(|(from, by)| from + by).collect());
                    // A place that is named is known, wherever the axis came from.
                    let named = || Stands { loose: true, ..Stands::at(parts(value.abs()), false) };
                    match at {
                        _ if way == Way::Turns => Stands::at(parts(value), false),
                        Some(at) => Stands { at: Some(at), loose: mine.loose, assumed: false }.few(),
                        None => named().few(),
                    }
                }
                _ => Stands::UNKNOWN,
            };
        }
        if nc.ops().any(|op| matches!(op, Op::SelectWork | Op::ShiftCancel)) {
            self.0.iter_mut().for_each(|mine| mine.assumed = true);
        }
        let returns = |op: Op| matches!(op, Op::ReferenceReturn | Op::Reference2 | Op::Home);
        if let Some(op) = nc.ops().find(|op| returns(*op)) {
            let all = !nc.names_axis();
            for (mine, role) in self.0.iter_mut().zip(AXES) {
                if all || nc.word(role).is_some() {
                    *mine = if op == Op::Reference2 { Stands::UNKNOWN } else { Stands::at(0, true) };
                }
            }
        }
    }
}

/// True for a block whose axis words are no angles to go to.
pub(in crate::legalize) fn is_aside(nc: &Nc) -> bool {
    nc.ops().any(|op| op.takes_axes() || op == Op::MachineOnce)
}

/// The angle of a word, where it is a number. A zero keeps its sign, unless the control is known not to read it.
pub(in crate::legalize) fn degrees(value: &Expr, control: &Control) -> Option<f64> {
    match value {
        Expr::Negate(inner) => degrees(inner, control).map(|angle| -angle),
        Expr::Increments(count) => Some(count * control.numbers().increment_degrees),
        value => value.constant(),
    }
    .map(|angle| if angle == 0.0 && zero_sign(control) == Some(false) { 0.0 } else { angle })
}

/// Follows them over a library.
pub(in crate::legalize) struct RotaryPlaces {
    known: OverCalls<Places>,
    /// The programs that begin with none known.
    alone: Vec<bool>,
}

impl RotaryPlaces {
    /// Those of a library; `facts` says what is in force, `origins` which program of the source each is made of.
    pub(in crate::legalize) fn of(
        module: &Module,
        facts: &ModalFacts,
        control: &Control,
        origins: &[usize],
    ) -> Self {
        Self::by(Way::of(control), module, facts, control, origins)
    }

    /// The same, for axes that go the given way to the angles.
    pub(in crate::legalize) fn by(
        way: Way,
        module: &Module,
        facts: &ModalFacts,
        control: &Control,
        origins: &[usize],
    ) -> Self {
        let called = called(module);
        // A subroutine that stands in a program's text is never run by itself: it comes after that program here.
        let is_part = |index: usize| index > 0 && origins.get(index - 1) == origins.get(index);
        let named = |index, program| names_angle(program, &|id| facts.at(index, id));
        let alone: Vec<bool> = (module.programs.iter().zip(called).enumerate())
            .map(|(index, (program, called))| called && !is_part(index) && named(index, program))
            .collect();
        let quiet = quiet(module, facts);
        let rules = Rules { module, facts, control, way, alone: &alone, quiet };
        Self { known: OverCalls::of(module, &rules), alone }
    }

    /// Where they may stand at the start of a block; a block that no run reaches knows nothing.
    pub(in crate::legalize) fn at(&self, program: usize, id: BlockId) -> Places {
        let begins = id == BlockId(0) && self.alone.get(program).copied().unwrap_or(true);
        let known = self.known.at(program, id).filter(|_| !begins).cloned();
        known.unwrap_or_else(|| Places(std::array::from_fn(|_| Stands::UNKNOWN)))
    }
}

/// True for a program with an angle to go to.
fn names_angle(program: &Program, modal: &dyn Fn(BlockId) -> Modal) -> bool {
    program.ids().zip(&program.blocks).any(|(id, block)| {
        let mut state = modal(id);
        block.stmts.iter().any(|stmt| {
            state.step(stmt);
            let absolute = state.op(Group::Distance) != Some(Op::Incremental);
            absolute && stmt.kind.nc().is_some_and(|nc| nc.items.iter().any(is_angle))
        })
    })
}

fn is_angle(item: &NcItem) -> bool {
    matches!(item, NcItem::Word(role, _) if AXES.contains(role))
}

struct Rules<'r> {
    module: &'r Module,
    facts: &'r ModalFacts,
    control: &'r Control,
    way: Way,
    alone: &'r [bool],
    quiet: BTreeSet<(usize, BlockId)>,
}

/// The routines that leave the axes, and what their angles count from, as they are: by program, and the block that is entered.
fn quiet(module: &Module, facts: &ModalFacts) -> BTreeSet<(usize, BlockId)> {
    let mut all = BTreeMap::new();
    for (index, program) in module.programs.iter().enumerate() {
        for call in program.blocks.iter().flat_map(calls_of) {
            let Some(entry) = entered(module, index, call) else { continue };
            all.entry(entry).or_insert_with(|| reachable(&module.programs[entry.0], entry.1));
        }
    }
    let mut quiet: BTreeSet<(usize, BlockId)> = all.keys().copied().collect();
    loop {
        let before = quiet.len();
        let keeps = |entry: &(usize, BlockId)| {
            let Some(program) = module.programs.get(entry.0) else { return false };
            all.get(entry).into_iter().flatten().all(|id| {
                let Some(block) = program.block(*id) else { return false };
                let own = !facts.at(entry.0, *id).may_call() && block.stmts.iter().all(leaves_axes);
                let mut calls = calls_of(block).map(|call| entered(module, entry.0, call));
                own && calls.all(|callee| callee.is_some_and(|callee| quiet.contains(&callee)))
            })
        };
        let kept: BTreeSet<_> = quiet.iter().filter(|entry| keeps(entry)).copied().collect();
        quiet = kept;
        if quiet.len() == before {
            return quiet;
        }
    }
}

/// Where a call goes; none if that is not known.
fn entered(module: &Module, program: usize, call: &Call) -> Option<(usize, BlockId)> {
    match &call.callee {
        Callee::Block(entry) => Some((program, *entry)),
        Callee::Program(name) => {
            let named = |program: &Program| program.name.as_ref() == Some(name);
            Some((module.programs.iter().position(named)?, BlockId(0)))
        }
        Callee::Computed(_) | Callee::Cycle(_) => None,
    }
}

/// True for a statement that turns no axis, and sets nothing that angles count from.
fn leaves_axes(stmt: &Stmt) -> bool {
    match &stmt.kind {
        StmtKind::Nc(nc) => nc.items.iter().all(|item| match item {
            NcItem::Word(role, _) => !AXES.contains(role),
            NcItem::Op(op) => {
                !op.is_return()
                    && !op.takes_axes()
                    && !matches!(op, Op::Home | Op::SelectWork | Op::ShiftCancel | Op::MachineOnce)
            }
            NcItem::Code(..) => false,
        }),
        StmtKind::Assign { target: Place::Var(_), .. } | StmtKind::Comment => true,
        _ => false,
    }
}

impl Follow for Rules<'_> {
    type Known = Places;

    fn outside(&self, _: usize) -> Places {
        Places::start()
    }

    fn stmts(&self, (index, id): (usize, BlockId), block: &Block, known: &mut Places) {
        if id == BlockId(0) && self.alone.get(index).copied().unwrap_or(true) {
            known.forget();
        }
        let mut state = self.facts.at(index, id);
        for stmt in &block.stmts {
            let before = state.clone();
            state.step(stmt);
            known.step(stmt, (&before, &state), self.way, self.control);
        }
    }

    fn lose(&self, known: &mut Places) {
        known.forget();
    }

    fn returned(&self, program: usize, call: &Call, before: &Places, after: &mut Places) {
        if entered(self.module, program, call).is_some_and(|entry| self.quiet.contains(&entry)) {
            after.clone_from(before);
        }
    }
}
