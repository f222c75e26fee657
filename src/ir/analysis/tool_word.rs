//! What the last tool word is to the tool in the spindle.

use crate::canon::{Op, Role};
use crate::dialect::turret_parts;
use crate::ir::{BinOp, Expr, Nc, NcItem};

/// What the last tool word is to the tool in the spindle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum ToolWord {
    /// What it was when the run began, on some way here: no tool was named or changed since.
    #[default]
    Begun,
    /// Not known: something that the library does not have ran, or a computed code, on some way here.
    Unknown,
    /// The tool in the spindle.
    Changed,
    /// On some way here it may be one that waits for its change.
    Waits,
}

impl ToolWord {
    /// What it is after a block.
    pub fn after(self, nc: &Nc) -> Self {
        if nc.has(Op::ToolChange) {
            ToolWord::Changed
        } else if nc.word(Role::Tool).is_some() {
            ToolWord::Waits
        } else if nc.items.iter().any(|item| matches!(item, NcItem::Code('M', _))) {
            // A computed code may be the tool change.
            self.after_unknown()
        } else {
            self
        }
    }

    /// What it is after a routine of which nothing is known.
    pub fn after_unknown(self) -> Self {
        if self == ToolWord::Waits { self } else { ToolWord::Unknown }
    }

    /// What it is where two ways meet.
    pub fn join(self, other: Self) -> Self {
        match (self, other) {
            (ToolWord::Waits, _) | (_, ToolWord::Waits) => ToolWord::Waits,
            (ToolWord::Unknown, _) | (_, ToolWord::Unknown) => ToolWord::Unknown,
            (ToolWord::Begun, _) | (_, ToolWord::Begun) => ToolWord::Begun,
            (ToolWord::Changed, ToolWord::Changed) => ToolWord::Changed,
        }
    }
}

/// True where the T word of a block takes the offset of a turret away, false where it may name one; none without such a word.
pub fn takes_offset(nc: &Nc) -> Option<bool> {
    let is_none = |value: f64| turret_parts(value).1 == 0.0;
    nc.word(Role::Turret).map(|word| match (word.constant(), word) {
        (Some(value), _) => is_none(value),
        // A station times 100 is any station, and no offset.
        (None, Expr::Binary(BinOp::Mul, sides)) => sides.iter().filter_map(Expr::constant).any(is_none),
        (None, _) => false,
    })
}
