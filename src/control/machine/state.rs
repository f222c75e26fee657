//! Modes: units, planes, distance, feed, and the frames of coordinates.

use super::frame::Rotation;
use super::{Command, INCH, Machine};
use crate::canon::{Group, Op, Role};
use crate::control::scenario::{AXES, Axes};
use crate::control::trace::{EventKind, FeedMode, Plane, Trace};

/// Modes that the rest of the block is read by.
pub(super) fn modes(machine: &mut Machine, command: &Command, trace: &mut Trace) {
    for &op in &command.ops {
        machine.lathe.feed_mode_told |= op.group() == Group::FeedMode;
        match op {
            Op::Inch | Op::Metric => machine.name_unit(op),
            Op::PlaneXy => machine.plane = Plane::Xy,
            Op::PlaneZx => machine.plane = Plane::Zx,
            Op::PlaneYz => machine.plane = Plane::Yz,
            Op::Absolute => machine.incremental = false,
            Op::Incremental => machine.incremental = true,
            Op::FeedPerMinute => machine.feed_mode = FeedMode::PerMinute,
            Op::FeedPerTurn => machine.feed_mode = FeedMode::PerTurn,
            Op::FeedInverse => machine.feed_mode = FeedMode::Inverse,
            Op::ReturnInitial => machine.return_to_r = false,
            Op::ReturnR => machine.return_to_r = true,
            Op::SurfaceSpeed | Op::TurnsPerMinute if machine.rules.lathe => {
                machine.change_speed_mode(op == Op::SurfaceSpeed, command, trace);
            }
            Op::SurfaceSpeed => machine.surface_speed = true,
            Op::TurnsPerMinute => machine.surface_speed = false,
            Op::PolarOn => machine.polar = Some(super::polar::Words::default()),
            Op::PolarOff => machine.polar = None,
            _ if op.group() == Group::PathMode && machine.path_mode != op => {
                machine.path_mode = op;
                trace.push(EventKind::Other { operation: op, code: None });
            }
            Op::AxisGain | Op::PathQuality => trace.push(EventKind::Other { operation: op, code: None }),
            Op::PlaneOther | Op::Wrap => trace.doubt("machine:plane"),
            _ => {}
        }
    }
    if let Some(lead) = command.word(Role::Lead).filter(|_| machine.rules.lathe) {
        // The lead of a thread is its feed, and stays in force as the feed.
        machine.feed = lead * machine.unit();
    }
    if let Some(count) = command.word(Role::ThreadsPerInch).filter(|count| *count > 0.0) {
        machine.feed = INCH / count;
    }
    per_inch(machine, command, trace);
    if let Some(feed) = command.word(Role::Feed) {
        let scale = if machine.inch && machine.feed_mode != FeedMode::Inverse { INCH } else { 1.0 };
        machine.feed = feed * scale;
        machine.feed_by_turn = machine.feed_mode == FeedMode::PerTurn;
    }
}

/// Notes a cut by the feed that threads an inch have left (M4).
fn per_inch(machine: &mut Machine, command: &Command, trace: &mut Trace) {
    let says = |roles: &[Role]| roles.iter().any(|role| command.word(*role).is_some());
    if says(&[Role::Feed, Role::Lead]) {
        machine.lathe.per_inch = false;
    }
    machine.lathe.per_inch |= says(&[Role::ThreadsPerInch]);
    let motion = command.of(Group::Motion).unwrap_or(machine.motion);
    let cuts = matches!(motion, Op::Linear | Op::ArcCw | Op::ArcCcw) && command.has_axes();
    if machine.lathe.per_inch && cuts {
        trace.doubt("machine:lathe.feed.after.threads");
    }
}

