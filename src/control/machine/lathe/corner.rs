//! Corners and lines by their angle, as the words of a block say them (Q2, Q3).

use super::{EXACT, alarm};
use crate::canon::Role;
use crate::control::machine::{Command, Machine};
use crate::control::outcome::Stop;

/// A corner: true for a chamfer, and its size.
pub type Cut = Option<(bool, f64)>;

/// The axis that the move after a corner must go along (0 for X, 2 for Z), where a letter names it, and the sign of its way.
pub type Way = Option<(Option<usize>, f64)>;

/// The words that may have a sign, whether they cut the corner off straight, and the axis of the next move where they name it.
const SIGNED: [(Role, bool, Option<usize>); 4] = [
    (Role::ChamferX, true, Some(0)),
    (Role::ChamferZ, true, Some(2)),
    (Role::ChamferNext, true, None),
    (Role::RoundNext, false, None),
];

/// The words that have none.
const PLAIN: [(Role, bool); 2] = [(Role::CornerRadius, false), (Role::CornerChamfer, true)];

/// The sine of a degree: lines that lie no farther apart do not meet, and a line no farther from an axis does not come to a place
/// along the other one.
pub const DEGREE: f64 = 0.017_452_406_437_283_51;

/// The corner that a block says, and where the next one must go.
pub fn of(machine: &Machine, command: &Command) -> Result<(Cut, Way), Stop> {
    let unit = machine.unit();
    let plain = PLAIN.iter().filter_map(|(role, chamfer)| Some((*chamfer, None, command.word(*role)?)));
    let signed = SIGNED.iter().filter_map(|(role, chamfer, axis)| {
        let value = command.word(*role)?;
        // By C and R, as a drawing gives them, the next line may go any way.
        let free = machine.rules.turning.letters && value > 0.0;
        let way = (!free).then_some((*axis, value.signum()));
        Some((*chamfer, way, value.abs()))
    });
    let mut found = plain.chain(signed);
    match (found.next(), found.next()) {
        (_, Some(_)) => Err(alarm("PS0053", "two corners in one block")),
        (None, None) => Ok((None, None)),
        (Some((_, _, size)), None) if size.is_nan() || size <= EXACT => {
            Err(Stop::unnamed("a corner whose size is 0 or negative"))
        }
        (Some((chamfer, way, size)), None) => Ok((Some((chamfer, size * unit)), way)),
    }
}

/// Whether a block names X, and Z.
pub fn names(command: &Command) -> [bool; 2] {
    [[Role::X, Role::StepX], [Role::Z, Role::StepZ]]
        .map(|roles| roles.iter().any(|role| command.word(*role).is_some()))
}

/// How far a line at an angle goes along X, as a radius, and along Z, where one of the two is known.
pub fn along(angle: f64, (named, way): ([bool; 2], [f64; 2])) -> Result<[f64; 2], Stop> {
    let (sin, cos) = angle.to_radians().sin_cos();
    let none = || alarm("PS0057", "a line by its angle does not come to its end");
    match named {
        [true, _] if sin.abs() <= DEGREE + EXACT => Err(none()),
        [true, _] => Ok([way[0], way[0] * cos / sin]),
        [false, _] if cos.abs() <= DEGREE + EXACT => Err(none()),
        [false, _] => Ok([way[1] * sin / cos, way[1]]),
    }
}
