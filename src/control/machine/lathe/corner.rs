//! Corners without a comma, and lines by their angle (Q3).
//!
//! Such a corner stands after a move along one axis, and the next block goes along the other one, the way that the sign says.

use super::{EXACT, alarm};
use crate::canon::{Group, Op, Role};
use crate::control::machine::{Command, Machine};
use crate::control::outcome::Stop;
use crate::control::scenario::Axes;
use crate::control::trace::{EventKind, Trace};

/// Where the block after a corner must go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn {
    /// 0 for X, 2 for Z.
    axis: usize,
    /// Its way.
    sign: f64,
    /// How far at least, as a radius in X.
    least: f64,
}

/// The words, whether they cut the corner off straight, and the axis of the next move where they name it.
const WORDS: [(Role, bool, Option<usize>); 4] = [
    (Role::ChamferX, true, Some(0)),
    (Role::ChamferZ, true, Some(2)),
    (Role::ChamferNext, true, None),
    (Role::RoundNext, false, None),
];

/// The corner words of a block that have a sign: chamfer, axis and value.
pub fn words(command: &Command) -> Vec<(bool, Option<usize>, f64)> {
    let found =
        WORDS.iter().filter_map(|(role, chamfer, axis)| Some((*chamfer, *axis, command.word(*role)?)));
    found.collect()
}

/// Checks the block after a corner, and tells the corner of this one.
pub fn after(
    machine: &mut Machine,
    command: &Command,
    (from, turn, cuts): (Axes, Option<Turn>, bool),
    trace: &mut Trace,
) -> Result<(), Stop> {
    if !machine.rules.lathe {
        return Ok(());
    }
    let way = |axis: usize| (machine.position[axis] - from[axis]) * if axis == 0 { 0.5 } else { 1.0 };
    if let Some(Turn { axis, sign, least }) = turn {
        let other = 2 - axis;
        if !cuts || machine.motion != Op::Linear {
            return Err(alarm("PS0052", "the block after a corner is no straight feed move"));
        }
        if way(axis) * sign <= EXACT || way(other).abs() > EXACT {
            return Err(alarm("PS0051", "the block after a corner goes another way"));
        }
        if way(axis).abs() + EXACT < least {
            return Err(alarm("PS0055", "the block after a corner is shorter than the corner"));
        }
    }
    let found = words(command);
    let Some((chamfer, named, value)) = found.first().copied() else { return Ok(()) };
    if found.len() > 1 || command.word(Role::CornerChamfer).or(command.word(Role::CornerRadius)).is_some() {
        return Err(alarm("PS0053", "two corners in one block"));
    }
    let size = value.abs() * machine.unit();
    let along = if way(0).abs() > EXACT { 0 } else { 2 };
    if !cuts || way(2 - along).abs() > EXACT || named == Some(along) {
        return Err(alarm("PS0054", "a corner after a block that does not go along one axis"));
    }
    if size <= EXACT || way(along).abs() + EXACT < size {
        return Err(alarm("PS0055", "a corner that is longer than its block"));
    }
    machine.lathe.turn = Some(Turn { axis: 2 - along, sign: value.signum(), least: size });
    trace.push(EventKind::Corner { chamfer, size });
    Ok(())
}

/// A line by its angle from Z, counter-clockwise, with the end that follows from it; none if no word gives an angle.
pub fn angled(machine: &Machine, command: &Command) -> Result<Option<Command>, Stop> {
    let Some(angle) = command.word(Role::LineAngle) else { return Ok(None) };
    if command.of(Group::Motion).unwrap_or(machine.motion) != Op::Linear {
        return Err(Stop::unnamed("an angle in a block that is no straight feed move"));
    }
    let unit = machine.unit();
    let to = machine.target(command);
    let way = |axis: usize| (to[axis] - machine.position[axis]) / unit;
    let (step, value) = end(command, angle, [way(0), way(2)])?;
    let mut command = command.clone();
    command.words.retain(|(role, _)| *role != Role::LineAngle);
    command.words.push((step, value));
    Ok(Some(command))
}

/// The word of the other axis: how far it goes. `ways` are those of the words, X as a diameter.
pub fn end(command: &Command, angle: f64, ways: [f64; 2]) -> Result<(Role, f64), Stop> {
    let has = |roles: [Role; 2]| roles.iter().any(|role| command.word(*role).is_some());
    let (sin, cos) = angle.to_radians().sin_cos();
    let none = || alarm("PS0057", "a line by its angle does not come to its end");
    match (has([Role::X, Role::StepX]), has([Role::Z, Role::StepZ])) {
        (true, true) => Err(Stop::unnamed("a line by its angle and by both its ends")),
        (false, false) => Err(Stop::unnamed("a line by its angle alone, whose end the next block gives")),
        (true, false) if sin.abs() <= EXACT => Err(none()),
        (true, false) => Ok((Role::StepZ, ways[0] / 2.0 * cos / sin)),
        (false, true) if cos.abs() <= EXACT => Err(none()),
        (false, true) => Ok((Role::StepX, 2.0 * ways[1] * sin / cos)),
    }
}
