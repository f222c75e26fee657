//! Arcs about one centre, one after the other, which are one arc for whoever watches the tool.

use super::observe::Act;
use super::paths::apart;
use crate::control::trace::EventKind;
use std::borrow::Cow;

/// How far the centres of two pieces may lie apart, millimetres: what the rounding of their ends makes of one centre.
const CENTRES: f64 = 0.005;

/// Joins the pieces of arcs.
pub fn joined(acts: Vec<Act<'_>>) -> Vec<Act<'_>> {
    let mut out: Vec<Act<'_>> = Vec::with_capacity(acts.len());
    for act in acts {
        let whole = out.last().and_then(|last| both(&last.what, &act.what));
        match (whole, out.last_mut()) {
            (Some(whole), Some(last)) => last.what = Cow::Owned(whole),
            _ => out.push(act),
        }
    }
    out
}

/// The arc that two are; none if they are none.
fn both(first: &EventKind, second: &EventKind) -> Option<EventKind> {
    use EventKind::Arc;
    let Arc { from, to, centre, radius, plane, sweep, feed, mode, .. } = first else { return None };
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
    } = second
    else {
        return None;
    };
    let one = plane == plane2 && feed == feed2 && mode == mode2 && (*sweep > 0.0) == (*more > 0.0);
    if !one || apart(to, from2) > 1e-9 || apart_in_plane(centre, centre2, *plane) > CENTRES {
        return None;
    }
    Some(Arc {
        from: *from,
        to: *to2,
        centre: *centre,
        radius: *radius,
        off: r2 + off2 - radius,
        plane: *plane,
        sweep: sweep + more,
        feed: *feed,
        mode: *mode,
    })
}

/// How far two places lie apart in the plane of an arc: its centre says nothing of the third axis.
fn apart_in_plane(
    a: &crate::control::trace::Position,
    b: &crate::control::trace::Position,
    plane: crate::control::trace::Plane,
) -> f64 {
    use crate::control::trace::Plane::{Xy, Yz, Zx};
    let axes = match plane {
        Xy => [0, 1],
        Zx => [2, 0],
        Yz => [1, 2],
    };
    axes.into_iter().map(|axis| (a.0[axis] - b.0[axis]).abs()).fold(0.0, f64::max)
}
