//! What is in force on a machine when a program starts, where that is not what power-on leaves.
//!
//! The machine was used before: another program, or a person, selected an offset, left a feed, started the spindle.
//! A program that says all it needs does the same whatever it finds. Modes and the unit stand in the
//! [`super::Scenario`] itself.

use super::scenario::Axes;
use crate::canon::Op;
use serde::{Deserialize, Serialize};

/// What was left in force. What is none is as after power-on.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Entry {
    /// The selected work offset, by common number; 0 for none, or for the first where the control cannot cancel them.
    pub work: Option<u32>,
    /// The offset of the tool length that is added.
    pub length: Option<u32>,
    /// True if it is subtracted.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub length_minus: bool,
    /// True if a return to the reference position may have cancelled it.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub length_lost: bool,
    /// True if a move in machine coordinates may have cancelled it.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub length_moved: bool,
    /// True if a tool change may have cancelled it.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub length_changed: bool,
    /// True if none went along its axis.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub length_across: bool,
    /// The offset of the cutter radius that is compensated to the left.
    pub cutter: Option<u32>,
    /// True if it is compensated to the right.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub cutter_right: bool,
    /// The feed, millimetres a minute or a turn.
    pub feed: Option<f64>,
    /// Turns a minute of the spindle, which runs counter-clockwise.
    pub spindle: Option<f64>,
    /// True if it runs clockwise.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub clockwise: bool,
    /// True where coolant is on.
    pub coolant: bool,
    /// The coolant that is on, where that is not flood.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub coolant_kind: Option<Op>,
    /// A drilling cycle in force.
    pub cycle: Option<Drilling>,
    /// The shift of coordinates by the local-shift code, millimetres.
    pub local: Option<Axes>,
    /// The rotation of X and Y about the origin, degrees.
    pub rotation: Option<f64>,
    /// The scale of X, Y and Z about the origin.
    pub scale: Option<f64>,
    /// True where X is mirrored about the origin.
    pub mirror: bool,
}

impl Entry {
    /// Keeps what another state has too.
    pub fn keep_common(&mut self, other: &Self) {
        if (self.length, self.length_minus) != (other.length, other.length_minus) {
            (self.length, self.length_minus) = (None, false);
        }
        let lost =
            |entry: &Self| [entry.length_lost, entry.length_moved, entry.length_changed, entry.length_across];
        if self.length.is_none() || lost(self) != lost(other) {
            (self.length_lost, self.length_moved) = (false, false);
            (self.length_changed, self.length_across) = (false, false);
        }
        if (self.cutter, self.cutter_right) != (other.cutter, other.cutter_right) {
            (self.cutter, self.cutter_right) = (None, false);
        }
        if (self.spindle, self.clockwise) != (other.spindle, other.clockwise) {
            (self.spindle, self.clockwise) = (None, false);
        }
        if (self.coolant, self.coolant_kind) != (other.coolant, other.coolant_kind) {
            (self.coolant, self.coolant_kind) = (false, None);
        }
        // Cycles differ from call to call: that there is one is what they have in common.
        self.cycle = self.cycle.filter(|_| other.cycle.is_some());
        self.work = self.work.filter(|_| self.work == other.work);
        self.feed = self.feed.filter(|_| self.feed == other.feed);
    }
}

/// A drilling cycle that an earlier program left in force: program coordinates along Z, millimetres.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Drilling {
    /// Its retract plane.
    pub retract: f64,
    /// Its bottom.
    pub bottom: f64,
}
