//! Stops, and what of spindle and coolant they end.

use super::Machine;
use crate::canon::{Op, Pause, Running};
use crate::control::trace::{EventKind, Spindle, Told, Trace};
use crate::dialect::Question;

impl Machine {
    /// Stops for a person, for a tool, or for good: what the control is known to end is ended, then it stops.
    pub fn pause(&mut self, pause: Pause, what: EventKind, trace: &mut Trace) {
        self.stop_running(pause, trace);
        trace.push(what);
    }

    /// Ends what a stop ends, and notes if nobody knows what it does with something that is running.
    fn stop_running(&mut self, pause: Pause, trace: &mut Trace) {
        for running in Running::ALL {
            let (answer, known) = self.rules.ends(pause, running);
            if !self.is_running(running) {
                // Whether a stop lets go of a spindle that is held, no source says; after the end nobody asks.
                let held = running == Running::Spindle && self.spindle == Spindle::Oriented;
                trace.open[running as usize] |= held && answer != Some(false) && pause != Pause::End;
                continue;
            }
            if !known {
                self.unsure_running[running as usize] = Some(pause);
            }
            match answer {
                Some(true) => {
                    trace.open[running as usize] = false;
                    self.end_running(running, trace);
                    trace.tell(Told::Implied);
                }
                Some(false) => {}
                None => trace.open[running as usize] = true,
            }
        }
    }

    pub(super) fn is_running(&self, running: Running) -> bool {
        match running {
            // One that is held at an angle stands.
            Running::Spindle => matches!(self.spindle, Spindle::Clockwise | Spindle::CounterClockwise),
            Running::Coolant => !matches!(self.coolant, Op::CoolantOff | Op::ThroughSpindleOff),
        }
    }

    fn end_running(&mut self, running: Running, trace: &mut Trace) {
        match running {
            Running::Spindle => {
                self.spindle = Spindle::Stopped;
                let (speed, surface) = (self.speed, self.surface_speed);
                trace.push(EventKind::Spindle { direction: Spindle::Stopped, speed, surface });
            }
            Running::Coolant => {
                self.coolant = Op::CoolantOff;
                trace.push(EventKind::Coolant { state: Op::CoolantOff });
            }
        }
    }

    /// The program says itself what runs from here on.
    pub(super) fn says_running(&mut self, running: Running, trace: &mut Trace) {
        trace.open[running as usize] = false;
        self.unsure_running[running as usize] = None;
    }

    /// It cuts: what runs then matters.
    pub(super) fn running_matters(&mut self, trace: &mut Trace) {
        for running in Running::ALL {
            if let Some(pause) = self.unsure_running[running as usize].take() {
                trace.doubt(Question::ends(pause, running).fact());
            }
        }
    }
}
