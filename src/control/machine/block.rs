//! The order in which a block's operations and words act.
//!
//! Modes come first, then tool, spindle and coolant as far as they act with the start of the move, then what moves,
//! then the rest of them, then a stop.

use super::{Command, Machine, auxiliary, lathe, motion, offsets, rigid, state, tooling};
use crate::canon::{Auxiliary, Group, Op, Pause, Role};
use crate::control::outcome::Stop;
use crate::control::trace::{EventKind, Side, Trace};

pub(super) fn run(machine: &mut Machine, command: &Command, trace: &mut Trace) -> Result<(), Stop> {
    let unrolled = if machine.rules.lathe { lathe::surface::block(machine, command, trace)? } else { None };
    let command = unrolled.as_ref().unwrap_or(command);
    if machine.frame.is_shaped() && command.ops.iter().any(|op| is_of_frame(*op)) {
        machine.rules.frame_codes_when_shaped.ask(trace);
    }
    if machine.rules.lathe {
        lathe::check::block(machine, command, trace)?;
    }
    rigid::enter(machine, command)?;
    state::modes(machine, command, trace);
    let before = auxiliary::Before::of(machine, trace);
    // What acts with the start of a move acts before a turret that turns beside it, but for some codes of the builder (T5).
    let waits = machine.rules.lathe && command.word(Role::Turret).is_some() && goes_somewhere(command);
    let after = waits && lathe::turret::is_awaited(machine, command, trace);
    if waits {
        auxiliary::with_start(machine, command, |kind| !after || kind != Auxiliary::Other, trace);
    }
    tooling::tool(machine, command, trace);
    if !waits || after {
        auxiliary::with_start(machine, command, |kind| !waits || kind == Auxiliary::Other, trace);
    }
    let compensated = machine.side != Side::Off;
    tooling::compensation(machine, command, trace);
    if compensated && machine.side != Side::Off && is_still(command) {
        machine.rules.still_blocks.ask(trace);
    }
    state::frames(machine, command, trace);
    for &op in &command.ops {
        one_shot(machine, op, command, trace)?;
    }
    if command.has_axes() {
        machine.place_by_offset(trace);
    }
    if places_length(machine, command) {
        machine.place_by_length(trace);
    }
    trace.zero(machine.zero());
    motion::run(machine, command, trace)?;
    if let Some(mode) = command.distance_after {
        machine.incremental = mode == Op::Incremental;
    }
    auxiliary::behind(machine, command, &before, trace);
    for &op in &command.ops {
        match op {
            Op::Stop => machine.pause(Pause::Stop, EventKind::Stop, trace),
            Op::OptionalStop => machine.pause(Pause::Stop, EventKind::OptionalStop, trace),
            _ => {}
        }
    }
    Ok(())
}

/// True for a block that moves, or returns.
fn goes_somewhere(command: &Command) -> bool {
    let returns = |op: &Op| matches!(op, Op::ReferenceReturn | Op::Reference2 | Op::Home | Op::Dwell);
    command.has_axes() || command.ops.iter().any(returns)
}

/// True for a block that moves nothing.
fn is_still(command: &Command) -> bool {
    let turns = [Role::ArcI, Role::ArcJ, Role::ArcK].iter().any(|role| command.word(*role).is_some());
    !command.is_empty() && !command.has_axes() && !turns
}

/// True where a block places something by the tool length, in coordinates of the program.
fn places_length(machine: &Machine, command: &Command) -> bool {
    let aside = |op: &Op| {
        matches!(op, Op::MachineOnce | Op::WriteWork | Op::WriteTurret | Op::LocalShift | Op::Dwell)
    };
    let depth = command.word(Role::Z).is_some() && !machine.incremental;
    // Words that are kept for later place nothing yet; a hole is placed by those that were kept.
    let drills = machine.cycle.is_some() && command.has_axes();
    let keeps = command.number(Role::Repeat) == Some(0);
    (depth || command.word(Role::CycleR).is_some() || drills) && !keeps && !command.ops.iter().any(aside)
}

/// True for a code that chooses or leaves the frame of coordinates.
fn is_of_frame(op: Op) -> bool {
    matches!(op.group(), Group::Plane | Group::WorkOffset)
        || matches!(op, Op::LocalShift | Op::SetPosition | Op::MachineOnce | Op::ReferenceFrom)
        || matches!(op, Op::ReferenceReturn | Op::Reference2 | Op::Home)
}

/// Operations that act once and do not move by the words of motion.
fn one_shot(machine: &mut Machine, op: Op, command: &Command, trace: &mut Trace) -> Result<(), Stop> {
    match op {
        Op::Dwell => dwell(machine, command, trace),
        Op::WriteWork
        | Op::WriteLength
        | Op::WriteLengthWear
        | Op::WriteRadius
        | Op::WriteRadiusWear
        | Op::WriteOffset => offsets::write_by_code(machine, op, command, trace)?,
        Op::WriteTurret => machine.write_turret(command, trace)?,
        op if op.is_lathe_setup() => lathe::setup(machine, op, command)?,
        // They move; of those that read a contour the interpreter knows the blocks.
        op if op.is_lathe_cycle() => {}
        Op::LimitSpeed => {
            if let Some(speed) = command.word(Role::SpeedLimit) {
                machine.lathe.limit = Some(speed);
                trace.push(EventKind::SpeedLimit { speed });
            }
        }
        Op::CheckInch if !machine.inch => return Err(Stop::unnamed("the control is set to metric")),
        Op::CheckMetric if machine.inch => return Err(Stop::unnamed("the control is set to inch")),
        Op::ThreadRunOutOn | Op::ThreadRunOutOff => machine.set_run_out(op == Op::ThreadRunOutOn),
        // Rigid or not, a tap goes the same way.
        Op::RigidTaps | Op::TapReady => {}
        // These move, or are modes, or were done in their places.
        _ if op.group() != Group::OneShot || is_done_elsewhere(op) => {}
        // An M code of its own, which has its time.
        op if auxiliary::is_own(op)
            && command.own_code.as_ref().is_some_and(|code| code.starts_with('M')) => {}
        _ => trace.push(EventKind::Other { operation: op, code: command.own_code.clone() }),
    }
    Ok(())
}

fn is_done_elsewhere(op: Op) -> bool {
    use Op::*;
    op.is_flow()
        || op.auxiliary().is_some()
        || matches!(
            op,
            RapidOnce
                | Probe
                | ProbeOther
                | MachineOnce
                | ReferenceReturn
                | ReferenceFrom
                | Reference2
                | Home
                | LocalShift
                | SetPosition
                | Pole
                | PolarOn
                | PolarOff
                | CycleHere
                | HolesCircle
                | HolesArc
                | HolesLine
                | PocketCw
                | PocketCcw
                | TurretIndex
                | Stop
                | OptionalStop
                | CheckInch
                | CheckMetric
        )
}

fn dwell(machine: &mut Machine, command: &Command, trace: &mut Trace) {
    let seconds = command
        .word(Role::DwellS)
        .or_else(|| command.word(Role::DwellMs).map(|ms| ms / 1000.0))
        .unwrap_or(0.0)
        .max(0.0);
    machine.clock += seconds * 1000.0;
    let in_cycle = machine.cycle.is_some() && !command.has(Op::CycleOff) && !machine.rules.lathe;
    if in_cycle && machine.rules.dwell_is_of_cycle.peek() {
        machine.cycle.iter_mut().for_each(|cycle| cycle.waited = Some(seconds));
    }
    machine.lathe.last_dwell = Some(seconds);
    trace.push(EventKind::Dwell { seconds });
}
