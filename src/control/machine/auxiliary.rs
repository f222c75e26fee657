//! Tool change, spindle and coolant: what a block does beside moving, with the start of its move or after it.

use super::lathe::holes::clamp_of;
use super::{Command, Machine, lathe, spoken, tooling};
use crate::canon::{Act, Auxiliary, Op, Role, Running};
use crate::control::trace::{Event, EventKind, Spindle, Told, Trace};
use std::collections::BTreeMap;

/// What counts of the machine before a block, to see whether the time at which something acts matters.
pub(super) struct Before {
    events: usize,
    turns: (Spindle, f64, bool),
    coolant: Op,
}

impl Before {
    pub(super) fn of(machine: &Machine, trace: &Trace) -> Self {
        Self { events: trace.events.len(), turns: turns(machine), coolant: machine.coolant }
    }
}

/// Does what acts with the start of the block's move, of some kinds.
pub(super) fn with_start(
    machine: &mut Machine,
    command: &Command,
    of: impl Fn(Auxiliary) -> bool,
    trace: &mut Trace,
) {
    act(machine, command, (false, of), trace);
}

/// True for a block with a builder's code that acts with the start of its move.
pub(super) fn starts_builders(machine: &Machine, command: &Command) -> bool {
    kinds(machine, command).any(|kind| kind == Auxiliary::Other)
        && !acts_late(machine, command, Auxiliary::Other)
}

/// Does what acts when the block's move is done.
pub(super) fn behind(machine: &mut Machine, command: &Command, before: &Before, trace: &mut Trace) {
    act(machine, command, (true, |_| true), trace);
    doubt(machine, command, before, trace);
    loosen(machine, before, trace);
}

/// The kinds of what a block does beside moving, in the order in which they act.
fn kinds<'c>(machine: &Machine, command: &'c Command) -> impl Iterator<Item = Auxiliary> + use<'c> {
    let by_word = changes_by_word(machine, command);
    let is = move |kind: &Auxiliary| match kind {
        // The word has changed it.
        Auxiliary::Change if by_word => false,
        Auxiliary::Speed => command.word(Role::Speed).is_some() && !starts(command),
        // What a builder's code does is told by its letter.
        Auxiliary::Other => is_builders(command) || of_kind(command, Auxiliary::Other).next().is_some(),
        kind => of_kind(command, *kind).next().is_some(),
    };
    Auxiliary::ALL.into_iter().filter(is)
}

/// True where the tool word has changed the tool before anything else of the block.
fn changes_by_word(machine: &Machine, command: &Command) -> bool {
    // The turret of a lathe turns by the word alone, wherever the code for a change stands.
    let by_word = machine.rules.tool_word_changes.peek() || machine.rules.tool_word_selects_length.peek();
    machine.rules.lathe || by_word && command.word(Role::Tool).is_some()
}

fn of_kind(command: &Command, kind: Auxiliary) -> impl Iterator<Item = Op> + '_ {
    command.ops.iter().copied().filter(move |op| op.auxiliary() == Some(kind))
}

fn is_builders(command: &Command) -> bool {
    command.own_code.as_ref().is_some_and(|code| code.starts_with('M'))
}

fn starts(command: &Command) -> bool {
    command.has(Op::SpindleCw) || command.has(Op::SpindleCcw)
}

fn acts_late(machine: &Machine, command: &Command, kind: Auxiliary) -> bool {
    let late = |kind| machine.rules.acts_late(kind).peek();
    // A tool in the changer does not turn: what starts waits for the change.
    let changes = command.has(Op::ToolChange) && !changes_by_word(machine, command);
    let waits = changes && late(Auxiliary::Change) && !kind.waits();
    waits || late(kind)
}

/// True where a block does nothing beside moving: most do not.
fn only_moves(command: &Command) -> bool {
    let acts = |(role, _): &(Role, f64)| matches!(role, Role::Speed | Role::Tool);
    let is_plain = command.own_code.is_none() && !command.words.iter().any(acts);
    is_plain && command.ops.iter().all(|op| op.auxiliary().is_none())
}

