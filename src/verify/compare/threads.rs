//! Passes of a thread over the way of the one before.
//!
//! Such a pass takes nothing off. Between the two the tool goes out along X, and along Z beside the part to where it began. Whether it goes in again along
//! both axes at once, or along Z first, no source says of a cycle of many passes (docs/lathe.md P8), and where a conversion writes such passes by single ones
//! it is Z first. So of that way only its first move counts, and moves along Z that follow one another are one. A thread that runs out may be written by
//! single ones from its first pass on: of each of its passes it counts where it begins, and not whether the tool goes there along both axes at once.

use super::observe::{Act, What};
use super::paths::apart;
use crate::control::trace::{EventKind, Position};

/// How far the ways of two passes may lie apart to be one, millimetres.
const NEAR: f64 = 1e-3;

/// The places of X and Z in a position.
const X: usize = 0;
const Z: usize = 2;

/// Leaves out, on both sides, how the tool comes from one such pass to the next.
pub fn passes<'a>(ours: Vec<Act<'a>>, theirs: Vec<Act<'a>>) -> [Vec<Act<'a>>; 2] {
    let open = is_open(&ours, &theirs);
    [again(ours, open), again(theirs, open)]
}

/// True where of some thread only one side knows whether it runs out: then it may run out on the other too.
fn is_open(ours: &[Act<'_>], theirs: &[Act<'_>]) -> bool {
    fn known<'a>(acts: &'a [Act<'_>]) -> impl Iterator<Item = bool> + 'a {
        acts.iter().filter_map(|act| match &*act.what {
            EventKind::Thread { chamfer, .. } => Some(chamfer.is_some()),
            _ => None,
        })
    }
    known(ours).zip(known(theirs)).any(|(here, there)| here != there)
}

/// Leaves out how the tool comes from one such pass to the next; `open` where threads may run out on one of the two sides.
fn again(acts: Vec<Act<'_>>, open: bool) -> Vec<Act<'_>> {
    let mut out: Vec<Act<'_>> = Vec::with_capacity(acts.len());
    // The last pass, and the place after it.
    let mut last: Option<(Position, Position, usize)> = None;
    for act in acts {
        match (&*act.what, last) {
            (EventKind::Thread { from, to, chamfer, .. }, before) => {
                let (from, to) = (*from, *to);
                let runs_out = open || chamfer.is_some_and(|length| length > 0.0);
                let way = before
                    .filter(|(_, end, after)| beside(out.get(*after..).unwrap_or_default(), *end, from));
                let same = |(start, end, _)| apart(&start, &from).max(apart(&end, &to)) <= NEAR;
                match way {
                    Some(before) if same(before) => out.truncate(before.2 + 1),
                    Some((.., after)) if runs_out => at_once(&mut out, after + 1, from),
                    _ if runs_out && goes_in(&out, from) => {
                        let first = out.len() - 2;
                        at_once(&mut out, first, from);
                    }
                    _ => {}
                }
                out.push(act);
                last = Some((from, to, out.len()));
            }
            (EventKind::Rapid { from, to }, Some((.., after))) if out.len() > after => {
                match out.last_mut().and_then(|before| Some((along_z(&before.what, (from, to))?, before))) {
                    Some((whole, before)) => before.what = What::other(whole),
                    None => out.push(act),
                }
            }
            (EventKind::Rapid { .. }, _) => out.push(act),
            _ => {
                last = None;
                out.push(act);
            }
        }
    }
    out
}

/// Makes one move of the rapid moves from an act on, to where a pass begins.
fn at_once(out: &mut Vec<Act<'_>>, first: usize, start: Position) {
    let Some(EventKind::Rapid { from, .. }) = out.get(first).map(|act| &*act.what) else { return };
    let whole = EventKind::Rapid { from: *from, to: start };
    // Each of them is off by what its own words are rounded to.
    let rounded = out.iter().skip(first).map(|act| act.rounded).sum();
    out.truncate(first + 1);
    if let Some(act) = out.last_mut() {
        act.rounded = rounded;
        act.what = What::other(whole);
    }
}

/// True where the tool comes to the start of a pass along Z, and then along X.
fn goes_in(out: &[Act<'_>], start: Position) -> bool {
    let [.., before, last] = out else { return false };
    match (&*before.what, &*last.what) {
        (EventKind::Rapid { from, to: corner }, EventKind::Rapid { from: there, to }) => {
            let along = |a: &Position, b: &Position, axis: usize| moves_along(a, b) == Some(axis);
            // A way along Z may be hardly any.
            moves_along(from, corner).is_none_or(|along| along == Z)
                && along(there, to, X)
                && apart(corner, there).max(apart(to, &start)) <= NEAR
        }
        _ => false,
    }
}

/// True for moves out along X from the end of a pass, along Z, and in to the start of the next one.
fn beside(moves: &[Act<'_>], end: Position, start: Position) -> bool {
    let ways = moves.iter().map(|act| match &*act.what {
        EventKind::Rapid { from, to } => Some((*from, *to)),
        _ => None,
    });
    let Some(ways) = ways.collect::<Option<Vec<_>>>() else { return false };
    let [(from, out), between @ .., (_, to)] = ways.as_slice() else { return false };
    let only = |axis: usize, a: &Position, b: &Position| moves_along(a, b).is_none_or(|along| along == axis);
    let goes_out = apart(from, &end) <= NEAR && only(X, from, out);
    goes_out && between.iter().all(|(a, b)| only(Z, a, b)) && apart(to, &start) <= NEAR
}

/// The one move along Z that two in one direction are.
fn along_z(before: &EventKind, (from, to): (&Position, &Position)) -> Option<EventKind> {
    let EventKind::Rapid { from: first, to: there } = before else { return None };
    let along = |a: &Position, b: &Position| moves_along(a, b) == Some(Z);
    let goes_on = (there.0[Z] - first.0[Z]) * (to.0[Z] - from.0[Z]) > 0.0;
    let one = apart(there, from) <= NEAR && along(first, there) && along(from, to) && goes_on;
    one.then_some(EventKind::Rapid { from: *first, to: *to })
}

/// The axis that a move goes along, if that is one.
fn moves_along(from: &Position, to: &Position) -> Option<usize> {
    let mut axes = (0..from.0.len()).filter(|axis| (from.0[*axis] - to.0[*axis]).abs() > NEAR);
    let axis = axes.next();
    if axes.next().is_some() { Some(usize::MAX) } else { axis }
}
