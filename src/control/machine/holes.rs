//! Holes on a circle or a line: one block names their places, and the drilling cycle in force runs at each.

use super::frame::sin_cos;
use super::{Command, Machine, cycle};
use crate::canon::{Op, Role};
use crate::control::outcome::Stop;
use crate::control::trace::Trace;

/// Drills round the place where the tool stands, or the centre that the block names, or from there on along a line, whose first hole the block may name; the tool stays at
/// the last hole.
pub(super) fn run(machine: &mut Machine, op: Op, command: &Command, trace: &mut Trace) -> Result<(), Stop> {
    if machine.cycle.is_none() {
        return Err(Stop::unnamed("holes in a pattern, and no drilling cycle is in force"));
    }
    let line = op == Op::HolesLine;
    let length = if line { Role::HolesApart } else { Role::HolesRadius };
    let words = [length, Role::HolesCount].map(|role| command.word(role));
    let [Some(length), Some(_)] = words else {
        return Err(Stop::unnamed(
            "holes in a pattern without a radius or a distance, or without their number",
        ));
    };
    let (first, second, along) = machine.plane.axes();
    let axes = [Role::X, Role::Y].map(|role| command.word(role));
    let centre = !machine.incremental && command.word(Role::Z).is_none();
    if (first, second) != (0, 1) || command.has_axes() && !(centre && axes.iter().any(Option::is_some)) {
        return Err(Stop::unnamed(
            "holes in a pattern that does not begin at the tool in the plane of X and Y",
        ));
    }
    let count = command.number(Role::HolesCount).unwrap_or(0);
    let step = match (op, command.word(Role::HolesStep)) {
        (Op::HolesCircle, _) => 360.0 / f64::from(count.max(1)),
        (Op::HolesLine, _) => 0.0,
        (_, Some(step)) => step,
        _ => return Err(Stop::unnamed("holes on an arc without the angle between them")),
    };
    let start = command.word(Role::HolesStart).unwrap_or(0.0);
    let (length, mut begin) = (length * machine.unit(), machine.frame.program(&machine.position));
    for (axis, word) in axes.into_iter().enumerate() {
        begin[axis] = word.map_or(begin[axis], |word| word * machine.unit());
    }
    let least = machine.least_length() * machine.unit();
    let counted = |place: f64| (place / least).round() * least;
    for at in 0..count {
        let (sin, cos) = sin_cos(step.mul_add(f64::from(at), start));
        let away = if line { length * f64::from(at) } else { length };
        let mut place = begin;
        place[first] = counted(away.mul_add(cos, begin[first]));
        place[second] = counted(away.mul_add(sin, begin[second]));
        let mut to = machine.frame.machine(&place);
        to[along] = machine.position[along];
        machine.rapid_to(to, trace);
        cycle::hole(machine, trace)?;
        if trace.is_full() {
            break;
        }
    }
    Ok(())
}
