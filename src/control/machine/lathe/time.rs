//! How long moves of a lathe take: feed a turn under a surface speed (S3 to S8).

use super::EXACT;
use crate::control::machine::Machine;
use crate::control::machine::motion::distance;
use crate::control::scenario::Axes;
use crate::control::trace::{FeedMode, Spindle, Trace};
use std::f64::consts::{PI, TAU};

/// Milliseconds of a minute.
const MINUTE: f64 = 60_000.0;

/// A spindle that turns: how many minutes a turn takes, by the diameter.
struct Turns {
    /// Millimetres a minute, or turns.
    speed: f64,
    surface: bool,
    limit: Option<f64>,
}

/// Lets the time of a straight feed move pass.
pub fn straight(machine: &mut Machine, from: &Axes, to: &Axes, trace: &mut Trace) {
    let real = |at: &Axes| {
        let mut at = *at;
        at[0] /= 2.0;
        at
    };
    let way = distance(&real(from), &real(to));
    let shift = machine.frame.shift(0);
    let ends = (from[0] - shift, to[0] - shift);
    feed(machine, way, trace, |turns| turns.mean_straight(ends));
}

/// Lets the time of an arc pass; its start and middle are machine coordinates, the angle is in degrees.
pub fn arc(machine: &mut Machine, start: &Axes, middle: &Axes, sweep: f64, trace: &mut Trace) {
    if machine.lathe.surface.is_some() {
        let (first, second, _) = machine.plane.axes();
        let way = |axis: usize| (start[axis] - middle[axis]) * machine.real(axis);
        let radius = way(first).hypot(way(second));
        let x = start[0] - machine.frame.shift(0);
        return feed(machine, radius * sweep.to_radians().abs(), trace, |turns| turns.minutes(x));
    }
    let (up, along) = ((start[0] - middle[0]) / 2.0, start[2] - middle[2]);
    let (radius, angle) = (up.hypot(along), up.atan2(along));
    let sweep = sweep.to_radians();
    let centre = middle[0] - machine.frame.shift(0);
    feed(machine, radius * sweep.abs(), trace, |turns| {
        turns.mean_arc(centre, radius, (angle, angle + sweep))
    });
}

/// Lets the time of a thread pass: so many turns, at the speed that the spindle has where it begins (S8).
pub fn thread(machine: &mut Machine, from: &Axes, turns: f64) {
    let x = from[0] - machine.frame.shift(0);
    match spindle(machine) {
        Some(speed) => machine.clock += turns * speed.minutes(x) * MINUTE,
        None => machine.lathe.has_stood = true,
    }
}

fn feed(machine: &mut Machine, way: f64, trace: &mut Trace, mean: impl Fn(&Turns) -> f64) {
    machine.doubt_feed_mode(trace);
    if machine.feed_mode != FeedMode::PerTurn {
        return machine.pass(way);
    }
    match spindle(machine) {
        Some(turns) if machine.feed > 0.0 => machine.clock += way / machine.feed * mean(&turns) * MINUTE,
        Some(_) => {}
        // On the machine it waits for ever (S7): no program sees that but by a clock.
        None => machine.lathe.has_stood = true,
    }
}

fn spindle(machine: &Machine) -> Option<Turns> {
    let turns = matches!(machine.spindle, Spindle::Clockwise | Spindle::CounterClockwise);
    (turns && machine.speed > 0.0).then_some(Turns {
        speed: machine.speed,
        surface: machine.surface_speed,
        limit: machine.lathe.limit.filter(|limit| *limit > 0.0),
    })
}

/// The turns a minute of the spindle where the tool stands.
pub fn turns_now(machine: &Machine) -> Option<f64> {
    let minutes = spindle(machine)?.minutes(machine.position[0] - machine.frame.shift(0));
    (minutes > 0.0).then(|| 1.0 / minutes)
}

impl Turns {
    /// Minutes that a turn takes at a diameter.
    fn minutes(&self, x: f64) -> f64 {
        let free = if self.surface { PI * x.abs() / self.speed } else { 1.0 / self.speed };
        self.limit.map_or(free, |limit| free.max(1.0 / limit))
    }

    /// The diameter under which the limit acts.
    fn edge(&self) -> Option<f64> {
        self.limit.map(|limit| self.speed / (PI * limit))
    }

