//! The turret, the tool offsets, and what of them a program reads and writes (T1 to T9, Q1).

use super::Offset;
use crate::canon::{Op, Role, Sys};
use crate::control::machine::{Command, Machine};
use crate::control::trace::{EventKind, FeedMode, Plane, Side, Trace};
use crate::dialect::Control;

/// Takes the T word: the station turns to its place, then the offset counts.
pub fn index(machine: &mut Machine, command: &Command, trace: &mut Trace) {
    let Some(word) = command.number(Role::Turret) else { return };
    let (station, offset) = (f64::from(word / 100), word % 100);
    machine.tool_ready = station;
    if station != 0.0 && station != machine.tool {
        machine.tool = station;
        trace.push(EventKind::ToolChange { tool: station });
    }
    let before = machine.lathe.offset;
    machine.lathe.offset = offset;
    machine.apply_offset(before, trace);
}

/// Takes the side of the nose: radius and tip are those of the offset in force.
pub fn nose(machine: &mut Machine, side: Side, trace: &mut Trace) {
    let off = side == Side::Off;
    if off && machine.side == Side::Off {
        return;
    }
    machine.side = side;
    machine.radius_offset = if off { 0 } else { machine.lathe.offset };
    let row = machine.lathe.table.get(&machine.radius_offset).copied().unwrap_or_default();
    let (value, tip) = if off { (0.0, 0) } else { (row.radius, row.tip.clamp(0.0, 9.0) as u32) };
    if !off {
        // The path that the tool takes is not worked out.
        trace.doubt("machine:lathe.nose.path");
    }
    trace.push(EventKind::CutterRadius { side, offset: machine.radius_offset, value, tip });
}

impl Machine {
    /// Puts a lathe into the state that power-on leaves (C6, S4).
    pub(in crate::control::machine) fn start_turning(&mut self, control: &Control) {
        if !self.rules.lathe {
            return;
        }
        self.plane = Plane::Zx;
        self.feed_mode = FeedMode::PerTurn;
        let stated = control.start().iter().map(|mode| mode.op);
        let known = self.rules.turning.feeds_by_turn;
        if known == Some(false) {
            self.feed_mode = FeedMode::PerMinute;
        }
        self.lathe.feed_mode_told = known.is_some();
        for op in stated.filter(|op| op.group() == crate::canon::Group::FeedMode) {
            self.start_in(op);
            self.lathe.feed_mode_told = true;
        }
    }

    /// Notes that nobody said what the feed counts, where it matters.
    pub(in crate::control::machine) fn doubt_feed_mode(&self, trace: &mut Trace) {
        if self.rules.lathe && !self.lathe.feed_mode_told {
            trace.doubt("machine:feed.mode.at.start");
        }
    }

    /// The offset in force counts from here on; nothing moves (T3).
    fn apply_offset(&mut self, before: u32, trace: &mut Trace) {
        let number = self.lathe.offset;
        let row = self.lathe.table.get(&number).copied().filter(|_| number != 0);
        let Offset { x, y, z, .. } = row.unwrap_or_default();
        let old = self.frame.tool.unwrap_or_default();
        if old != [x, y, z] {
            // Whether the slide goes there at once, and what the offset is, no source says for every machine.
            trace.doubt("machine:lathe.tool.offset");
        }
        self.frame.tool = (number != 0).then_some([x, y, z]);
        if before != number || old != [x, y, z] {
            trace.push(EventKind::ToolOffset { offset: number, x, z });
        }
    }

    /// A value of the table of tool offsets, in the unit of the program.
    pub(in crate::control::machine) fn lathe_offset(&self, state: Sys, number: u32) -> f64 {
        let row = self.lathe.table.get(&number).copied().unwrap_or_default();
        let unit = self.unit();
        match state {
            Sys::LatheX => row.x / unit,
            Sys::LatheY => row.y / unit,
            Sys::LatheZ => row.z / unit,
            Sys::LatheRadius => row.radius / unit,
            _ => row.tip,
        }
    }

    /// Writes a value of the table of tool offsets; gives it in millimetres. It counts from the next T word on.
    pub(in crate::control::machine) fn keep_lathe_offset(
        &mut self,
        state: Sys,
        number: u32,
        value: f64,
    ) -> f64 {
        let value = if state == Sys::LatheTip { value } else { value * self.unit() };
        let row = self.lathe.table.entry(number).or_default();
        match state {
            Sys::LatheX => row.x = value,
            Sys::LatheY => row.y = value,
            Sys::LatheZ => row.z = value,
            Sys::LatheRadius => row.radius = value,
            _ => row.tip = value,
        }
        value
    }

    /// Changes between turns a minute and a surface speed (S1): without a speed the last one of the new mode counts.
    pub(in crate::control::machine) fn change_speed_mode(
        &mut self,
        surface: bool,
        command: &Command,
        trace: &mut Trace,
    ) {
        if self.surface_speed == surface {
            return;
        }
        self.surface_speed = surface;
        if command.word(Role::Speed).is_none() {
            self.speed = self.lathe.speeds[usize::from(surface)];
            trace.doubt("machine:lathe.speed.kept");
            if !command.has(Op::SpindleCw) && !command.has(Op::SpindleCcw) {
                trace.push(EventKind::Spindle { direction: self.spindle, speed: self.speed, surface });
            }
        }
    }
}
