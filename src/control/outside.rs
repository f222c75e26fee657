//! Programs that stand in both machines and are no part of the library.
//!
//! What such a program does nobody knows; that both do the same with the same arguments and variables the target's profile
//! says. So a run only tells that it was called, with what, and in which state of the machine: two runs that differ in none
//! of it find the same after it. What that is, is drawn: the same on both sides.

use super::machine::ExitState;
use super::scenario::{AXES, Axes};
use crate::dialect::Standing;
use crate::syntax::ProgramName;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// The programs that stand in both machines, as one of the two sees them.
#[derive(Clone, Debug, Default)]
pub struct Outside {
    standing: Standing,
    /// True for the machine that programs are converted for: its numbers may be others.
    is_target: bool,
    /// Numbers on the source of programs that the library has: those are no part of it.
    library: BTreeSet<u32>,
    /// Common variables that both know, by their numbers on the source and on the target.
    common: Vec<(u32, u32)>,
    /// Locals that both know by one number.
    locals: Vec<usize>,
}

impl Outside {
    /// The programs that the target's profile names, but those of the library, as the source sees them.
    pub fn new(
        standing: &Standing,
        library: BTreeSet<u32>,
        common: Vec<(u32, u32)>,
        locals: Vec<usize>,
    ) -> Self {
        Self { standing: standing.clone(), is_target: false, library, common, locals }
    }

    /// The same as the target sees them.
    #[must_use]
    pub fn of_target(&self) -> Self {
        Self { is_target: true, ..self.clone() }
    }

    /// The number on the source of the program that a call names here; none if none such stands here.
    pub fn source_of(&self, number: u32) -> Option<u32> {
        let found = match self.is_target {
            true => self.standing.source_of(number),
            false => self.standing.number_of(number).map(|_| number),
        };
        found.filter(|source| !self.library.contains(source))
    }

    /// True if none stands in them.
    pub fn is_empty(&self) -> bool {
        self.standing.is_empty()
    }

    /// Common variables that both know: the number on the source, and the one here.
    pub fn common(&self) -> impl Iterator<Item = (u32, u32)> + '_ {
        self.common.iter().map(|(source, target)| (*source, if self.is_target { *target } else { *source }))
    }

    /// Locals that both know by one number.
    pub fn locals(&self) -> &[usize] {
        &self.locals
    }
}

/// A call of such a program.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OutsideCall {
    /// Its number on the source.
    #[serde(rename = "called")]
    pub program: u32,
    /// How often it runs.
    #[serde(skip_serializing_if = "is_once")]
    pub runs: u32,
    /// The locals that it finds.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub locals: BTreeMap<u32, f64>,
    /// The common variables that it finds.
    #[serde(skip)]
    pub common: BTreeMap<u32, f64>,
    /// What is in force on the machine.
    #[serde(skip)]
    pub state: ExitState,
}

impl OutsideCall {
    /// The name that the called program has on the source.
    pub fn name(&self) -> String {
        ProgramName::Number(self.program).short().into_owned()
    }
}

fn is_once(runs: &u32) -> bool {
    *runs == 1
}

/// What is there after a call, as it is drawn: by a seed, the number of the call in its run, and what it is of.
#[derive(Clone, Copy, Debug)]
pub struct Drawn(u64);

/// What is drawn besides variables, by numbers that no variable has.
const PLACE: u64 = 1 << 40;
const STATE: u64 = 1 << 41;

impl Drawn {
    /// Of a call; none if the seed is 0: then all is as before.
    pub fn new(seed: u64, call: u64) -> Option<Self> {
        (seed != 0).then(|| Self(mixed(seed ^ mixed(call))))
    }

    /// A variable; vacant now and then.
    pub fn variable(self, number: u32) -> Option<f64> {
        let drawn = mixed(self.0 ^ u64::from(number));
        // Below a thousand.
        let part = ((drawn >> 8) % 1000) as f64;
        match drawn % 8 {
            0 => None,
            1 => Some(0.0),
            2 => Some(1.0),
            3 | 4 => Some(part % 13.0 - 2.0),
            _ => Some((part - 500.0) / 8.0),
        }
    }

    /// How far the machine was moved, millimetres: in X, Y and Z, or not at all.
    pub fn shift(self) -> Axes {
        let mut shift = [0.0; AXES];
        for (axis, shift) in shift.iter_mut().enumerate().take(3) {
            let drawn = mixed(self.0 ^ PLACE ^ axis as u64);
            // Few steps of a quarter.
            *shift = if self.0.is_multiple_of(4) { 0.0 } else { ((drawn % 81) as f64 - 40.0) / 4.0 };
        }
        shift
    }

    /// One of so many ways that something else may be left in.
    pub fn one_of(self, what: u64, ways: u64) -> u64 {
        mixed(self.0 ^ STATE ^ what) % ways.max(1)
    }
}

/// Numbers that look drawn (splitmix64).
fn mixed(number: u64) -> u64 {
    let number = number.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let number = (number ^ (number >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let number = (number ^ (number >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    number ^ (number >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_drawn_is_the_same_for_one_seed_and_call_and_nothing_for_none() {
        assert!(Drawn::new(0, 3).is_none());
        let all =
            |seed, call| (100..200).map(|n| Drawn::new(seed, call).unwrap().variable(n)).collect::<Vec<_>>();
        assert_eq!(all(7, 1), all(7, 1));
        assert_ne!(all(7, 1), all(7, 2));
        assert_ne!(all(7, 1), all(8, 1));
        assert!(all(7, 1).contains(&None) && all(7, 1).contains(&Some(0.0)));
    }
}
