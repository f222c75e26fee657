//! What is in force on a machine when a program starts, where that is not what power-on leaves.
//!
//! The machine was used before: another program, or a person, selected an offset, left a feed, started the spindle.
//! A program that says all it needs does the same whatever it finds. Modes and the unit stand in the
//! [`super::Scenario`] itself.

use super::scenario::Axes;
use serde::{Deserialize, Serialize};

/// What was left in force. What is none is as after power-on.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Entry {
    /// The selected work offset, by common number; 0 for none, or for the first where the control cannot cancel them.
    pub work: Option<u32>,
    /// The offset of the tool length that is added.
    pub length: Option<u32>,
    /// True if a return to the reference position may have cancelled it.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub length_lost: bool,
    /// The offset of the cutter radius that is compensated to the left.
    pub cutter: Option<u32>,
    /// The feed, millimetres a minute or a turn.
    pub feed: Option<f64>,
    /// Turns a minute of the spindle, which runs counter-clockwise.
    pub spindle: Option<f64>,
    /// True where flood coolant is on.
    pub coolant: bool,
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

/// A drilling cycle that an earlier program left in force: program coordinates along Z, millimetres.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Drilling {
    /// Its retract plane.
    pub retract: f64,
    /// Its bottom.
    pub bottom: f64,
}
