//! Places in machine coordinates that lie elsewhere on the machine which the programs go to: its profile says where. A program of the
//! old machine is followed as if it named them.

use super::{Command, Machine};
use crate::canon::{Op, Role};

/// The block with the words of the other place, if it goes to one that is said to lie elsewhere.
pub(super) fn elsewhere(machine: &Machine, command: &Command) -> Option<Command> {
    let places = &machine.rules.places;
    if places.is_empty() || machine.incremental || !command.steps.is_empty() || !is_of_machine(command) {
        return None;
    }
    let named: Vec<(Role, f64)> = command.words.iter().filter(|(role, _)| role.is_axis()).copied().collect();
    let there = places.of(&named, Some(machine.inch))?;
    let mut moved = command.clone();
    moved.words.retain(|(role, _)| !role.is_axis());
    moved.words.extend(there.iter().copied());
    Some(moved)
}

/// True for a move in machine coordinates: by its code, or by the end of the work offset in its own block.
fn is_of_machine(command: &Command) -> bool {
    command.has(Op::MachineOnce)
        || command.has(Op::ShiftCancel)
        || command.has(Op::SelectWork) && command.number(Role::WorkOffset) == Some(0)
}
