//! Drilling cycles of a lathe, along Z or along X (Q5 to Q9).

use super::sense;
use crate::canon::{Act, Op, Role};
use crate::control::machine::auxiliary::builders;
use crate::control::machine::cycle::{Cycle, across};
use crate::control::machine::{Command, Machine, expand};
use crate::control::outcome::Stop;
use crate::control::trace::{FeedMode, Spindle, Trace};

/// The axes that holes go along, as places in a position.
const ALONG_X: usize = 0;
const ALONG_Z: usize = 2;

/// Drills, if the block asks for it, at each of the places that its repeats come to.
pub fn run(machine: &mut Machine, command: &Command, trace: &mut Trace) -> Result<(), Stop> {
    let begins = command.ops.iter().rev().copied().find(|op| op.is_cycle());
    let Some(op) = begins.or(machine.cycle()) else {
        return Err(Stop::unnamed("no drilling cycle is in force"));
    };
    let along = if op.is_side_hole() { ALONG_X } else { ALONG_Z };
    let places = command.axes().any(|(axis, _)| axis != along);
    let depths = [Role::CycleR, Role::CycleRStep].iter().any(|role| command.word(*role).is_some())
        || command.axes().any(|(axis, _)| axis == along);
    if begins.is_none() && !places && !depths {
        return Ok(());
    }
    check(machine, command, op)?;
    if begins.is_some() {
        let height = machine.frame.program(&machine.position)[along];
        machine.cycle.get_or_insert_with(|| Cycle::new(op, height)).op = op;
    }
    read(machine, command, along, trace);
    machine.round_cycle(command, along, begins.is_some());
    machine.round_in(&across(command, along), trace);
    trace.doubt("machine:lathe.hole.moves");
    let clamp = clamp_of(machine, command);
    if clamp.is_some() {
        machine.rules.hole_clamp_acts.ask(trace);
    }
    for turn in 0..command.number(Role::Repeat).unwrap_or(1) {
        if turn > 0 {
            machine.round_in(&across(command, along), trace);
        }
        let mut to = machine.target(&across(command, along));
        to[along] = machine.position[along];
        machine.rapid_to(to, trace);
        if let Some([clamps, _]) = clamp {
            builders(machine, command, clamps, trace);
        }
        hole(machine, (along, clamp.map(|[_, frees]| (command, frees))), trace)?;
        if trace.is_full() {
            break;
        }
    }
    Ok(())
}

/// What clamps the C axis for the hole of a block, and what lets it go, if the block has that code and drills (Q8).
pub(in crate::control::machine) fn clamp_of(machine: &Machine, command: &Command) -> Option<[Act; 2]> {
    let [Some(clamps), Some(frees)] = machine.rules.hole_clamp else { return None };
    let drills = command.ops.iter().copied().chain(machine.cycle()).any(Op::is_hole);
    let mut acts = command.words.iter().filter(|(role, _)| *role == Role::Act);
    let own = acts.next().and_then(|(_, number)| Act::of(*number)) == Some(clamps);
    let places = command.axes().next().is_some() || command.ops.iter().any(|op| op.is_hole());
    (drills && places && own && acts.next().is_none()).then_some([clamps, frees])
}

/// What is refused (Q8).
fn check(machine: &Machine, command: &Command, op: Op) -> Result<(), Stop> {
    let refused = |what: &str| Err(Stop::unnamed(what));
    if !op.is_hole() {
        return refused("a drilling cycle that the emulated lathe does not run");
    }
    let beside = |op: &Op| {
        let clamps = *op == Op::Act && clamp_of(machine, command).is_some();
        let own =
            matches!(op, Op::Stop | Op::OptionalStop | Op::Builder | Op::MachineSpecific | Op::RigidTaps);
        !clamps && (own || op.auxiliary().is_some())
    };
    if command.ops.iter().any(beside) || command.word(Role::Turret).is_some() {
        return refused("an M code or a tool word in a drilling block");
    }
    if machine.cycle().is_some_and(|before| before.is_side_hole() != op.is_side_hole()) {
        return refused("a drilling cycle along one axis while one along the other is in force");
    }
    if op.is_live_tap() && machine.feed_mode != FeedMode::PerTurn {
        return refused("a tap of a live tool while F is a feed a minute");
    }
    if op.is_live_tap() && machine.speed <= 0.0 {
        return refused("a tap of a live tool without a speed");
    }
    if command.number(Role::Repeat) == Some(0) {
        return refused("a drilling cycle with no repeats");
    }
    let step = if op.is_side_hole() { Role::StepX } else { Role::StepZ };
    let absolute = command.word(Role::CycleR).is_some()
        || machine.cycle.as_ref().and_then(|cycle| cycle.r).is_some_and(|(_, by_step)| !by_step);
    if absolute && command.word(step).is_some() {
        return refused("a depth as an increment, where the retract plane is a place");
    }
    Ok(())
}

