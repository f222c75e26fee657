//! Returns to the reference positions of the machine, and from them.

use super::motion::LENGTH_AXIS;
use super::tooling::LostBy;
use super::{Command, Machine, lathe};
use crate::canon::Role;
use crate::control::outcome::Stop;
use crate::control::scenario::AXES;
use crate::control::trace::Trace;

/// The place in the list of the position that P names; the second without it.
pub(super) fn named(command: &Command) -> Result<usize, Stop> {
    match command.number(Role::ReferencePoint) {
        None => Ok(1),
        Some(which @ 2..=4) => Ok(which as usize - 1),
        Some(_) => Err(Stop::unnamed("a reference position that is not the second, the third or the fourth")),
    }
}

/// To the reference position of the named axes, by way of the block's point.
pub(super) fn to(
    machine: &mut Machine,
    command: &Command,
    which: usize,
    trace: &mut Trace,
) -> Result<(), Stop> {
    let home = machine.references[which];
    let mut named: Vec<usize> = machine.named_axes(command).iter().map(|(axis, _)| *axis).collect();
    if named.is_empty() && machine.rules.lathe {
        return lathe::zeros::without_axes(machine, which, trace);
    }
    if named.is_empty() && machine.rules.reference_takes_all.ask(trace) {
        named = (0..AXES).collect();
    }
    lathe::engaging::by_return(machine, &named, trace);
    if command.has_axes() {
        let by = machine.target(command);
        machine.rapid_to(by, trace);
        machine.by_way_of = Some(by);
    }
    let mut to = machine.position;
    let along = named.contains(&LENGTH_AXIS);
    for axis in named {
        to[axis] = home[axis];
        machine.round_home(axis);
    }
    machine.rapid_to(to, trace);
    machine.may_lose_length(LostBy::Reference, along);
    Ok(())
}

/// From the reference position by way of the point of the last return, and on to the block's.
pub(super) fn from(machine: &mut Machine, command: &Command, trace: &mut Trace) {
    trace.doubt("machine:reference.from");
    if let Some(point) = machine.by_way_of {
        let mut by = machine.position;
        for (axis, _) in machine.named_axes(command) {
            by[axis] = point[axis];
        }
        machine.rapid_to(by, trace);
    }
    let to = machine.target(command);
    machine.rapid_to(to, trace);
}
