//! Lines and arcs of a contour in work coordinates, X as a radius.

use super::way::Point;
use std::f64::consts::{FRAC_PI_2, TAU};

/// A line or an arc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    pub from: Point,
    pub to: Point,
    /// The middle of an arc, and the angle that it passes, radians, positive from Z to X.
    pub arc: Option<(Point, f64)>,
    /// True where it is gone in rapid.
    pub rapid: bool,
}

impl Piece {
    /// The same, so far off its place.
    pub fn moved(&self, off: Point) -> Self {
        let add = |at: Point| [at[0] + off[0], at[1] + off[1]];
        let arc = self.arc.map(|(centre, sweep)| (add(centre), sweep));
        Self { from: add(self.from), to: add(self.to), arc, rapid: self.rapid }
    }

    /// Cut where it turns back in X or in Z, so that each part goes one way in both.
    pub fn parts(&self) -> Vec<Piece> {
        let Some((centre, sweep)) = self.arc else { return vec![*self] };
        let (start, radius) = polar(centre, self.from);
        let end = start + sweep;
        let quarters =
            (start.min(end) / FRAC_PI_2).floor() as i64..=(start.max(end) / FRAC_PI_2).ceil() as i64;
        let inside = |angle: &f64| (angle - start) * sweep > 1e-9 && (end - angle) * sweep > 1e-9;
        let mut cuts: Vec<f64> = quarters.map(|quarter| quarter as f64 * FRAC_PI_2).filter(inside).collect();
        if sweep < 0.0 {
            cuts.reverse();
        }
        let (mut from, mut angle, mut parts) = (self.from, start, Vec::new());
        for cut in cuts {
            let to = at_quarter(centre, radius, cut);
            parts.push(Piece { from, to, arc: Some((centre, cut - angle)), rapid: self.rapid });
            (from, angle) = (to, cut);
        }
        parts.push(Piece { from, to: self.to, arc: Some((centre, end - angle)), rapid: self.rapid });
        parts
    }

    /// Where a part, which goes one way, has this coordinate along an axis (0 for X).
    pub fn crossing(&self, axis: usize, place: f64) -> Point {
        let other = 1 - axis;
        let mut at = [place; 2];
        at[other] = match self.arc {
            Some((centre, _)) => {
                let radius = (self.from[0] - centre[0]).hypot(self.from[1] - centre[1]);
                let away = place - centre[axis];
                let way = (radius * radius - away * away).max(0.0).sqrt();
                let side = (self.from[other] + self.to[other]) / 2.0 - centre[other];
                let (low, high) =
                    (self.from[other].min(self.to[other]), self.from[other].max(self.to[other]));
                (centre[other] + way * side.signum()).clamp(low, high)
            }
            None => {
                let part = (place - self.from[axis]) / (self.to[axis] - self.from[axis]);
                self.from[other] + (self.to[other] - self.from[other]) * part.clamp(0.0, 1.0)
            }
        };
        at
    }

    /// The part of it, which goes one way, between two of its places, gone at feed.
    pub fn between(&self, from: Point, to: Point) -> Self {
        let arc = self.arc.map(|(centre, sweep)| {
            let turned = polar(centre, to).0 - polar(centre, from).0;
            // No part is longer than a quarter.
            let turned = (turned + TAU / 2.0).rem_euclid(TAU) - TAU / 2.0;
            (centre, turned.abs() * sweep.signum())
        });
        Self { from, to, arc, rapid: false }
    }
}

/// Angle from the Z axis, and distance, of a place from a middle.
fn polar(centre: Point, at: Point) -> (f64, f64) {
    let (up, along) = (at[0] - centre[0], at[1] - centre[1]);
    (up.atan2(along), up.hypot(along))
}

/// The place of an arc at a whole quarter.
fn at_quarter(centre: Point, radius: f64, angle: f64) -> Point {
    match ((angle / FRAC_PI_2).round() as i64).rem_euclid(4) {
        0 => [centre[0], centre[1] + radius],
        1 => [centre[0] + radius, centre[1]],
        2 => [centre[0], centre[1] - radius],
        _ => [centre[0] - radius, centre[1]],
    }
}

#[cfg(test)]
mod tests {
    use super::Piece;
    use std::f64::consts::PI;

    #[test]
    fn an_arc_is_cut_at_its_highest_and_farthest_places() {
        // Half a circle of radius 10 about X20 Z-10 (radius): from Z0 over X30 to Z-20.
        let half =
            Piece { from: [20.0, 0.0], to: [20.0, -20.0], arc: Some(([20.0, -10.0], PI)), rapid: false };
        let parts = half.parts();
        assert_eq!(parts.iter().map(|part| part.to).collect::<Vec<_>>(), [[30.0, -10.0], [20.0, -20.0]]);
        // At X26 it is 8 off its middle along Z, by Pythagoras.
        assert!((parts[0].crossing(0, 26.0)[1] + 2.0).abs() < 1e-12);
        assert!((parts[1].crossing(0, 26.0)[1] + 18.0).abs() < 1e-12);
    }

    #[test]
    fn a_line_is_crossed_by_similar_triangles() {
        let cone = Piece { from: [10.0, -15.0], to: [15.0, -25.0], arc: None, rapid: false };
        assert_eq!(cone.crossing(0, 12.0), [12.0, -19.0]);
        assert_eq!(cone.crossing(1, -20.0), [12.5, -20.0]);
    }
}
