//! The moves of a drilling cycle at one hole.

use super::Machine;
use super::cycle::{Cycle, Planes};
use super::rigid::Rigid;
use super::rules::{Fact, fact};
use crate::canon::Op;
use crate::control::scenario::Axes;
use crate::control::trace::{EventKind, FeedMode, Position, Spindle, Told, Trace};
use crate::dialect::{Control, Question, matters};

/// The way of a boring cycle's shift: what was tried on the machine counts where no setting says it.
pub(super) fn shift_of(control: &Control) -> Fact<(bool, f64)> {
    let read = |value: &str| Some((value.starts_with('y'), if value.ends_with('-') { -1.0 } else { 1.0 }));
    let tried = control.has_tried(matters::SHIFT);
    let known = |value: &str| if value == "unknown" { None } else { read(value) };
    let found = fact(control, Question::CycleShift, known, (false, 1.0));
    Fact { unsure: found.unsure.filter(|_| !tried), ..found }
}

/// Drills where the machine stands over the hole, along an axis, and leaves it as the return plane says.
pub(super) fn hole(
    machine: &mut Machine,
    cycle: &Cycle,
    (planes, along): (Planes, usize),
    trace: &mut Trace,
) {
    // The bottom may count from the retract plane, and that from the initial one.
    trace.rounded += 2.0 * machine.rounding.cycle;
    let mut driver = Driver { machine, trace, planes, along };
    if cycle.op == Op::CycleBackBore {
        return driver.bore_back(cycle);
    }
    driver.start(cycle);
    driver.rapid(planes.r);
    driver.tell(cycle);
    driver.drill(cycle);
}

struct Driver<'a> {
    machine: &'a mut Machine,
    trace: &'a mut Trace,
    planes: Planes,
    along: usize,
}

