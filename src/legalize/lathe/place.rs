//! Where the tool of a lathe stands in the program's coordinates, as far as the words of the blocks before say it.
//!
//! Cycles and passes end where they began. The blocks of a contour are read by the cycle before them, which then goes on after them
//! from where it began; what a contour's words say counts inside it alone.

use crate::canon::{Group, Op, Role};
use crate::ir::{BinOp, Expr, Nc, NcItem, Place as Target, Stmt, StmtKind};

/// What is known of it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Place {
    at: At,
    /// Whether a pass is in force, which each block with axis words runs; none where that is not known.
    passes: Option<bool>,
    /// Whether a drilling cycle is in force, and whether it goes along X.
    hole: Option<bool>,
    /// Whether X and Z are increments, as far as a code of the blocks before says it.
    steps: Option<bool>,
    /// True where every hole ends where its cycle began.
    keeps_level: bool,
    /// True where the coordinates changed since the last word of a place: where the block before ended is told in the old ones.
    shifted: bool,
    /// The numbers of the first and the last block of the contour that a cycle read.
    read: Option<(u32, u32)>,
    /// Inside a contour: the number of its last block, and what was known where the cycle began.
    inside: Option<(u32, At, Option<bool>)>,
    /// The number of the block at hand, for those that ask which one told a place.
    block: u32,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct At {
    x: Option<Told>,
    z: Option<Told>,
}

/// What is known of a place along an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Told {
    /// The place itself.
    Number(f64),
    /// The block whose word, which is computed, says it.
    Block(u32),
}

impl Told {
    fn number(self) -> Option<f64> {
        match self {
            Self::Number(number) => Some(number),
            Self::Block(_) => None,
        }
    }
}

impl Place {
    /// Nothing known yet, where every hole ends at the level at which its cycle began.
    pub fn keeping_level() -> Self {
        Self { keeps_level: true, ..Self::default() }
    }

    /// What is known where other ways come in.
    pub fn forget(&mut self) {
        *self = Self { keeps_level: self.keeps_level, shifted: self.shifted, ..Self::default() };
    }

    /// What is known where two ways meet: what they agree in.
    pub fn met(mut self, other: &Self) -> Self {
        if self.steps != other.steps || self.inside != other.inside {
            self.shifted |= other.shifted;
            self.forget();
            return self;
        }
        // What words do is not known where a cycle may be in force or not.
        let alike = self.hole == other.hole && self.passes == other.passes;
        let agreed = |one: Option<Told>, other: Option<Told>| {
            one.filter(|one| Some(*one) == other && one.number().is_some())
        };
        Self {
            at: At { x: agreed(self.at.x, other.at.x), z: agreed(self.at.z, other.at.z) },
            passes: self.passes.filter(|_| alike),
            hole: self.hole.filter(|_| alike),
            shifted: self.shifted || other.shifted,
            read: self.read.filter(|_| self.read == other.read),
            ..self
        }
    }

    /// True while a drilling cycle is in force, as far as the blocks before say.
    pub fn drills(&self) -> bool {
        self.hole.is_some()
    }

    /// True where a code of the blocks before makes X and Z increments.
    pub fn counts_steps(&self) -> bool {
        self.steps == Some(true)
    }

    /// X, a diameter.
    pub fn x(&self) -> Option<f64> {
        self.at.x?.number()
    }

    /// Z.
    pub fn z(&self) -> Option<f64> {
        self.at.z?.number()
    }

    /// X and Z, or which blocks told them.
    pub(super) fn told(&self) -> (Option<Told>, Option<Told>) {
        (self.at.x, self.at.z)
    }

    /// Gives the next statement a number.
    pub(super) fn comes_to(&mut self, block: u32) {
        self.block = block;
    }

    /// True where an offset or a shift came after the last move.
    pub fn is_shifted(&self) -> bool {
        self.shifted
    }

    /// Where the tool stands in the coordinates that count for the words of a block: an offset that it chooses counts already.
    pub fn counted_in(mut self, nc: &Nc) -> Self {
        if changes_coordinates(nc) {
            (self.at, self.shifted) = (At::default(), true);
        }
        self
    }

