//! Spindle and coolant beside a rapid move or a wait, where no source says which comes first.
//!
//! Nobody could tell in the work: nothing is cut. So such a change may stand before the move of its block or after it.

use super::kinds::runs;
use crate::canon::Running;
use crate::control::Run;
use crate::control::trace::{Event, EventKind, Place, Told};

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

    /// The block of the first change that may stand elsewhere, from where a block ran first.
    fn loose_from(&self, block: Place) -> Option<Place> {
        let from = self.0.iter().position(|event| event.at == block)?;
        self.0[from..].iter().find(|event| event.told == Told::Loose).map(|event| event.at)
    }

    /// Puts the changes of some kinds that may stand elsewhere in their other place, wherever their block ran. False if
    /// a kind has none there.
    fn turn(&mut self, block: Place, kinds: &[Running]) -> bool {
        let mut found = [false; 2];
        let all = self.0.chunk_by_mut(|a, b| a.at == b.at);
        for run in all.filter(|run| run.first().is_some_and(|event| event.at == block)) {
            let loose = |event: &&Event| {
                event.told == Told::Loose && runs(&event.what).is_some_and(|kind| kinds.contains(&kind))
            };
            let idle =
                |event: &&Event| matches!(event.what, EventKind::Rapid { .. } | EventKind::Dwell { .. });
            let (Some(first), Some(last)) = (run.iter().position(idle), run.iter().rposition(idle)) else {
                continue;
            };
            // The end of a program may stand in its last block, after all of that.
            let (moves, behind) = run.split_at(last + 1);
            let (before, moves) = moves.split_at(first);
            let (after, kept): (Vec<&Event>, Vec<_>) = before.iter().copied().partition(loose);
            let (ahead, rest): (Vec<&Event>, Vec<_>) = behind.iter().copied().partition(loose);
            let turned = after.iter().chain(&ahead).filter_map(|event| runs(&event.what));
            turned.for_each(|kind| found[kind as usize] = true);
            let turned = [&kept, &ahead, moves, &after, &rest].map(<[_]>::to_vec).concat();
            run.copy_from_slice(&turned);
        }
        kinds.iter().all(|kind| found[*kind as usize])
    }
}

/// What may be turned of one side at once.
const KINDS: [&[Running]; 4] =
    [&[], &[Running::Spindle], &[Running::Coolant], &[Running::Spindle, Running::Coolant]];

/// Blocks that are looked at, at the most.
const TURNS: usize = 40;

/// How far two runs go together in one order of their events.
pub struct Found<T> {
    /// What was found.
    pub what: T,
    /// How many acts were paired; none if nothing differs.
    pub pairs: Option<usize>,
    /// The blocks of the first difference, of both sides.
    pub blocks: [Option<Place>; 2],
}

/// Compares two runs; where they differ at or before a block with a change that may stand elsewhere, on one side or on
/// both, it is looked for there, and left there if the runs then go farther together. A block may be looked at again: what
/// was turned first is not what was to be turned.
pub fn farthest<'r, T>(runs: [&'r Run; 2], mut compare: impl FnMut(&[Order<'r>; 2]) -> Found<T>) -> T {
    let mut orders = runs.map(Order::of);
    let mut best = compare(&orders);
    for _ in 0..TURNS {
        let Some(pairs) = best.pairs else { break };
        let ways = KINDS.into_iter().flat_map(|ours| KINDS.map(|theirs| [ours, theirs]));
        let farther = ways.filter(|ways| !ways.concat().is_empty()).find_map(|ways| {
            let mut other = orders.clone();
            for (side, kinds) in ways.into_iter().enumerate().filter(|(_, kinds)| !kinds.is_empty()) {
                // What a block leaves waiting may meet what the next one turns.
                let next = other[side].loose_from(best.blocks[side]?)?;
                if !other[side].turn(next, kinds) {
                    return None;
                }
            }
            let found = compare(&other);
            found.pairs.is_none_or(|farther| farther > pairs).then_some((found, other))
        });
        let Some(farther) = farther else { break };
        (best, orders) = farther;
    }
    best.what
}
