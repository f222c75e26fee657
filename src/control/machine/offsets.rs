//! Writing offsets.

use super::Machine;
use super::command::{Command, is_rotary};
use crate::canon::{Op, Role, Sys};
use crate::control::outcome::Stop;
use crate::control::scenario::AXES;
use crate::control::trace::{EventKind, Trace};

/// The code that writes offsets, with its words.
pub(super) fn write_by_code(
    machine: &mut Machine,
    op: Op,
    command: &Command,
    trace: &mut Trace,
) -> Result<(), Stop> {
    let row = command.number(Role::OffsetRow).unwrap_or(0);
    trace.rounded = machine.off_by() + machine.most_off(command, |_| true);
    if op == Op::WriteWork {
        for (axis, value) in command.axes() {
            let state = if row == 0 { Sys::ExternalShift } else { Sys::WorkOffset };
            let axis = axis as u32 + 1;
            let subscripts = if row == 0 { vec![axis] } else { vec![row, axis] };
            let old = if machine.incremental { machine.peek(state, &subscripts).unwrap_or(0.0) } else { 0.0 };
            machine.write(state, &subscripts, old + value, trace)?;
        }
        return Ok(());
    }
    let state = match op {
        Op::WriteLength => Sys::LengthGeometry,
        Op::WriteLengthWear => Sys::LengthWear,
        Op::WriteRadius => Sys::DiameterOrRadius,
        Op::WriteRadiusWear => Sys::DiameterOrRadiusWear,
        _ => Sys::ToolOffset,
    };
    let Some(value) = command.word(Role::OffsetValue) else { return Ok(()) };
    let old = if machine.incremental { machine.peek(state, &[row]).unwrap_or(0.0) } else { 0.0 };
    machine.write(state, &[row], old + value, trace)
}

impl Machine {
    /// Keeps an axis value of a work offset, or of the shift over all of them, in millimetres.
    pub(super) fn keep_work(&mut self, number: Option<u32>, axis: usize, value: f64, trace: &mut Trace) {
        let state = if number.is_some() { Sys::WorkOffset } else { Sys::ExternalShift };
        let subscripts = number.into_iter().chain([axis as u32 + 1]).collect();
        trace.push(EventKind::Write { state, subscripts, value });
        let Some(number) = number else {
            self.frame.external[axis] = value;
            if self.rules.local_is_external.peek() {
                self.frame.local[axis] = 0.0;
            }
            return;
        };
        self.work_offsets.entry(number).or_insert([0.0; AXES])[axis] = value;
        if number == self.frame.number && self.frame.work[axis] != value {
            // Nobody can tell before something is placed by it, if it is not selected anew until then.
            self.stale = true;
            if self.rules.offset_acts_at_once.peek() {
                self.frame.work[axis] = value;
            }
        }
    }

    /// Notes what a changed offset in force rests on, where something is placed by it.
    pub(super) fn place_by_offset(&mut self, trace: &mut Trace) {
        if std::mem::take(&mut self.stale) {
            self.rules.offset_acts_at_once.ask(trace);
        }
    }

    /// Keeps a value of the tool table, in millimetres; radii as radii.
    pub(super) fn keep_tool(&mut self, state: Sys, number: u32, value: f64, trace: &mut Trace) {
        let tool = self.tools.entry(number).or_default();
        match state {
            Sys::LengthWear => tool.length_wear = value,
            Sys::RadiusGeometry => tool.radius = value,
            Sys::RadiusWear => tool.radius_wear = value,
            // Where length and radius share a table, the one value is kept as a length.
            _ => tool.length = value,
        }
        let (written, amount) = self.apart(state, number, value);
        trace.push(EventKind::Write { state: written, subscripts: vec![number], value: amount });
        if number == self.length_offset && self.length_value() != self.frame.length {
            // Nobody can tell before something is placed by it, if it is not named anew until then.
            self.stale_length = true;
            if self.rules.length_acts_at_once.peek() {
                self.frame.length = self.length_value();
            }
        }
    }

    /// Millimetres of a unit of an axis.
    pub(super) fn axis_unit(&self, axis: usize) -> f64 {
        if is_rotary(axis) { 1.0 } else { self.unit() }
    }
}