fn act(
    machine: &mut Machine,
    command: &Command,
    (late, of): (bool, impl Fn(Auxiliary) -> bool),
    trace: &mut Trace,
) {
    if only_moves(command) {
        return;
    }
    for kind in kinds(machine, command) {
        if acts_late(machine, command, kind) != late || !of(kind) {
            continue;
        }
        match kind {
            Auxiliary::Change => {
                machine.spoken.doubt();
                tooling::change(machine, trace);
            }
            Auxiliary::Speed if readies(machine, command) => {}
            Auxiliary::Speed => {
                spoken::again(machine, command, trace);
                turn(machine, command, machine.spindle, trace);
            }
            Auxiliary::Other => others(machine, command, trace),
            Auxiliary::Forward | Auxiliary::Start | Auxiliary::Stop => {
                for op in of_kind(command, kind) {
                    switch(machine, command, op, trace);
                }
            }
        }
    }
}

fn switch(machine: &mut Machine, command: &Command, op: Op, trace: &mut Trace) {
    let direction = match op {
        Op::SpindleCw => Spindle::Clockwise,
        Op::SpindleCcw => Spindle::CounterClockwise,
        Op::SpindleStop => Spindle::Stopped,
        Op::SpindleOrient => Spindle::Oriented,
        coolant => {
            // The one through the spindle ends alone, or goes on alone.
            let coolant = match coolant {
                _ if machine.coolant != Op::ThroughSpindle => coolant,
                Op::ThroughSpindleOff => Op::CoolantOff,
                Op::CoolantOff if machine.rules.through_stays => Op::ThroughSpindle,
                _ => coolant,
            };
            machine.coolant = coolant;
            machine.says_running(Running::Coolant, trace);
            return trace.push(EventKind::Coolant { state: coolant });
        }
    };
    if direction != Spindle::Oriented {
        machine.commanded = Some(direction);
    }
    machine.says_running(Running::Spindle, trace);
    machine.spoken.doubt();
    if starts(command) {
        lathe::engaging::by_start(machine, trace);
    }
    turn(machine, command, direction, trace);
}

fn others(machine: &mut Machine, command: &Command, trace: &mut Trace) {
    // Each code that switches an output brings the number of its own.
    let mut outputs = command.words.iter().filter(|(role, _)| *role == Role::Output);
    let mut acts = command.words.iter().filter(|(role, _)| *role == Role::Act);
    for &op in &command.ops {
        if op == Op::Act {
            if let Some(act) = acts.next().and_then(|(_, number)| Act::of(*number))
                && clamp_of(machine, command).is_none()
            {
                builders(machine, command, act, trace);
            }
            continue;
        }
        if matches!(op, Op::OutputOn | Op::OutputOff) {
            if let Some((_, number)) = outputs.next() {
                machine.switch_output(number.round() as u32, op == Op::OutputOn, trace);
            }
            continue;
        }
        if op.auxiliary() == Some(Auxiliary::Other) || (is_builders(command) && is_own(op)) {
            machine.spoken.doubt();
            trace.push(EventKind::Other { operation: op, code: command.own_code.clone() });
        }
    }
}

/// A builder's code that the profile names: the variables that it sets have what the machine puts there.
pub(super) fn builders(machine: &mut Machine, command: &Command, act: Act, trace: &mut Trace) {
    let words = command.words.iter().filter_map(|(role, value)| Some((act.word_name(*role)?, *value)));
    let words = words.filter(|(name, _)| !Act::is_dropped(name));
    let mut words: BTreeMap<String, f64> = words.collect();
    let surface = spoken::beside(machine, command, act, &mut words);
    if lathe::engaging::by_code(machine, act) {
        trace.push(EventKind::Act { name: act.name(), words, surface });
    }
    machine.answers(act);
}

