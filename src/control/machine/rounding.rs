//! How far the rounding of words may have put the machine off.
//!
//! Words have a least increment. What a program computes for a word seldom is a whole number of it, so two
//! controls that get the same number may go to two places. Here is kept how far: nothing where all words
//! were whole increments, one rounding for each absolute word, the sum of them for incremental ones.

use super::command::{axis, is_rotary};
use super::{Command, Machine};
use crate::canon::{Op, Role};
use crate::control::scenario::AXES;
use crate::control::trace::Trace;
use crate::dialect::Control;

/// What lies nearer to a whole number of increments than this is one.
const WHOLE: f64 = 1e-9;

/// The least increments, and how far things may be off, millimetres or degrees.
#[derive(Clone, Debug)]
pub(super) struct Rounding {
    increment_mm: f64,
    increment_inch: f64,
    increment_degrees: f64,
    axes: [f64; AXES],
    /// The local shift, the set position, work offsets written, the shape (rotation, scale).
    frame: [f64; 4],
    /// The angle of a rotation, degrees.
    turn: f64,
    /// The planes and steps of the drilling cycle.
    pub cycle: f64,
    /// The plane that the cycle began at.
    initial: f64,
    /// A place that the program read, in its own units.
    pub read: f64,
}

impl Rounding {
    pub(super) fn new(control: &Control) -> Self {
        let numbers = control.numbers();
        Self {
            increment_mm: numbers.increment_mm,
            increment_inch: numbers.increment_inch,
            increment_degrees: numbers.increment_degrees,
            axes: [0.0; AXES],
            frame: [0.0; 4],
            turn: 0.0,
            cycle: 0.0,
            initial: 0.0,
            read: 0.0,
        }
    }
}

impl Machine {
    /// How far a word may be off, millimetres or degrees.
    fn off(&self, command: &Command, role: Role, value: f64) -> f64 {
        let turns = matches!(role, Role::Angle | Role::PolarAngle) || axis(role).is_some_and(is_rotary);
        let increment = if turns { self.rounding.increment_degrees } else { self.least_length() };
        if increment <= 0.0 || !value.is_finite() {
            return 0.0;
        }
        let unrolled = matches!(role, Role::Y | Role::StepY) && self.unrolls();
        let own = if unrolled { 0.0 } else { (value - (value / increment).round() * increment).abs() };
        let told = command.rounded.iter().filter(|(found, _)| *found == role).map(|(_, by)| *by);
        let off = told.fold(own, f64::max);
        match (off < WHOLE, turns) {
            (true, _) => 0.0,
            (false, true) => off,
            // It may be computed from a place that was read.
            (false, false) => (off + self.rounding.read) * self.unit(),
        }
    }

    /// The least increment of a length, in the units of the program.
    pub(super) fn least_length(&self) -> f64 {
        if self.inch { self.rounding.increment_inch } else { self.rounding.increment_mm }
    }

    /// The program reads a place: what it computes from that is as far off. One increment at the most is told, or it
    /// would grow without end in a loop.
    pub(super) fn round_read(&mut self) {
        let off = (self.off_by() / self.unit()).min(self.least_length());
        self.rounding.read = self.rounding.read.max(off);
    }

    /// The most that a length of a block may be off.
    pub(super) fn most_off(&self, command: &Command, of: impl Fn(Role) -> bool) -> f64 {
        let lengths = command.words.iter().filter(|(role, _)| role.is_length() && of(*role));
        lengths.map(|(role, value)| self.off(command, *role, *value)).fold(0.0, f64::max)
    }

    /// Takes in the words of a block that moves; what moves by it may be as far off as `trace` is told.
    pub(super) fn round_in(&mut self, command: &Command, trace: &mut Trace) {
        let before = self.off_by();
        let (reach, incremental) =
            (self.position.iter().fold(0.0f64, |a, b| a.max(b.abs())), self.incremental);
        for (role, value) in &command.words {
            let off = match (axis(*role), role) {
                (Some(_), _) | (_, Role::PolarDistance) => self.off(command, *role, *value),
                (_, Role::PolarAngle) => self.off(command, *role, *value).to_radians() * reach,
                _ => continue,
            };
            let by_itself = role.is_step() || command.steps.contains(role);
            let named = axis(*role).map(|axis| (axis, by_itself));
            for (at, kept) in self.rounding.axes.iter_mut().enumerate() {
                // A polar word moves both axes of the plane.
                if named.map_or(at < 3, |(axis, _)| axis == at) {
                    let adds = incremental || named.is_none_or(|(_, by_itself)| by_itself);
                    *kept = off + if adds { *kept } else { 0.0 };
                }
            }
        }
        let centre = self.most_off(command, |role| axis(role).is_none());
        // A rotation puts the far end of a move off farther than its start.
        let words = command.words.iter().filter(|(role, _)| axis(*role).is_some());
        let far = words.map(|(_, value)| value.abs() * self.unit()).fold(0.0, f64::max);
        let far = if incremental { self.reach() + far } else { far };
        trace.rounded = before.max(self.off_within(far)) + centre;
        if self.rounding.turn > 0.0 {
            // An axis that no word names was turned back and forth where the move began.
            let named = |at: usize| {
                let mut axes = command.words.iter().filter_map(|(role, _)| axis(*role));
                axes.any(|axis| axis == at)
            };
            let off = self.off_within(far) - self.rounding.frame.iter().sum::<f64>();
            (0..3).filter(|at| !named(*at)).collect::<Vec<_>>().into_iter().for_each(|at| {
                self.rounding.axes[at] = self.rounding.axes[at].max(off);
            });
        }
    }

