//! The state that a program finds on the machine.

use super::cycle::Cycle;
use super::frame::Rotation;
use super::tooling::LostBy;
use super::{Machine, Op};
use crate::control::entry::Entry;
use crate::control::scenario::AXES;
use crate::control::trace::{FeedMode, Happening, Plane, Side, Spindle, Told, Trace};

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
            (self.spindle, self.speed) = (Spindle::CounterClockwise, speed);
        }
        if entry.coolant {
            self.coolant = Op::Flood;
        }
        if let Some(number) = entry.length {
            (self.length_op, self.length_offset) = (Op::LengthPlus, number);
            self.frame.length = self.length_value();
            if entry.length_lost {
                self.may_lose_length(LostBy::Reference, true);
            }
        }
        if let Some(number) = entry.cutter {
            (self.side, self.radius_offset) = (Side::Left, number);
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
        let cutter = || Happening::CutterRadius {
            side: self.side,
            offset: self.radius_offset,
            value: self.radius_value(self.radius_offset),
        };
        let (direction, speed, surface) = (self.spindle, self.speed, self.surface_speed);
        let told = [
            entry.work.map(|_| Happening::WorkOffset { number: self.frame.number }),
            entry.length.map(|offset| Happening::ToolLength { offset, value: self.length_value() }),
            entry.cutter.map(|_| cutter()),
            entry.spindle.map(|_| Happening::Spindle { direction, speed, surface }),
            entry.coolant.then_some(Happening::Coolant { state: self.coolant }),
        ];
        for what in told.into_iter().flatten() {
            trace.push(what);
            trace.tell(Told::Found);
        }
    }

    /// The feed in force, in the units of the program.
    pub fn feed(&self) -> f64 {
        self.feed / self.unit()
    }
}
