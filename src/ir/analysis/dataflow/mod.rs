//! The one solver that analyses share.
//!
//! An analysis is a [`Lattice`] of what may be known at a place, and a rule for what a block makes of it
//! ([`Analysis`]). [`solve`] follows it through the control-flow graph of one program, forwards or backwards, until
//! nothing changes. What goes from caller to callee or back is [`super::CallGraph`]'s. Where routines are entered with the
//! states of their calls, and calls go on with those of the returns, [`Routines`] follows them, over any text that has nodes:
//! lowering follows source text so. All stand on [`Flow`].
//!
//! **Law.** What is found at a place holds on every way that leads there, if a block's rule loses nothing when more
//! is known before it (it is monotone). Then the order of visits does not count either.
//!
//! **Where it ends.** Each join that changes a state goes up in its lattice. A lattice of endless height needs
//! [`Analysis::merge`], which is told how often a state was joined, or a limit ([`solve_within`]).

mod blocks;
mod flow;
mod one_of;
mod routines;

#[cfg(test)]
mod tests;

#[cfg(test)]
pub(crate) use blocks::solve_everywhere_by;
pub use blocks::{Analysis, Cursor, Direction, States, Steps, solve, solve_everywhere, solve_within};
pub use flow::{Flow, Worklist, reached, reached_among};
pub use one_of::OneOf;
pub use routines::Routines;

use std::collections::BTreeSet;

/// What is known at a place.
pub trait Lattice: Clone {
    /// Joins what is known on another way here; true where that changed anything.
    fn join(&mut self, other: &Self) -> bool;
}

/// True on some way.
impl Lattice for bool {
    fn join(&mut self, other: &Self) -> bool {
        let before = *self;
        *self |= other;
        *self != before
    }
}

/// One value on every way; none if there is none, or another one on some way.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Same<T>(pub Option<T>);

impl<T: Copy + PartialEq> Lattice for Same<T> {
    fn join(&mut self, other: &Self) -> bool {
        let before = *self;
        self.0 = self.0.filter(|_| self == other);
        *self != before
    }
}

/// What holds on every way.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Every<T>(pub BTreeSet<T>);

impl<T: Clone + Ord> Lattice for Every<T> {
    fn join(&mut self, other: &Self) -> bool {
        let before = self.0.len();
        self.0.retain(|one| other.0.contains(one));
        self.0.len() != before
    }
}
