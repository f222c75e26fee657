//! The order in which a block's operations and words act.
//!
//! Modes come first, then tool, spindle and coolant, then what moves, then what stops; so
//! that `G1 X1 M5` moves with the spindle turning.

use super::{Command, Machine, motion, offsets, state, tooling};
use crate::canon::{Group, Op, Role};
use crate::control::outcome::Stop;
use crate::control::trace::{Happening, Trace};

pub(super) fn run(machine: &mut Machine, command: &Command, trace: &mut Trace) -> Result<(), Stop> {
    state::modes(machine, command, trace);
    tooling::before(machine, command, trace);
    state::frames(machine, command, trace);
    for &op in &command.ops {
        one_shot(machine, op, command, trace)?;
    }
    if command.has_axes() {
        machine.place_by_offset(trace);
    }
    motion::run(machine, command, trace)?;
    tooling::after(machine, command, trace);
    for &op in &command.ops {
        match op {
            Op::Stop => trace.push(Happening::Stop),
            Op::OptionalStop => trace.push(Happening::OptionalStop),
            _ => {}
        }
    }
    Ok(())
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
        Op::LimitSpeed => {
            if let Some(speed) = command.word(Role::SpeedLimit) {
                trace.push(Happening::SpeedLimit { speed });
            }
        }
        Op::CheckInch if !machine.inch => return Err(Stop::unnamed("the control is set to metric")),
        Op::CheckMetric if machine.inch => return Err(Stop::unnamed("the control is set to inch")),
        // These move, or are modes, or were done in their places.
        _ if op.group() != Group::OneShot || is_done_elsewhere(op) => {}
        _ => trace.push(Happening::Other { operation: op, code: command.own_code.clone() }),
    }
    Ok(())
}

fn is_done_elsewhere(op: Op) -> bool {
    use Op::*;
    op.is_flow()
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
                | Stop
                | OptionalStop
                | SpindleOrient
                | ToolChange
                | ThroughSpindle
                | ThroughSpindleOff
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
    trace.push(Happening::Dwell { seconds });
}
