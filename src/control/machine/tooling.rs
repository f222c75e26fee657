//! Tool, spindle, coolant and compensation.

use super::rules::RadiusTable;
use super::{Command, Machine};
use crate::canon::{Op, Role};
use crate::control::trace::{Happening, Side, Spindle, Trace};

/// What acts before the block's motion.
pub(super) fn before(machine: &mut Machine, command: &Command, trace: &mut Trace) {
    tool(machine, command, trace);
    spindle(machine, command, trace);
    for &op in &command.ops {
        match op {
            Op::Mist | Op::Flood | Op::ThroughSpindle => coolant(machine, op, trace),
            _ => {}
        }
    }
    length(machine, command, trace);
    radius(machine, command, trace);
}

/// What acts when the motion is done.
pub(super) fn after(machine: &mut Machine, command: &Command, trace: &mut Trace) {
    for &op in &command.ops {
        match op {
            Op::SpindleStop => turn(machine, Spindle::Stopped, trace),
            Op::CoolantOff | Op::ThroughSpindleOff => coolant(machine, op, trace),
            _ => {}
        }
    }
}

fn coolant(machine: &mut Machine, op: Op, trace: &mut Trace) {
    machine.coolant = op;
    trace.push(Happening::Coolant { state: op });
}

fn tool(machine: &mut Machine, command: &Command, trace: &mut Trace) {
    let word = command.word(Role::Tool);
    let changes = word.is_some() && machine.rules.tool_word_changes.peek();
    if let Some(tool) = word {
        if machine.rules.lathe {
            trace.doubt("machine:lathe.tool.word");
        }
        machine.tool_ready = tool;
        if !command.has(Op::ToolChange) && !changes {
            trace.push(Happening::ToolReady { tool });
        }
    }
    if !changes && !command.has(Op::ToolChange) {
        return;
    }
    if changes {
        machine.rules.tool_word_changes.ask(trace);
    }
    let selects = changes && machine.rules.tool_word_selects_length.peek();
    if selects && machine.tool_ready == 0.0 {
        // Tool 0 takes the length away; the tool stays where it is.
        machine.rules.tool_word_selects_length.ask(trace);
        machine.length_op = Op::LengthOff;
        return apply_length(machine, trace);
    }
    machine.tool = machine.tool_ready;
    trace.push(Happening::ToolChange { tool: machine.tool });
    if selects {
        machine.rules.tool_word_selects_length.ask(trace);
        machine.length_op = Op::LengthPlus;
        machine.length_offset = machine.tool as u32;
        apply_length(machine, trace);
    }
}

fn spindle(machine: &mut Machine, command: &Command, trace: &mut Trace) {
    let speed = command.word(Role::Speed);
    if let Some(speed) = speed {
        // Surface speed comes in metres or feet a minute.
        let unit = if machine.inch { 304.8 } else { 1000.0 };
        machine.speed = if machine.surface_speed { speed * unit } else { speed };
    }
    let direction = command.ops.iter().rev().find_map(|op| match op {
        Op::SpindleCw => Some(Spindle::Clockwise),
        Op::SpindleCcw => Some(Spindle::CounterClockwise),
        Op::SpindleOrient => Some(Spindle::Oriented),
        _ => None,
    });
    if direction.is_some() || speed.is_some() {
        turn(machine, direction.unwrap_or(machine.spindle), trace);
    }
}

fn turn(machine: &mut Machine, direction: Spindle, trace: &mut Trace) {
    machine.spindle = direction;
    trace.push(Happening::Spindle { direction, speed: machine.speed, surface: machine.surface_speed });
}

fn length(machine: &mut Machine, command: &Command, trace: &mut Trace) {
    let op = command
        .ops
        .iter()
        .rev()
        .copied()
        .find(|op| matches!(op, Op::LengthPlus | Op::LengthMinus | Op::LengthOff));
    if let Some(op) = op {
        machine.length_op = op;
    }
    if let Some(number) = command.number(Role::LengthOffset) {
        machine.length_offset = number;
    }
    let renewed = command.word(Role::LengthOffset).is_some() && machine.length_op != Op::LengthOff;
    if op.is_some() || renewed {
        apply_length(machine, trace);
    }
}

fn apply_length(machine: &mut Machine, trace: &mut Trace) {
    let value = machine.length_value();
    machine.frame.length = value;
    let offset = if machine.length_op == Op::LengthOff { 0 } else { machine.length_offset };
    trace.push(Happening::ToolLength { offset, value });
}

fn radius(machine: &mut Machine, command: &Command, trace: &mut Trace) {
    let side = command.ops.iter().rev().find_map(|op| match op {
        Op::RadiusOff => Some(Side::Off),
        Op::RadiusLeft => Some(Side::Left),
        Op::RadiusRight => Some(Side::Right),
        _ => None,
    });
    let with_length = command.number(Role::LengthOffset).filter(|_| machine.rules.length_picks_radius.peek());
    let with_length = with_length.filter(|_| command.word(Role::RadiusOffset).is_none());
    if let Some(number) = command.number(Role::RadiusOffset).or(with_length) {
        machine.radius_offset = number;
        machine.radius_with_length = with_length.is_some();
    } else if side.is_some_and(|side| side != Side::Off) && machine.rules.cutter_takes_tool.peek() {
        machine.rules.cutter_takes_tool.ask(trace);
        machine.active_tool_asked(trace);
        machine.radius_offset = machine.tool as u32;
    }
    let named = command.word(Role::RadiusOffset).is_some() || with_length.is_some();
    let renewed = named && machine.side != Side::Off;
    if side.is_some() || renewed {
        machine.side = side.unwrap_or(machine.side);
        let off = machine.side == Side::Off;
        if machine.radius_with_length && !off {
            machine.rules.length_picks_radius.ask(trace);
        }
        let offset = if off { 0 } else { machine.radius_offset };
        let value = if off { 0.0 } else { machine.radius_value(offset) };
        trace.push(Happening::CutterRadius { side: machine.side, offset, value });
    }
}

impl Machine {
    /// The length in force, with its sign.
    pub(super) fn length_value(&self) -> f64 {
        let tool = self.tools.get(&self.length_offset).copied().unwrap_or_default();
        let value = tool.length + tool.length_wear;
        match self.length_op {
            Op::LengthPlus => value,
            Op::LengthMinus => -value,
            _ => 0.0,
        }
    }

    /// Notes that the active tool matters: no source says which it is once tool 0 took the length away.
    pub(super) fn active_tool_asked(&self, trace: &mut Trace) {
        if self.rules.tool_word_selects_length.peek() && self.tool_ready != self.tool {
            trace.doubt("machine:tool.zero");
        }
    }

    /// The cutter radius of an offset.
    pub(super) fn radius_value(&self, offset: u32) -> f64 {
        let tool = self.tools.get(&offset).copied().unwrap_or_default();
        if !self.rules.shared_offsets {
            return tool.radius + tool.radius_wear;
        }
        // Where length and radius share a table, the one value is kept as a length.
        match self.rules.radius_table.peek() {
            RadiusTable::Radius => tool.length,
            RadiusTable::Diameter => tool.length / 2.0,
        }
    }

    /// What the end of the program does to the machine.
    pub fn end(&mut self, by: Op, trace: &mut Trace) {
        if self.length_op != Op::LengthOff && self.rules.end_cancels_length.peek() {
            self.length_op = Op::LengthOff;
            self.frame.length = 0.0;
        }
        self.spindle = Spindle::Stopped;
        self.coolant = Op::CoolantOff;
        trace.push(Happening::End { by });
    }
}
