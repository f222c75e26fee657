//! Whether polar coordinates are in force, and what their words were last, on every way.

use crate::canon::{Group, Op, Role};
use crate::ir::analysis::dataflow::Lattice;
use crate::ir::analysis::over_calls::Follow;
use crate::ir::analysis::{Modal, ModalFacts};
use crate::ir::{Block, BlockId, Expr, Nc, Stmt, StmtKind, Var};
use crate::legalize::moves::rotations::is_of_frame;

/// More places than this are a slip.
const MOST: f64 = 1000.0;

const UNSAID: &str = "this block says one of distance and angle, and the other one was not said before on every way: write both";

/// What a word was last.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kept {
    /// Nothing, on some way.
    Unsaid,
    /// This on every way.
    Number(f64),
    /// What its register holds.
    Held,
}

impl Kept {
    fn of(word: &Expr) -> Self {
        word.constant().map_or(Self::Held, Self::Number)
    }

    /// With increments added, `times` over.
    fn and(self, word: &Expr, times: f64) -> Self {
        match (self, word.constant()) {
            (Self::Unsaid, _) => Self::Unsaid,
            (Self::Number(before), Some(more)) => Self::Number(more.mul_add(times, before)),
            _ => Self::Held,
        }
    }

    fn join(self, other: Self) -> Self {
        match (self, other) {
            (a, b) if a == b => a,
            (Self::Unsaid, _) | (_, Self::Unsaid) => Self::Unsaid,
            _ => Self::Held,
        }
    }

    /// What stands for a word that is left out.
    pub fn value(self, register: Var) -> Result<Expr, &'static str> {
        match self {
            Self::Unsaid => Err(UNSAID),
            Self::Number(number) => Ok(Expr::Number(number)),
            Self::Held => Ok(Expr::Var(register)),
        }
    }
}

/// Whether polar coordinates are in force, and with which words.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Polar {
    Off,
    On {
        length: Kept,
        angle: Kept,
    },
    /// On some ways.
    Mixed,
}

impl Lattice for Polar {
    fn join(&mut self, other: &Self) -> bool {
        let before = *self;
        *self = match (before, *other) {
            (Self::Off, Self::Off) => Self::Off,
            (Self::On { length, angle }, Self::On { length: l, angle: a }) => {
                Self::On { length: length.join(l), angle: angle.join(a) }
            }
            _ => Self::Mixed,
        };
        *self != before
    }
}

/// The count of a block; 1 without one.
pub(super) fn count(nc: &Nc) -> Option<f64> {
    let Some(word) = nc.word(Role::Repeat) else { return Some(1.0) };
    word.constant().filter(|count| count.fract() == 0.0 && (1.0..=MOST).contains(count))
}

impl Polar {
    /// Takes a statement; `modal` is what is in force after it.
    pub fn step(&mut self, stmt: &Stmt, modal: &Modal) {
        let StmtKind::Nc(nc) = &stmt.kind else { return };
        let before = *self;
        if nc.has(Op::PolarOff) {
            *self = Self::Off;
        } else if nc.has(Op::PolarOn) {
            *self = Self::On { length: Kept::Unsaid, angle: Kept::Unsaid };
        }
        if let Self::On { length, angle } = self {
            // The tool may stand elsewhere from the zero than the last words say.
            if nc.ops().any(moves_otherwise) {
                (*length, *angle) = (Kept::Unsaid, Kept::Unsaid);
            }
            if let Some(word) = nc.word(Role::X) {
                *length = Kept::of(word);
            }
            if let Some(word) = nc.word(Role::Y) {
                let adds = modal.op(Group::Distance) == Some(Op::Incremental);
                *angle = if adds { angle.and(word, count(nc).unwrap_or(1.0)) } else { Kept::of(word) };
            }
        }
        if stmt.site.skip.is_some() {
            self.join(&before);
        }
    }
}

pub(super) struct Rules<'r> {
    pub facts: &'r ModalFacts,
}

impl Follow for Rules<'_> {
    type Known = Polar;

    fn outside(&self, _: usize) -> Polar {
        Polar::Off
    }

    fn stmts(&self, (program, id): (usize, BlockId), block: &Block, known: &mut Polar) {
        let mut modal = self.facts.at(program, id);
        for stmt in &block.stmts {
            modal.step(stmt);
            known.step(stmt, &modal);
        }
    }

    fn lose(&self, known: &mut Polar) {
        if *known != Polar::Off {
            *known = Polar::Mixed;
        }
    }
}

/// True for what chooses another zero, or goes where words do not say.
pub(super) fn moves_otherwise(op: Op) -> bool {
    is_of_frame(op) && !matches!(op, Op::PolarOn | Op::PolarOff)
        || matches!(op, Op::ReferenceReturn | Op::Reference2 | Op::Home | Op::RotateOn | Op::RotateOff)
}
