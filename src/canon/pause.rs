//! Where a program stops for a person or for a tool, and what may be running there.

/// Kinds of places where a program stops.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Pause {
    /// A program stop, optional or not.
    Stop,
    /// A stop with a message that a statement raises.
    Message,
    /// A change of the tool.
    Change,
    /// The end of the program.
    End,
}

/// What may be running there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Running {
    /// The spindle.
    Spindle,
    /// Coolant.
    Coolant,
}

impl Running {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Spindle, Self::Coolant];
}

impl Pause {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Stop, Self::Message, Self::Change, Self::End];

    /// The question of behaviour that asks whether it stops what is running.
    pub const fn question(self, running: Running) -> &'static str {
        match (self, running) {
            (Self::Stop, Running::Spindle) => "stop.ends.spindle",
            (Self::Stop, Running::Coolant) => "stop.ends.coolant",
            (Self::Message, Running::Spindle) => "message.ends.spindle",
            (Self::Message, Running::Coolant) => "message.ends.coolant",
            (Self::Change, Running::Spindle) => "change.ends.spindle",
            (Self::Change, Running::Coolant) => "change.ends.coolant",
            (Self::End, Running::Spindle) => "end.ends.spindle",
            (Self::End, Running::Coolant) => "end.ends.coolant",
        }
    }
}
