//! What is in force at a place of a program's text.

use crate::ir::analysis::dataflow::{Lattice, OneOf};

/// What may be in force of a modal group, or of a setting, as the ways to a place have it.
#[derive(Clone, Debug, PartialEq)]
pub struct InForce<T> {
    /// What the program may have set it to.
    pub set: OneOf<T>,
    /// True where it may be what the program was entered with.
    pub entry: bool,
    /// True where a program was called since it was set.
    pub called: bool,
}

impl<T> Default for InForce<T> {
    fn default() -> Self {
        Self { set: OneOf::NONE, entry: false, called: false }
    }
}

impl<T> InForce<T> {
    /// This, set by the program itself.
    pub fn one(value: T) -> Self {
        Self { set: OneOf::one(value), entry: false, called: false }
    }

    /// Whatever the program was entered with.
    pub fn entry() -> Self {
        Self { entry: true, ..Self::default() }
    }

    /// True where another program may have set it.
    pub fn is_from_outside(&self) -> bool {
        self.entry || self.called
    }
}

impl<T: Copy + Ord> Lattice for InForce<T> {
    fn join(&mut self, other: &Self) -> bool {
        let set = self.set.join(&other.set);
        let entry = self.entry.join(&other.entry);
        self.called.join(&other.called) || entry || set
    }
}
