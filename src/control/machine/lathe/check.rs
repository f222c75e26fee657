//! What an emulated lathe refuses, with the word or the code that is in the way.

use super::{alarm, said};
use crate::canon::{Group, Op, Role};
use crate::control::machine::{Command, Machine, arc};
use crate::control::outcome::Stop;
use crate::control::trace::Trace;

/// The place of the Y axis.
const Y: usize = 1;

/// An absolute word and the increment of the same axis.
const TWINS: [(Role, Role); 4] =
    [(Role::X, Role::StepX), (Role::Y, Role::StepY), (Role::Z, Role::StepZ), (Role::C, Role::StepC)];

/// Refuses a block that the emulated lathe does not do.
pub fn block(machine: &Machine, command: &Command, trace: &mut Trace) -> Result<(), Stop> {
    let has = |role| command.word(role).is_some();
    if TWINS.iter().any(|(place, step)| has(*place) && has(*step)) {
        return Err(Stop::unnamed("an axis has its place and its increment in one block"));
    }
    if command.ops.iter().any(|op| is_refused(*op)) {
        let code = command.own_code.as_deref().map(str::to_owned);
        let what = code.unwrap_or_else(|| {
            command.ops.iter().find(|op| is_refused(**op)).map_or_else(String::new, ToString::to_string)
        });
        return Err(Stop::unnamed(format!("the emulated lathe does not run {what}")));
    }
    // What only this control has is a code of the machine (M) or moves in a way of its own (G).
    let own = |op: &Op| matches!(op, Op::MachineSpecific | Op::CycleOther | Op::Builder);
    if let Some(code) = command.own_code.as_ref().filter(|code| code.starts_with('G'))
        && command.ops.iter().any(own)
    {
        return Err(Stop::unnamed(format!("the emulated lathe does not run {code}")));
    }
    let other = |inch: bool| command.has(if inch { Op::Metric } else { Op::Inch });
    if machine.rules.turning.inch_set.is_some_and(other) {
        return Err(Stop::unnamed("a unit that the control is not set to"));
    }
    let ignored =
        |role: Role| machine.rules.finish_allowance.peek() && matches!(role, Role::StepX | Role::StepZ);
    let mut beside = command.words.iter().filter(|(role, value)| beside_finish(*role, *value));
    if command.has(Op::Finish) && beside.clone().any(|(role, _)| !ignored(*role)) {
        return Err(Stop::unnamed("an axis word beside the finishing of a contour"));
    }
    if command.has(Op::Finish) && beside.next().is_some() {
        machine.rules.finish_allowance.ask(trace);
    }
    if command.has(Op::Finish) && command.word(Role::CutDepth).is_some() {
        machine.rules.finish_depth.ask(trace);
    }
    if command.word(Role::ThreadsPerInch).is_some_and(|count| count <= 0.0) {
        return Err(Stop::unnamed("threads an inch that are none"));
    }
    letters(machine, command)?;
    tool_word(command)?;
    arcs(machine, command, trace)
}

/// True for an axis word beside the finishing of a contour that is no allowance of 0 (F1).
fn beside_finish(role: Role, value: f64) -> bool {
    role.is_axis() && !(matches!(role, Role::StepX | Role::StepZ) && value == 0.0)
}

fn is_refused(op: Op) -> bool {
    use Op::*;
    let shapes = matches!(op, ScaleOn | MirrorOn | RotateOn | PolarOn | Pole | Wrap | PlaneOther);
    let offsets =
        matches!(op, LengthPlus | LengthMinus | OffsetPlus | OffsetMinus | OffsetPlus2 | OffsetMinus2);
    shapes || offsets || matches!(op, ArcTangent | ReferenceFrom | Home | ProbeOther | FeedInverse)
}

