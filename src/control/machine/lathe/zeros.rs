//! Returns and machine coordinates of a lathe (Z1 to Z4).

use super::engaging;
use crate::canon::{Op, Role};
use crate::control::machine::{Command, Machine};
use crate::control::outcome::Stop;
use crate::control::trace::Trace;

/// A return without an axis: all axes that the profile lists, else X and Z, go home at once, where the control does so (Z2). C
/// that a code of the builder engages is no axis until then.
pub fn without_axes(machine: &mut Machine, which: usize, trace: &mut Trace) -> Result<(), Stop> {
    if machine.rules.turning.two_blocks {
        return Err(Stop::unnamed("a return to the reference point without an axis"));
    }
    trace.doubt("machine:lathe.home.without.axes");
    let home = machine.references[which];
    let mut to = machine.position;
    for axis in machine.rules.turning.axes.clone() {
        if axis == engaging::C && machine.rules.turning.c_by_code && !machine.lathe.c_engaged {
            continue;
        }
        to[axis] = home[axis];
        machine.round_home(axis);
    }
    machine.rapid_to(to, trace);
    Ok(())
}

/// A move in machine coordinates, X as a diameter.
pub fn in_machine_coordinates(
    machine: &mut Machine,
    command: &Command,
    trace: &mut Trace,
) -> Result<(), Stop> {
    if machine.incremental || command.words.iter().any(|(role, _)| role.is_step()) {
        return Err(Stop::unnamed("machine coordinates as increments"));
    }
    if machine.motion != Op::Rapid && !machine.rules.turning.machine_rapid {
        return Err(Stop::unnamed("machine coordinates without rapid traverse in force"));
    }
    let mut to = machine.position;
    for (axis, value) in machine.named_axes(command) {
        to[axis] = value;
    }
    if command.word(Role::Feed).is_some() && machine.motion != Op::Rapid {
        trace.doubt("machine:lathe.machine.rapid");
    }
    machine.rapid_to(to, trace);
    Ok(())
}
