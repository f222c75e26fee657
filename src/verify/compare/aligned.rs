//! Which acts of two runs belong together, whatever they differ by.
//!
//! First by kind and place, then, among what is left between those, by kind and way, then by kind alone. It says where two
//! runs meet again after something that one of them has more; whether a pair is the same is not decided here.

use super::observe::Act;
use super::paths::leaves;
use crate::control::scenario::Axes;
use crate::control::trace::{EventKind, Position};
use similar::{Algorithm, DiffOp, capture_diff_slices};
use std::hash::Hash;
use std::mem::discriminant;

/// What is looked at of an act: more, and then less.
type Key = (std::mem::Discriminant<EventKind>, Vec<i64>, String);

/// The places of the pairs, in order, each place once.
pub fn aligned(ours: &[Act<'_>], theirs: &[Act<'_>], allowed: f64) -> Vec<(usize, usize)> {
    // A few times what counts as the same, so that few such pairs fall on two sides of an edge.
    let grid = (4.0 * allowed).max(1e-3);
    let mut pairs = Vec::new();
    let by_place = keys(ours, theirs, |act| key(act, grid, false));
    gaps(&by_place, &mut pairs, (0, 0), &mut |i, j, pairs| {
        let by_way = keys(&ours[i.clone()], &theirs[j.clone()], |act| key(act, grid, true));
        gaps(&by_way, pairs, (i.start, j.start), &mut |i, j, pairs| {
            let kind = |act: &Act<'_>| discriminant(&*act.what);
            let by_kind = keys(&ours[i.clone()], &theirs[j.clone()], kind);
            gaps(&by_kind, pairs, (i.start, j.start), &mut |_, _, _| {});
        });
    });
    pairs
}

fn keys<'a, 'r, K>(ours: &[Act<'r>], theirs: &[Act<'r>], key: impl Fn(&Act<'r>) -> K + 'a) -> [Vec<K>; 2] {
    [ours.iter().map(&key).collect(), theirs.iter().map(&key).collect()]
}

/// Adds the pairs of equal keys, and calls somebody with what lies between them on both sides.
fn gaps<K: Eq + Hash>(
    [ours, theirs]: &[Vec<K>; 2],
    pairs: &mut Vec<(usize, usize)>,
    (from, from_there): (usize, usize),
    between: &mut dyn FnMut(std::ops::Range<usize>, std::ops::Range<usize>, &mut Vec<(usize, usize)>),
) {
    for op in capture_diff_slices(Algorithm::Myers, ours, theirs) {
        match op {
            DiffOp::Equal { old_index, new_index, len } => {
                pairs.extend((0..len).map(|at| (from + old_index + at, from_there + new_index + at)));
            }
            DiffOp::Replace { old_index, old_len, new_index, new_len } => {
                let (i, j) = (from + old_index, from_there + new_index);
                between(i..i + old_len, j..j + new_len, pairs);
            }
            DiffOp::Delete { .. } | DiffOp::Insert { .. } => {}
        }
    }
}

/// The kind of an act with the place that it leaves the tool at, or with the way that it goes to it; of what moves
/// nothing, all that is told of it.
fn key(act: &Act<'_>, grid: f64, by_way: bool) -> Key {
    let on_grid = |place: &Axes| place.iter().map(|value| (value / grid).round() as i64).collect();
    let what: &EventKind = &act.what;
    let kind = discriminant(what);
    match (leaves(what), from(what)) {
        (Some(to), Some(from)) if by_way => {
            let way: Axes = std::array::from_fn(|axis| to.0[axis] - from.0[axis]);
            (kind, on_grid(&way), String::new())
        }
        (Some(to), _) => (kind, on_grid(&to.0), String::new()),
        _ => (kind, Vec::new(), format!("{what:?}")),
    }
}

/// Where a move begins.
pub fn from(what: &EventKind) -> Option<Position> {
    match what {
        EventKind::Rapid { from, .. }
        | EventKind::Feed { from, .. }
        | EventKind::Arc { from, .. }
        | EventKind::Thread { from, .. }
        | EventKind::Probe { from, .. } => Some(*from),
        _ => None,
    }
}
