//! What may have cancelled a tool length that a program did not end.

/// What may have cancelled a tool length that the program did not end.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LengthLost {
    /// A return to the reference position along the axis of the length.
    pub by_reference: Ways,
    /// A return of other axes alone.
    pub by_other_axes: Ways,
    /// A move in machine coordinates along the axis of the length.
    pub by_machine_move: Ways,
    /// A tool change.
    pub by_change: Ways,
    /// True where every way here went home, or in machine coordinates, along the axis of the length, whatever length was in
    /// force.
    pub is_home: bool,
    /// True where some way here named a length, and has neither ended it nor gone home, or in machine coordinates, along its
    /// axis since.
    pub is_held: bool,
}

/// On which of the ways to a place something happens.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Ways {
    /// On none.
    #[default]
    None,
    /// On some, on others not.
    Some,
    /// On every one.
    Every,
}

impl LengthLost {
    /// True where something may have cancelled it.
    pub fn may_be(&self) -> bool {
        [self.by_reference, self.by_other_axes, self.by_machine_move, self.by_change] != [Ways::None; 4]
    }

    /// Joins what other ways did; true where that changed anything.
    pub(super) fn join(&mut self, other: Self) -> bool {
        let join = |a: Ways, b: Ways| if a == b { a } else { Ways::Some };
        let joined = Self {
            by_reference: join(self.by_reference, other.by_reference),
            by_other_axes: join(self.by_other_axes, other.by_other_axes),
            by_machine_move: join(self.by_machine_move, other.by_machine_move),
            by_change: join(self.by_change, other.by_change),
            is_home: self.is_home && other.is_home,
            is_held: self.is_held || other.is_held,
        };
        std::mem::replace(self, joined) != joined
    }
}