/// Takes the block's words; those it does not have stay, but for a peck of a code that drills without it too (Q7).
fn read(machine: &mut Machine, command: &Command, along: usize, trace: &mut Trace) {
    let (unit, incremental) = (machine.unit(), machine.incremental);
    // A radius is half of the coordinate.
    let radius = unit / machine.real(along);
    let Some(cycle) = &mut machine.cycle else { return };
    if let Some(step) = command.word(Role::CycleRStep) {
        cycle.r = Some((step * radius, true));
    }
    if let Some(place) = command.word(Role::CycleR) {
        cycle.r = Some((place * unit, false));
    }
    if let Some((_, depth, step)) = command.places().filter(|(axis, ..)| *axis == along).last() {
        cycle.z = Some((depth * unit, step || incremental));
        machine.lathe.hole_by_mode = (!step).then_some(incremental);
    }
    let peck = command.word(Role::CycleQ).map(|peck| peck * radius);
    let one_code = matches!(cycle.op, Op::FaceHole | Op::SideHole);
    let asks = one_code && peck.is_none() && cycle.peck.is_some_and(|peck| peck != 0.0);
    let lasts = matches!(cycle.op, Op::FacePeck | Op::SidePeck)
        || asks && machine.rules.turning.peck_lasts.ask(trace);
    cycle.peck = peck.or(cycle.peck.filter(|_| lasts));
    // On a control whose P lasts across codes a cycle without one takes the last (S10).
    let last = machine.lathe.last_dwell.filter(|_| cycle.op.is_waiting_hole()).unwrap_or(cycle.dwell);
    cycle.dwell = command.word(Role::CycleDwell).map_or(last, |ms| ms / 1000.0);
    machine.lathe.last_dwell =
        command.word(Role::CycleDwell).map(|ms| ms / 1000.0).or(machine.lathe.last_dwell);
    cycle.without_dwell = command.without_dwell;
}

/// Drills at the present place; a clamp is let go at the plane.
fn hole(
    machine: &mut Machine,
    (along, frees): (usize, Option<(&Command, Act)>),
    trace: &mut Trace,
) -> Result<(), Stop> {
    let Some(mut cycle) = machine.cycle.clone() else { return Ok(()) };
    let mut planes = cycle.planes(None).ok_or_else(|| Stop::unnamed("a drilling cycle without its depth"))?;
    if cycle.without_dwell {
        cycle.dwell = 0.0;
    }
    if machine.lathe.hole_by_mode.is_some_and(|by_mode| by_mode != machine.incremental) {
        machine.rules.planes_frozen.ask(trace);
    }
    let (main, live) = (machine.spindle, cycle.op.is_live_tap());
    let stood = cycle.op.is_tap() && main == Spindle::Stopped;
    if live {
        // The tool stands until the cycle turns it.
        machine.spindle = Spindle::Stopped;
    }
    cycle.op = way(machine, &cycle, trace)?;
    cycle.clear = Some(machine.peck_clearance / machine.real(along));
    let told_as_place = cycle.r.is_some_and(|(_, by_step)| !by_step);
    if told_as_place && sense(planes.initial - planes.r) == sense(planes.bottom - planes.r) {
        // It began below the plane, and ends at it (Q9).
        planes.initial = planes.r;
    }
    let initial = planes.initial;
    if frees.is_some() {
        planes.initial = planes.r;
    }
    expand::hole(machine, &cycle, (planes, along), trace);
    if let Some((command, act)) = frees {
        builders(machine, command, act, trace);
        if !machine.return_to_r {
            let mut to = machine.position;
            to[along] += initial - planes.initial;
            machine.rapid_to(to, trace);
        }
    }
    if live || stood {
        // The spindle that turns the part is where it was; one that a tap has turned by itself stands again.
        machine.spindle = main;
        machine.lathe.has_tapped = true;
    }
    Ok(())
}

/// What the cycle does, as the cycles of all controls are called.
fn way(machine: &Machine, cycle: &Cycle, trace: &mut Trace) -> Result<Op, Stop> {
    let peck = cycle.peck.is_some_and(|peck| peck != 0.0);
    Ok(match cycle.op {
        Op::FaceTap | Op::FaceTapMain | Op::FaceTapLive | Op::SideTap | Op::SideTapLive => Op::CycleTap,
        Op::FaceTapMainLeft | Op::FaceTapLiveLeft | Op::SideTapLiveLeft => Op::CycleTapLeft,
        Op::FaceBore | Op::SideBore => Op::CycleBore,
        Op::FaceBoreDwell | Op::SideBoreDwell => Op::CycleBoreDwell,
        Op::FaceBoreStop | Op::SideBoreStop => Op::CycleBoreStop,
        Op::FacePeck | Op::SidePeck if !peck => {
            return Err(Stop::unnamed("a drilling cycle in pecks without a peck"));
        }
        Op::FaceHole | Op::SideHole | Op::FacePeck | Op::SidePeck if peck => {
            match machine.rules.pecks_to_plane.ask(trace) {
                true => Op::CyclePeck,
                false => Op::CycleChipBreak,
            }
        }
        _ => Op::CycleDrill,
    })
}

impl Machine {
    /// Takes the P of a call, which is the last P of any code: a wait where P lasts across codes (S10), unless P
    /// of a call is none.
    pub(in crate::control) fn last_wait(&mut self, milliseconds: f64) {
        if !self.rules.turning.calls_are_no_wait {
            self.lathe.last_dwell = Some(milliseconds / 1000.0);
        }
    }
}
