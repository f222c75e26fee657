//! Which acts of two runs belong together, whatever they differ by.
//!
//! First by kind and place; what is left between those by the text of the block, then by the way that a move goes, then by
//! kind alone. So two runs meet again after something that only one of them does. Whether a pair is the same is not decided
//! here.

use super::kinds::setting;
use super::observe::Act;
use super::paths::leaves;
use crate::control::scenario::Axes;
use crate::control::trace::{EventKind, Position};
use similar::{Algorithm, DiffOp, capture_diff_slices};
use std::mem::discriminant;
use std::ops::Range;

/// What is looked at of an act: more, and then less.
type Key = (std::mem::Discriminant<EventKind>, Vec<i64>, String);

/// Says what is looked at of the act at a place.
type KeyOf<'k> = dyn Fn(&Blocks<'_, '_>, usize) -> Key + 'k;

/// The acts of a side, with the text of the block of each.
pub struct Blocks<'t, 'r> {
    /// The acts.
    pub acts: &'t [Act<'r>],
    /// The texts.
    pub blocks: Vec<String>,
}

/// The places of the pairs, in order, each place once.
pub fn aligned(ours: &Blocks<'_, '_>, theirs: &Blocks<'_, '_>, allowed: f64) -> Vec<(usize, usize)> {
    // A few times what counts as the same, so that few such pairs fall on two sides of an edge.
    let grid = (4.0 * allowed).max(1e-3);
    let by_place = |told: &Blocks<'_, '_>, at: usize| key(&told.acts[at], grid, false);
    let by_text = |told: &Blocks<'_, '_>, at: usize| {
        (discriminant(&*told.acts[at].what), Vec::new(), told.blocks[at].clone())
    };
    let by_way = |told: &Blocks<'_, '_>, at: usize| key(&told.acts[at], grid, true);
    let by_kind =
        |told: &Blocks<'_, '_>, at: usize| (discriminant(&*told.acts[at].what), Vec::new(), String::new());
    let all: [&KeyOf<'_>; 4] = [&by_place, &by_text, &by_way, &by_kind];
    // Settings go with what they stand before, so they are looked at last: they would tear moves apart.
    let acting = |told: &Blocks<'_, '_>| {
        let all = told.acts.iter().enumerate().filter(|(_, act)| setting(&act.what).is_none());
        let (places, keys): (Vec<usize>, Vec<Key>) = all.map(|(at, _)| (at, by_place(told, at))).unzip();
        (places, keys)
    };
    let ((here, old), (there, new)) = (acting(ours), acting(theirs));
    let mut met = Vec::new();
    for op in capture_diff_slices(Algorithm::Myers, &old, &new) {
        if let DiffOp::Equal { old_index, new_index, len } = op {
            met.extend((0..len).map(|at| (here[old_index + at], there[new_index + at])));
        }
    }
    let (mut pairs, mut from) = (Vec::new(), (0, 0));
    for (i, j) in
        met.into_iter().map(Some).chain([None]).map(|met| met.unwrap_or((ours.acts.len(), theirs.acts.len())))
    {
        pair([ours, theirs], [from.0..i, from.1..j], &all, &mut pairs);
        if i < ours.acts.len() && j < theirs.acts.len() {
            pairs.push((i, j));
        }
        from = (i + 1, j + 1);
    }
    pairs
}

/// Pairs what has the same key of the first kind, and what lies between by the kinds after it.
fn pair(
    [ours, theirs]: [&Blocks<'_, '_>; 2],
    [here, there]: [Range<usize>; 2],
    keys: &[&KeyOf<'_>],
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
