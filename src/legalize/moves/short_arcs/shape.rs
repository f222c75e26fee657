//! The geometry of arcs: where they are after a part of their way, and how many pieces they need.

use crate::canon::Func;
use crate::ir::{BinOp, Expr};

/// More than so many degrees are cut.
const MOST: f64 = 170.0;

/// Degrees of a piece, at the most.
const PIECE: f64 = 120.0;

/// An arc, from its start at zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Arc {
    way: [f64; 2],
    centre: [f64; 2],
    /// Degrees, counter-clockwise.
    sweep: f64,
}

/// In what an arc is measured.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Size {
    /// The program's unit.
    One,
    /// So many units, of either sign.
    Of(Expr),
}

impl Arc {
    /// The arc to a place, about a centre; a whole turn to where it begins.
    pub fn about(way: [f64; 2], centre: [f64; 2], ccw: bool) -> Self {
        let angle = |at: [f64; 2]| (at[1] - centre[1]).atan2(at[0] - centre[0]).to_degrees();
        let turned = (angle(way) - angle([0.0; 2])).rem_euclid(360.0);
        let closed = way[0].hypot(way[1]) < 1e-7;
        let sweep = match (closed || !(1e-9..=360.0 - 1e-9).contains(&turned), ccw) {
            (true, true) => 360.0,
            (true, false) => -360.0,
            (false, true) => turned,
            (false, false) => turned - 360.0,
        };
        Self { way, centre, sweep }
    }

    /// The arc of a radius, the longer one of a radius below 0; none if there is none.
    pub fn by_radius(way: [f64; 2], radius: f64, ccw: bool) -> Option<Self> {
        let chord = way[0].hypot(way[1]);
        let rest = radius * radius - chord * chord / 4.0;
        if chord == 0.0 || rest < -1e-9 {
            return None;
        }
        let height = rest.max(0.0).sqrt();
        // The centre lies to the right of the chord of the longer arc that turns to the left, and of the shorter one that turns
        // to the right.
        let side = if ccw == (radius < 0.0) { -1.0 } else { 1.0 };
        let centre =
            [way[0] / 2.0 - side * height * way[1] / chord, way[1] / 2.0 + side * height * way[0] / chord];
        Some(Self::about(way, centre, ccw))
    }

    pub fn radius(&self) -> f64 {
        self.centre[0].hypot(self.centre[1])
    }

    /// Where the centre is.
    pub fn centre(&self) -> [f64; 2] {
        self.centre
    }

    /// How far the end lies from the arc.
    pub fn off(&self) -> f64 {
        ((self.way[0] - self.centre[0]).hypot(self.way[1] - self.centre[1]) - self.radius()).abs()
    }

    pub fn pieces(&self) -> u32 {
        if self.sweep.abs() <= MOST { 1 } else { ((self.sweep.abs() - 1e-6) / PIECE).ceil() as u32 }
    }

    /// Where the arc is after a piece of so many.
    pub fn place(&self, piece: u32, count: u32) -> [f64; 2] {
        if piece == count {
            return self.way;
        }
        let (sin, cos) = (self.sweep * f64::from(piece) / f64::from(count)).to_radians().sin_cos();
        let [i, j] = self.centre;
        [i - i * cos + j * sin, j - i * sin - j * cos]
    }
}

/// A word as a multiple of a variable: the variable, if any, and how many.
fn multiple(word: Option<&Expr>) -> Option<(Option<&Expr>, f64)> {
    match word {
        None => Some((None, 0.0)),
        Some(word) if word.constant() == Some(0.0) => Some((None, 0.0)),
        Some(Expr::Negate(inner)) => multiple(Some(inner)).map(|(of, times)| (of, -times)),
        Some(word @ Expr::Var(_)) => Some((Some(word), 1.0)),
        Some(_) => None,
    }
}

