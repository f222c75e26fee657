//! Where the spindle stands, though the source's cycle turns it.

use crate::canon::{Group, Op, Pause, Role, Running};
use crate::dialect::{Control, Question};
use crate::ir::analysis::dataflow::Lattice;
use crate::ir::analysis::over_calls::Follow;
use crate::ir::{Block, BlockId, Expr, Nc, NcItem, StmtKind};
use crate::legalize::Modal;

/// What is known of the spindle at a place, on some way to it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::legalize) struct Spindle {
    /// A tool change, an orientation or a stop has ended its turning.
    pub stands: bool,
    /// On another way nothing of that came last.
    pub otherwise: bool,
    /// A program that is not in the library may have stopped it: one that probes does.
    pub lost: bool,
}

impl Lattice for Spindle {
    fn join(&mut self, other: &Self) -> bool {
        let joined = Self {
            stands: self.stands || other.stands,
            otherwise: self.otherwise || other.otherwise,
            lost: self.lost || other.lost,
        };
        std::mem::replace(self, joined) != joined
    }
}

/// Follows that over a library.
pub(in crate::legalize) struct Standing {
    /// True where a stop of the program ends it.
    by_stop: bool,
    /// True where a stop with a message does.
    by_message: bool,
    /// The target's cycle for rigid taps turns it, and all taps of the source are rigid, or those after a code.
    rigid: Option<bool>,
}

impl Follow for Standing {
    type Known = Spindle;

    fn outside(&self, _: usize) -> Spindle {
        Spindle { otherwise: true, ..Spindle::default() }
    }

    fn stmts(&self, _: (usize, BlockId), block: &Block, spindle: &mut Spindle) {
        block.stmts.iter().for_each(|stmt| *spindle = self.after(&stmt.kind, *spindle));
    }

    fn lose(&self, spindle: &mut Spindle) {
        spindle.lost = true;
    }
}

impl Standing {
    /// What ends its turning on the source, and what turns it on the target.
    pub fn of(source: &Control, target: &Control) -> Self {
        let ends = |pause| source.ends(pause, Running::Spindle).answer == Some(true);
        let told = |control: &Control, question| control.behaviour(question).map(|row| row.value.clone());
        let has = |op| target.code_for(op, &std::collections::BTreeMap::new()).is_some();
        let turns = told(target, Question::TapRigidTurns).as_deref() == Some("true");
        let by_cycle = told(target, Question::TapRigid).as_deref() == Some("code") && !has(Op::RigidTaps);
        let always = told(source, Question::TapRigid).as_deref() == Some("always");
        Self {
            by_stop: ends(Pause::Stop),
            by_message: ends(Pause::Message),
            rigid: (turns && by_cycle).then_some(always),
        }
    }

    /// True for a block from which on the target's rigid tap turns the spindle.
    pub fn turns(&self, nc: &Nc) -> bool {
        match self.rigid {
            Some(true) => nc.ops().any(Op::is_tap),
            Some(false) => nc.has(Op::RigidTaps),
            None => false,
        }
    }

    /// Takes a statement, which may say what the spindle does.
    pub fn after(&self, kind: &StmtKind, before: Spindle) -> Spindle {
        let standing = Spindle { stands: true, otherwise: false, ..before };
        match kind {
            StmtKind::Nc(nc) => {
                let says = nc.ops().any(|op| op.group() == Group::Spindle && op != Op::SpindleOrient);
                let pauses = nc.has(Op::Stop) || nc.has(Op::OptionalStop);
                let ends = nc.has(Op::ToolChange) || nc.has(Op::SpindleOrient) || self.by_stop && pauses;
                match (says || self.turns(nc), ends) {
                    (true, _) => Spindle { otherwise: true, ..Spindle::default() },
                    (_, true) => standing,
                    _ => before,
                }
            }
            StmtKind::StopMessage { .. } if self.by_message => standing,
            _ => before,
        }
    }
}

/// True where a block drills, or taps, and finds the spindle standing.
pub(in crate::legalize) fn turned_by_cycle(nc: &Nc, stands: bool, before: &Modal) -> bool {
    let begun = nc.ops().find(|op| op.is_cycle());
    let Some(op) = begun.or(before.op(Group::Cycle)).filter(|op| op.is_cycle()) else { return false };
    let says = nc.ops().any(|op| op.group() == Group::Spindle);
    let moves = nc.ops().any(|op| op.group() == Group::Motion);
    let stopped = before.op(Group::Spindle) == Some(Op::SpindleStop);
    // The holes of a stored tap may stand in a subprogram that drills with other tools too.
    let stored = nc.word(Role::Repeat).and_then(Expr::constant) == Some(0.0) && !op.is_tap();
    let drills = begun.is_some() || !moves && !nc.has(Op::CycleOff) && goes_somewhere(nc, Some(before));
    drills && !stored && !says && (stands || stopped && op.is_tap()) && !op.is_live_tap()
}

/// True where a block of a drilling cycle has a position.
pub(in crate::legalize) fn goes_somewhere(nc: &Nc, state: Option<&Modal>) -> bool {
    let drills =
        nc.ops().any(Op::is_cycle) || state.is_some_and(|state| state.op(Group::Cycle) != Some(Op::CycleOff));
    let across = |item: &NcItem| matches!(item, NcItem::Word(role, _) if role.is_axis() && *role != Role::Z);
    drills && nc.items.iter().any(across)
}