    /// The mean of it over a straight way between two diameters: it is cut where it bends.
    fn mean_straight(&self, (a, b): (f64, f64)) -> f64 {
        if !self.surface || (b - a).abs() <= EXACT {
            return self.minutes(a);
        }
        let bends = self.bends().map(|x| (x - a) / (b - a));
        let cuts = sorted(bends.filter(|part| *part > 0.0 && *part < 1.0), (0.0, 1.0));
        let at = |part: f64| self.minutes(a + (b - a) * part);
        cuts.windows(2).map(|part| (part[1] - part[0]) * (at(part[0]) + at(part[1])) / 2.0).sum()
    }

    /// The mean of it over an arc between two angles from the Z axis, about a diameter.
    fn mean_arc(&self, centre: f64, radius: f64, (from, to): (f64, f64)) -> f64 {
        if !self.surface || (to - from).abs() <= EXACT || radius <= EXACT {
            return self.minutes(centre + 2.0 * radius * from.sin());
        }
        let (low, high) = (from.min(to), from.max(to));
        let sines = self.bends().map(|x| (x - centre) / (2.0 * radius)).filter(|sine| sine.abs() <= 1.0);
        let angles = sines.flat_map(|sine| [sine.asin(), PI - sine.asin()]);
        let turned = angles.flat_map(|angle| (-2..=2).map(move |turn| angle + TAU * f64::from(turn)));
        let cuts = sorted(turned.filter(|angle| *angle > low && *angle < high), (low, high));
        let piece = |a: f64, b: f64| {
            let middle = (centre + 2.0 * radius * ((a + b) / 2.0).sin()).abs();
            if self.edge().is_some_and(|edge| middle < edge) {
                return self.minutes(0.0);
            }
            let mean = (centre + 2.0 * radius * (a.cos() - b.cos()) / (b - a)).abs();
            PI * mean / self.speed
        };
        let parts = cuts.windows(2).filter(|part| part[1] - part[0] > 1e-12);
        parts.map(|part| (part[1] - part[0]) / (high - low) * piece(part[0], part[1])).sum()
    }

    /// The diameters at which it bends.
    fn bends(&self) -> impl Iterator<Item = f64> {
        let edge = self.edge();
        [Some(0.0), edge, edge.map(|x| -x)].into_iter().flatten()
    }
}

fn sorted(within: impl Iterator<Item = f64>, (first, last): (f64, f64)) -> Vec<f64> {
    let mut cuts: Vec<f64> = [first, last].into_iter().chain(within).collect();
    cuts.sort_by(f64::total_cmp);
    cuts
}

#[cfg(test)]
mod tests {
    use super::Turns;
    use std::f64::consts::PI;

    /// The mean by many small steps.
    fn by_steps(of: impl Fn(f64) -> f64) -> f64 {
        let steps = 200_000;
        (0..steps).map(|step| of((f64::from(step) + 0.5) / f64::from(steps))).sum::<f64>() / f64::from(steps)
    }

    #[test]
    fn a_face_to_the_middle_meets_the_limit() {
        // 180 m a minute, at most 2500 turns: under 22.918 mm the limit acts.
        let turns = Turns { speed: 180_000.0, surface: true, limit: Some(2500.0) };
        let edge = 180_000.0 / (PI * 2500.0);
        // From 54 to 0: the outer part has the mean of both ends, the inner one the limit.
        let outer = (54.0 - edge) / 54.0 * (PI * (54.0 + edge) / 2.0 / 180_000.0);
        let expected = outer + edge / 54.0 / 2500.0;
        assert!((turns.mean_straight((54.0, 0.0)) - expected).abs() < 1e-12);
        let stepped = by_steps(|part| turns.minutes(54.0 * (1.0 - part)));
        assert!((turns.mean_straight((54.0, 0.0)) - stepped).abs() < 1e-9);
    }

    #[test]
    fn an_arc_has_the_mean_of_its_diameters() {
        for limit in [None, Some(1500.0), Some(2000.0)] {
            let turns = Turns { speed: 180_000.0, surface: true, limit };
            for (from, to) in [(0.0, PI / 2.0), (PI, 0.25), (-1.0, 2.0), (2.0, -4.0)] {
                let stepped =
                    by_steps(|part| turns.minutes(20.0 + 2.0 * 12.0 * (from + (to - from) * part).sin()));
                let exact = turns.mean_arc(20.0, 12.0, (from, to));
                assert!((exact - stepped).abs() < 1e-9, "{limit:?} {from} {to}: {exact} {stepped}");
            }
        }
    }
}