    /// How far the rounding to a least increment puts a place of the program off that the control works out, millimetres.
    pub(super) fn off_place(&self, place: f64) -> f64 {
        let increment = self.least_length() * self.unit();
        if increment <= 0.0 || !place.is_finite() {
            return 0.0;
        }
        let off = (place - (place / increment).round() * increment).abs();
        if off < WHOLE { 0.0 } else { off }
    }

    /// An axis ends at a place that the control worked out, and that is so far off.
    pub(super) fn round_place(&mut self, axis: usize, off: f64) {
        if let Some(kept) = self.rounding.axes.get_mut(axis) {
            *kept = kept.max(off);
        }
    }

    /// Takes in the words of a block that sets the frame of coordinates.
    pub(super) fn round_frame(&mut self, op: Op, command: &Command) {
        use Op::{LocalShift, MirrorOn, RotateOff, RotateOn, ScaleOn, SetPosition, ShiftCancel, WriteWork};
        let is_of_frame = matches!(
            op,
            LocalShift | SetPosition | ShiftCancel | WriteWork | RotateOn | RotateOff | ScaleOn | MirrorOn
        );
        if !is_of_frame {
            return;
        }
        let off = self.most_off(command, |role| axis(role).is_some());
        let angle = command.word(Role::Angle).map_or(0.0, |angle| self.off(command, Role::Angle, angle));
        let there = self.rounding.axes.iter().fold(0.0f64, |most, axis| most.max(*axis));
        if op == Op::RotateOff && self.rounding.turn > 0.0 {
            // Where the rotation put the machine, it stays.
            let turned = self.off_by() - self.rounding.frame.iter().sum::<f64>();
            self.rounding.axes[..3].iter_mut().for_each(|kept| *kept = kept.max(turned));
        }
        let [local, set, work, shape] = &mut self.rounding.frame;
        match op {
            Op::LocalShift => *local = off,
            // The place that the machine is at counts from now on as the one that is said.
            Op::SetPosition => *set += off + there,
            Op::ShiftCancel => (*local, *set) = (0.0, 0.0),
            Op::WriteWork => *work = work.max(off),
            Op::RotateOn => (*shape, self.rounding.turn) = (off + there, angle),
            Op::RotateOff => self.rounding.turn = 0.0,
            Op::ScaleOn | Op::MirrorOn => *shape = shape.max(off + there),
            _ => {}
        }
    }

    /// A work offset is written: what is no whole number of increments may be computed from a place that was read.
    pub(super) fn round_written(&mut self, place: f64) {
        if self.off_place(place) > 0.0 {
            let read = self.rounding.read * self.unit();
            self.rounding.frame[2] = self.rounding.frame[2].max(read);
        }
    }

    /// Takes in the words of a drilling cycle.
    pub(super) fn round_cycle(&mut self, command: &Command, along: usize, begins: bool) {
        let across = |role: Role| axis(role).is_some_and(|axis| axis != along);
        let off = self.most_off(command, |role| !across(role));
        if begins {
            self.rounding.initial = self.rounding.axes[along];
        }
        self.rounding.cycle = if begins { off } else { self.rounding.cycle.max(off) };
    }

    /// A cycle left its axis on the retract plane.
    pub(super) fn round_at_r(&mut self, along: usize) {
        self.rounding.axes[along] = self.rounding.initial + 2.0 * self.rounding.cycle;
    }

    /// An axis stands where the machine knows.
    pub(super) fn round_home(&mut self, axis: usize) {
        self.rounding.axes[axis] = 0.0;
    }

    /// How far the machine may be off in any axis.
    pub(super) fn off_by(&self) -> f64 {
        self.off_within(0.0)
    }

    /// How far the machine stands from the zero of the program, along the axis where that is most, millimetres.
    fn reach(&self) -> f64 {
        let along = |axis: usize| (self.position[axis] - self.frame.shift(axis)).abs();
        (0..3).map(along).fold(0.0, f64::max)
    }

    /// How far it may be off on a move that goes as `far` from the zero of the program, millimetres.
    fn off_within(&self, far: f64) -> f64 {
        let Rounding { axes, frame, turn, .. } = &self.rounding;
        let mut off = axes.iter().fold(0.0f64, |most, axis| most.max(*axis));
        if off > 0.0 && self.frame.is_shaped() {
            let scale =
                self.frame.scale.map_or(1.0, |(factors, _)| factors.iter().fold(1.0, |a, b| b.abs().max(a)));
            // What is turned by 45 degrees is off by both of its parts.
            off *= scale * std::f64::consts::SQRT_2;
        }
        if *turn > 0.0 {
            let centre = self.frame.rotation.as_ref().map_or(0.0, |r| r.centre.0.abs().max(r.centre.1.abs()));
            // An axis that no word names is turned back by the angle first, and then turned again.
            let both = self.reach() + far.max(self.reach()) + 2.0 * centre;
            off += turn.to_radians() * both * std::f64::consts::SQRT_2;
        }
        off + frame.iter().sum::<f64>()
    }
}
