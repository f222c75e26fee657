//! Paths of moves: whether two are the same for whoever watches the tool.

use crate::control::scenario::Axes;
use crate::control::trace::{EventKind, Plane, Position};

/// Places at which two arcs are held against each other, their ends included.
const PLACES: u32 = 24;

/// The two axes of a plane.
pub fn axes(plane: Plane) -> [usize; 2] {
    match plane {
        Plane::Xy => [0, 1],
        Plane::Zx => [2, 0],
        Plane::Yz => [1, 2],
    }
}

/// The largest distance along any axis.
pub fn apart(a: &Position, b: &Position) -> f64 {
    let differences = a.0.iter().zip(b.0).map(|(a, b)| (a - b).abs());
    // What is no number is as far as can be.
    differences.fold(0.0, |most, one| if one.is_nan() { f64::INFINITY } else { most.max(one) })
}

/// Where a move goes, and true where it is one that may be left out when it is short.
pub fn ends(what: &EventKind) -> Option<(Position, Position)> {
    match what {
        EventKind::Rapid { from, to } | EventKind::Feed { from, to, .. } => Some((*from, *to)),
        EventKind::Arc { from, to, .. } => Some((*from, *to)),
        _ => None,
    }
}

/// Where an event leaves the tool; none if it moves nothing.
pub fn leaves(what: &EventKind) -> Option<Position> {
    match what {
        EventKind::Rapid { to, .. }
        | EventKind::Feed { to, .. }
        | EventKind::Arc { to, .. }
        | EventKind::Thread { to, .. }
        | EventKind::Probe { to, .. } => Some(*to),
        _ => None,
    }
}

/// True for a move that stays, on its whole way, as near to its start as `allowed`.
pub fn goes_nowhere(what: &EventKind, allowed: f64) -> bool {
    match what {
        EventKind::Rapid { from, to } | EventKind::Feed { from, to, .. } => apart(from, to) <= allowed,
        EventKind::Arc { from, .. } => {
            (0..=PLACES).all(|at| arc_place(what, at).is_some_and(|place| apart(from, &place) <= allowed))
        }
        _ => false,
    }
}

/// The largest distance between two arcs at the same part of their ways.
pub fn arcs_apart(a: &EventKind, b: &EventKind) -> f64 {
    let one = |at| match (arc_place(a, at), arc_place(b, at)) {
        (Some(a), Some(b)) => apart(&a, &b),
        _ => f64::INFINITY,
    };
    (0..=PLACES).map(one).fold(0.0, f64::max)
}

/// Where an arc is after so many parts of its way.
fn arc_place(what: &EventKind, at: u32) -> Option<Position> {
    let EventKind::Arc { from, to, centre, off, plane, sweep, radius, diameters, .. } = what else {
        return None;
    };
    if at == 0 || at == PLACES {
        return Some(if at == 0 { *from } else { *to });
    }
    let part = f64::from(at) / f64::from(PLACES);
    let [first, second] = axes(*plane);
    let mut place: Axes = std::array::from_fn(|axis| from.0[axis] + (to.0[axis] - from.0[axis]) * part);
    let [wide, high] = [first, second].map(|axis| if *diameters && axis == 0 { 2.0 } else { 1.0 });
    let start = ((from.0[second] - centre.0[second]) / high).atan2((from.0[first] - centre.0[first]) / wide);
    let (sin, cos) = (start + (sweep * part).to_radians()).sin_cos();
    let reach = radius + off * part;
    (place[first], place[second]) =
        (centre.0[first] + wide * reach * cos, centre.0[second] + high * reach * sin);
    Some(Position(place))
}
