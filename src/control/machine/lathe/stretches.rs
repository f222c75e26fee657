//! Where a contour lies deeper than a level.

use super::shape::Piece;
use super::way::Point;
use std::ops::RangeInclusive;

/// What lies no deeper than this under a level does not (K5), millimetres.
pub const DEEPER: f64 = 1e-6;

/// A rough contour in parts that go one way, and how deep its places are.
pub struct Rough {
    pub parts: Vec<Piece>,
    /// The axis of the infeed (0 for X), its sense, and where depths count from.
    pub axis: usize,
    pub sense: f64,
    pub zero: f64,
}

/// A stretch of the contour that lies deeper than a level.
#[derive(Clone, Debug)]
pub struct Stretch {
    pub from: Point,
    pub to: Point,
    /// The parts that it lies on.
    pub parts: RangeInclusive<usize>,
    /// True where the contour ends in it.
    pub ends: bool,
}

impl Rough {
    pub fn depth(&self, at: Point) -> f64 {
        (at[self.axis] - self.zero) * self.sense
    }

    /// The coordinate of a depth.
    pub fn place(&self, depth: f64) -> f64 {
        self.zero + self.sense * depth
    }

    /// The greatest depth of some parts.
    pub fn deepest(&self, parts: &RangeInclusive<usize>) -> f64 {
        let within = self.parts.get(parts.clone()).unwrap_or_default();
        within.iter().map(|part| self.depth(part.from).max(self.depth(part.to))).fold(0.0, f64::max)
    }

    /// The stretches of some parts that lie under a level, in order; with `level`, those too that only reach it, where
    /// they have a length.
    pub fn stretches(&self, depth: f64, parts: &RangeInclusive<usize>, level: bool) -> Vec<Stretch> {
        let is_in = |deep: f64| deep >= depth - DEEPER;
        let (mut found, mut open, mut under) = (Vec::new(), None, false);
        for at in parts.clone() {
            let Some(part) = self.parts.get(at) else { break };
            let (before, after) = (self.depth(part.from), self.depth(part.to));
            if open.is_none() {
                open = match (is_in(before), is_in(after)) {
                    (true, _) => Some((at, part.from)),
                    (false, true) => Some((at, self.reach(part, depth, after, part.to))),
                    (false, false) => continue,
                };
            }
            under |= before.max(after) > depth + DEEPER;
            if let Some((first, from)) = open.filter(|_| !is_in(after)) {
                let to = self.reach(part, depth, before, part.from);
                found.push((under, Stretch { from, to, parts: first..=at, ends: false }));
                (open, under) = (None, false);
            }
        }
        if let (Some((first, from)), Some(last)) = (open, self.parts.get(*parts.end())) {
            let ends = *parts.end() + 1 == self.parts.len();
            found.push((under, Stretch { from, to: last.to, parts: first..=*parts.end(), ends }));
        }
        let other = 1 - self.axis;
        let long = |stretch: &Stretch| (stretch.to[other] - stretch.from[other]).abs() > super::EXACT;
        let wanted = found.into_iter().filter(|(under, stretch)| (*under || level) && long(stretch));
        wanted.map(|(_, stretch)| stretch).collect()
    }

    /// Where a part comes to a depth; its end that lies in it is that place where it lies on the level.
    fn reach(&self, part: &Piece, depth: f64, deep: f64, end: Point) -> Point {
        if deep <= depth + DEEPER { end } else { part.crossing(self.axis, self.place(depth)) }
    }
}

#[cfg(test)]
mod tests {
    use super::{Piece, Rough};

    /// Lines through places, X as a radius; depths count down from 27.
    fn rough(places: &[[f64; 2]]) -> Rough {
        let line = |pair: &[[f64; 2]]| Piece { from: pair[0], to: pair[1], arc: None, rapid: false };
        Rough { parts: places.windows(2).map(line).collect(), axis: 0, sense: -1.0, zero: 27.0 }
    }

    #[test]
    fn two_valleys_are_two_stretches() {
        let rough = rough(&[
            [27.0, 3.0],
            [22.0, 3.0],
            [22.0, -5.0],
            [15.0, -12.0],
            [15.0, -20.0],
            [22.0, -27.0],
            [22.0, -33.0],
            [18.0, -37.0],
            [18.0, -41.0],
            [22.0, -45.0],
            [22.0, -52.0],
            [27.0, -52.0],
        ]);
        let all = 0..=10;
        let ends = |depth: f64| {
            let found = rough.stretches(depth, &all, false);
            found.iter().map(|stretch| (stretch.from[1], stretch.to[1])).collect::<Vec<_>>()
        };
        assert_eq!(ends(2.0), [(3.0, -52.0)]);
        assert_eq!(ends(6.0), [(-6.0, -26.0), (-34.0, -44.0)]);
        assert_eq!(ends(10.0), [(-10.0, -22.0)]);
        // Level with the land between the valleys: one stretch over all.
        assert_eq!(ends(5.0), [(3.0, -52.0)]);
        // On the bottom nothing lies deeper; asked for, the bottom itself is found.
        assert_eq!(ends(12.0), []);
        assert_eq!(rough.stretches(12.0, &all, true).len(), 1);
    }
}
