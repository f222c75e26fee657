//! What a control means by the number of a variable.

use crate::canon::Sys;
use crate::dialect::{Control, SystemVariable};

/// What a number means.
#[derive(PartialEq)]
pub(super) enum Meaning {
    Local,
    Shared,
    /// The cell of another number.
    Cell(u32),
    State(Sys, Vec<u32>),
}

/// What a number is of the system's, with its subscripts and its row.
pub(super) type State<'c> = (Sys, Vec<u32>, &'c SystemVariable);

/// What a control means by a number.
pub(super) fn meaning(control: &Control, number: u32) -> Option<Meaning> {
    meaning_by(control, number, control.numbered_state(number).as_ref())
}

/// The same, where it is this of the system's.
pub(super) fn meaning_by(control: &Control, number: u32, state: Option<&State<'_>>) -> Option<Meaning> {
    if let Some(row) = control.numbered_class(number) {
        return Some(if row.class == "local" { Meaning::Local } else { Meaning::Shared });
    }
    if let Some(row) = control.numbered_same(number) {
        return Some(Meaning::Cell(row.cell_of(number)));
    }
    // A second number is counted as that of its cell: what is counted as 200 may be written 10200.
    let rows =
        control.dialect().same_cells.iter().filter(|row| Some(row.name.as_str()) == control.numbered());
    let written = rows.filter_map(|row| number.checked_add(row.first.checked_sub(row.cell)?));
    if let Some(other) =
        written.filter(|_| state.is_none()).find(|other| control.numbered_class(*other).is_some())
    {
        return Some(Meaning::Cell(other));
    }
    state.map(|(state, subscripts, _)| Meaning::State(*state, subscripts.clone()))
}

/// The largest number that the control has.
pub(super) fn last_number(control: &Control) -> u32 {
    let Some(name) = control.numbered() else { return 0 };
    let system = control.dialect().system.iter().filter(|row| row.name == name);
    let system = system.filter_map(SystemVariable::last);
    let own = control.classes().iter().filter(|row| row.name == name).map(|row| row.last);
    let same = control.dialect().same_cells.iter().filter(|row| row.name == name).map(|row| row.last);
    system.chain(own).chain(same).max().unwrap_or(0)
}
