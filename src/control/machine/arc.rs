//! Arcs.

use super::rules::NoCentre;
use super::{Command, Machine, lathe};
use crate::canon::{Op, Role};
use crate::control::outcome::Stop;
use crate::control::scenario::Axes;
use crate::control::trace::{EventKind, Position, Trace};

/// How far, in millimetres, the ends of an arc may lie apart beyond twice its radius: what
/// rounding to least increments can cause.
const SLACK: f64 = 0.01;

/// The ends and the sense of an arc in a plane. On a lathe X is a radius here.
pub(super) struct Flat {
    pub from: (f64, f64),
    pub to: (f64, f64),
    pub clockwise: bool,
}

pub(super) fn run(machine: &mut Machine, command: &Command, trace: &mut Trace) -> Result<(), Stop> {
    let (first, second, _) = machine.plane.axes();
    let end = machine.target(command);
    let scale = |axis| machine.real(axis);
    let flat_of = |at: &Axes| (at[first] * scale(first), at[second] * scale(second));
    let from = machine.frame.program(&machine.position);
    let to = machine.frame.program(&end);
    let clockwise = (machine.motion == Op::ArcCw) != lathe::surface::flips(machine);
    let flat = Flat { from: flat_of(&from), to: flat_of(&to), clockwise };
    let centre = if has_centre(command) {
        flat.centre(machine, command, trace)?
    } else {
        match machine.rules.no_centre.ask(trace) {
            NoCentre::Straight => {
                machine.feed_to(end, trace);
                return Ok(());
            }
            NoCentre::Alarm => {
                return Err(Stop::alarm(machine.lathe_name("PS0022"), "an arc without centre and radius"));
            }
        }
    };
    let Some(centre) = centre else {
        // A radius and no way to go: no control moves.
        return Ok(());
    };
    let centre = (centre.0 / scale(first), centre.1 / scale(second));
    record(machine, &flat, centre, (from, end), trace)
}

/// True where a block says where the middle of its arc is.
pub(super) fn has_centre(command: &Command) -> bool {
    let words = [Role::ArcI, Role::ArcJ, Role::ArcK, Role::ArcRadius];
    words.iter().any(|role| command.word(*role).is_some())
}

fn record(
    machine: &mut Machine,
    flat: &Flat,
    centre: (f64, f64),
    ends: (Axes, Axes),
    trace: &mut Trace,
) -> Result<(), Stop> {
    let (first, second, _) = machine.plane.axes();
    let (from, end) = ends;
    let mut middle = from;
    (middle[first], middle[second]) = centre;
    let middle = machine.frame.machine(&middle);
    let flips = machine.frame.flips((first, second));
    let own = (centre.0 * machine.real(first), centre.1 * machine.real(second));
    let sweep = flat.sweep(own) * if flips { -1.0 } else { 1.0 };
    turn(machine, end, middle, sweep, trace)
}

/// Goes to a place on an arc about a middle, machine coordinates.
pub(super) fn turn(
    machine: &mut Machine,
    end: Axes,
    middle: Axes,
    sweep: f64,
    trace: &mut Trace,
) -> Result<(), Stop> {
    let (first, second, _) = machine.plane.axes();
    let start = machine.position;
    let way = |at: &Axes, axis: usize| (at[axis] - middle[axis]) * machine.real(axis);
    let reach = |at: &Axes| way(at, first).hypot(way(at, second));
    let (radius, end_radius) = (reach(&start), reach(&end));
    let off = end_radius - radius;
    if machine.rules.turning.arc_limit.is_some_and(|limit| off.abs() > limit + 1e-9) {
        return Err(Stop::alarm(machine.lathe_name("PS0020"), "the end of the arc is not on its circle"));
    }
    machine.position = end;
    if machine.rules.lathe {
        lathe::surface::arc(machine, &start, &middle, sweep, trace);
        lathe::time::arc(machine, &start, &middle, sweep, trace);
    } else {
        machine.pass(radius * sweep.abs().to_radians());
    }
    trace.push(EventKind::Arc {
        from: Position(start),
        to: Position(end),
        centre: Position(middle),
        radius,
        off,
        plane: machine.plane,
        sweep,
        diameters: machine.rules.lathe,
        feed: machine.feed,
        mode: machine.feed_mode,
    });
    Ok(())
}

impl Flat {
    /// The centre that the words of a block say; none if start and end are one.
    pub(super) fn centre(
        &self,
        machine: &Machine,
        command: &Command,
        trace: &mut Trace,
    ) -> Result<Option<(f64, f64)>, Stop> {
        let (first, second, _) = machine.plane.axes();
        let unit = machine.unit();
        if let Some(radius) = command.word(Role::ArcRadius) {
            if machine.rules.lathe && machine.rules.turning.radius_not_negative && radius < 0.0 {
                return Err(Stop::alarm(machine.lathe_name("PS0023"), "the radius of an arc is negative"));
            }
            return self.centre_by_radius(radius * unit, machine, trace);
        }
        let words = [Role::ArcI, Role::ArcJ, Role::ArcK].map(|role| command.word(role));
        let incremental = machine.rules.centre_is_incremental.ask(trace);
        let place = |axis: usize, from: f64| {
            let word = words[axis].map(|value| value * unit);
            if incremental { from + word.unwrap_or(0.0) } else { word.unwrap_or(from) }
        };
        Ok(Some((place(first, self.from.0), place(second, self.from.1))))
    }

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
    pub(super) fn sweep(&self, centre: (f64, f64)) -> f64 {
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
