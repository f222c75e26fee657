//! The kinds of events.

use crate::canon::{Op, Sys};
use crate::control::outcome::Stop;
use crate::control::outside::OutsideCall;
use crate::control::scenario::{AXES, Axes};
use serde::ser::{Serialize, SerializeMap, Serializer};

/// A position or a vector.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Position(pub Axes);

/// The names of the axes in their common order.
pub const AXIS_NAMES: [&str; AXES] = ["x", "y", "z", "a", "b", "c", "u", "v", "w", "e"];

impl Serialize for Position {
    /// X, Y and Z always, the others where they are not zero.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        for (at, (name, value)) in AXIS_NAMES.iter().zip(self.0).enumerate() {
            if at < 3 || value != 0.0 {
                map.serialize_entry(name, &value)?;
            }
        }
        map.end()
    }
}

/// A working plane: its two axes in the order in which counter-clockwise turns from the first to the second.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
#[allow(missing_docs)]
pub enum Plane {
    #[default]
    Xy,
    Zx,
    Yz,
}

impl Plane {
    /// Its two axes, the one that counts as X first, and the axis that drilling goes along.
    pub fn axes(self) -> (usize, usize, usize) {
        match self {
            Plane::Xy => (0, 1, 2),
            Plane::Zx => (2, 0, 1),
            Plane::Yz => (1, 2, 0),
        }
    }
}

/// What a feed number counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum FeedMode {
    /// Millimetres (degrees, where only a rotary axis moves) per minute.
    #[default]
    PerMinute,
    /// Millimetres per turn.
    PerTurn,
    /// The inverse of the time, per minute.
    Inverse,
}

/// Which side of the path the cutter is on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
#[allow(missing_docs)]
pub enum Side {
    #[default]
    Off,
    Left,
    Right,
}

/// What the spindle does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
#[allow(missing_docs)]
pub enum Spindle {
    #[default]
    Stopped,
    Clockwise,
    CounterClockwise,
    Oriented,
}

/// True for a number that an event leaves out.
fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

/// True for a mark that an event leaves out.
fn is_false(mark: &bool) -> bool {
    !*mark
}

/// True for a count that an event leaves out.
fn is_none(count: &u32) -> bool {
    *count == 0
}

/// A line or an arc of a contour.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Leg {
    /// Where it ends.
    pub to: Position,
    /// The centre of an arc.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub centre: Option<Position>,
    /// True for an arc that turns counter-clockwise.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub ccw: bool,
}

