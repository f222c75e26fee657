//! Whether milling on a face is in force, and what else is known with it, on every way through a library.

use crate::canon::{Group, Op, Role, Sys};
use crate::ir::analysis::dataflow::Lattice;
use crate::ir::analysis::over_calls::Follow;
use crate::ir::{Block, BlockId, Expr, Nc, NcItem, Place, Stmt, StmtKind};

/// Whether it is in force.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Not.
    Off,
    /// It is.
    On,
    /// On some ways here.
    Unknown,
}

/// What is known at a place.
#[derive(Clone, Debug, PartialEq)]
pub struct Known {
    /// Whether it is in force.
    pub mode: Mode,
    /// True where C stands at 0 of the work coordinates.
    pub at_zero: bool,
    /// True where coordinates are places.
    pub absolute: bool,
    /// The plane in force, or the one that is in force again after it.
    pub plane: Option<Op>,
    /// The plane in force where it began.
    pub entered: Option<Op>,
}

impl Lattice for Known {
    fn join(&mut self, other: &Self) -> bool {
        let before = self.clone();
        if self.mode != other.mode {
            self.mode = Mode::Unknown;
        }
        self.at_zero &= other.at_zero;
        self.absolute &= other.absolute;
        self.plane = self.plane.filter(|plane| other.plane == Some(*plane));
        self.entered = self.entered.filter(|plane| other.entered == Some(*plane));
        *self != before
    }
}

impl Known {
    /// A run begins in no such milling, in the plane of turning, with places (C6 and D2 of docs/lathe.md).
    fn outside() -> Self {
        Self { mode: Mode::Off, at_zero: false, absolute: true, plane: Some(Op::PlaneZx), entered: None }
    }

    /// Takes a statement's effect; `by_c` where the control has the plane by itself.
    pub fn step(&mut self, stmt: &Stmt, by_c: bool) {
        let before = stmt.site.skip.map(|_| self.clone());
        match &stmt.kind {
            StmtKind::Nc(nc) => self.words(nc, by_c),
            StmtKind::ModalCall(_) => self.at_zero = false,
            StmtKind::Assign { target, .. } => {
                self.at_zero &= !matches!(target, Place::System(..) | Place::Indirect(..));
            }
            _ => {}
        }
        if let Some(before) = before {
            self.join(&before);
        }
    }

    fn words(&mut self, nc: &Nc, by_c: bool) {
        for op in nc.ops() {
            match op {
                Op::PolarPlane => {
                    if self.mode == Mode::Off {
                        self.entered = self.plane;
                    }
                    (self.mode, self.at_zero) = (Mode::On, false);
                }
                Op::PolarPlaneOff => {
                    self.at_zero &= self.mode == Mode::Off;
                    self.mode = Mode::Off;
                }
                Op::Absolute | Op::Incremental => self.absolute = op == Op::Absolute,
                op if op.group() == Group::Plane && !(by_c && self.mode != Mode::Off) => {
                    self.plane = Some(op)
                }
                _ => {}
            }
        }
        if nc.items.iter().any(|item| matches!(item, NcItem::Code('G', _))) {
            (self.plane, self.at_zero) = (None, false);
        }
        let turns = nc.word(Role::C).is_some() || nc.word(Role::StepC).is_some();
        let elsewhere = nc.ops().any(|op| {
            op.takes_axes()
                || op.is_hole()
                || matches!(op.group(), Group::WorkOffset | Group::Units)
                || matches!(
                    op,
                    Op::MachineOnce | Op::ReferenceReturn | Op::Reference2 | Op::Home | Op::Cylinder
                )
        });
        if elsewhere {
            self.at_zero = false;
        } else if turns && self.mode == Mode::Off {
            let zero = nc.word(Role::C).and_then(Expr::constant) == Some(0.0);
            self.at_zero = zero && self.absolute && nc.word(Role::StepC).is_none();
        }
    }
}

/// Follows it.
pub struct Faces {
    /// True where the control has the plane by itself.
    pub by_c: bool,
}

impl Follow for Faces {
    type Known = Known;

    fn outside(&self, _: usize) -> Known {
        Known::outside()
    }

    fn stmts(&self, _: (usize, BlockId), block: &Block, known: &mut Known) {
        block.stmts.iter().for_each(|stmt| known.step(stmt, self.by_c));
    }

    fn lose(&self, known: &mut Known) {
        (known.at_zero, known.absolute, known.plane) = (false, false, None);
    }
}

/// True where a value reads where the tool is.
pub fn reads_place(e: &Expr) -> bool {
    let mut reads = false;
    e.walk(&mut |e: &Expr| {
        reads |= match e {
            Expr::System(state, _) => matches!(
                state,
                Sys::EndPosition
                    | Sys::MachinePosition
                    | Sys::WorkPosition
                    | Sys::SkipPosition
                    | Sys::AxisPosition
                    | Sys::ProbePoint
            ),
            Expr::Indirect(..) => true,
            _ => false,
        };
    });
    reads
}
