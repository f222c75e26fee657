//! Whether milling on a face is in force, and what else is known with it, on every way through a library.

use super::words::may_stand;
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
    /// The places that words name, where the words before say them: X, a diameter, and in the milling the length of C.
    pub at: [Option<f64>; 2],
    /// True where a block goes where its words say.
    goes: bool,
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
        for (mine, theirs) in self.at.iter_mut().zip(other.at) {
            *mine = mine.filter(|mine| theirs == Some(*mine));
        }
        self.goes &= other.goes;
        *self != before
    }
}

impl Known {
    /// A run begins in no such milling, in the plane of turning, with places (C6 and D2 of docs/lathe.md).
    fn outside() -> Self {
        Self {
            mode: Mode::Off,
            at_zero: false,
            absolute: true,
            plane: Some(Op::PlaneZx),
            entered: None,
            at: [None; 2],
            goes: false,
        }
    }

    /// Takes a statement's effect; `by_c` where the control has the plane by itself.
    pub fn step(&mut self, stmt: &Stmt, by_c: bool) {
        let before = stmt.site.skip.map(|_| self.clone());
        match &stmt.kind {
            StmtKind::Nc(nc) => self.words(nc, by_c),
            StmtKind::ModalCall(_) => (self.at_zero, self.goes, self.at) = (false, false, [None; 2]),
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
                    (self.mode, self.at_zero, self.at[1]) = (Mode::On, false, Some(0.0));
                }
                Op::PolarPlaneOff => {
                    self.at_zero &= self.mode == Mode::Off;
                    (self.mode, self.at) = (Mode::Off, [None; 2]);
                }
                Op::Absolute | Op::Incremental => self.absolute = op == Op::Absolute,
                op if op.group() == Group::Plane && !(by_c && self.mode != Mode::Off) => {
                    self.plane = Some(op)
                }
                op if op.group() == Group::Motion => {
                    self.goes = matches!(op, Op::Rapid | Op::Linear | Op::ArcCw | Op::ArcCcw);
                }
                op if op.group() == Group::Cycle => self.goes = false,
                _ => {}
            }
        }
        if nc.items.iter().any(|item| matches!(item, NcItem::Code('G', _))) {
            (self.plane, self.at_zero, self.goes) = (None, false, false);
        }
        self.places(nc);
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

impl Known {
    /// Takes the places that a block's words name.
    fn places(&mut self, nc: &Nc) {
        let stands = |op| may_stand(op) || matches!(op, Op::PolarPlane | Op::PolarPlaneOff);
        if !nc.ops().all(stands) || nc.names_axis() && !self.goes {
            self.at = [None; 2];
            return;
        }
        for (at, [place, step]) in self.at.iter_mut().zip([[Role::X, Role::StepX], [Role::C, Role::StepC]]) {
            if let Some(value) = nc.word(place) {
                *at = value.constant().filter(|_| self.absolute);
            }
            if let Some(value) = nc.word(step) {
                *at = moved(*at, value);
            }
        }
        if nc.word(Role::LineAngle).is_some() {
            self.at = [None; 2];
        }
        if self.mode == Mode::Off {
            // C counts degrees.
            self.at[1] = None;
        }
    }
}

/// The place that lies so far from another one.
pub fn moved(from: Option<f64>, by: &Expr) -> Option<f64> {
    from.zip(by.constant()).map(|(from, by)| ((from + by) * 1e6).round() / 1e6)
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
        (known.at, known.goes) = ([None; 2], false);
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
