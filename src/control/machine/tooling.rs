//! The tool, and compensation.

use super::motion::LENGTH_AXIS;
use super::rules::{BareChange, LengthAfter, RadiusTable};
use super::{Command, Machine};
use crate::canon::{Op, Pause, Role};
use crate::control::scenario::AXES;
use crate::control::trace::{EventKind, Side, Told, Trace};

/// Takes the codes and words of compensation.
pub(super) fn compensation(machine: &mut Machine, command: &Command, trace: &mut Trace) {
    if compensates(command) {
        let by_length = length_word_is_radius(machine, command, trace);
        if !by_length {
            length(machine, command, trace);
        }
        radius(machine, command, by_length, trace);
    }
}

/// True where the word of the tool length names the cutter radius: beside its code, where nothing else names one.
fn length_word_is_radius(machine: &Machine, command: &Command, trace: &mut Trace) -> bool {
    use Op::{LengthMinus, LengthOff, LengthPlus};
    let begins = command.has(Op::RadiusLeft) || command.has(Op::RadiusRight);
    let of_length = [LengthPlus, LengthMinus, LengthOff].into_iter().any(|op| command.has(op));
    let alone = command.word(Role::LengthOffset).is_some() && command.word(Role::RadiusOffset).is_none();
    begins && !of_length && alone && machine.rules.radius_by_length_word.ask(trace)
}

/// True where a block has a code or a word of compensation: most have none.
fn compensates(command: &Command) -> bool {
    use Op::{LengthMinus, LengthOff, LengthPlus, RadiusLeft, RadiusOff, RadiusRight};
    let is_code =
        |op: &Op| matches!(op, LengthPlus | LengthMinus | LengthOff | RadiusOff | RadiusLeft | RadiusRight);
    let is_word = |(role, _): &(Role, f64)| matches!(role, Role::LengthOffset | Role::RadiusOffset);
    command.ops.iter().any(is_code) || command.words.iter().any(is_word)
}

/// Takes the tool word.
pub(super) fn tool(machine: &mut Machine, command: &Command, trace: &mut Trace) {
    if machine.rules.lathe {
        return super::lathe::turret::index(machine, command, trace);
    }
    let Some(tool) = command.word(Role::Tool) else { return };
    let selects = machine.rules.tool_word_selects_length.peek();
    let by_word = machine.rules.tool_word_changes.peek();
    if by_word {
        machine.rules.tool_word_changes.ask(trace);
    }
    if selects && tool == 0.0 {
        // Tool 0 takes the length away; the tool stays where it is.
        machine.tool_ready = if by_word { tool } else { machine.tool_ready };
        machine.rules.tool_word_selects_length.ask(trace);
        machine.length_op = Op::LengthOff;
        return apply_length(machine, trace);
    }
    machine.tool_ready = tool;
    machine.tool_named = true;
    let coded = command.has(Op::ToolChange);
    if !by_word && !coded {
        trace.push(EventKind::ToolReady { tool });
    }
    // A code that changes to the tool of its block does so before the length of that tool counts.
    let by_code = !by_word && coded && selects;
    if by_code || by_word && (machine.tool != tool || machine.rules.tool_word_again.ask(trace)) {
        change(machine, trace);
    }
    if selects {
        machine.rules.tool_word_selects_length.ask(trace);
        machine.length_op = Op::LengthPlus;
        machine.length_offset = machine.tool_ready as u32;
        machine.length_named = true;
        apply_length(machine, trace);
    }
}

/// Puts the tool that is ready into the spindle.
pub(super) fn change(machine: &mut Machine, trace: &mut Trace) {
    let before = machine.tool;
    let named = std::mem::take(&mut machine.tool_named);
    if !named && machine.rules.bare_change.ask(trace) == BareChange::Pot {
        machine.tool_ready = machine.tool_back;
    }
    let same = machine.tool == machine.tool_ready;
    machine.tool = machine.tool_ready;
    machine.tool_back = before;
    machine.pause(Pause::Change, EventKind::ToolChange { tool: machine.tool }, trace);
    if same {
        trace.tell(Told::SameTool);
    }
    machine.may_lose_length(LostBy::Change, true);
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
        machine.length_named = true;
    }
    let begins = op.is_some_and(|op| op != Op::LengthOff);
    if begins && !machine.length_named && machine.rules.unnamed_length_is_tools.ask(trace) {
        machine.length_offset = machine.tool as u32;
    }
    let renewed = command.word(Role::LengthOffset).is_some() && machine.length_op != Op::LengthOff;
    if op.is_some() || renewed {
        let before = machine.frame.length;
        machine.stale_length = false;
        let lone = command.word(Role::Z).is_none();
        if lone {
            trace.lone_length();
        }
        apply_length(machine, trace);
        if machine.rules.length_moves && lone {
            let mut to = machine.position;
            to[LENGTH_AXIS] += machine.frame.length - before;
            match machine.motion {
                Op::Rapid => machine.rapid_to(to, trace),
                _ => machine.feed_to(to, trace),
            }
        }
    }
}

/// What cancels a length that the program did not end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LostBy {
    /// A return to the reference position.
    Reference,
    /// A move in machine coordinates.
    MachineMove,
    /// A tool change.
    Change,
}

/// A length that may be cancelled since the program named it.
#[derive(Clone, Copy, Debug)]
pub struct Lost {
    /// What may have done it last.
    pub by: LostBy,
    /// What may have done it before.
    pub before: [bool; 3],
    /// True if it did.
    pub gone: bool,
    /// True if the length's own axis was moved.
    pub along: bool,
}

