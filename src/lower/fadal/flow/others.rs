//! What is known of the other programs of a file.

use super::state::{Motion, Sets};
use crate::canon::Role;
use crate::lower::fadal::codes::{Codes, operand, program_number};
use crate::syntax::Item;
use std::collections::BTreeMap;

/// What is known of the programs of a file.
#[derive(Debug, Default)]
pub struct Others {
    /// By number, the motion modes that a program leaves. Not of one that calls itself in the end, that returns
    /// to another place than that of its call, or whose number stands twice.
    motion: BTreeMap<u32, Motion>,
    /// What the programs before each set, and those after it.
    sets: Vec<Sets>,
}

impl Others {
    /// Programs of which is known what the others of each set.
    pub fn that_set(sets: Vec<Sets>) -> Self {
        Self { motion: BTreeMap::new(), sets }
    }

    /// Notes what a program leaves.
    pub fn leaves(&mut self, number: u32, motion: Motion) {
        self.motion.insert(number, motion);
    }

    /// What the programs but this one set.
    pub fn sets(&self, own: usize) -> &Sets {
        const NONE: &Sets = &Sets::NONE;
        self.sets.get(own).unwrap_or(NONE)
    }

    /// The motion modes that the program of a call leaves, where they are known.
    pub fn motion(&self, items: &[Item], codes: &Codes<'_, '_>) -> Option<&Motion> {
        self.motion.get(&operand(items, codes, Role::Program).and_then(program_number)?)
    }
}