impl Driver<'_> {
    /// Says where the hole is: the tool stands at the plane that cutting starts from.
    fn tell(&mut self, cycle: &Cycle) {
        let at = Position(self.machine.position);
        let bottom = self.place(self.planes.bottom)[self.along];
        let op = if cycle.pecks_nothing() { Op::CycleDrill } else { cycle.op };
        self.trace.push(EventKind::Hole { cycle: op, at, bottom });
    }

    /// Turns a spindle that something else than its own code ended, where the control's cycles do that. After that code a
    /// cycle turns nothing; a tap starts it by itself.
    fn start(&mut self, cycle: &Cycle) {
        let machine = &self.machine;
        let turns = matches!(machine.commanded, Some(Spindle::Clockwise | Spindle::CounterClockwise));
        let starts = machine.rules.taps.start && !machine.rules.lathe && !cycle.op.is_tap();
        if let Some(direction) = machine.commanded
            && turns
            && starts
            && machine.spindle == Spindle::Stopped
        {
            self.turn(direction);
        }
    }

    /// From the retract plane into the hole, out of it, and on to the initial plane where that is asked for.
    fn drill(&mut self, cycle: &Cycle) {
        let Planes { r, bottom, .. } = self.planes;
        let before = self.machine.spindle;
        match cycle.op {
            Op::CyclePeck | Op::CycleChipBreak => self.peck(cycle),
            Op::CycleTap | Op::CycleTapLeft | Op::CycleTapRigid | Op::CycleTapByLead => self.tap(cycle),
            Op::CycleBore | Op::CycleBoreDwell => {
                self.feed(bottom);
                self.dwell(cycle.dwell);
                self.feed(r);
            }
            Op::CycleBoreStop => {
                self.feed(bottom);
                self.turn(Spindle::Stopped);
                self.rapid(r);
            }
            Op::CycleBoreManual => {
                self.feed(bottom);
                self.dwell(cycle.dwell);
                self.turn(Spindle::Stopped);
                self.trace.push(EventKind::Stop);
                self.rapid(r);
                self.turn(before);
            }
            Op::CycleFineBore => {
                self.feed(bottom);
                self.dwell(cycle.dwell);
                self.turn(Spindle::Oriented);
                self.shift(cycle, 1.0);
                self.rapid(r);
            }
            _ => {
                self.feed(bottom);
                self.dwell(cycle.dwell);
                self.rapid(r);
            }
        }
        if self.machine.return_to_r {
            self.machine.round_at_r(self.along);
        } else {
            self.rapid(self.planes.initial);
        }
        // The tool stays off the wall, and a stopped spindle stopped, up to the plane that the cycle ends at.
        if cycle.op == Op::CycleFineBore {
            self.shift(cycle, -1.0);
        }
        if matches!(cycle.op, Op::CycleFineBore | Op::CycleBoreStop) {
            self.turn(before);
        }
    }

    /// Through a hole beside its middle, and up into the part from below; always back to the initial plane.
    fn bore_back(&mut self, cycle: &Cycle) {
        self.trace.doubt("machine:cycle.back.bore");
        let before = self.machine.spindle;
        self.turn(Spindle::Oriented);
        self.shift(cycle, 1.0);
        self.rapid(self.planes.r);
        self.shift(cycle, -1.0);
        self.turn(before);
        self.tell(cycle);
        self.feed(self.planes.bottom);
        self.dwell(cycle.dwell);
        self.turn(Spindle::Oriented);
        self.shift(cycle, 1.0);
        self.rapid(self.planes.initial);
        self.shift(cycle, -1.0);
        self.turn(before);
    }

    /// In steps: out of the hole each time, or back a little to break the chip.
    fn peck(&mut self, cycle: &Cycle) {
        let Planes { r, bottom, .. } = self.planes;
        let (whole, down) = ((bottom - r).abs(), (bottom - r).signum());
        let mut step = cycle.first_peck.or(cycle.peck).unwrap_or(whole).abs();
        let clearance = cycle.clear.map_or(self.machine.peck_clearance, f64::abs);
        let mut depth = 0.0;
        while depth < whole && !self.trace.is_full() {
            if depth > 0.0 {
                self.trace.rounded += self.machine.rounding.cycle;
                let back = (depth - clearance).max(0.0);
                if cycle.op == Op::CyclePeck {
                    self.rapid(r);
                }
                self.rapid(r + down * back);
            }
            // A step of nothing would never end: the rest goes in one.
            let next = if step > 0.0 { depth + step } else { whole };
            depth = if next >= whole - 1e-9 { whole } else { next };
            self.feed(if depth == whole { bottom } else { r + down * depth });
            if cycle.first_peck.is_some() {
                step = (step - cycle.less.abs()).max(cycle.least.abs());
            }
        }
        if self.machine.rules.taps.peck_wait {
            self.dwell(cycle.dwell);
        }
        self.rapid(r);
    }

    fn tap(&mut self, cycle: &Cycle) {
        let Planes { r, bottom, .. } = self.planes;
        // A tap by its lead follows the spindle; the feed in force is for the moves after the cycle.
        let in_force = (self.machine.feed, self.machine.feed_mode);
        let by_turn = self.machine.feed_mode == FeedMode::PerTurn && !self.machine.surface_speed;
        let lead = cycle.lead.or(Some(self.machine.feed).filter(|_| by_turn && self.machine.speed > 0.0));
        if let Some(lead) = lead {
            (self.machine.feed, self.machine.feed_mode) = (lead * self.machine.speed, FeedMode::PerMinute);
        }
        let rigid = self.machine.rigid == Rigid::Taps;
        if rigid && self.machine.spindle == Spindle::CounterClockwise && cycle.op != Op::CycleTapLeft {
            self.turn(Spindle::Clockwise);
        }
        let (before, back) = match (self.machine.spindle, cycle.op) {
            (Spindle::CounterClockwise, _) | (_, Op::CycleTapLeft) => {
                (Spindle::CounterClockwise, Spindle::Clockwise)
            }
            _ => (Spindle::Clockwise, Spindle::CounterClockwise),
        };
        let stands = matches!(self.machine.spindle, Spindle::Stopped | Spindle::Oriented);
        if stands
            && !self.machine.rules.lathe
            && self.machine.rules.taps.starts(cycle.op, self.machine.rigid, self.trace)
        {
            self.turn(before);
        }
        self.feed(bottom);
        if self.machine.rules.taps.wait {
            self.dwell(cycle.dwell);
        }
        self.turn(back);
        self.feed(r);
        self.turn(before);
        (self.machine.feed, self.machine.feed_mode) = in_force;
    }

    /// Moves the tool off the wall by the cycle's shift, or back.
    fn shift(&mut self, cycle: &Cycle, sign: f64) {
        let (first, second, _) = self.machine.plane.axes();
        let (mut dx, mut dy) = cycle.shift;
        if let Some(by) = cycle.peck {
            // Which way Q shifts is a parameter of the machine, and its sign is ignored.
            let (second, sign) = self.machine.rules.cycle_shift.ask(self.trace);
            (dx, dy) = if second { (0.0, sign * by.abs()) } else { (sign * by.abs(), 0.0) };
        }
        let mut to = self.machine.position;
        to[first] += sign * dx;
        to[second] += sign * dy;
        self.machine.rapid_to(to, self.trace);
    }

    /// The machine position over or in the hole at a height.
    fn place(&self, height: f64) -> Axes {
        let frame = &self.machine.frame;
        if !frame.is_shaped() {
            let mut to = self.machine.position;
            to[self.along] = height + frame.shift(self.along);
            return to;
        }
        let mut work = frame.program(&self.machine.position);
        work[self.along] = height;
        frame.machine(&work)
    }

    fn rapid(&mut self, height: f64) {
        let to = self.place(height);
        self.machine.rapid_to(to, self.trace);
    }

    fn feed(&mut self, height: f64) {
        let to = self.place(height);
        self.machine.feed_to(to, self.trace);
    }

    fn dwell(&mut self, seconds: f64) {
        if seconds > 0.0 {
            self.machine.clock += seconds * 1000.0;
            self.trace.push(EventKind::Dwell { seconds });
            if let Some(cycle) = &self.machine.cycle {
                self.trace.tell(Told::Bottom(cycle.op));
            }
        }
    }

    fn turn(&mut self, direction: Spindle) {
        if self.machine.spindle != direction {
            self.machine.spindle = direction;
            let (speed, surface) = (self.machine.speed, self.machine.surface_speed);
            self.trace.push(EventKind::Spindle { direction, speed, surface });
            self.trace.tell(Told::Cycle);
        }
    }
}
