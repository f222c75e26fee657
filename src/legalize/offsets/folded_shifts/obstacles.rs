//! Why a shift cannot be counted into the coordinates.

use crate::canon::{Group, Op, Role, Sys};
use crate::dialect::Control;
use crate::ir::{Bank, Expr, NcItem, Place, StmtKind, constant_part};
use crate::legalize::Modal;

/// What is in the way, and what to do.
pub(super) type Obstacle = (&'static str, &'static str);

pub(super) const READS: Obstacle = (
    "a position is read under it, or the place where the probe touched",
    "work with the coordinates of the work offset there",
);
pub(super) const CALLED: Obstacle = (
    "what is called while it is in force is not in the library, is named by a computed number or at each move, or may run no times",
    "set the shift in the program that moves, or write its places in the coordinates of the work offset",
);
pub(super) const JUMPS: Obstacle = (
    "the programs that call each other here go back to a sequence number (M99 P)",
    "go back without a number, and jump in the caller",
);
pub(super) const RETURNS: Obstacle =
    ("the program goes back to its caller with it", "end the shift (G52 X0 Y0 Z0) before the return");
pub(super) const STAYS: Obstacle =
    ("it is not known to end with the program", "end the shift (G52 X0 Y0 Z0) before the end");
pub(super) const COMPUTED: Obstacle = (
    "its size is computed",
    "write its size as a number of whole increments, or add it to the coordinates by hand",
);
pub(super) const ROTARY: Obstacle =
    ("it turns a rotary axis", "write the angles in the coordinates of the work offset");
pub(super) const BESIDE: Obstacle =
    ("another code or word stands in its block", "give it a block of its own");
pub(super) const SKIPPED: Obstacle =
    ("its block may be skipped", "take the / out, or write both ways after a condition");
pub(super) const EXTERNAL: Obstacle = (
    "the library reads or sets the shift of all work offsets, which some machines keep in one place with it",
    "convert the programs that do by themselves",
);
pub(super) const UNITS: Obstacle = (
    "the library has programs in both units",
    "convert those in millimetres and those in inches by themselves",
);
pub(super) const IN_FORCE: Obstacle = (
    "it is not known that no drilling cycle and no cutter compensation is in force where it is set",
    "write G80 and G40 before it",
);
pub(super) const FRAME: Obstacle = (
    "coordinates are turned, scaled, mirrored or polar under it, or a position is set",
    "write the places in the coordinates of the work offset",
);
pub(super) const TABLE: Obstacle = (
    "a code under it may take its words otherwise",
    "end the shift before that code, and set it again after it",
);
pub(super) const SEVERAL: Obstacle = (
    "it may be one of several where a word counts with it",
    "write the places in the coordinates of the work offset",
);
pub(super) const DISTANCE: Obstacle =
    ("it is not known whether G90 or G91 is in force under it", "write one of them before it");
pub(super) const PLANE: Obstacle = (
    "a drilling cycle under it drills along another axis than Z, or is not known",
    "write G17 and the cycle's code before its words",
);
pub(super) const VACANT: Obstacle = (
    "a word under it may be vacant, and would be a place with the shift in it",
    "give the variable a value in every run",
);
pub(super) const POINT: Obstacle = ("a word under it counts increments", "write it with a decimal point");

/// What is in the way of a shift in a block under it.
pub(super) fn stands_in_way(item: &NcItem, state: &Modal) -> Option<Obstacle> {
    match item {
        NcItem::Op(op) => op_in_way(*op),
        NcItem::Code('M', _) => None,
        NcItem::Code(..) => Some(TABLE),
        NcItem::Word(Role::PolarAngle | Role::PolarDistance, _) => Some(FRAME),
        NcItem::Word(..) if !matches!(state.op(Group::Scaling), None | Some(Op::ScaleOff)) => Some(FRAME),
        NcItem::Word(..) if !matches!(state.op(Group::Mirror), None | Some(Op::MirrorOff)) => Some(FRAME),
        NcItem::Word(..) => None,
    }
}

