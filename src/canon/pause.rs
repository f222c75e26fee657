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
}
