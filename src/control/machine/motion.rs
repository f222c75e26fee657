//! Moves.

use super::command::is_rotary;
use super::frame::UnderIncremental;
use super::tooling::LostBy;
use super::{Command, Machine, arc, cycle, holes, inverse, lathe, places, pockets, returns};
use crate::canon::{Group, Op, Role};
use crate::control::outcome::Stop;
use crate::control::scenario::{AXES, Axes, Probe};
use crate::control::trace::{EventKind, Position, Trace};

/// The axis that tool lengths lie along.
pub(super) const LENGTH_AXIS: usize = 2;

/// The words for a corner, and whether they cut it off straight.
const CORNERS: [(Role, bool); 2] = [(Role::CornerRadius, false), (Role::CornerChamfer, true)];

pub(super) fn run(machine: &mut Machine, command: &Command, trace: &mut Trace) -> Result<(), Stop> {
    let elsewhere = places::elsewhere(machine, command);
    let command = elsewhere.as_ref().unwrap_or(command);
    let cuts = moves(machine, command, trace)?;
    if machine.rules.lathe {
        return Ok(());
    }
    let mut corners = CORNERS.iter().filter_map(|(role, chamfer)| Some((command.word(*role)?, *chamfer)));
    if let Some(corner) = corners.next() {
        let second = corners.next();
        if !cuts || second.is_some() {
            trace.doubt("machine:corner.elsewhere");
        }
        for (size, chamfer) in [Some(corner), second].into_iter().flatten().filter(|_| cuts) {
            trace.push(EventKind::Corner { chamfer, size: size * machine.unit() });
        }
    }
    Ok(())
}

/// Does what a block moves; true where it cuts along its path, so that a corner may follow.
fn moves(machine: &mut Machine, command: &Command, trace: &mut Trace) -> Result<bool, Stop> {
    if let Some(op) = command.of(Group::Motion) {
        machine.motion = op;
        machine.lathe.after_cycle = false;
        let arc_goes_on = |machine: &Machine, trace: &mut Trace| {
            op.is_arc() && !command.has(Op::CycleOff) && !machine.rules.arc_ends_cycle.ask(trace)
        };
        if machine.cycle.is_some()
            && machine.rules.motion_ends_cycle.ask(trace)
            && !arc_goes_on(machine, trace)
        {
            machine.cycle = None;
        }
    }
    lathe::pass::cross(machine, command);
    if lathe::way::follows(machine, command, trace)? {
        return Ok(true);
    }
    if command.has(Op::CycleOff) {
        machine.cycle = None;
    }
    let drills =
        machine.cycle.is_some() || command.ops.iter().any(|op| op.is_cycle()) || command.has(Op::CycleHere);
    if !drills && !takes_axes(command) {
        machine.round_in(command, trace);
    }
    for &op in &command.ops {
        match op {
            Op::ReferenceReturn => return returns::to(machine, command, 0, trace).map(|()| false),
            Op::Reference2 => {
                let which = returns::named(command)?;
                return returns::to(machine, command, which, trace).map(|()| false);
            }
            Op::Home => {
                let home = machine.references[0];
                machine.rapid_to(home, trace);
                return Ok(false);
            }
            Op::MachineOnce if machine.rules.lathe => {
                return lathe::zeros::in_machine_coordinates(machine, command, trace).map(|()| false);
            }
            Op::FaceGroove | Op::Groove => {
                return lathe::groove::run(machine, op, command, trace).map(|()| false);
            }
            Op::HolesCircle | Op::HolesArc | Op::HolesLine => {
                return holes::run(machine, op, command, trace).map(|()| false);
            }
            op if op.is_pocket() => return pockets::run(machine, op, command, trace).map(|()| false),
            Op::Threading => return lathe::thread::many(machine, command, trace).map(|()| false),
            Op::ReferenceFrom => {
                returns::from(machine, command, trace);
                return Ok(false);
            }
            Op::Probe | Op::ProbeOther => {
                probe(machine, command, trace);
                return Ok(false);
            }
            Op::MachineOnce => {
                in_machine_coordinates(machine, command, trace);
                return Ok(false);
            }
            Op::RotateOn if machine.cycle.is_some() && machine.rules.rotation_runs_cycle.ask(trace) => {
                return cycle::at_turned_place(machine, trace).map(|()| false);
            }
            _ => {}
        }
    }
    if takes_axes(command) {
        return Ok(false);
    }
    if machine.fresh_rotation && command.has_axes() {
        if machine.incremental {
            machine.rules.first_increments.ask(trace);
        }
        machine.fresh_rotation = machine.incremental;
    }
    machine.polar_matters(command, trace);
    if drills {
        return cycle::run(machine, command, trace).map(|()| false);
    }
    if machine.motion.is_pass() {
        return lathe::pass::run(machine, command, trace).map(|()| false);
    }
    let arc_words = [Role::ArcI, Role::ArcJ, Role::ArcK].iter().any(|role| command.word(*role).is_some());
    let arcs = matches!(machine.motion, Op::ArcCw | Op::ArcCcw);
    let polar = [Role::PolarDistance, Role::PolarAngle].iter().any(|role| command.word(*role).is_some());
    let goes = command.has_axes() || polar || (arcs && arc_words);
    if !goes {
        return Ok(false);
    }
    lathe::way::doubt_motion(machine, trace);
    // A drilling cycle counts its own repeats.
    let count = match command.number(Role::Repeat) {
        Some(count) if count != 1 && machine.rules.repeats_move.ask(trace) => count,
        _ => 1,
    };
    for turn in 0..count {
        if turn > 0 {
            machine.round_in(command, trace);
        }
        once(machine, command, trace)?;
        if trace.is_full() {
            break;
        }
    }
    Ok(machine.motion != Op::Rapid && !command.has(Op::RapidOnce))
}

