//! Places in machine coordinates that lie elsewhere on the machine which the programs go to: its profile says where. A program of the
//! old machine is followed as if it named them.

use super::{Command, Machine};
use crate::canon::{Op, Role};
use crate::dialect::{Control, MachinePlaces, Question, turret_parts};

/// The places of the machine that lie elsewhere there.
#[derive(Clone, Debug, Default)]
pub struct Places {
    all: MachinePlaces,
    /// True where the words of a move in machine coordinates are known to be places under G91 too.
    in_steps: bool,
}

impl Places {
    pub fn of(control: &Control) -> Self {
        let answer = control.behaviour(Question::MachineUnderIncremental);
        Self { all: control.places_there().clone(), in_steps: answer.is_some_and(|row| row.value == "place") }
    }
}

/// The block with the words of the other place, if it goes to one that is said to lie elsewhere.
pub(super) fn elsewhere(machine: &Machine, command: &Command) -> Option<Command> {
    let places = &machine.rules.places;
    let steps = machine.incremental && !(places.in_steps && command.has(Op::MachineOnce));
    if places.all.is_empty() || steps || !command.steps.is_empty() || !is_of_machine(machine, command) {
        return None;
    }
    let named: Vec<(Role, f64)> = command.words.iter().filter(|(role, _)| role.is_axis()).copied().collect();
    let there = places.all.of(&named, Some(machine.inch))?;
    let mut moved = command.clone();
    moved.words.retain(|(role, _)| !role.is_axis());
    moved.words.extend(there.iter().copied());
    Some(moved)
}

/// True for a move in machine coordinates: by its code, by the end of the work offset in its own block, or on a lathe by a T word that
/// takes the tool offset away.
fn is_of_machine(machine: &Machine, command: &Command) -> bool {
    let away = || command.number(Role::Turret).is_some_and(|word| turret_parts(f64::from(word)).1 == 0.0);
    let home = command.has(Op::ReferenceReturn) || command.has(Op::Reference2);
    machine.rules.lathe && !home && away()
        || command.has(Op::MachineOnce)
        || command.has(Op::ShiftCancel)
        || command.has(Op::SelectWork) && command.number(Role::WorkOffset) == Some(0)
}
