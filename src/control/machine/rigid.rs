//! Taps that a code of their own makes rigid: the code stands in the block of the tap, or before it.
//!
//! Between the two an axis that moves, and a speed, are alarms. A rigid tap turns as its cycle says, whatever the spindle
//! did before.

use super::{Command, Machine};
use crate::canon::{Group, Op, Role};
use crate::control::outcome::Stop;
use crate::control::trace::Trace;
use crate::dialect::{Control, Question};
use std::collections::BTreeMap;

/// How a control taps.
#[derive(Clone, Copy, Debug)]
pub struct Taps {
    /// False where the profile says that the wait of a tap is none.
    pub wait: bool,
    /// The same of peck drills.
    pub peck_wait: bool,
    /// True if every tap is rigid.
    pub rigid: bool,
    /// True if a code makes taps rigid, and nobody says whether others are too.
    open: bool,
    /// True if a cycle for rigid taps turns a spindle that stands.
    turn: bool,
    /// True if a plain tap does, and each drilling cycle after an end that no code of the spindle made.
    pub start: bool,
}

impl Taps {
    pub fn of(control: &Control) -> Self {
        let yes = |question| control.behaviour(question).is_some_and(|row| row.value == "true");
        let waits = |question| control.behaviour(question).is_none_or(|row| row.value != "none");
        Self {
            wait: waits(Question::TapDwell),
            peck_wait: waits(Question::PeckDwell),
            rigid: control.behaviour(Question::TapRigid).is_some_and(|row| row.value == "always"),
            open: control.behaviour(Question::TapRigid).is_some_and(|row| row.value == "unknown")
                && control.code_for(Op::RigidTaps, &BTreeMap::new()).is_some(),
            turn: yes(Question::TapRigidTurns),
            start: yes(Question::CycleStartsSpindle),
        }
    }

    /// True if this tap turns a spindle that stands.
    pub fn starts(self, op: Op, state: Rigid, trace: &mut Trace) -> bool {
        let starts = self.start || self.rigid || state == Rigid::Taps || self.turn && op == Op::CycleTapRigid;
        if !starts && self.open {
            trace.doubt("behaviour:tap.rigid");
        }
        starts || self.open
    }
}

/// How far a rigid tap is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Rigid {
    /// Nothing asks for one.
    #[default]
    No,
    /// The code stood, and its tap is to come.
    Asked,
    /// The tapping cycle in force is rigid.
    Taps,
}

/// Takes what a block says of rigid taps, before it moves.
pub(super) fn enter(machine: &mut Machine, command: &Command) -> Result<(), Stop> {
    let taps = command.ops.iter().copied().any(Op::is_tap);
    if machine.rules.lathe {
        return Ok(());
    }
    if machine.rigid == Rigid::No && !command.has(Op::RigidTaps) {
        return if taps && machine.rules.taps.rigid { with_speed(machine, command) } else { Ok(()) };
    }
    let asked = machine.rigid == Rigid::Asked;
    if taps && (asked || command.has(Op::RigidTaps)) {
        with_speed(machine, command)?;
        machine.rigid = Rigid::Taps;
        return Ok(());
    }
    if command.has(Op::RigidTaps) || asked {
        if command.has_axes() {
            return Err(Stop::unnamed("an axis moves between the code for a rigid tap and the tap"));
        }
        if asked && command.word(Role::Speed).is_some() {
            return Err(Stop::unnamed("a speed stands between the code for a rigid tap and the tap"));
        }
        machine.rigid = Rigid::Asked;
        return Ok(());
    }
    let ends = |op: &Op| matches!(op.group(), Group::Cycle | Group::Motion);
    if command.ops.iter().any(ends) {
        machine.rigid = Rigid::No;
    }
    Ok(())
}

/// A tap that follows a spindle which has no speed would go nowhere.
fn with_speed(machine: &Machine, command: &Command) -> Result<(), Stop> {
    let speed = command.word(Role::Speed).unwrap_or(machine.speed);
    if speed <= 0.0 { Err(Stop::unnamed("a rigid tap without a speed")) } else { Ok(()) }
}
