//! Arcs.

use super::rules::NoCentre;
use super::{Command, Machine};
use crate::canon::{Op, Role};
use crate::control::outcome::Stop;
use crate::control::scenario::Axes;
use crate::control::trace::{EventKind, Position, Trace};

/// How far, in millimetres, the ends of an arc may lie apart beyond twice its radius: what
/// rounding to least increments can cause.
const SLACK: f64 = 0.01;

/// The ends and the centre of an arc in a plane.
struct Flat {
    from: (f64, f64),
    to: (f64, f64),
    clockwise: bool,
}

pub(super) fn run(machine: &mut Machine, command: &Command, trace: &mut Trace) -> Result<(), Stop> {
    let (first, second, _) = machine.plane.axes();
    let from = machine.frame.program(&machine.position);
    let end = machine.target(command);
    let to = machine.frame.program(&end);
    let clockwise = machine.motion == Op::ArcCw;
    let flat = Flat { from: (from[first], from[second]), to: (to[first], to[second]), clockwise };
    let words = [Role::ArcI, Role::ArcJ, Role::ArcK].map(|role| command.word(role));
    let unit = machine.unit();
    let centre = if let Some(radius) = command.word(Role::ArcRadius) {
        flat.centre_by_radius(radius * unit, machine, trace)?
    } else if words.iter().any(Option::is_some) {
        let incremental = machine.rules.centre_is_incremental.ask(trace);
        let place = |axis: usize| {
            let word = words[axis].map(|value| value * unit);
            if incremental { from[axis] + word.unwrap_or(0.0) } else { word.unwrap_or(from[axis]) }
        };
        Some((place(first), place(second)))
    } else {
        match machine.rules.no_centre.ask(trace) {
            NoCentre::Alarm => return Err(Stop::unnamed("an arc without centre and radius")),
            NoCentre::Straight => {
                machine.feed_to(end, trace);
                return Ok(());
            }
        }
    };
    let Some(centre) = centre else {
        // A radius and no way to go: no control moves.
        return Ok(());
    };
    record(machine, &flat, centre, (from, end), trace);
    Ok(())
}

fn record(machine: &mut Machine, flat: &Flat, centre: (f64, f64), ends: (Axes, Axes), trace: &mut Trace) {
    let (first, second, _) = machine.plane.axes();
    let (from, end) = ends;
    let mut middle = from;
    (middle[first], middle[second]) = centre;
    let start = std::mem::replace(&mut machine.position, end);
    let middle = machine.frame.machine(&middle);
    let reach = |at: &Axes| (at[first] - middle[first]).hypot(at[second] - middle[second]);
    let (radius, end_radius) = (reach(&start), reach(&end));
    machine.doubt_feed_mode(trace);
    let flips = machine.frame.flips((first, second));
    let sweep = flat.sweep(centre) * if flips { -1.0 } else { 1.0 };
    machine.pass(radius * sweep.abs().to_radians());
    trace.push(EventKind::Arc {
        from: Position(start),
        to: Position(end),
        centre: Position(middle),
        radius,
        off: end_radius - radius,
        plane: machine.plane,
        sweep,
        feed: machine.feed,
        mode: machine.feed_mode,
    });
}

impl Flat {
    /// The centre of the arc with a signed radius; none if start and end are one.
    fn centre_by_radius(
        &self,
        radius: f64,
        machine: &Machine,
        trace: &mut Trace,
    ) -> Result<Option<(f64, f64)>, Stop> {
        let (dx, dy) = (self.to.0 - self.from.0, self.to.1 - self.from.1);
        let chord = dx.hypot(dy);
        if chord == 0.0 {
            trace.doubt("machine:arc.radius.full.circle");
            return Ok(None);
        }
        if chord > 2.0 * radius.abs() + SLACK {
            return Err(Stop::unnamed("the radius is too small for the end of the arc"));
        }
        let rules = &machine.rules;
        let long = if chord >= 2.0 * radius.abs() - 1e-9 {
            false
        } else if radius < 0.0 {
            rules.negative_radius_is_long.ask(trace)
        } else {
            !rules.positive_radius_is_short.ask(trace)
        };
        let height = (radius * radius - chord * chord / 4.0).max(0.0).sqrt();
        // The centre lies to the right of a short clockwise arc's chord.
        let side = if self.clockwise != long { -1.0 } else { 1.0 };
        let (x, y) = ((self.from.0 + self.to.0) / 2.0, (self.from.1 + self.to.1) / 2.0);
        Ok(Some((x - side * height * dy / chord, y + side * height * dx / chord)))
    }

    /// Degrees that are passed, positive counter-clockwise; a whole turn where the ends are one.
    fn sweep(&self, centre: (f64, f64)) -> f64 {
        let angle = |at: (f64, f64)| (at.1 - centre.1).atan2(at.0 - centre.0).to_degrees();
        let turned = (angle(self.to) - angle(self.from)).rem_euclid(360.0);
        let same = (self.from.0 - self.to.0).hypot(self.from.1 - self.to.1) < 1e-7;
        match (same, self.clockwise) {
            (true, true) => -360.0,
            (true, false) => 360.0,
            (false, true) => turned - 360.0,
            (false, false) => turned,
        }
    }
}
