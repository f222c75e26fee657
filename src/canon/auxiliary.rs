//! What a block does beside moving, by when it may act.

use super::Op;

/// Kinds of operations that a control does with the start of their block's move, or when the move is done.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Auxiliary {
    /// A change of the tool.
    Change,
    /// A new spindle speed that no code beside it starts the spindle with.
    Speed,
    /// Turns the spindle clockwise.
    Forward,
    /// Turns the spindle the other way, or switches coolant on.
    Start,
    /// Any other M code.
    Other,
    /// Stops the spindle, turns it into position, or switches coolant off.
    Stop,
}

impl Auxiliary {
    /// All of them, in the order in which those of one block act where nothing moves.
    pub const ALL: [Self; 6] =
        [Self::Change, Self::Speed, Self::Forward, Self::Start, Self::Other, Self::Stop];

    /// True for what waits for the move where nothing else is known: what stops or changes something.
    pub const fn waits(self) -> bool {
        matches!(self, Self::Change | Self::Other | Self::Stop)
    }
}

impl Op {
    /// What kind of operation beside a move it is; none if it moves something itself, or is a mode.
    pub const fn auxiliary(self) -> Option<Auxiliary> {
        use Op::*;
        Some(match self {
            ToolChange => Auxiliary::Change,
            SpindleCw => Auxiliary::Forward,
            SpindleCcw | Mist | Flood | ThroughSpindle => Auxiliary::Start,
            SpindleStop | SpindleOrient | CoolantOff | ThroughSpindleOff => Auxiliary::Stop,
            OverrideOn | OverrideOff | ProbeOn | ToolProbeOn | OutputOn | OutputOff | Act => Auxiliary::Other,
            FourthBrakeOn | FourthBrakeOff | FifthBrakeOn | FifthBrakeOff => Auxiliary::Other,
            _ => return None,
        })
    }
}
