//! Arcs about one centre, one after the other, which are one arc for whoever watches the tool.

use super::observe::{Act, What};
use super::paths::{apart, axes};
use crate::control::trace::{EventKind, Plane, Position};

/// How far the centres of two pieces may lie apart, millimetres: what five digits of their ends make of one centre.
const CENTRES: f64 = 1e-4;

/// By how many roundings of their words they may lie farther apart.
const ROUNDINGS: f64 = 2.0;

/// Joins the pieces of arcs. Of a run that was `cut` off it is not known how far its last arc would have gone.
pub fn joined(acts: Vec<Act<'_>>, cut: bool) -> Vec<Act<'_>> {
    let mut out: Vec<Act<'_>> = Vec::with_capacity(acts.len());
    let mut pieces = 0;
    for act in acts {
        let whole = out.last().and_then(|last| {
            both(&last.what, &act.what, CENTRES + ROUNDINGS * last.rounded.max(act.rounded))
        });
        match (whole, out.last_mut()) {
            (Some(whole), Some(last)) => {
                last.what = What::other(whole);
                // Ends of pieces are written with five digits, in inches too: so near the whole arc they keep.
                last.rounded = last.rounded.max(act.rounded).max(CENTRES);
                pieces += 1;
            }
            _ => {
                out.push(act);
                pieces = 1;
            }
        }
    }
    if cut && pieces > 1 {
        out.pop();
    }
    out
}

/// The arc that two are, whose centres lie at most so far apart; none if they are none.
fn both(first: &EventKind, second: &EventKind, centres: f64) -> Option<EventKind> {
    use EventKind::Arc;
    let Arc { from, to, centre, radius, plane, sweep, feed, mode, diameters, .. } = first else {
        return None;
    };
    let Arc {
        from: from2,
        to: to2,
        centre: centre2,
        plane: plane2,
        sweep: more,
        radius: r2,
        off: off2,
        feed: feed2,
        mode: mode2,
        diameters: _,
    } = second
    else {
        return None;
    };
    let one = plane == plane2 && feed == feed2 && mode == mode2 && (*sweep > 0.0) == (*more > 0.0);
    if !one || apart(to, from2) > 1e-9 || apart_in_plane(centre, centre2, *plane) > centres {
        return None;
    }
    Some(Arc {
        from: *from,
        to: *to2,
        centre: *centre,
        radius: *radius,
        off: r2 + off2 - radius,
        plane: *plane,
        sweep: ending(sweep + more, [from, to2, centre], *plane, *diameters),
        diameters: *diameters,
        feed: *feed,
        mode: *mode,
    })
}

/// The sweep about the first centre that ends where the arc does: each piece turned about a centre of its own, a hair off.
fn ending(sum: f64, [from, to, centre]: [&Position; 3], plane: Plane, diameters: bool) -> f64 {
    let [first, second] = axes(plane);
    let way = |at: &Position, axis: usize| {
        let scale = if diameters && axis == 0 { 2.0 } else { 1.0 };
        (at.0[axis] - centre.0[axis]) / scale
    };
    let angle = |at: &Position| way(at, second).atan2(way(at, first)).to_degrees();
    let off = angle(to) - angle(from) - sum;
    sum + off - 360.0 * (off / 360.0).round()
}

/// How far two places lie apart in the plane of an arc: its centre says nothing of the third axis.
fn apart_in_plane(a: &Position, b: &Position, plane: Plane) -> f64 {
    axes(plane).into_iter().map(|axis| (a.0[axis] - b.0[axis]).abs()).fold(0.0, f64::max)
}