/// True for the operations that only the code tells apart.
pub(super) fn is_own(op: Op) -> bool {
    matches!(op, Op::Builder | Op::MachineSpecific)
}

/// True where the code for rigid taps of a lathe, or S alone between taps that turn their tool by themselves, says the speed again that is
/// in force while the spindle stands (Q11, Q12).
fn readies(machine: &Machine, command: &Command) -> bool {
    let same = command.word(Role::Speed) == Some(machine.speed) && !machine.surface_speed;
    let between = command.has(Op::RigidTaps) || machine.lathe.has_tapped;
    between && machine.rules.lathe && same && machine.spindle == Spindle::Stopped
}

/// Turns the spindle, at the speed of the block where it has one.
fn turn(machine: &mut Machine, command: &Command, direction: Spindle, trace: &mut Trace) {
    if let Some(speed) = command.word(Role::Speed) {
        // Surface speed comes in metres or feet a minute.
        let unit = if machine.inch { 304.8 } else { 1000.0 };
        machine.speed = if machine.surface_speed { speed * unit } else { speed };
        machine.spoken.says(speed, machine.surface_speed);
        machine.lathe.speeds[usize::from(machine.surface_speed)] = machine.speed;
    }
    machine.spindle = direction;
    trace.push(EventKind::Spindle { direction, speed: machine.speed, surface: machine.surface_speed });
}

fn turns(machine: &Machine) -> (Spindle, f64, bool) {
    (machine.spindle, machine.speed, machine.surface_speed)
}

/// Notes that the time at which something acted matters: beside a cut everything that changed, beside any move the
/// tool and what the tables do not know.
fn doubt(machine: &mut Machine, command: &Command, before: &Before, trace: &mut Trace) {
    let events = trace.events.get(before.events..).unwrap_or_default();
    let (moves, cuts) = (events.iter().any(is_move), events.iter().any(is_cut));
    if !moves {
        return;
    }
    if cuts {
        machine.running_matters(trace);
    }
    if only_moves(command) {
        return;
    }
    for kind in kinds(machine, command) {
        let matters = match kind {
            Auxiliary::Change | Auxiliary::Other => true,
            _ => cuts && (turns(machine) != before.turns || machine.coolant != before.coolant),
        };
        if matters {
            machine.rules.acts_late(kind).ask(trace);
        }
    }
}

/// Marks what nobody could tell the time of: spindle and coolant beside a rapid move or a wait, where no source says it.
fn loosen(machine: &Machine, before: &Before, trace: &mut Trace) {
    let events = trace.events.get_mut(before.events..).unwrap_or_default();
    let idle = |event: &Event| matches!(event.what, EventKind::Rapid { .. } | EventKind::Dwell { .. });
    if !events.iter().any(idle) || events.iter().any(is_cut) {
        return;
    }
    for event in events {
        let kind = match event.what {
            EventKind::Spindle { direction: Spindle::Clockwise, .. } => Auxiliary::Forward,
            EventKind::Spindle { direction: Spindle::CounterClockwise, .. } => Auxiliary::Start,
            EventKind::Spindle { .. } => Auxiliary::Stop,
            EventKind::Coolant { state: Op::CoolantOff | Op::ThroughSpindleOff } => Auxiliary::Stop,
            EventKind::Coolant { .. } => Auxiliary::Start,
            _ => continue,
        };
        if machine.rules.acts_late(kind).is_unsure() && event.told == Told::Plain {
            event.told = Told::Loose;
        }
    }
}

fn is_move(event: &Event) -> bool {
    is_cut(event) || matches!(&event.what, EventKind::Rapid { from, to } if from != to)
}

fn is_cut(event: &Event) -> bool {
    use EventKind::{Arc, Feed, Hole, Probe, Thread};
    matches!(event.what, Feed { .. } | Arc { .. } | Thread { .. } | Probe { .. } | Hole { .. })
}
