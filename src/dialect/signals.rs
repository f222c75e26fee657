//! Inputs and outputs by the numbers that a shop knows them by.
//!
//! A profile says which wire is on which input or output. Its number there takes the place of the table's own number of
//! that input, so that programs of two controls mean one signal by one number. Signals that a profile does not speak of
//! keep the table's numbers, but for those that it gives away.

use super::origin::PROFILE;
use super::overlay::Overlay;
use super::profile::Signal;
use super::{Dialect, Origin, Subscript, SystemVariable};
use crate::canon::Sys;

/// The states that show inputs, and those that show outputs: as they are, and the other way round.
const INPUTS: [Sys; 2] = [Sys::Input, Sys::InputInverted];
const OUTPUTS: [Sys; 2] = [Sys::Output, Sys::OutputInverted];

impl Overlay {
    /// Gives signals the numbers of the profile.
    pub(super) fn signals(&mut self, dialect: &mut Dialect) {
        let table = dialect.system.clone();
        for signal in self.profile.signal.clone() {
            let (states, own) = match (signal.input, signal.output) {
                (Some(input), None) => (INPUTS, input),
                (None, Some(output)) => (OUTPUTS, output),
                _ => {
                    let help = "write input = 1 or output = 1 beside number = 24";
                    self.fault("signal", "a signal is one input or one output".into(), help.into());
                    continue;
                }
            };
            let own_number = |row: &SystemVariable| row.number_of(&[own]).flatten();
            let found = |row: &SystemVariable| states.contains(&row.state) && own_number(row).is_some();
            let Some(row) = table.iter().find(|row| found(row)) else {
                let kind = if states == INPUTS { "input" } else { "output" };
                let help = format!("the table of this control says which {kind}s it has");
                self.fault("signal", format!("the control has no {kind} {own}"), help);
                continue;
            };
            let state = match signal.on {
                None => row.state,
                Some(1) => states[0],
                Some(0) => states[1],
                Some(_) => {
                    let help = "write on = 0 or on = 1: what the control shows when the signal is on";
                    self.fault("signal", "a signal shows 0 or 1".into(), help.into());
                    continue;
                }
            };
            let first = own_number(row);
            let rows = std::mem::take(&mut dialect.system);
            for old in rows {
                if old.name == row.name && states.contains(&old.state) {
                    dialect.system.extend(without(&old, first, signal.number));
                } else {
                    dialect.system.push(old);
                }
            }
            dialect.system.push(one(row, state, first, &signal));
        }
    }
}

/// A run without the variable `gone`, and without the number `taken` of another signal.
fn without(row: &SystemVariable, gone: Option<u32>, taken: u32) -> Vec<SystemVariable> {
    let (Some(first), [counted]) = (row.first, row.subscripts.as_slice()) else { return vec![row.clone()] };
    let stays = |at: &u32| {
        Some(first + at * counted.step) != gone
            && (counted.from + at != taken || row.origin.source == PROFILE)
    };
    let mut runs: Vec<(u32, u32)> = Vec::new();
    for at in (0..counted.count).filter(stays) {
        match runs.last_mut() {
            Some((start, count)) if *start + *count == at => *count += 1,
            _ => runs.push((at, 1)),
        }
    }
    let part = |(at, count): (u32, u32)| SystemVariable {
        first: Some(first + at * counted.step),
        subscripts: vec![Subscript { from: counted.from + at, count, ..counted.clone() }],
        ..row.clone()
    };
    runs.into_iter().map(part).collect()
}

fn one(row: &SystemVariable, state: Sys, first: Option<u32>, signal: &Signal) -> SystemVariable {
    let subscript = Subscript { from: signal.number, count: 1, step: 1, axis: false };
    let note = signal.text.clone();
    let origin = Origin::of_profile(note);
    SystemVariable { state, first, subscripts: vec![subscript], origin, ..row.clone() }
}
