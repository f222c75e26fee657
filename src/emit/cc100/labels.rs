//! Labels: a block that something jumps to or calls has a number of its own after `$`.
//!
//! Jumps and calls share one space of numbers, and no program of the course has one of more than two digits (seed
//! 004:464; facts/cc100-target.md 1). A block keeps the number that it has on the source where there is such a label.

use super::super::common::labels::numbers;
use crate::ir::{Program, TermKind};
use crate::syntax::Label;
use std::collections::BTreeSet;

/// The largest number.
const LAST: u32 = 99;

/// The labels of one program.
#[derive(Debug, Default)]
pub(super) struct Labels {
    /// By block, and one for the end of the text.
    numbers: Vec<Option<u32>>,
    taken: BTreeSet<u32>,
    /// True where there are more than the control has numbers.
    pub short: bool,
}

impl Labels {
    /// Gives a number to each block of `labelled`. What a computed jump looks for keeps its own.
    pub fn new(program: &Program, labelled: &[bool]) -> Self {
        let mut labels = Self { numbers: vec![None; labelled.len()], ..Self::default() };
        for block in &program.blocks {
            let TermKind::Computed { targets, .. } = &block.term.kind else { continue };
            for (number, to) in targets {
                labels.claim(to.index(), *number);
            }
        }
        let needed = || labelled.iter().enumerate().filter(|(_, needed)| **needed).map(|(at, _)| at);
        for at in needed() {
            let Some(block) = program.blocks.get(at) else { continue };
            let named = block.labels.iter().filter_map(of_name);
            let own: Vec<u32> = named.chain(numbers(block)).collect();
            own.into_iter().for_each(|number| labels.claim(at, number));
        }
        for at in needed() {
            if labels.numbers[at].is_none() {
                labels.numbers[at] = labels.free(1..=LAST);
            }
        }
        labels
    }

    fn claim(&mut self, at: usize, number: u32) {
        if (1..=LAST).contains(&number) && self.numbers.get(at) == Some(&None) && self.taken.insert(number) {
            self.numbers[at] = Some(number);
        }
    }

    fn free(&mut self, mut from: impl Iterator<Item = u32>) -> Option<u32> {
        let found = from.find(|number| self.taken.insert(*number));
        self.short |= found.is_none();
        found
    }

    /// The number that a block is found by.
    pub fn of(&self, block: usize) -> Option<u32> {
        self.numbers.get(block).copied().flatten()
    }

    /// A number for a stop after an error: the last ones, as the course has them (seed 004:1568).
    pub fn of_stop(&mut self) -> Option<u32> {
        self.free((1..=LAST).rev())
    }
}

/// The number in a label like `$2`.
fn of_name(label: &Label) -> Option<u32> {
    match label {
        Label::Name(name) => name.strip_prefix('$')?.parse().ok(),
        Label::Number(_) => None,
    }
}