/// What is in the way with an operation: all is but what is known to take its words as a move does, or none.
fn op_in_way(op: Op) -> Option<Obstacle> {
    use Op::*;
    let fine = match op.group() {
        Group::Motion => matches!(op, Rapid | Linear | ArcCw | ArcCcw),
        Group::Cycle => op == CycleOff || op.is_cycle() && !op.is_hole() && op != CycleOther,
        Group::Plane => matches!(op, PlaneXy | PlaneZx | PlaneYz),
        Group::WorkOffset => op == SelectWork,
        Group::Distance
        | Group::FeedMode
        | Group::Units
        | Group::RadiusComp
        | Group::LengthComp
        | Group::ReturnPlane
        | Group::PathMode
        | Group::SpeedMode
        | Group::Rotation
        | Group::Spindle
        | Group::Coolant => true,
        Group::OneShot => {
            let plain = matches!(
                op,
                MachineOnce
                    | ReferenceReturn
                    | Dwell
                    | Stop
                    | OptionalStop
                    | ToolChange
                    | Probe
                    | CheckInch
                    | CheckMetric
            );
            plain || op.auxiliary().is_some()
        }
        Group::Scaling => op == ScaleOff,
        Group::Mirror => op == MirrorOff,
        Group::ModalCall => false,
    };
    let frame = matches!(op, SetPosition | ShiftCancel | Pole | PolarOn)
        || matches!(op.group(), Group::Scaling | Group::Mirror);
    (!fine).then_some(if frame { FRAME } else { TABLE })
}

/// True for a position that the shift is in, or what it is; a computed number may be that of any.
pub(super) fn has_place(e: &Expr) -> bool {
    use Sys::{AxisPosition, CyclePlane, EndPosition, ExternalShift, ProbePoint, SkipPosition, WorkPosition};
    any(e, &|e| {
        let places =
            [AxisPosition, CyclePlane, EndPosition, ExternalShift, ProbePoint, SkipPosition, WorkPosition];
        match e {
            Expr::System(state, _) => places.contains(state),
            Expr::Indirect(bank, _) => *bank == Bank::Numbered,
            _ => false,
        }
    })
}

/// True for what reads where the probe touched, which may have been under the shift.
pub(super) fn has_touch(e: &Expr) -> bool {
    any(e, &|e| match e {
        Expr::System(state, _) => matches!(state, Sys::SkipPosition | Sys::ProbePoint),
        Expr::Indirect(bank, _) => *bank == Bank::Numbered,
        _ => false,
    })
}

/// True for what reads the shift of all work offsets.
pub(super) fn has_external(e: &Expr, source: &Control) -> bool {
    any(e, &|e| match e {
        Expr::System(state, _) => *state == Sys::ExternalShift,
        Expr::Indirect(Bank::Numbered, number) => may_be_external(number, source),
        _ => false,
    })
}

/// True for a statement that sets it.
pub(super) fn sets_external(kind: &StmtKind, source: &Control) -> bool {
    match kind.target() {
        Some(Place::System(state, _)) => *state == Sys::ExternalShift,
        Some(Place::Indirect(Bank::Numbered, number)) => may_be_external(number, source),
        _ => false,
    }
}

/// True where a computed number starts in its variables or right before them, or anywhere.
fn may_be_external(number: &Expr, source: &Control) -> bool {
    let mut runs = source.system_runs(Sys::ExternalShift).filter_map(|row| Some((row.first?, row.last()?)));
    let near =
        |start: f64| runs.any(|(first, last)| start + 1.0 >= f64::from(first) && start <= f64::from(last));
    constant_part(number).is_none_or(near)
}

/// True where a part of an expression is so.
fn any(e: &Expr, is_so: &dyn Fn(&Expr) -> bool) -> bool {
    let mut found = false;
    e.walk(&mut |e| found |= is_so(e));
    found
}