/// Selects and shapes the frame of coordinates.
pub(super) fn frames(machine: &mut Machine, command: &Command, trace: &mut Trace) {
    if command.ops.iter().any(|op| super::polar::ends_words(*op)) {
        machine.polar = machine.polar.map(|_| super::polar::Words::default());
    }
    for &op in &command.ops {
        machine.round_frame(op, command);
        match op {
            Op::SelectWork => {
                let number = command.number(Role::WorkOffset).unwrap_or(machine.frame.number);
                machine.select(number);
                trace.push(EventKind::WorkOffset { number });
            }
            Op::ShiftCancel => {
                machine.select(0);
                machine.frame.local = [0.0; AXES];
                machine.frame.datum = [0.0; AXES];
                trace.push(EventKind::WorkOffset { number: 0 });
            }
            Op::LocalShift => {
                for (axis, value) in machine.named_axes(command) {
                    machine.frame.local[axis] = value;
                    if machine.rules.local_is_external.peek() {
                        machine.frame.external[axis] = 0.0;
                    }
                }
            }
            Op::SetPosition => {
                let at = machine.frame.program(&machine.position);
                if machine.rules.lathe && machine.incremental && command.has_axes() {
                    trace.doubt("machine:lathe.position.steps");
                }
                for (axis, value) in machine.named_places(command, &at) {
                    machine.frame.datum[axis] += at[axis] - value;
                    if machine.frame.local[axis] != 0.0 && machine.rules.set_position_ends_local.ask(trace) {
                        machine.frame.datum[axis] += std::mem::take(&mut machine.frame.local[axis]);
                    }
                }
            }
            Op::RotateOn => rotate(machine, command, trace),
            Op::RotateOff => {
                machine.frame.rotation = None;
                machine.fresh_rotation = false;
            }
            Op::MirrorOn => {
                for (axis, value) in machine.named_axes(command) {
                    if machine.rules.mirrors_by_sign {
                        machine.frame.mirror[axis] = (value < 0.0).then_some(0.0);
                        continue;
                    }
                    let by_word = value == 0.0 || machine.rules.mirrors_about_word.ask(trace);
                    machine.frame.mirror[axis] = Some(if by_word { value } else { 0.0 });
                }
            }
            Op::MirrorOff => {
                let axes = machine.named_axes(command);
                let named = |axis: usize| axes.iter().any(|(named, _)| *named == axis);
                let left = (0..AXES).any(|axis| machine.frame.mirror[axis].is_some() && !named(axis));
                if axes.is_empty() && left {
                    machine.rules.mirror_off_bare.ask(trace);
                }
                let all = axes.is_empty() || left && !machine.rules.mirror_off_names.ask(trace);
                for axis in (0..AXES).filter(|axis| all || named(*axis)) {
                    machine.frame.mirror[axis] = None;
                }
            }
            Op::ScaleOn => scale(machine, command, trace),
            Op::ScaleOff => machine.frame.scale = None,
            _ => {}
        }
    }
}

fn rotate(machine: &mut Machine, command: &Command, trace: &mut Trace) {
    let (first, second, _) = machine.plane.axes();
    machine.unturned = machine.frame.program(&machine.position);
    let before = machine.frame.rotation.take().map(|turned| turned.degrees);
    machine.fresh_rotation = command.has_axes();
    let mut centre = machine.frame.program(&machine.position);
    let from_tool = machine.incremental && command.has_axes() && machine.rules.centre_from_tool.ask(trace);
    for (axis, value) in machine.named_axes(command) {
        centre[axis] = if from_tool { centre[axis] + value } else { value };
    }
    let [bare_angle, _] = machine.rules.bare_shapes;
    let angle = command.word(Role::Angle).or(bare_angle);
    if angle.is_none() {
        trace.doubt("machine:shape.from.setting");
    }
    let angle = angle.unwrap_or(0.0);
    let mut degrees = if machine.rules.rotation_is_ccw.ask(trace) { angle } else { -angle };
    if machine.incremental
        && let Some(before) = before.filter(|_| machine.rules.rotation_adds.ask(trace))
    {
        degrees += before;
    }
    let centre = (centre[first], centre[second]);
    machine.frame.rotation = Some(Rotation { axes: (first, second), centre, degrees });
}

fn scale(machine: &mut Machine, command: &Command, trace: &mut Trace) {
    let mut centre = machine.frame.program(&machine.position);
    for (axis, value) in machine.named_axes(command) {
        centre[axis] = value;
    }
    let [_, bare_factor] = machine.rules.bare_shapes;
    let of_axes = [Role::ScaleX, Role::ScaleY, Role::ScaleZ].iter().any(|role| command.word(*role).is_some());
    let factor = command.word(Role::Scale).or(bare_factor.filter(|_| !of_axes)).unwrap_or(1.0);
    let mut factors = [1.0; AXES];
    for (own, role) in factors.iter_mut().zip([Role::ScaleX, Role::ScaleY, Role::ScaleZ]) {
        *own = command.word(role).unwrap_or(factor);
    }
    if command.word(Role::Scale).is_none() && bare_factor.is_none() && factors == [1.0; AXES] {
        trace.doubt("machine:shape.from.setting");
    }
    machine.frame.scale = Some((factors, centre));
}

impl Machine {
    /// Selects a work offset without a trace.
    pub(super) fn select(&mut self, number: u32) {
        self.frame.number = number;
        self.stale = false;
        self.frame.work = self.work_offsets.get(&number).copied().unwrap_or([0.0; AXES]);
    }

    /// True if all zero shifts are cancelled.
    pub fn has_no_offset(&self) -> bool {
        self.frame.number == 0
    }

    /// The same, where an increment counts from a place: by its letter, or on a lathe by the mode (Z6).
    fn named_places(&self, command: &Command, at: &Axes) -> Vec<(usize, f64)> {
        let unit = |axis| if super::command::is_rotary(axis) { 1.0 } else { self.unit() };
        let places = command.places();
        let place = |(axis, value, steps): (usize, f64, bool)| {
            let steps = steps || self.rules.lathe && self.incremental;
            (axis, value * unit(axis) + if steps { at[axis] } else { 0.0 })
        };
        places.map(place).collect()
    }

    /// The axis words of a block, lengths in millimetres.
    pub(super) fn named_axes(&self, command: &Command) -> Vec<(usize, f64)> {
        let unit = |axis| if super::command::is_rotary(axis) { 1.0 } else { self.unit() };
        command.axes().map(|(axis, value)| (axis, value * unit(axis))).collect()
    }
}
