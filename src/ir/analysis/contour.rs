//! What a contour leaves in force that stands after the cycle that reads it.

use super::modal::Setting;
use crate::canon::Role;
use crate::ir::{Expr, Nc};

/// A contour: what its blocks put in force of the motion ends with it (docs/lathe.md K12).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Contour {
    /// The numbers of its first and its last block.
    ends: [u32; 2],
    /// Inside it, what was in force of the motion before it.
    motion: Option<Setting>,
}

impl Contour {
    /// The one that a cycle reads, where its numbers are known.
    pub(super) fn of(nc: &Nc) -> Option<Self> {
        let number = |role| nc.word(role).and_then(Expr::constant).map(|number| number as u32);
        let ends = number(Role::ContourFirst).zip(number(Role::ContourLast));
        ends.map(|(first, last)| Self { ends: [first, last], motion: None })
    }

    /// Comes to a block, with what is in force before it.
    pub(super) fn enter(&mut self, number: Option<u32>, motion: Setting) {
        if number == Some(self.ends[0]) {
            self.motion = Some(motion);
        }
    }

    /// After a block: what is in force again, where the contour ended with it.
    pub(super) fn leave(self, number: Option<u32>) -> Option<Setting> {
        self.motion.filter(|_| number == Some(self.ends[1]))
    }
}
