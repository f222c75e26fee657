//! What a control means by the number of a variable.

use crate::canon::Sys;
use crate::dialect::{Control, SystemVariable};

/// What a number means.
#[derive(PartialEq)]
pub(super) enum Meaning {
    Local,
    Shared,
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
    state.map(|(state, subscripts, _)| Meaning::State(*state, subscripts.clone()))
}

/// The largest number that the control has.
pub(super) fn last_number(control: &Control) -> u32 {
    let Some(name) = control.numbered() else { return 0 };
    let system = control.dialect().system.iter().filter(|row| row.name == name);
    let system = system.filter_map(SystemVariable::last);
    let own = control.classes().iter().filter(|row| row.name == name).map(|row| row.last);
    system.chain(own).max().unwrap_or(0)
}
