//! Spindle and coolant beside a rapid move or a wait, where no source says which comes first.
//!
//! Nobody could tell in the work: nothing is cut. So such a change may stand before the move of its block or behind it.

use crate::control::Run;
use crate::control::trace::{Event, Happening, Place, Told};
use std::collections::BTreeSet;

/// The order in which the events of a run are looked at.
#[derive(Clone, Debug)]
pub struct Order<'r>(Vec<&'r Event>);

impl<'r> Order<'r> {
    /// The order in which they came.
    pub fn of(run: &'r Run) -> Self {
        Self(run.events.iter().collect())
    }

    /// The events.
    pub fn events(&self) -> &[&'r Event] {
        &self.0
    }

    /// Puts the changes of a block that may stand elsewhere in their other place, wherever it ran. False where it has
    /// none.
    fn turn(&mut self, block: Place) -> bool {
        let mut found = false;
        for run in self
            .0
            .chunk_by_mut(|a, b| a.at == b.at)
            .filter(|run| run.first().is_some_and(|event| event.at == block))
        {
            let loose = |event: &&Event| event.told == Told::Loose;
            let idle =
                |event: &&Event| matches!(event.what, Happening::Rapid { .. } | Happening::Dwell { .. });
            let (Some(first), Some(last)) = (run.iter().position(idle), run.iter().rposition(idle)) else {
                continue;
            };
            // The end of a program may stand in its last block, behind all of that.
            let (moves, behind) = run.split_at(last + 1);
            let (before, moves) = moves.split_at(first);
            let (after, kept): (Vec<&Event>, Vec<_>) = before.iter().copied().partition(loose);
            let (ahead, rest): (Vec<&Event>, Vec<_>) = behind.iter().copied().partition(loose);
            found |= after.len() + ahead.len() > 0;
            let turned: Vec<&Event> = [&kept, &ahead, moves, &after, &rest].map(<[_]>::to_vec).concat();
            run.copy_from_slice(&turned);
        }
        found
    }
}

/// Blocks that are looked at, at the most.
const TURNS: usize = 40;

/// How far two runs go together in one order of their events.
pub struct Found<T> {
    /// What was found.
    pub what: T,
    /// How many acts were paired; none where nothing differs.
    pub pairs: Option<usize>,
    /// The blocks of the first difference, of both sides.
    pub blocks: [Option<Place>; 2],
}

/// Compares two runs; where they differ at a block with a change that may stand elsewhere, on one side or on both, it is
/// looked for there, and left there if the runs then go farther together.
pub fn farthest<'r, T>(runs: [&'r Run; 2], mut compare: impl FnMut(&[Order<'r>; 2]) -> Found<T>) -> T {
    let mut orders = runs.map(Order::of);
    let mut best = compare(&orders);
    let mut tried = BTreeSet::new();
    for _ in 0..TURNS {
        let Some(pairs) = best.pairs.filter(|_| tried.insert(best.blocks)) else { break };
        let farther = [&[0][..], &[1], &[0, 1]].into_iter().find_map(|sides| {
            let mut other = orders.clone();
            let mut turn = |side: usize| best.blocks[side].is_some_and(|block| other[side].turn(block));
            if !sides.iter().all(|side| turn(*side)) {
                return None;
            }
            let found = compare(&other);
            found.pairs.is_none_or(|farther| farther > pairs).then_some((found, other))
        });
        let Some(farther) = farther else { break };
        (best, orders) = farther;
    }
    best.what
}
