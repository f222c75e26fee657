//! What a lathe's drilling cycle in force was told, for a target that is told it again.

use crate::canon::{Group, Op, Role};
use crate::ir::{Expr, Nc, NcItem};
use crate::legalize::Modal;

/// What is known of the cycle in force.
#[derive(Clone, Debug, Default)]
pub(super) struct Told {
    /// Its code, where it began in this block of the program.
    pub op: Option<Op>,
    /// The depth, the retract plane and the wait, as they were told last.
    words: Vec<(Role, Expr)>,
    /// Whether places were places or increments when it was told the depth.
    mode: Option<Op>,
}

/// Words that a hole takes from the block of an earlier one; the last two say the depth.
const LASTING: [Role; 4] = [Role::CycleRStep, Role::CycleDwell, Role::Z, Role::StepZ];
const LASTING_SIDE: [Role; 4] = [Role::CycleRStep, Role::CycleDwell, Role::X, Role::StepX];

/// Words that last from hole to hole of this cycle.
pub(super) fn lasting(op: Op) -> [Role; 4] {
    if op.is_side_hole() { LASTING_SIDE } else { LASTING }
}

impl Told {
    /// Takes what a block tells.
    pub fn take(&mut self, nc: &Nc, op: Op, state: &Modal) {
        if nc.ops().any(Op::is_hole) {
            self.op = Some(op);
        }
        let depth = |role: &Role| !matches!(role, Role::CycleRStep | Role::CycleDwell);
        for item in &nc.items {
            let NcItem::Word(role, value) = item else { continue };
            if lasting(op).contains(role) {
                self.words.retain(|(old, _)| old != role && !(depth(old) && depth(role)));
                self.words.push((*role, value.clone()));
                if depth(role) {
                    self.mode = state.op(Group::Distance);
                }
            }
        }
    }

    /// The words, in the order in which they were told.
    pub fn words(&self) -> impl Iterator<Item = &(Role, Expr)> {
        self.words.iter()
    }

    /// How far the retract plane lies from where the cycle began, as a radius along X; nothing if it is computed.
    pub fn plane(&self) -> Option<f64> {
        let plane = self.words.iter().find(|(role, _)| *role == Role::CycleRStep);
        plane.map_or(Some(0.0), |(_, value)| value.constant())
    }

    /// True where all of it can be told again here: a code, numbers, and a depth that counts as it did.
    pub fn is_whole(&self, state: &Modal) -> bool {
        let numbers = self.words.iter().all(|(_, value)| value.constant().is_some());
        self.op.is_some() && numbers && self.mode == state.op(Group::Distance)
    }
}
