//! Which acts of two runs belong together, whatever they differ by.
//!
//! First by kind and place, then, among what is left between those, by the text of the block, then by the way that a move
//! goes, then by kind alone. It says where two
//! runs meet again after something that one of them has more; whether a pair is the same is not decided here.

use super::observe::Act;
use super::paths::leaves;
use crate::control::scenario::Axes;
use crate::control::trace::{EventKind, Position};
use similar::{Algorithm, DiffOp, capture_diff_slices};
use std::mem::discriminant;
use std::ops::Range;

/// What is looked at of an act: more, and then less.
type Key = (std::mem::Discriminant<EventKind>, Vec<i64>, String);

/// The acts of a side, with the text of the block of each.
pub struct Told<'t, 'r> {
    /// The acts.
    pub acts: &'t [Act<'r>],
    /// The texts.
    pub blocks: Vec<String>,
}

/// The places of the pairs, in order, each place once.
pub fn aligned(ours: &Told<'_, '_>, theirs: &Told<'_, '_>, allowed: f64) -> Vec<(usize, usize)> {
    // A few times what counts as the same, so that few such pairs fall on two sides of an edge.
    let grid = (4.0 * allowed).max(1e-3);
    let by_place = |told: &Told<'_, '_>, at: usize| key(&told.acts[at], grid, false);
    let by_text = |told: &Told<'_, '_>, at: usize| {
        (discriminant(&*told.acts[at].what), Vec::new(), told.blocks[at].clone())
    };
    let by_way = |told: &Told<'_, '_>, at: usize| key(&told.acts[at], grid, true);
    let by_kind =
        |told: &Told<'_, '_>, at: usize| (discriminant(&*told.acts[at].what), Vec::new(), String::new());
    let all: [&dyn Fn(&Told<'_, '_>, usize) -> Key; 4] = [&by_place, &by_text, &by_way, &by_kind];
    let mut pairs = Vec::new();
    pair([ours, theirs], [0..ours.acts.len(), 0..theirs.acts.len()], &all, &mut pairs);
    pairs
}

/// Pairs what has the same key of the first kind, and what lies between by the kinds after it.
fn pair(
    [ours, theirs]: [&Told<'_, '_>; 2],
    [here, there]: [Range<usize>; 2],
    keys: &[&dyn Fn(&Told<'_, '_>, usize) -> Key],
    pairs: &mut Vec<(usize, usize)>,
) {
    let Some((key, rest)) = keys.split_first() else { return };
    let (from, from_there) = (here.start, there.start);
    let old: Vec<Key> = here.map(|at| key(ours, at)).collect();
    let new: Vec<Key> = there.map(|at| key(theirs, at)).collect();
    for op in capture_diff_slices(Algorithm::Myers, &old, &new) {
        match op {
            DiffOp::Equal { old_index, new_index, len } => {
                pairs.extend((0..len).map(|at| (from + old_index + at, from_there + new_index + at)));
            }
            DiffOp::Replace { old_index, old_len, new_index, new_len } => {
                let (i, j) = (from + old_index, from_there + new_index);
                pair([ours, theirs], [i..i + old_len, j..j + new_len], rest, pairs);
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
fn from(what: &EventKind) -> Option<Position> {
    match what {
        EventKind::Rapid { from, .. }
        | EventKind::Feed { from, .. }
        | EventKind::Arc { from, .. }
        | EventKind::Thread { from, .. }
        | EventKind::Probe { from, .. } => Some(*from),
        _ => None,
    }
}