/// The shape of an arc by incremental words of variables; none if that is not known.
pub(super) fn of(ends: [Option<&Expr>; 2], centre: [Option<&Expr>; 2], ccw: bool) -> Option<(Arc, Size)> {
    let [i, j] = [multiple(centre[0])?, multiple(centre[1])?];
    let [x, y] = ends.map(multiple);
    let unit = i.0.or(j.0)?;
    let of_unit = |(of, times): (Option<&Expr>, f64)| of.is_none_or(|of| of == unit).then_some(times);
    let size = || Size::Of(unit.clone());
    let centre = [of_unit(i)?, of_unit(j)?];
    if let (Some(x), Some(y)) = (x.and_then(of_unit), y.and_then(of_unit)) {
        let arc = Arc::about([x, y], centre, ccw);
        return (arc.off() < 1e-9).then(|| (arc, size()));
    }
    // Of one axis alone: the end lies opposite.
    let opposite = match (centre, x, y) {
        ([i, 0.0], _, Some((None, _))) => [2.0 * i, 0.0],
        ([0.0, j], Some((None, _)), _) => [0.0, 2.0 * j],
        _ => return None,
    };
    Some((Arc::about(opposite, centre, ccw), size()))
}

impl Size {
    /// A radius of so many units.
    pub fn radius(&self, unit: &Expr, times: f64) -> Expr {
        let size = Expr::Call(Func::Abs, [unit.clone()].into());
        if times == 1.0 { size } else { Expr::binary(BinOp::Mul, size, Expr::Number(times)) }
    }

    /// The incremental word of a piece; the last one of a word that is no multiple of the unit ends where that says.
    pub fn word(&self, unit: &Expr, given: Option<Expr>, at: f64, before: f64) -> Expr {
        let times = |count: f64| {
            let count = (count * 1e9).round() / 1e9;
            match count {
                0.0 => Expr::Number(0.0),
                1.0 => unit.clone(),
                _ => Expr::binary(BinOp::Mul, unit.clone(), Expr::Number(count)),
            }
        };
        let known = given.as_ref().is_none_or(|given| match multiple(Some(given)) {
            Some((of, count)) => of.is_none_or(|of| of == unit) && (count - at).abs() < 1e-9,
            None => false,
        });
        match given.filter(|_| !known) {
            Some(given) if before == 0.0 => given,
            Some(given) => Expr::binary(BinOp::Sub, given, times(before)),
            None => times(at - before),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_lie_on_their_circle() {
        for (way, centre, ccw, sweep) in [
            ([0.0, 0.0], [5.0, 0.0], true, 360.0),
            ([0.0, 0.0], [3.0, -4.0], false, -360.0),
            ([10.0, 0.0], [5.0, 0.0], true, 180.0),
            ([5.0, 5.0], [5.0, 0.0], false, -90.0),
            ([5.0, 5.0], [5.0, 0.0], true, 270.0),
        ] {
            let arc = Arc::about(way, centre, ccw);
            assert!((arc.sweep - sweep).abs() < 1e-9, "{way:?} {centre:?}: {}", arc.sweep);
            let count = arc.pieces();
            assert!(sweep.abs() / f64::from(count) <= PIECE + 1e-6);
            for piece in 1..=count {
                let at = arc.place(piece, count);
                let off = (at[0] - centre[0]).hypot(at[1] - centre[1]) - arc.radius();
                assert!(off.abs() < 1e-9, "{at:?}");
            }
            assert_eq!(arc.place(count, count), way);
        }
    }

    /// From (0,0) to (10,0) with a radius of 10 the centre lies 8.66 below, at 120 degrees from the start: 300 degrees on.
    #[test]
    fn a_longer_arc_by_its_radius() {
        let arc = Arc::by_radius([10.0, 0.0], -10.0, true);
        let low = -(75f64.sqrt());
        assert!(arc.is_some_and(|Arc { centre: [x, y], sweep, .. }| {
            (x - 5.0).abs() < 1e-9 && (y - low).abs() < 1e-9 && (sweep - 300.0).abs() < 1e-9
        }));
        assert_eq!(Arc::by_radius([10.0, 0.0], -4.0, true), None);
    }
}
