//! The state that a program finds on the machine.

use super::cycle::Cycle;
use super::frame::Rotation;
use super::tooling::LostBy;
use super::{Machine, Op};
use crate::canon::Running;
use crate::control::entry::{Drilling, Entry};
use crate::control::scenario::AXES;
use crate::control::trace::{EventKind, FeedMode, Plane, Side, Spindle, Told, Trace};

impl Machine {
    /// Starts in a mode that a caller, or an earlier program, left.
    pub(super) fn start_in(&mut self, op: Op) {
        match op {
            Op::Rapid | Op::Linear | Op::ArcCw | Op::ArcCcw => self.motion = op,
            Op::Absolute => self.incremental = false,
            Op::Incremental => self.incremental = true,
            Op::PlaneXy => self.plane = Plane::Xy,
            Op::PlaneZx => self.plane = Plane::Zx,
            Op::PlaneYz => self.plane = Plane::Yz,
            Op::FeedPerMinute => self.feed_mode = FeedMode::PerMinute,
            Op::FeedPerTurn => self.feed_mode = FeedMode::PerTurn,
            Op::FeedInverse => self.feed_mode = FeedMode::Inverse,
            Op::ReturnInitial => self.return_to_r = false,
            Op::ReturnR => self.return_to_r = true,
            Op::ExactStop | Op::CuttingMode => self.path_mode = op,
            op => self.name_unit(op),
        }
    }

    /// Starts with what an earlier program left in force.
    pub(super) fn enter(&mut self, entry: &Entry) {
        let cancels = self.rules.cancels_offsets;
        self.select(entry.work.filter(|number| *number > 0 || cancels).unwrap_or(1));
        self.feed = entry.feed.unwrap_or(self.feed);
        if let Some(speed) = entry.spindle {
            self.speed = speed;
            self.spindle = if entry.clockwise { Spindle::Clockwise } else { Spindle::CounterClockwise };
        }
        if entry.coolant {
            self.coolant = entry.coolant_kind.unwrap_or(Op::Flood);
        }
        if let Some(number) = entry.length {
            self.length_op = if entry.length_minus { Op::LengthMinus } else { Op::LengthPlus };
            self.length_offset = number;
            self.length_named = true;
            self.frame.length = self.length_value();
            let lost = [
                (entry.length_lost, LostBy::Reference),
                (entry.length_moved, LostBy::MachineMove),
                (entry.length_changed, LostBy::Change),
            ];
            for (_, by) in lost.into_iter().filter(|(is_so, _)| *is_so) {
                self.may_lose_length(by, !entry.length_across);
            }
        }
        if let Some(number) = entry.cutter {
            self.side = if entry.cutter_right { Side::Right } else { Side::Left };
            self.radius_offset = number;
        }
        self.shape(entry);
        if let Some(drilling) = entry.cycle {
            let height = self.frame.program(&self.position)[2];
            self.cycle = Some(Cycle::drilling(height, drilling));
        }
    }

    fn shape(&mut self, entry: &Entry) {
        self.frame.local = entry.local.unwrap_or_default();
        self.frame.rotation =
            entry.rotation.map(|degrees| Rotation { axes: (0, 1), centre: (0.0, 0.0), degrees });
        self.frame.scale = entry.scale.map(|by| {
            let factors = std::array::from_fn(|axis| if axis < 3 { by } else { 1.0 });
            (factors, [0.0; AXES])
        });
        if entry.mirror {
            self.frame.mirror[0] = Some(0.0);
        }
    }

    /// Tells what of it an observer of the machine sees from the start.
    pub fn tell_entry(&self, entry: &Entry, trace: &mut Trace) {
        let cutter = || EventKind::CutterRadius {
            side: self.side,
            offset: self.radius_offset,
            value: self.radius_value(self.radius_offset),
            tip: 0,
        };
        let (direction, speed, surface) = (self.spindle, self.speed, self.surface_speed);
        let told = [
            entry.work.map(|_| EventKind::WorkOffset { number: self.frame.number }),
            entry.length.map(|offset| EventKind::ToolLength { offset, value: self.length_value() }),
            entry.cutter.map(|_| cutter()),
            entry.spindle.map(|_| EventKind::Spindle { direction, speed, surface }),
            entry.coolant.then_some(EventKind::Coolant { state: self.coolant }),
        ];
        for what in told.into_iter().flatten() {
            trace.push(what);
            trace.tell(Told::Found);
        }
    }

    /// What a called program finds now. What nobody knows to run is left out, and so is a spindle at a surface speed.
    pub fn in_force(&self, open: [bool; 2]) -> Entry {
        let runs = |running: Running| self.is_running(running) && !open[running as usize];
        let turns = runs(Running::Spindle) && !self.surface_speed;
        let coolant = runs(Running::Coolant);
        let lost = |by| self.length_lost.is_some_and(|lost| lost.may_be(by));
        let has_length = self.length_op != Op::LengthOff;
        let cycle = self.cycle.as_ref().and_then(|cycle| cycle.planes(None));
        Entry {
            work: self.has_no_offset().then_some(0),
            length: has_length.then_some(self.length_offset),
            length_minus: self.length_op == Op::LengthMinus,
            length_lost: lost(LostBy::Reference),
            length_moved: lost(LostBy::MachineMove),
            length_changed: lost(LostBy::Change),
            length_across: self.length_lost.is_some_and(|lost| !lost.along),
            cutter: (self.side != Side::Off).then_some(self.radius_offset),
            cutter_right: self.side == Side::Right,
            feed: (self.feed > 0.0).then_some(self.feed),
            spindle: turns.then_some(self.speed),
            clockwise: turns && self.spindle == Spindle::Clockwise,
            coolant,
            coolant_kind: Some(self.coolant).filter(|op| coolant && *op != Op::Flood),
            cycle: cycle.map(|planes| Drilling { retract: planes.r, bottom: planes.bottom }),
            ..Entry::default()
        }
    }

    /// The feed in force, in the units of the program.
    pub fn feed(&self) -> f64 {
        self.feed / self.unit()
    }
}
