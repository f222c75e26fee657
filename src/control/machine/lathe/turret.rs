//! The turret, the tool offsets, and what of them a program reads and writes (T1 to T9, Q1).

use super::time::turns_now;
use super::{Lathe, Offset};
use crate::canon::{Op, Role, Sys};
use crate::control::machine::{Command, Machine, auxiliary};
use crate::control::outcome::Stop;
use crate::control::trace::{EventKind, FeedMode, Plane, Side, Trace};
use crate::dialect::{Control, turret_parts};
use std::collections::BTreeMap;

/// Takes the T word: the station turns to its place, then the offset counts.
pub fn index(machine: &mut Machine, command: &Command, trace: &mut Trace) {
    let Some(word) = command.number(Role::Turret) else { return };
    let (station, offset) = turret_parts(f64::from(word));
    let offset = offset as u32;
    machine.spoken.doubt();
    if (1..100).contains(&word) {
        // By its digits it is an offset alone; a machine may take it for a station.
        machine.rules.turning.short_word.ask(trace);
    }
    machine.tool_ready = station;
    if station != 0.0 && station != machine.tool {
        machine.tool = station;
        if command.axes().next().is_some() {
            trace.doubt("machine:lathe.tool.beside.move");
        }
        trace.push(EventKind::ToolChange { tool: station });
    }
    let before = machine.lathe.offset;
    machine.lathe.offset = offset;
    machine.apply_offset(before, trace);
}

/// True where a builder's code of the block acts when the turret has turned, and not before it does (T5).
pub fn is_awaited(machine: &Machine, command: &Command, trace: &mut Trace) -> bool {
    let station = command.number(Role::Turret).map_or(0.0, |word| turret_parts(f64::from(word)).0);
    let turns = station != 0.0 && station != machine.tool;
    turns && auxiliary::starts_builders(machine, command) && machine.rules.turret_first.ask(trace)
}

/// Takes the side of the nose: radius and tip are those of the offset in force.
pub fn nose(machine: &mut Machine, side: Side, trace: &mut Trace) {
    let off = side == Side::Off;
    if off && machine.side == Side::Off {
        return;
    }
    machine.side = side;
    machine.radius_offset = if off { 0 } else { machine.lathe.offset };
    let row = machine.offset_row(machine.radius_offset);
    let (value, tip) = if off { (0.0, 0) } else { (row.radius, row.tip.clamp(0.0, 9.0) as u32) };
    trace.push(EventKind::CutterRadius { side, offset: machine.radius_offset, value, tip });
}

/// What is added to the number of a geometry offset where a program writes it.
const GEOMETRY: u32 = 10_000;

impl Lathe {
    /// What an offset adds: the wear of its row and the geometry of that one, together (T3).
    fn row(&self, number: u32, geometry: u32) -> Offset {
        if number == 0 {
            return Offset::default();
        }
        let of = |table: &BTreeMap<u32, Offset>, number| table.get(&number).copied().unwrap_or_default();
        let (own, more) = (of(&self.table, number), of(&self.geometry, geometry));
        Offset {
            x: own.x + more.x,
            y: own.y + more.y,
            z: own.z + more.z,
            radius: own.radius + more.radius,
            tip: if own.tip == 0.0 { more.tip } else { own.tip },
        }
    }
}

impl Machine {
    /// What an offset adds for the tool that is there.
    fn offset_row(&self, number: u32) -> Offset {
        self.lathe.row(number, self.geometry_of(number))
    }