impl Lost {
    /// True if this may have done it.
    pub fn may_be(&self, by: LostBy) -> bool {
        self.by == by || self.before[by as usize]
    }
}

fn apply_length(machine: &mut Machine, trace: &mut Trace) {
    machine.length_lost = None;
    let value = machine.length_value();
    machine.frame.length = value;
    let offset = if machine.length_op == Op::LengthOff { 0 } else { machine.length_offset };
    trace.push(EventKind::ToolLength { offset, value });
}

fn radius(machine: &mut Machine, command: &Command, by_length: bool, trace: &mut Trace) {
    let side = command.ops.iter().rev().find_map(|op| match op {
        Op::RadiusOff => Some(Side::Off),
        Op::RadiusLeft => Some(Side::Left),
        Op::RadiusRight => Some(Side::Right),
        _ => None,
    });
    let with_length = command.number(Role::LengthOffset).filter(|_| machine.rules.length_picks_radius.peek());
    let with_length = with_length.filter(|_| command.word(Role::RadiusOffset).is_none());
    let own = if by_length { Role::LengthOffset } else { Role::RadiusOffset };
    if let Some(number) = command.number(own).or(with_length) {
        machine.radius_offset = number;
        machine.radius_with_length = with_length.is_some();
    } else if side.is_some_and(|side| side != Side::Off) && machine.rules.cutter_takes_tool.peek() {
        machine.rules.cutter_takes_tool.ask(trace);
        machine.active_tool_asked(trace);
        machine.radius_offset = machine.tool as u32;
    }
    let named = command.word(own).is_some() || with_length.is_some();
    let renewed = named && machine.side != Side::Off;
    if let Some(side) = side.filter(|_| machine.rules.lathe) {
        return super::lathe::turret::nose(machine, side, trace);
    }
    if side.is_some() || renewed {
        let was_off = machine.side == Side::Off;
        machine.side = side.unwrap_or(machine.side);
        let off = machine.side == Side::Off;
        machine.side_switched |= was_off != off;
        if machine.radius_with_length && !off {
            machine.rules.length_picks_radius.ask(trace);
        }
        let offset = if off { 0 } else { machine.radius_offset };
        let value = if off { 0.0 } else { machine.radius_value(offset) };
        trace.push(EventKind::CutterRadius { side: machine.side, offset, value, tip: 0 });
    }
}

impl Machine {
    /// What a return, a move in machine coordinates or a tool change does to the tool length; `along` where it moved its axis.
    pub(super) fn may_lose_length(&mut self, by: LostBy, along: bool) {
        if self.length_op == Op::LengthOff {
            return;
        }
        let after = match by {
            LostBy::Reference => self.rules.length_after_reference.peek(),
            LostBy::MachineMove => self.rules.length_after_machine_move.peek(),
            LostBy::Change => self.rules.length_after_change.peek(),
        };
        let gone = after == LengthAfter::Cancelled || (after == LengthAfter::CancelledAlong && along);
        let before = self.length_lost.take();
        let was = |what: fn(&Lost) -> bool| before.as_ref().is_some_and(what);
        let (gone, along) = (gone || was(|lost| lost.gone), along || was(|lost| lost.along));
        let before = before.map_or([false; 3], |lost| {
            let mut before = lost.before;
            before[lost.by as usize] = true;
            before
        });
        self.length_lost = Some(Lost { by, before, gone, along });
        if gone {
            self.frame.length = 0.0;
        }
    }

    /// Notes what a length that may be lost rests on, where something is placed by it.
    pub(super) fn place_by_length(&mut self, trace: &mut Trace) {
        if std::mem::take(&mut self.stale_length) {
            self.rules.length_acts_at_once.ask(trace);
        }
        let Some(lost) = self.length_lost.take() else { return };
        match lost.by {
            LostBy::Reference => self.rules.length_after_reference.ask(trace),
            LostBy::MachineMove => self.rules.length_after_machine_move.ask(trace),
            LostBy::Change => self.rules.length_after_change.ask(trace),
        };
        if lost.gone {
            self.length_op = Op::LengthOff;
            trace.push(EventKind::ToolLength { offset: 0, value: 0.0 });
        }
    }

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

    /// Ends the local shift where the end of the program clears it.
    pub fn end_local(&mut self, by: Op) {
        if !matches!(by, Op::Return | Op::SubEnd) && self.rules.end_clears_local.peek() {
            self.frame.local = [0.0; AXES];
        }
    }

    /// What the end of the program does to the machine.
    pub fn end(&mut self, by: Op, trace: &mut Trace) {
        if !matches!(by, Op::Return | Op::SubEnd) {
            self.lathe.offset = 0;
            self.frame.tool = None;
        }
        if self.length_op != Op::LengthOff && self.rules.end_cancels_length.peek() {
            self.length_op = Op::LengthOff;
            self.frame.length = 0.0;
        }
        if self.frame.external != [0.0; AXES]
            && self.rules.local_is_external.peek()
            && self.rules.end_clears_local.ask(trace)
        {
            self.frame.external = [0.0; AXES];
        }
        if matches!(by, Op::Return | Op::SubEnd) {
            return trace.push(EventKind::End { by });
        }
        self.pause(Pause::End, EventKind::End { by }, trace);
    }
}