/// The move of a block, once.
fn once(machine: &mut Machine, command: &Command, trace: &mut Trace) -> Result<(), Stop> {
    inverse::check(machine, command)?;
    let arcs = matches!(machine.motion, Op::ArcCw | Op::ArcCcw) && !command.has(Op::RapidOnce);
    if machine.side_switched && arcs && !machine.rules.radius_starts_on_arc.ask(trace) {
        return Err(Stop::unnamed("cutter compensation begins or ends on an arc"));
    }
    let (first, second, _) = machine.plane.axes();
    machine.side_switched &= !arcs && !command.axes().any(|(axis, _)| axis == first || axis == second);
    match machine.motion {
        _ if command.has(Op::RapidOnce) => {
            let to = machine.target(command);
            machine.rapid_to(to, trace);
        }
        Op::Rapid => {
            let to = machine.target(command);
            machine.rapid_to(to, trace);
        }
        Op::ArcCw | Op::ArcCcw => arc::run(machine, command, trace)?,
        Op::Thread | Op::ThreadVariable if machine.rules.lathe => {
            lathe::thread::single(machine, command, trace)?;
        }
        Op::Thread => {
            let (from, to) = (machine.position, machine.target(command));
            machine.position = to;
            let lead = command.word(Role::Lead).map_or(machine.feed, |lead| lead * machine.unit());
            trace.push(EventKind::Thread {
                from: Position(from),
                to: Position(to),
                lead,
                start: 0.0,
                change: 0.0,
                chamfer: None,
                chamfer_angle: None,
            });
        }
        other => {
            if other == Op::ArcTangent {
                trace.doubt("machine:arc.tangent");
            }
            let to = machine.target(command);
            machine.feed_to(to, trace);
        }
    }
    machine.keep_polar(command);
    Ok(())
}

/// True where the axis words of a block are not for moving.
fn takes_axes(command: &Command) -> bool {
    command.ops.iter().any(|op| {
        matches!(op, Op::LocalShift | Op::SetPosition | Op::WriteWork | Op::RotateOn | Op::ScaleOn)
            || matches!(op, Op::MirrorOn | Op::MirrorOff | Op::Pole | Op::Dwell)
            || *op == Op::WriteTurret
            || op.is_lathe_cycle()
            || op.is_lathe_setup()
    })
}