    /// The row of the geometry that belongs to an offset: its own, or that of the station (T3).
    fn geometry_of(&self, offset: u32) -> u32 {
        if self.rules.turning.geometry_by_station { self.tool as u32 } else { offset }
    }

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
        let Offset { x, y, z, .. } = self.offset_row(number);
        let old = self.frame.tool.unwrap_or_default();
        if number == 0 && self.rules.turning.keeps_geometry {
            self.leave_geometry(before, trace);
            return;
        }
        if old != [x, y, z] {
            // Whether the slide goes there at once, and what the offset is, no source says for every machine.
            trace.doubt("machine:lathe.tool.offset");
        }
        self.frame.tool = (number != 0).then_some([x, y, z]);
        if before != number || old != [x, y, z] {
            trace.push(EventKind::ToolOffset { offset: number, x, z });
        }
    }

    /// Offset 00 takes the wear away, and the geometry of the tool before stays (T4).
    fn leave_geometry(&mut self, before: u32, trace: &mut Trace) {
        if before == 0 {
            return;
        }
        let rest = self.lathe.geometry.get(&self.geometry_of(before)).copied().unwrap_or_default();
        self.frame.tool = Some([rest.x, rest.y, rest.z]);
        trace.push(EventKind::ToolOffset { offset: 0, x: 0.0, z: 0.0 });
    }

    /// Writes the words of a block into an offset (Z8). It counts from the next T word on.
    pub(in crate::control::machine) fn write_turret(
        &mut self,
        command: &Command,
        trace: &mut Trace,
    ) -> Result<(), Stop> {
        let number = command.number(Role::OffsetRow).unwrap_or(0);
        let (number, geometry) = if number > GEOMETRY { (number - GEOMETRY, true) } else { (number, false) };
        if number == 0 && !geometry {
            return self.write_work_shift(command, trace);
        }
        if command.word(Role::C).or(command.word(Role::StepC)).is_some() {
            return Err(Stop::unnamed("an increment of a nose radius"));
        }
        trace.rounded = self.off_by() + self.most_off(command, |_| true);
        for (role, value) in command.words.iter().copied() {
            let (state, adds) = match role {
                Role::X => (Sys::LatheX, false),
                Role::StepX => (Sys::LatheX, true),
                Role::Y => (Sys::LatheY, false),
                Role::StepY => (Sys::LatheY, true),
                Role::Z => (Sys::LatheZ, false),
                Role::StepZ => (Sys::LatheZ, true),
                Role::OffsetNose => (Sys::LatheRadius, false),
                Role::OffsetTip => (Sys::LatheTip, false),
                _ => continue,
            };
            if geometry {
                std::mem::swap(&mut self.lathe.table, &mut self.lathe.geometry);
            }
            let old = if adds { self.lathe_offset(state, number) } else { 0.0 };
            let value = self.keep_lathe_offset(state, number, old + value);
            if geometry {
                std::mem::swap(&mut self.lathe.table, &mut self.lathe.geometry);
            }
            let row = if geometry { number + GEOMETRY } else { number };
            trace.push(EventKind::Write { state, subscripts: vec![row], value });
        }
        Ok(())
    }

    /// Writes the shift of all zeros: from then on it counts in all work offsets (Z8).
    fn write_work_shift(&mut self, command: &Command, trace: &mut Trace) -> Result<(), Stop> {
        let other = [Role::OffsetNose, Role::OffsetTip, Role::C, Role::StepC];
        if other.iter().any(|role| command.word(*role).is_some()) {
            return Err(Stop::unnamed("a word beside the shift of all zeros that is no place of it"));
        }
        trace.doubt("machine:lathe.work.shift");
        trace.rounded = self.off_by() + self.most_off(command, |_| true);
        let unit = self.unit();
        for (role, value) in command.words.iter().copied() {
            let (state, axis, adds) = match role {
                Role::X => (Sys::LatheX, 0, false),
                Role::StepX => (Sys::LatheX, 0, true),
                Role::Y => (Sys::LatheY, 1, false),
                Role::StepY => (Sys::LatheY, 1, true),
                Role::Z => (Sys::LatheZ, 2, false),
                Role::StepZ => (Sys::LatheZ, 2, true),
                _ => continue,
            };
            let old = if adds { self.lathe.work_shift[axis] } else { 0.0 };
            let shift = old + value * unit;
            self.frame.external[axis] += shift - self.lathe.work_shift[axis];
            self.lathe.work_shift[axis] = shift;
            trace.push(EventKind::Write { state, subscripts: vec![0], value: shift / unit });
        }
        Ok(())
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
        let turns = turns_now(self);
        self.surface_speed = surface;
        if command.word(Role::Speed).is_none() {
            let kept = self.rules.speed_kept.ask(trace);
            let held = turns.filter(|_| !kept && !surface);
            self.speed = held.unwrap_or(self.lathe.speeds[usize::from(surface)]);
            if !command.has(Op::SpindleCw) && !command.has(Op::SpindleCcw) {
                trace.push(EventKind::Spindle { direction: self.spindle, speed: self.speed, surface });
            }
        }
    }
}
