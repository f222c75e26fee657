//! Moves of the tool of a lathe in work coordinates, X as a radius.

use super::EXACT;
use super::shape::Piece;
use crate::canon::{Group, Op};
use crate::control::machine::{Command, Machine, arc};
use crate::control::outcome::Stop;
use crate::control::scenario::Axes;
use crate::control::trace::Trace;

/// A place: X as a radius, and Z.
pub type Point = [f64; 2];

/// Goes along what a finishing has in place of the block's words; true where it has something.
pub fn follows(machine: &mut Machine, command: &Command, trace: &mut Trace) -> Result<bool, Stop> {
    let Some(way) = machine.lathe.way.take() else { return Ok(false) };
    if command.of(Group::Motion).is_none() && way.is_empty() {
        return Ok(true);
    }
    for piece in &way {
        machine.follow(piece, [0.0, 0.0], trace)?;
    }
    Ok(true)
}

/// After a cycle nobody knows for certain which code of motion is in force (K12).
pub fn doubt_motion(machine: &mut Machine, trace: &mut Trace) {
    if std::mem::take(&mut machine.lathe.after_cycle) {
        trace.doubt("machine:lathe.motion.after.cycle");
    }
}

impl Machine {
    /// Where the tool stands.
    pub(super) fn tool_at(&self) -> Point {
        [(self.position[0] - self.frame.shift(0)) / 2.0, self.position[2] - self.frame.shift(2)]
    }

    /// The machine position of a place; an axis that is left out stays.
    pub(super) fn placed(&self, x: Option<f64>, z: Option<f64>) -> Axes {
        let mut to = self.position;
        let near = |new: f64, old: f64| if (new - old).abs() <= EXACT { old } else { new };
        if let Some(x) = x {
            to[0] = near(2.0 * x + self.frame.shift(0), to[0]);
        }
        if let Some(z) = z {
            to[2] = near(z + self.frame.shift(2), to[2]);
        }
        to
    }

    /// Goes in rapid, both axes in one.
    pub(super) fn rapid_way(&mut self, x: Option<f64>, z: Option<f64>, trace: &mut Trace) {
        let to = self.placed(x, z);
        self.rapid_to(to, trace);
    }

    /// Goes at feed.
    pub(super) fn feed_way(&mut self, x: Option<f64>, z: Option<f64>, trace: &mut Trace) {
        let to = self.placed(x, z);
        self.feed_to(to, trace);
    }

    /// In rapid or at feed to a place.
    pub(super) fn go(&mut self, rapid: bool, to: Point, trace: &mut Trace) {
        match rapid {
            true => self.rapid_way(Some(to[0]), Some(to[1]), trace),
            false => self.feed_way(Some(to[0]), Some(to[1]), trace),
        }
    }

    /// Goes to the end of a piece that lies so far off its place.
    pub(super) fn follow(&mut self, piece: &Piece, off: Point, trace: &mut Trace) -> Result<(), Stop> {
        let to = [piece.to[0] + off[0], piece.to[1] + off[1]];
        let Some((centre, sweep)) = piece.arc else {
            self.go(piece.rapid, to, trace);
            return Ok(());
        };
        let end = self.placed(Some(to[0]), Some(to[1]));
        let mut middle = self.position;
        middle[0] = 2.0 * (centre[0] + off[0]) + self.frame.shift(0);
        middle[2] = centre[1] + off[1] + self.frame.shift(2);
        arc::turn(self, end, middle, sweep.to_degrees(), trace)
    }

    /// A cycle ends where it began, to the last digit.
    pub(super) fn settle(&mut self, start: &Axes) {
        if self.position.iter().zip(start).all(|(now, then)| (now - then).abs() <= EXACT) {
            self.position = *start;
        }
    }

    /// After a cycle the code of motion is the one from before it.
    pub(super) fn cycle_done(&mut self, motion: Op) {
        self.motion = motion;
        self.lathe.after_cycle = true;
    }
}

impl Machine {
    /// Along one axis (0 for X as a radius, 1 for Z) to a place.
    pub(super) fn go_one(&mut self, axis: usize, place: f64, rapid: bool, trace: &mut Trace) {
        let (x, z) = if axis == 0 { (Some(place), None) } else { (None, Some(place)) };
        if rapid { self.rapid_way(x, z, trace) } else { self.feed_way(x, z, trace) }
    }
}