fn in_machine_coordinates(machine: &mut Machine, command: &Command, trace: &mut Trace) {
    let mut to = machine.position;
    let by_increments = machine.incremental && command.has_axes();
    let under = by_increments.then(|| machine.rules.under_incremental.ask(trace));
    for (axis, value) in machine.named_axes(command) {
        to[axis] = match under {
            None | Some(UnderIncremental::Place) => value,
            Some(UnderIncremental::Increments) => to[axis] + value,
            Some(UnderIncremental::Ignored) => return,
        };
    }
    let named = machine.named_axes(command);
    machine.may_lose_length(LostBy::MachineMove, named.iter().any(|(axis, _)| *axis == LENGTH_AXIS));
    if to == machine.position {
        return;
    }
    match machine.motion {
        Op::Rapid => machine.rapid_to(to, trace),
        _ if machine.rules.machine_move_is_rapid => machine.rapid_to(to, trace),
        _ => machine.feed_to(to, trace),
    }
}

fn probe(machine: &mut Machine, command: &Command, trace: &mut Trace) {
    let (from, aim) = (machine.position, machine.target(command));
    let (to, hit) = match machine.probes.next().unwrap_or(Probe::Miss) {
        Probe::Miss => (aim, false),
        Probe::At(at) => (at, true),
        Probe::Part(part) => {
            let part = part.clamp(0.0, 1.0);
            (std::array::from_fn(|axis| from[axis] + (aim[axis] - from[axis]) * part), true)
        }
    };
    machine.position = to;
    machine.probed = to;
    if let Some(point) = command.word(Role::ProbePoint) {
        machine.keep_touch_point(point.round().max(0.0) as u32);
    }
    trace.push(EventKind::Probe {
        from: Position(from),
        aim: Position(aim),
        to: Position(to),
        hit,
        feed: machine.feed,
    });
}

impl Machine {
    /// A rapid move; none if the machine is there.
    pub(super) fn rapid_to(&mut self, to: Axes, trace: &mut Trace) {
        let from = std::mem::replace(&mut self.position, to);
        if from != to {
            if self.rules.lathe {
                lathe::surface::line(self, &from, &to, trace);
            }
            trace.push(EventKind::Rapid { from: Position(from), to: Position(to) });
        }
    }

    /// A move at feed; none if the machine is there.
    pub(super) fn feed_to(&mut self, to: Axes, trace: &mut Trace) {
        let from = std::mem::replace(&mut self.position, to);
        if from != to {
            if self.rules.lathe {
                lathe::surface::line(self, &from, &to, trace);
                lathe::time::straight(self, &from, &to, trace);
            } else {
                self.pass(distance(&from, &to));
            }
            trace.push(EventKind::Feed {
                from: Position(from),
                to: Position(to),
                feed: self.feed,
                mode: self.feed_mode,
            });
        }
    }

    /// Lets the time pass that a feed move over so many millimetres takes.
    pub(super) fn pass(&mut self, millimetres: f64) {
        let per_minute = match self.feed_mode {
            super::FeedMode::PerMinute => self.feed,
            super::FeedMode::PerTurn => self.feed * self.speed,
            super::FeedMode::Inverse => self.feed * millimetres,
        };
        if per_minute > 0.0 {
            self.clock += millimetres / per_minute * 60_000.0;
        }
    }

    /// Machine position that the axis words of a block aim at.
    pub(super) fn target(&self, command: &Command) -> Axes {
        if self.polar.is_some() {
            return self.polar_target(command);
        }
        let unit = self.unit();
        if !self.frame.is_shaped() {
            let mut to = self.position;
            for (axis, value, by_itself) in command.places() {
                let value = if is_rotary(axis) { value } else { value * unit };
                to[axis] = self.by_word(axis, to[axis], (value, by_itself), self.frame.shift(axis));
            }
            return to;
        }
        let mut work = self.frame.program(&self.position);
        for (axis, value, by_itself) in command.places() {
            let value = if is_rotary(axis) { value } else { value * unit };
            work[axis] = self.by_word(axis, work[axis], (value, by_itself), 0.0);
        }
        self.frame.machine(&work)
    }
}

/// The length of a straight way over the linear axes, over all axes where only rotary ones move.
pub(super) fn distance(from: &Axes, to: &Axes) -> f64 {
    let over = |rotary: bool| {
        (0..AXES)
            .filter(|axis| is_rotary(*axis) == rotary)
            .map(|axis| (to[axis] - from[axis]).powi(2))
            .sum::<f64>()
            .sqrt()
    };
    let linear = over(false);
    if linear > 0.0 { linear } else { over(true) }
}