    /// Takes what is known of where the cycles begin that read the contour that begins here.
    pub fn knows(&mut self, x: Option<f64>, z: Option<f64>) {
        let number = |at: Option<f64>| at.map(Told::Number);
        self.at = At { x: self.at.x.or(number(x)), z: self.at.z.or(number(z)) };
    }

    /// Keeps what agrees with where the cycles begin that read the contour that begins here, and that are come to elsewhere.
    pub fn agrees(&mut self, x: Option<f64>, z: Option<f64>) {
        let same = |at: &Told, other: Option<f64>| at.number().is_some() && at.number() == other;
        self.at = At { x: self.at.x.filter(|at| same(at, x)), z: self.at.z.filter(|at| same(at, z)) };
    }

    /// The tool stands there, whatever the words of the last block are rounded to.
    pub fn lies_at(&mut self, x: f64, z: f64) {
        self.at = At { x: Some(Told::Number(x)), z: Some(Told::Number(z)) };
    }

    /// True inside a contour.
    pub fn in_contour(&self) -> bool {
        self.inside.is_some()
    }

    /// Comes to a statement: the first block of a contour begins where nobody knows, as several cycles may read it.
    pub fn enter(&mut self, stmt: &Stmt) {
        if let Some((first, last)) = self.read
            && stmt.site.sequence.get() == Some(first)
        {
            self.inside = Some((last, self.at, self.passes));
            self.at = At::default();
        }
    }

    /// Takes what a statement does to it.
    pub fn step(&mut self, stmt: &Stmt) {
        match &stmt.kind {
            StmtKind::Nc(nc) => self.words(nc, stmt.site.skip.is_some()),
            // What is written into a table may move the coordinates.
            StmtKind::Assign { .. } if matches!(stmt.kind.target(), Some(Target::System(..))) => {
                self.forget()
            }
            StmtKind::Comment | StmtKind::Assign { .. } => {}
            _ => self.forget(),
        }
        if let Some((last, at, passes)) = self.inside
            && stmt.site.sequence.get() == Some(last)
        {
            (self.at, self.passes, self.inside) = (at, passes, None);
        }
    }

    fn words(&mut self, nc: &Nc, skipped: bool) {
        if nc.items.iter().any(|item| matches!(item, NcItem::Code(..))) {
            self.forget();
            return;
        }
        if nc.ops().any(Op::reads_contour) {
            let number = |role: Role| nc.word(role).and_then(Expr::constant).map(|number| number as u32);
            self.read = number(Role::ContourFirst).zip(number(Role::ContourLast));
        }
        if let Some(motion) = nc.ops().filter(|op| op.group() == Group::Motion).last() {
            self.passes = Some(motion.is_pass()).filter(|_| !skipped);
        }
        if nc.ops().any(|op| op.is_lathe_cycle() || op.is_lathe_setup()) {
            return;
        }
        if let Some(op) = nc.ops().filter(|op| matches!(op.group(), Group::Motion | Group::Cycle)).last() {
            self.hole = op.is_hole().then_some(op.is_side_hole());
        }
        if let Some(mode) = nc.ops().filter(|op| op.group() == Group::Distance).last() {
            // What the words before counted is not sure.
            if self.steps.is_none() {
                self.at = At::default();
            }
            self.steps = Some(mode == Op::Incremental).filter(|_| !skipped);
        }
        // A new offset or shift moves the coordinates under the tool; an offset that is chosen beside a move counts for it already.
        if !nc.ops().all(is_plain) {
            self.at = At::default();
        }
        self.shifted |= changes_coordinates(nc);
        if !nc.ops().all(|op| is_plain(op) || chooses_offset(op)) {
            return;
        }
        if !nc.names_axis() {
            return;
        }
        self.shifted = false;
        if let Some(side) = self.hole {
            return self.drill(nc, side, skipped);
        }
        match self.passes {
            Some(true) => {}
            Some(false) if !skipped => {
                // The end of a line by its angle is known along one axis only.
                if nc.word(Role::LineAngle).is_some() {
                    self.at = At::default();
                }
                nc.items.iter().for_each(|item| self.word(item))
            }
            _ => self.at = At::default(),
        }
    }

