//! Codes for places and increments (G90, G91) on a control that reads a block from left to right.

use super::machine::Command;
use super::outcome::Stop;
use super::words::Spoken;
use crate::canon::{Group, Op, Role};
use crate::dialect::{CodeMeaning, Control, Question};
use smallvec::SmallVec;

/// Which code counts at each word of a block.
#[derive(Clone, Debug, Default)]
pub struct ByPlace {
    /// For each word, in order, the code that was read before it in its block; one more for the end of the block.
    at: SmallVec<[Option<Op>; 12]>,
    /// The words that count by it: roles and places.
    told: SmallVec<[(Role, usize); 6]>,
}

impl ByPlace {
    /// Reads the codes of a block. None if the block has no such code, or the control takes one for its whole block.
    pub fn of(control: &Control, words: &[Spoken], codes: &[&CodeMeaning]) -> Option<Self> {
        let row = control.behaviour(Question::DistanceCode)?;
        if row.value != "by.place" || !codes.iter().any(|row| row.op.group() == Group::Distance) {
            return None;
        }
        let (mut codes, mut now, mut at) = (codes.iter(), None, SmallVec::new());
        for word in words {
            at.push(now);
            if matches!(word.letter, 'G' | 'M')
                && let Some(row) = codes.next()
                && row.op.group() == Group::Distance
            {
                now = Some(row.op);
            }
        }
        at.push(now);
        Some(Self { at, told: SmallVec::new() })
    }

    /// Takes note of a word that stands where so many words stand before it.
    pub fn note(&mut self, role: Role, before: usize) {
        if role.is_axis() || matches!(role, Role::CycleR | Role::OffsetValue) {
            self.told.push((role, before));
        }
    }

    /// True where a code stands after a word that counts by it.
    pub fn matters(&self) -> bool {
        let last = self.at.last().copied().flatten();
        self.told.iter().any(|(_, before)| self.at.get(*before).copied().flatten() != last)
    }

    /// Tells a command which of its words are places, and what is in force after it.
    pub fn tell(&self, command: &mut Command, incremental: bool, drills: bool) -> Result<(), Stop> {
        let is_incremental = |place: usize| match self.at.get(place).copied().flatten() {
            Some(op) => op == Op::Incremental,
            None => incremental,
        };
        let after = is_incremental(self.at.len().saturating_sub(1));
        let code = |incremental: bool| if incremental { Op::Incremental } else { Op::Absolute };
        let modes: SmallVec<[bool; 6]> =
            self.told.iter().map(|(_, before)| is_incremental(*before)).collect();
        let all = modes.first().copied().unwrap_or(after);
        command.ops.retain(|op| op.group() != Group::Distance);
        if modes.iter().all(|mode| *mode == all) {
            command.ops.insert(0, code(all));
        } else {
            let aside = self.told.iter().any(|(role, _)| !role.is_axis());
            if drills || aside {
                return Err(Stop::unnamed("G90 and G91 both count for the words of a cycle or of an offset"));
            }
            command.ops.insert(0, Op::Absolute);
            let steps = self.told.iter().zip(&modes).filter(|(_, mode)| **mode).map(|((role, _), _)| *role);
            command.steps.extend(steps);
        }
        command.distance_after = Some(code(after));
        Ok(())
    }
}
