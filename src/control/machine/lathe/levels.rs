//! The passes of a roughing from level to level (K5 to K8, W1 to W7, L1).

use super::shape::Piece;
use super::stretches::{DEEPER, Rough, Stretch};
use super::way::Point;
use super::{EXACT, sense};
use crate::control::machine::Machine;
use crate::control::outcome::Stop;
use crate::control::trace::Trace;
use std::ops::RangeInclusive;

/// More levels than any part has.
const MOST: u32 = 100_000;

/// What the passes take.
pub struct Levels<'r> {
    pub rough: &'r Rough,
    /// Where they begin.
    pub corner: Point,
    /// The sense of the cuts.
    pub cut: f64,
    pub depth: f64,
    pub retract: f64,
    /// True where the infeed goes in rapid.
    pub rapid: bool,
    /// True where the last level lies on the deepest place.
    pub bottom: bool,
}

/// What is still to be done, the next thing last.
enum Work {
    Look(u32, RangeInclusive<usize>),
    Cut(u32, Stretch, Level),
}

/// A level: how deep, and whether it is the last.
#[derive(Clone, Copy)]
struct Level {
    depth: f64,
    last: bool,
}

impl Levels<'_> {
    /// All parts of the contour.
    fn all(&self) -> RangeInclusive<usize> {
        0..=self.rough.parts.len().saturating_sub(1)
    }

    /// A level over some parts of the contour; none if there is nothing to cut.
    fn level(&self, count: u32, parts: &RangeInclusive<usize>) -> Option<Level> {
        let (depth, deepest) = (self.depth * f64::from(count), self.rough.deepest(parts));
        if depth < deepest - DEEPER {
            return Some(Level { depth, last: false });
        }
        let over = self.depth * f64::from(count - 1) < deepest - DEEPER;
        (self.bottom && over).then_some(Level { depth: deepest, last: true })
    }

    /// Type I: each level from the corner to where the contour stops it (K6).
    pub fn steps(&self, machine: &mut Machine, trace: &mut Trace) -> Result<(), Stop> {
        let (rough, all) = (self.rough, self.all());
        let (infeed, along) = (rough.axis, 1 - rough.axis);
        for count in 1..=MOST {
            let Some(level) = self.level(count, &all) else { return Ok(()) };
            let stretches = rough.stretches(level.depth, &all, level.last);
            if let Some(end) = stretches.first().map(|stretch| stretch.to[along]) {
                let place = rough.place(level.depth);
                machine.go_one(infeed, place, self.rapid, trace);
                machine.go_one(along, end, false, trace);
                let mut back = [0.0; 2];
                back[infeed] = place - rough.sense * self.retract;
                back[along] = end - self.cut * self.retract;
                machine.go(true, back, trace);
                machine.go_one(along, self.corner[along], true, trace);
            }
            if level.last || trace.is_full() {
                return Ok(());
            }
        }
        Err(too_many())
    }

    /// Type II: each valley to its bottom before the next one (W2).
    pub fn valleys(&self, machine: &mut Machine, trace: &mut Trace) -> Result<(), Stop> {
        let mut work = vec![Work::Look(1, self.all())];
        let mut before = 0;
        while let Some(next) = work.pop() {
            match next {
                Work::Look(count, _) if count > MOST => return Err(too_many()),
                Work::Look(count, parts) => {
                    let Some(level) = self.level(count, &parts) else { continue };
                    let stretches = self.rough.stretches(level.depth, &parts, level.last);
                    work.extend(stretches.into_iter().rev().map(|stretch| Work::Cut(count, stretch, level)));
                }
                Work::Cut(count, stretch, level) => {
                    if before > count {
                        let clear = self.clear(count);
                        machine.go_one(self.rough.axis, clear, true, trace);
                    }
                    before = count;
                    self.stretch(machine, (count, &stretch, level), trace)?;
                    if !level.last {
                        work.push(Work::Look(count + 1, stretch.parts));
                    }
                }
            }
            if trace.is_full() {
                return Ok(());
            }
        }
        self.out(machine, trace);
        Ok(())
    }

    /// Over the level before, by the retract.
    fn clear(&self, count: u32) -> f64 {
        self.rough.place(self.depth * f64::from(count - 1) - self.retract)
    }

    /// W3 to W5.
    fn stretch(
        &self,
        machine: &mut Machine,
        (count, stretch, level): (u32, &Stretch, Level),
        trace: &mut Trace,
    ) -> Result<(), Stop> {
        let (infeed, along) = (self.rough.axis, 1 - self.rough.axis);
        machine.go_one(along, stretch.from[along], true, trace);
        // Elsewhere than on the first leg it goes down into full stock.
        let rapid = self.rapid && *stretch.parts.start() == 0;
        machine.go_one(infeed, self.rough.place(level.depth), rapid, trace);
        machine.go_one(along, stretch.to[along], false, trace);
        if !stretch.ends {
            for piece in self.flank(stretch, self.depth * f64::from(count - 1)) {
                machine.follow(&piece, [0.0; 2], trace)?;
            }
        }
        machine.go_one(infeed, self.clear(count), true, trace);
        Ok(())
    }

    /// The contour after a stretch, as far as it gets shallower, up to a depth (W5).
    fn flank(&self, stretch: &Stretch, up_to: f64) -> Vec<Piece> {
        let (rough, mut from, mut way) = (self.rough, stretch.to, Vec::new());
        for part in rough.parts.get(*stretch.parts.end()..).unwrap_or_default() {
            let (now, then) = (rough.depth(from), rough.depth(part.to));
            if then >= now - DEEPER || now <= up_to + DEEPER {
                break;
            }
            if then < up_to - DEEPER {
                way.push(part.between(from, part.crossing(rough.axis, rough.place(up_to))));
                break;
            }
            way.push(part.between(from, part.to));
            from = part.to;
        }
        way
    }

    /// W7: back to where the passes begin.
    fn out(&self, machine: &mut Machine, trace: &mut Trace) {
        let infeed = self.rough.axis;
        if self.rough.depth(machine.tool_at()) > EXACT {
            machine.go_one(infeed, self.corner[infeed], true, trace);
        }
        machine.go_one(1 - infeed, self.corner[1 - infeed], true, trace);
    }
}

fn too_many() -> Stop {
    Stop::unnamed("a roughing of more levels than the emulated lathe makes")
}

/// The sense of a contour's infeed or cut between two of its places.
pub fn sense_of(from: Point, to: Point, axis: usize) -> f64 {
    sense(to[axis] - from[axis])
}
