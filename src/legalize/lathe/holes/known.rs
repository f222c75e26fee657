//! What is known where a block drills.

use crate::canon::Op;
use crate::ir::Expr;

/// What turns, and how the feed counts, where a block drills.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Turning {
    /// The last speed, if that is a known number.
    pub speed: Option<f64>,
    /// True where a block before gives the speed, as a number or as what a variable holds.
    pub is_said: bool,
    /// True where F is a feed a turn.
    pub by_turn: bool,
    /// True where the spindle is known to stand, or nothing of the library ever turns it.
    pub stands: bool,
    /// True where a code before it made the tap rigid: which way it turns is the control's, and no code's before it.
    pub rigid: bool,
}

/// What is known of the cycle in force.
#[derive(Clone, Debug, Default)]
pub(super) struct Cycle {
    /// Where it began along its axis, a coordinate of the program.
    pub initial: Option<f64>,
    /// Its retract plane, a coordinate too.
    pub plane: Option<f64>,
    /// Its bottom, where it is a place.
    pub bottom: Option<Expr>,
    /// The wait that it was told.
    pub dwell: Option<Expr>,
    /// The peck that it was told.
    pub peck: Option<Expr>,
    /// Whether a hole of it has had a peck; none if that is not known.
    pub pecked: Option<bool>,
    /// The code that the target has in force.
    pub written: Option<Op>,
    /// True where the coordinates changed since it began.
    pub shifted: bool,
    /// True where a move after its last hole ended it on the target.
    pub is_ended: bool,
}