/// What happened.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
#[serde(tag = "event", rename_all = "snake_case")]
pub enum EventKind {
    /// A rapid move.
    Rapid {
        /// Where it began.
        from: Position,
        /// Where it ended.
        to: Position,
    },
    /// A straight move at feed.
    Feed {
        /// Where it began.
        from: Position,
        /// Where it ended.
        to: Position,
        /// The feed.
        feed: f64,
        /// What the feed counts.
        mode: FeedMode,
    },
    /// An arc, a helix where the third axis moves too.
    Arc {
        /// Where it began.
        from: Position,
        /// Where it ended.
        to: Position,
        /// Its centre; axes outside the plane as at the start.
        centre: Position,
        /// Its radius at the start.
        radius: f64,
        /// By how much farther from the centre the end lies than the start.
        off: f64,
        /// The plane.
        plane: Plane,
        /// Angle passed, degrees, positive counter-clockwise.
        sweep: f64,
        /// True on a lathe: X of the places is a diameter, the radius is a radius.
        #[serde(skip_serializing_if = "is_false")]
        diameters: bool,
        /// The feed.
        feed: f64,
        /// What the feed counts.
        mode: FeedMode,
    },
    /// A threading move.
    Thread {
        /// Where it began.
        from: Position,
        /// Where it ended.
        to: Position,
        /// The lead.
        lead: f64,
        /// Angle of the spindle at which it begins, thousandths of a degree.
        #[serde(skip_serializing_if = "is_zero")]
        start: f64,
        /// By how much the lead grows each turn.
        #[serde(skip_serializing_if = "is_zero")]
        change: f64,
        /// Over which length before its end the tool is pulled out; none where the machine alone knows it.
        #[serde(skip_serializing_if = "Option::is_none")]
        chamfer: Option<f64>,
        /// The angle of that, degrees.
        #[serde(skip_serializing_if = "Option::is_none")]
        chamfer_angle: Option<f64>,
    },
    /// A move that the probe could end.
    Probe {
        /// Where it began.
        from: Position,
        /// Where it would have ended.
        aim: Position,
        /// Where it ended.
        to: Position,
        /// True where the probe touched.
        hit: bool,
        /// The feed.
        feed: f64,
    },
    /// A corner to be rounded or chamfered between the last move and the next one.
    Corner {
        /// True for a chamfer.
        chamfer: bool,
        /// Its size.
        size: f64,
    },
    /// A drilling cycle begins at a place; its moves follow.
    Hole {
        /// The cycle.
        cycle: Op,
        /// Machine position of the hole on the retract plane.
        at: Position,
        /// Machine coordinate of the bottom, along the drilling axis.
        bottom: f64,
    },
    /// A contour is roughed; the passes follow.
    Roughing {
        /// The cycle.
        cycle: Op,
        /// Depth of a pass: real, no diameter.
        depth: f64,
        /// What stays for finishing, along X (a diameter) and Z.
        allowance: [f64; 2],
        /// The contour, from its first place on.
        contour: Vec<Leg>,
        /// True where its first block is a rapid: then each pass goes in rapidly.
        rapid: bool,
        /// The feed.
        feed: f64,
        /// What the feed counts.
        mode: FeedMode,
    },
    /// A wait.
    Dwell {
        /// How long.
        seconds: f64,
    },
    /// The spindle's direction or speed changed.
    Spindle {
        /// Its direction.
        direction: Spindle,
        /// Turns per minute; millimetres per minute under constant surface speed.
        speed: f64,
        /// True under constant surface speed.
        surface: bool,
    },
    /// A limit of the spindle speed.
    SpeedLimit {
        /// Turns per minute.
        speed: f64,
    },
    /// Coolant.
    Coolant {
        /// Which, on or off.
        state: Op,
    },
    /// A tool was put ready, before its change.
    ToolReady {
        /// The tool.
        tool: f64,
    },
    /// A tool change.
    ToolChange {
        /// The tool now in the spindle.
        tool: f64,
    },
    /// Tool length compensation changed.
    ToolLength {
        /// The number of the offset; 0 for none.
        offset: u32,
        /// The length now added along its axis.
        value: f64,
    },
    /// Cutter compensation changed.
    CutterRadius {
        /// The side.
        side: Side,
        /// The number of the offset; 0 for none.
        offset: u32,
        /// The radius.
        value: f64,
        /// On a lathe, the direction in which the tip of the tool points, 1 to 9.
        #[serde(skip_serializing_if = "is_none")]
        tip: u32,
    },
    /// A tool of a lathe's turret took another offset.
    ToolOffset {
        /// The number of the offset; 0 for none.
        offset: u32,
        /// What it adds to X: a diameter.
        x: f64,
        /// What it adds to Z.
        z: f64,
    },
    /// Another work offset was selected: 0 none, 1 to 6, 101 and up.
    WorkOffset {
        /// Its common number.
        number: u32,
    },
    /// A program wrote machine state: an offset, an output, a parameter.
    Write {
        /// Which.
        state: Sys,
        /// Its subscripts.
        subscripts: Vec<u32>,
        /// The value; lengths in millimetres.
        value: f64,
    },
    /// A variable that outlives the program was written. Not compared.
    Variable {
        /// Its name on this control.
        name: String,
        /// Its value; none for vacant.
        value: Option<f64>,
    },
    /// Program stop.
    Stop,
    /// Optional stop, with its switch on.
    OptionalStop,
    /// A stop with a message.
    Message {
        /// The text.
        text: String,
    },
    /// An alarm; the run ends.
    Alarm(Stop),
    /// A line of output.
    Output {
        /// The text without its line end.
        text: String,
    },
    /// The operator was asked.
    Asked {
        /// What was answered.
        answer: f64,
    },
    /// A code with no part in motion: a probe switched on, exact stop, a builder's code.
    Other {
        /// The operation.
        operation: Op,
        /// The code as it is written on this control, where no other control has it.
        #[serde(skip_serializing_if = "Option::is_none")]
        code: Option<String>,
    },
    /// A code of the machine's builder that the profile names.
    Act {
        /// Its name.
        name: String,
        /// The values of its words, by their names.
        #[serde(skip_serializing_if = "std::collections::BTreeMap::is_empty")]
        words: std::collections::BTreeMap<String, f64>,
        /// True where the speed among them counts what the surface does, not turns.
        #[serde(skip_serializing_if = "std::ops::Not::not")]
        surface: bool,
    },
    /// The program ended.
    End {
        /// The code's operation; a program that runs out ends by [`Op::End`].
        by: Op,
    },
    /// A program was called. Not compared.
    Enter {
        /// The program, in [`crate::control::Run::programs`].
        #[serde(rename = "called")]
        program: u32,
        /// True where it has locals of its own.
        #[serde(skip)]
        level: bool,
    },
    /// A program returned. Not compared.
    Leave,
    /// A program was called that stands in the machine and is no part of the library: what it does nobody knows.
    Outside(Box<OutsideCall>),
    /// Something mattered that no source confirms.
    Unsure {
        /// The fact, as machine profiles confirm it: `behaviour:goto.forward.first`; or `machine:...`
        /// for a matter that no table asks.
        fact: String,
    },
}

impl EventKind {
    /// False for a dwell, for a mode, and for what the program keeps for itself: while nothing else comes, it may wait.
    pub(super) fn happens(&self) -> bool {
        let keeps =
            matches!(self, Self::Variable { .. } | Self::Enter { .. } | Self::Leave | Self::Unsure { .. });
        !keeps && !matches!(self, Self::Dwell { .. } | Self::Other { .. })
    }
}
