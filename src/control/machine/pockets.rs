//! Round pockets: one block mills a circle, or circles that grow, about the place where the tool stands.
//!
//! The maker says what the words are, and that the cutter radius is taken off by itself. A figure alone shows the path.

use super::{Command, Machine, Plane, Side, arc};
use crate::canon::{Op, Role};
use crate::control::outcome::Stop;
use crate::control::scenario::Axes;
use crate::control::trace::Trace;

/// More circles than this are a slip.
const MOST: usize = 100;

/// Mills the pocket; the tool ends at its centre, at the depth.
pub(super) fn run(machine: &mut Machine, op: Op, command: &Command, trace: &mut Trace) -> Result<(), Stop> {
    let beside = command.axes().any(|(axis, _)| axis != 2);
    if machine.plane != Plane::Xy || beside || machine.cycle.is_some() || machine.side != Side::Off {
        return Err(Stop::unnamed(
            "a round pocket in another plane than that of X and Y, beside words of them, under a drilling cycle or under cutter compensation",
        ));
    }
    trace.doubt("machine:pocket.path");
    let Some(offset) = command.number(Role::RadiusOffset) else {
        return Err(Stop::unnamed("a round pocket without the number of its cutter radius"));
    };
    let (unit, least) = (machine.unit(), machine.least_length() * machine.unit());
    let cutter = machine.radius_value(offset);
    let counted = (cutter / least).round() * least;
    if (cutter - counted).abs() > 1e-9 {
        trace.rounded += least;
    }
    let circles: Vec<f64> =
        circles(command)?.into_iter().map(|radius| radius.mul_add(unit, -counted)).collect();
    if circles.iter().any(|radius| *radius <= 1e-9) {
        return Err(Stop::for_all("the tool is too large for the pocket"));
    }
    let count = command.number(Role::PocketCount).unwrap_or(1);
    if count > 1 && !machine.incremental {
        return Err(Stop::unnamed("a round pocket is repeated in absolute coordinates"));
    }
    if command.word(Role::Z).is_some() && !machine.rules.pocket_ends_deep.ask(trace) {
        return Err(Stop::unnamed("a round pocket that ends where it began"));
    }
    let sense = if op == Op::PocketCw { -1.0 } else { 1.0 };
    for _ in 0..count {
        if command.word(Role::Z).is_some() {
            let to = machine.target(command);
            machine.feed_to(to, trace);
        }
        once(machine, &circles, sense, trace)?;
        if trace.is_full() {
            break;
        }
    }
    Ok(())
}

/// The radii of the finished circles, in the units of the program.
fn circles(command: &Command) -> Result<Vec<f64>, Stop> {
    let words = [Role::PocketFirst, Role::PocketLast, Role::PocketStep].map(|role| command.word(role));
    let (first, last, step) = match words {
        [Some(first), None, None] => return Ok(vec![first]),
        [Some(first), Some(last), Some(step)] if step > 0.0 && last > first => (first, last, step),
        _ => return Err(Stop::unnamed("a round pocket needs I, or I, K and Q, with I less than K")),
    };
    let mut radii = Vec::new();
    let mut radius = first;
    while radius < last - 1e-9 {
        if radii.len() == MOST {
            return Err(Stop::unnamed("a round pocket in more than 100 circles"));
        }
        radii.push(radius);
        radius += step;
    }
    radii.push(last);
    Ok(radii)
}

/// Out to the first circle, from circle to circle and back, in half circles.
fn once(machine: &mut Machine, circles: &[f64], sense: f64, trace: &mut Trace) -> Result<(), Stop> {
    let start = machine.frame.program(&machine.position);
    let mut at = 0.0;
    let mut side = 1.0;
    for radius in circles {
        at = along(machine, start, (at, side * radius), sense * 180.0, trace)?;
        turn(machine, start, at, (0.0, sense * 360.0), trace)?;
        side = -side;
    }
    along(machine, start, (at, 0.0), sense * 180.0, trace).map(|_| ())
}

/// A half circle from one place on the line through the centre to another, both along X from it.
fn along(
    machine: &mut Machine,
    start: Axes,
    (from, to): (f64, f64),
    sweep: f64,
    trace: &mut Trace,
) -> Result<f64, Stop> {
    turn(machine, start, to, ((from + to) / 2.0, sweep), trace)?;
    Ok(to)
}

/// An arc that ends so far along X from the centre of the pocket, about a middle on the same line.
fn turn(
    machine: &mut Machine,
    start: Axes,
    to: f64,
    (middle, sweep): (f64, f64),
    trace: &mut Trace,
) -> Result<(), Stop> {
    let at = |x: f64| {
        let mut place = start;
        place[0] += x;
        machine.frame.machine(&place)
    };
    let (end, middle) = (at(to), at(middle));
    let sweep = if machine.frame.flips((0, 1)) { -sweep } else { sweep };
    arc::turn(machine, end, middle, sweep, trace)
}