    /// A hole is at the place of its block, and ends at the level of before, if at all.
    fn drill(&mut self, nc: &Nc, side: bool, skipped: bool) {
        if skipped {
            self.at = At::default();
            return;
        }
        let level = if side { self.at.x } else { self.at.z };
        nc.items.iter().for_each(|item| self.word(item));
        if nc.word(Role::Repeat).is_some() {
            self.at = At::default();
        }
        *(if side { &mut self.at.x } else { &mut self.at.z }) = level.filter(|_| self.keeps_level);
    }

    fn word(&mut self, item: &NcItem) {
        let NcItem::Word(role, value) = item else { return };
        let steps = self.counts_steps();
        let by = |from: Option<Told>| {
            let from = from.and_then(Told::number).zip(value.constant());
            from.map(|(from, by)| Told::Number(((from + by) * 1e6).round() / 1e6))
        };
        let told = value.constant().map_or(Told::Block(self.block), Told::Number);
        match role {
            Role::X if !steps => self.at.x = Some(told),
            Role::Z if !steps => self.at.z = Some(told),
            Role::X | Role::StepX => self.at.x = by(self.at.x),
            Role::Z | Role::StepZ => self.at.z = by(self.at.z),
            _ => {}
        }
    }
}

/// Makes places of increments, if all of them are known.
pub(super) fn to_places(nc: &mut Nc, from: Place) {
    let place = |item: &NcItem| {
        let NcItem::Word(role, value) = item else { return Some(item.clone()) };
        let (whole, from) = match role {
            Role::StepX => (Role::X, from.x()?),
            Role::StepZ => (Role::Z, from.z()?),
            role if role.is_step() => return None,
            _ => return Some(item.clone()),
        };
        let to = match value.constant() {
            Some(by) => Expr::Number(((from + by) * 1e6).round() / 1e6),
            // A count of increments stands by itself.
            None if matches!(value, Expr::Increments(_) | Expr::Negate(_)) || value.count().is_some() => {
                return None;
            }
            None => Expr::binary(BinOp::Add, Expr::Number(from), value.clone()),
        };
        Some(NcItem::Word(whole, to))
    };
    if let Some(items) = nc.items.iter().map(place).collect() {
        nc.items = items;
    }
}

/// Makes increments of places along X and Z, where the tool is known to stand: C has no place that is followed here, so `X40. H90.` is
/// a way of both. Nothing changes where a place is computed, or one of another axis.
pub(super) fn to_steps(nc: &mut Nc, from: Place) {
    let step = |item: &NcItem| {
        let NcItem::Word(role, value) = item else { return Some(item.clone()) };
        let (step, from) = match role {
            Role::X => (Role::StepX, from.x()?),
            Role::Z => (Role::StepZ, from.z()?),
            role if Role::STEPS.iter().any(|(whole, _)| whole == role) => return None,
            _ => return Some(item.clone()),
        };
        Some(NcItem::Word(step, Expr::Number(((value.constant()? - from) * 1e6).round() / 1e6)))
    };
    let plain = nc.ops().all(|op| matches!(op.group(), Group::Motion | Group::Distance | Group::FeedMode));
    if let Some(items) = nc.items.iter().map(step).collect::<Option<_>>().filter(|_| plain) {
        nc.items = items;
    }
}

/// True for what leaves a move where its words say.
fn is_plain(op: Op) -> bool {
    let elsewhere = matches!(
        op,
        Op::MachineOnce
            | Op::ReferenceReturn
            | Op::Reference2
            | Op::ReferenceFrom
            | Op::Home
            | Op::Probe
            | Op::PolarPlane
            | Op::PolarPlaneOff
            | Op::Cylinder
    );
    !op.takes_axes() && !elsewhere && !chooses_offset(op) && op.group() != Group::Units
}

/// True for a block after which the same place has other coordinates.
pub(super) fn changes_coordinates(nc: &Nc) -> bool {
    nc.ops().any(|op| op.takes_axes() || chooses_offset(op))
}

/// True for what chooses an offset, before the move of its block.
fn chooses_offset(op: Op) -> bool {
    !op.takes_axes() && (op.group() == Group::WorkOffset || op == Op::TurretIndex)
}
