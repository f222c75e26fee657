//! What a block tells the machine, in common terms.

use crate::canon::{Group, Op, Role};
use smallvec::SmallVec;

/// A block's operations and words, letters resolved: lengths in the units of the program.
///
/// Of a role that stands twice the last word counts. Words that a code fixes (work offset 2
/// of G55) are words like any other. Flow (calls, jumps, returns, the end) is the interpreter's.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Command {
    /// The operations, in the order in which they stand.
    pub ops: SmallVec<[Op; 4]>,
    /// The words.
    pub words: SmallVec<[(Role, f64); 8]>,
    /// The code of an operation that only this control has, for the trace.
    pub own_code: Option<String>,
    /// By how much the control rounded words to their least increment, where it did.
    pub rounded: SmallVec<[(Role, f64); 2]>,
    /// True where the code of the drilling cycle in force takes no dwell.
    pub without_dwell: bool,
    /// The axis words that say how far to go, whatever is in force.
    pub steps: SmallVec<[Role; 3]>,
    /// What is in force from the next block on, places or increments, where the block says so after its words.
    pub distance_after: Option<Op>,
}

impl Command {
    /// Empties it, to be used again.
    pub fn clear(&mut self) {
        self.ops.clear();
        self.words.clear();
        self.own_code = None;
        self.rounded.clear();
        self.without_dwell = false;
        self.steps.clear();
        self.distance_after = None;
    }

    /// True where it says nothing.
    pub fn is_empty(&self) -> bool {
        self.ops.is_empty() && self.words.is_empty()
    }

    /// True where an operation stands in it.
    pub fn has(&self, op: Op) -> bool {
        self.ops.contains(&op)
    }

    /// The last operation of a modal group.
    pub fn of(&self, group: Group) -> Option<Op> {
        self.ops.iter().rev().copied().find(|op| op.group() == group)
    }

    /// The value of a role.
    pub fn word(&self, role: Role) -> Option<f64> {
        self.words.iter().rev().find(|(found, _)| *found == role).map(|(_, value)| *value)
    }

    /// A whole number that is not negative; zero for what is none.
    pub fn number(&self, role: Role) -> Option<u32> {
        // A float outside the range becomes its nearest end.
        self.word(role).map(|value| value.round() as u32)
    }

    /// The axis words by common axis number less one.
    pub fn axes(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.words.iter().filter_map(|(role, value)| Some((axis(*role)?, *value)))
    }

    /// The same, with whether each says how far the axis goes from where it is.
    pub fn places(&self) -> impl Iterator<Item = (usize, f64, bool)> + '_ {
        let steps = |role: &Role| role.is_step() || self.steps.contains(role);
        self.words.iter().filter_map(move |(role, value)| Some((axis(*role)?, *value, steps(role))))
    }

    /// True where an axis word stands in it.
    pub fn has_axes(&self) -> bool {
        self.axes().next().is_some()
    }
}

/// The place of an axis in a position.
pub(super) fn axis(role: Role) -> Option<usize> {
    role.axis_number().map(|number| number as usize - 1)
}

/// True for an axis whose values are degrees.
pub(super) fn is_rotary(axis: usize) -> bool {
    (3..6).contains(&axis)
}