/// Corners without a comma, angles of lines (Q3), and axes that no lathe here has.
fn letters(machine: &Machine, command: &Command) -> Result<(), Stop> {
    let motion = command.of(Group::Motion).unwrap_or(machine.motion);
    let has = |roles: &[Role]| roles.iter().find(|role| command.word(**role).is_some()).copied();
    let arcs = matches!(motion, Op::ArcCw | Op::ArcCcw);
    if let Some(role) = has(&[Role::ArcI, Role::ArcJ, Role::ArcK, Role::ArcRadius]).filter(|_| !arcs) {
        let what = said(role.meaning());
        return Err(Stop::unnamed(format!("a word of arcs ({what}) in a block that makes none")));
    }
    let steps = command.words.iter().any(|(role, _)| role.is_step());
    let by_mode = command.of(Group::Distance).map_or(machine.incremental, |op| op == Op::Incremental);
    let places = TWINS.iter().any(|(place, _)| command.word(*place).is_some());
    let unknown = |op: &Op| match op {
        Op::LocalShift => steps || by_mode && places,
        Op::WriteWork => steps,
        Op::WriteTurret => by_mode && places,
        _ => false,
    };
    if command.ops.iter().any(unknown) {
        return Err(Stop::unnamed("increments of a zero or of a table"));
    }
    // Where a block cuts, C may be a chamfer; in rapid, in a drilling cycle or alone it is the axis (Q4).
    let drills = machine.cycle.is_some() || command.ops.iter().any(|op| op.is_cycle());
    let cuts = motion != Op::Rapid && !drills && has(&[Role::X, Role::Z, Role::StepX, Role::StepZ]).is_some();
    let turned = has(&[Role::C]).filter(|_| cuts && !machine.rules.turning.has_c);
    let axis = has(&[Role::A, Role::B, Role::E, Role::U, Role::V, Role::W]).or(turned);
    match axis {
        Some(role) => Err(Stop::unnamed(format!(
            "an axis that the emulated lathe does not have ({})",
            said(role.meaning())
        ))),
        None => Ok(()),
    }
}

/// T6.
fn tool_word(command: &Command) -> Result<(), Stop> {
    let aside = |op: &Op| {
        matches!(op, Op::SetPosition | Op::LimitSpeed | Op::Dwell | Op::WriteWork | Op::WriteTurret)
    };
    if command.word(Role::Turret).is_some() && command.ops.iter().any(aside) {
        return Err(alarm("PS0245", "a T word in a block that sets a zero, writes an offset or waits"));
    }
    Ok(())
}

/// Arcs are made in the plane of Z and X (C6), in another one by a lathe with a Y axis (C10), or in that of a surface that is milled
/// with C (V3, V8); compensation does not begin in one (Q1).
fn arcs(machine: &Machine, command: &Command, trace: &mut Trace) -> Result<(), Stop> {
    let motion = command.of(Group::Motion).unwrap_or(machine.motion);
    let whole = machine.lathe.surface.is_some() && arc::has_centre(command);
    if !matches!(motion, Op::ArcCw | Op::ArcCcw) || !(command.has_axes() || whole) {
        return Ok(());
    }
    let plane = command.of(Group::Plane);
    let zx = plane.map_or(machine.plane == crate::control::trace::Plane::Zx, |op| op == Op::PlaneZx);
    let there = super::surface::arcs(machine).unwrap_or(zx);
    // A lathe with a Y axis mills in the other planes too: X is a diameter there, and I, J, K and R are radii (C10).
    let across = machine.lathe.surface.is_none() && machine.rules.turning.axes.contains(&Y);
    if !there && across {
        trace.doubt("machine:lathe.arc.across");
    } else if !there {
        return Err(Stop::unnamed(match machine.lathe.surface {
            Some(_) => "an arc outside the plane of the milling with C",
            None => "an arc outside the plane of Z and X",
        }));
    }
    if command.has(Op::RadiusLeft) || command.has(Op::RadiusRight) {
        trace.rounded = machine.off_by();
        return Err(alarm("PS0034", "compensation of the nose radius begins in an arc"));
    }
    Ok(())
}
