//! State of the machine that programs read and write.
//!
//! What the machine models is answered from it; all else (inputs, parameters, counters) is a
//! cell that holds what the scenario or the program put there, zero otherwise.

use super::Machine;
use super::rules::RadiusTable;
use crate::canon::{Act, Op, Sys};
use crate::control::outcome::Stop;
use crate::control::scenario::AXES;
use crate::control::trace::{EventKind, Side, Spindle, Trace};
use crate::dialect::Question;

/// The key of a cell; states have two subscripts at the most.
pub(super) fn cell(state: Sys, subscripts: &[u32]) -> (Sys, [u32; 2]) {
    let at = |place: usize| subscripts.get(place).copied().unwrap_or(0);
    (state, [at(0), at(1)])
}

/// How a cutter value that a control keeps is made of a radius.
fn factor(table: RadiusTable) -> f64 {
    if table == RadiusTable::Diameter { 2.0 } else { 1.0 }
}

impl Machine {
    /// Reads state, lengths in the units of the program. None where the subscripts name nothing.
    ///
    /// What only an interpreter knows (modal codes as its control numbers them, the last
    /// words, variables) it answers itself. Reading a timer lets it move on.
    pub fn read(&mut self, state: Sys, subscripts: &[u32], trace: &mut Trace) -> Option<f64> {
        if matches!(state, Sys::MachinePosition | Sys::ProbePoint) {
            self.round_read();
        }
        if self.waits() {
            trace.doubt("machine:lathe.corner.read");
        }
        if self.rules.lathe && self.rules.turning.radii && (state.is_length() || state.is_tool_offset()) {
            // In what it is read then no source says.
            return None;
        }
        let place = matches!(
            state,
            Sys::EndPosition
                | Sys::WorkPosition
                | Sys::MachinePosition
                | Sys::SkipPosition
                | Sys::AxisPosition
        );
        if place && self.rules.lathe && self.side != Side::Off {
            // The path that the tool takes is not worked out.
            trace.doubt("machine:lathe.nose.path");
        }
        if place && self.lathe.surface.is_some() {
            trace.doubt("machine:lathe.face.place");
        }
        if matches!(state, Sys::EndPosition | Sys::WorkPosition | Sys::SkipPosition | Sys::AxisPosition) {
            if self.rules.lathe && subscripts.last() == Some(&1) {
                // Whether the number is a radius or a diameter no source says.
                trace.doubt("machine:lathe.position.diameter");
            }
            self.place_by_offset(trace);
            // A place along another axis holds no length.
            let along = subscripts.last().is_none_or(|axis| *axis == 3);
            if along {
                self.place_by_length(trace);
            }
            self.round_read();
            let depth = along && state != Sys::EndPosition;
            if depth && self.frame.length != 0.0 {
                self.rules.positions_hold_length.ask(trace);
            }
        }
        match state {
            // Reading takes a tick, before the answer: a timer that is set from this reading starts at 0.
            Sys::TimerMs | Sys::TimerHours | Sys::CycleSeconds => {
                if self.lathe.has_stood {
                    trace.doubt("machine:lathe.spindle.stands");
                }
                self.clock += self.tick;
            }
            Sys::DiameterOrRadius | Sys::DiameterOrRadiusWear => {
                self.rules.radius_table.ask(trace);
            }
            Sys::AxisPosition => trace.doubt(Question::PositionFrame.fact()),
            Sys::ActiveTool => self.active_tool_asked(trace),
            Sys::Input | Sys::InputInverted => {
                self.input_asked(subscripts.first().copied().unwrap_or(0), trace);
            }
            _ => {}
        }
        self.peek(state, subscripts)
    }

    /// Reads state without a trace and without letting time pass.
    pub fn peek(&self, state: Sys, subscripts: &[u32]) -> Option<f64> {
        let axis = || usize::try_from(*subscripts.last()?).ok()?.checked_sub(1).filter(|axis| *axis < AXES);
        let length = |axis: usize, value: f64| value / self.axis_unit(axis);
        let along = |values: &[f64; AXES]| axis().map(|axis| length(axis, values[axis]));
        let tool = || {
            let number = subscripts.first()?;
            Some(self.tools.get(number).copied().unwrap_or_default())
        };
        let unit = self.unit();
        let both = factor(self.rules.radius_table.peek());
        Some(match state {
            Sys::MachinePosition => along(&self.position)?,
            Sys::EndPosition => along(&self.frame.program(&self.position))?,
            Sys::WorkPosition | Sys::AxisPosition => {
                along(&self.frame.program(&self.position))? + length(2, self.held_length(axis()?))
            }
            Sys::SkipPosition => {
                along(&self.frame.program(&self.probed))? + length(2, self.held_length(axis()?))
            }
            Sys::ActiveOffset => {
                let axis = axis()?;
                let tool = self.frame.tool.as_ref().and_then(|tool| tool.get(axis)).copied();
                let along = if axis == 2 { self.frame.length } else { 0.0 };
                length(axis, tool.unwrap_or(along))
            }
            // Who wrote the one register shows in which of the two is not zero.
            Sys::ExternalShift if self.rules.local_is_external.peek() => {
                along(&self.frame.external)? + along(&self.frame.local)?
            }
            Sys::ExternalShift => along(&self.frame.external)?,
            Sys::SetPosition => along(&self.frame.datum)?,
            Sys::HomeOffset => along(&self.references[0])?,
            Sys::WorkOffset => {
                let number = subscripts.first()?;
                along(&self.work_offsets.get(number).copied().unwrap_or([0.0; AXES]))?
            }
            Sys::LengthGeometry | Sys::ToolOffset => tool()?.length / unit,
            Sys::LengthWear => tool()?.length_wear / unit,
            Sys::RadiusGeometry => tool()?.radius / unit,
            Sys::RadiusWear => tool()?.radius_wear / unit,
            Sys::DiameterGeometry => tool()?.radius * 2.0 / unit,
            Sys::DiameterWear => tool()?.radius_wear * 2.0 / unit,
            Sys::DiameterOrRadius => tool()?.radius * both / unit,
            Sys::DiameterOrRadiusWear => tool()?.radius_wear * both / unit,
            Sys::LatheX | Sys::LatheY | Sys::LatheZ | Sys::LatheRadius | Sys::LatheTip => {
                self.lathe_offset(state, *subscripts.first()?)
            }
            Sys::ActiveTool => self.tool,
            Sys::TimerMs => self.clock - self.timer_ms_from,
            Sys::TimerHours => (self.clock - self.timer_hours_from) / 3_600_000.0,
            Sys::CycleSeconds => self.clock / 1000.0,
            Sys::Date => self.date,
            Sys::ShortDate => self.date % 1_000_000.0,
            Sys::Time => self.time,
            Sys::SpindleActual => {
                if matches!(self.spindle, Spindle::Clockwise | Spindle::CounterClockwise) {
                    self.speed
                } else {
                    0.0
                }
            }
            Sys::CyclePlane => f64::from(u8::from(self.return_to_r)),
            Sys::Pi => std::f64::consts::PI,
            Sys::Euler => std::f64::consts::E,
            // One signal, whichever of its states a control shows as 1.
            Sys::InputInverted => 1.0 - self.cell(Sys::Input, subscripts),
            Sys::OutputInverted => 1.0 - self.cell(Sys::Output, subscripts),
            _ => self.cell(state, subscripts),
        })
    }

    fn cell(&self, state: Sys, subscripts: &[u32]) -> f64 {
        let held = self.cells.get(&cell(state, subscripts)).copied().unwrap_or(0.0);
        if state == Sys::Input { self.input(subscripts.first().copied().unwrap_or(0), held) } else { held }
    }

    /// Puts a state there before the program starts, without a trace.
    pub(super) fn preset(&mut self, state: Sys, subscripts: &[u32], value: f64) {
        let (state, value) = match state {
            Sys::InputInverted => (Sys::Input, 1.0 - value),
            Sys::OutputInverted => (Sys::Output, 1.0 - value),
            _ => (state, value),
        };
        if matches!(state, Sys::LatheX | Sys::LatheY | Sys::LatheZ | Sys::LatheRadius | Sys::LatheTip) {
            self.keep_lathe_offset(state, subscripts.first().copied().unwrap_or(0), value);
            return;
        }
        if let (Sys::Act, Some(number)) = (state, subscripts.first()) {
            self.given_acts.insert(*number, value);
        }
        self.cells.insert(cell(state, subscripts), value);
    }

    /// The tool length that a position along an axis holds.
    fn held_length(&self, axis: usize) -> f64 {
        if axis == 2 && self.rules.positions_hold_length.peek() { self.frame.length } else { 0.0 }
    }

    /// Keeps the place where the probe touched under a number, in the coordinates and the unit of the program.
    pub fn keep_touch_point(&mut self, point: u32) {
        for axis in 1..=AXES as u32 {
            let place = self.peek(Sys::SkipPosition, &[axis]).unwrap_or(0.0);
            self.cells.insert(cell(Sys::ProbePoint, &[axis, point]), place);
        }
    }

    /// Writes state, lengths in the units of the program. Alarms and stops are the interpreter's.
    pub fn write(
        &mut self,
        state: Sys,
        subscripts: &[u32],
        value: f64,
        trace: &mut Trace,
    ) -> Result<(), Stop> {
        let nothing = || Stop::unnamed(format!("there is no such {state}"));
        let axis =
            subscripts.last().and_then(|axis| (*axis as usize).checked_sub(1)).filter(|axis| *axis < AXES);
        let first = subscripts.first().copied();
        let unit = self.unit();
        match state {
            Sys::ExternalShift | Sys::WorkOffset => {
                let axis = axis.ok_or_else(nothing)?;
                let number = if state == Sys::WorkOffset { Some(first.ok_or_else(nothing)?) } else { None };
                self.round_written(value * self.axis_unit(axis));
                self.keep_work(number, axis, value * self.axis_unit(axis), trace);
            }
            Sys::LengthGeometry
            | Sys::LengthWear
            | Sys::RadiusGeometry
            | Sys::RadiusWear
            | Sys::ToolOffset => {
                self.keep_tool(state, first.ok_or_else(nothing)?, value * unit, trace);
            }
            Sys::DiameterGeometry => {
                self.keep_tool(Sys::RadiusGeometry, first.ok_or_else(nothing)?, value * unit / 2.0, trace);
            }
            Sys::DiameterWear => {
                self.keep_tool(Sys::RadiusWear, first.ok_or_else(nothing)?, value * unit / 2.0, trace);
            }
            Sys::DiameterOrRadius | Sys::DiameterOrRadiusWear => {
                let kept = if state == Sys::DiameterOrRadius { Sys::RadiusGeometry } else { Sys::RadiusWear };
                let radius = value * unit / factor(self.rules.radius_table.ask(trace));
                self.keep_tool(kept, first.ok_or_else(nothing)?, radius, trace);
            }
            Sys::SetPosition => {
                let axis = axis.ok_or_else(nothing)?;
                self.frame.datum[axis] = value * self.axis_unit(axis);
            }
            Sys::LatheX | Sys::LatheY | Sys::LatheZ | Sys::LatheRadius | Sys::LatheTip => {
                let value = self.keep_lathe_offset(state, first.ok_or_else(nothing)?, value);
                trace.push(EventKind::Write { state, subscripts: subscripts.to_vec(), value });
            }
            // Whatever is not 0 switches a signal one way; the trace says whether it is on.
            Sys::Output | Sys::OutputInverted => {
                let on = (value != 0.0) == (state == Sys::Output);
                self.switch_output(first.ok_or_else(nothing)?, on, trace);
            }
            Sys::TimerMs => self.timer_ms_from = self.clock - value,
            Sys::TimerHours => self.timer_hours_from = self.clock - value * 3_600_000.0,
            _ => {
                self.cells.insert(cell(state, subscripts), value);
                trace.push(EventKind::Write { state, subscripts: subscripts.to_vec(), value });
            }
        }
        Ok(())
    }

    /// Switches an output.
    pub(super) fn switch_output(&mut self, number: u32, on: bool, trace: &mut Trace) {
        let value = f64::from(u8::from(on));
        self.cells.insert(cell(Sys::Output, &[number]), value);
        trace.push(EventKind::Write { state: Sys::Output, subscripts: vec![number], value });
    }

    /// A builder's code has run: what it sets holds what the scenario says that the machine puts there.
    pub(super) fn answers(&mut self, act: Act) {
        for number in self.rules.sets.get(&act).into_iter().flatten() {
            let at = cell(Sys::Act, &[*number]);
            let value = self.given_acts.get(number).copied().unwrap_or(0.0);
            self.cells.insert(at, value);
        }
    }

    /// The operation in force in a modal group that the machine keeps.
    pub fn modal(&self, group: crate::canon::Group) -> Option<Op> {
        use crate::canon::Group;
        Some(match group {
            Group::Motion => self.motion,
            Group::Cycle => self.cycle().unwrap_or(Op::CycleOff),
            Group::Plane => match self.plane {
                super::Plane::Xy => Op::PlaneXy,
                super::Plane::Zx => Op::PlaneZx,
                super::Plane::Yz => Op::PlaneYz,
            },
            Group::Distance => {
                if self.incremental {
                    Op::Incremental
                } else {
                    Op::Absolute
                }
            }
            Group::FeedMode => match self.feed_mode {
                super::FeedMode::PerMinute => Op::FeedPerMinute,
                super::FeedMode::PerTurn => Op::FeedPerTurn,
                super::FeedMode::Inverse => Op::FeedInverse,
            },
            Group::Units => {
                if self.inch {
                    Op::Inch
                } else {
                    Op::Metric
                }
            }
            Group::RadiusComp => match self.side {
                super::Side::Off => Op::RadiusOff,
                super::Side::Left => Op::RadiusLeft,
                super::Side::Right => Op::RadiusRight,
            },
            Group::LengthComp => self.length_op,
            Group::ReturnPlane => {
                if self.return_to_r {
                    Op::ReturnR
                } else {
                    Op::ReturnInitial
                }
            }
            Group::WorkOffset => {
                if self.frame.number == 0 {
                    Op::ShiftCancel
                } else {
                    Op::SelectWork
                }
            }
            Group::PathMode => self.path_mode,
            Group::SpeedMode => {
                if self.surface_speed {
                    Op::SurfaceSpeed
                } else {
                    Op::TurnsPerMinute
                }
            }
            Group::Rotation => {
                if self.frame.rotation.is_some() {
                    Op::RotateOn
                } else {
                    Op::RotateOff
                }
            }
            Group::Scaling => {
                if self.frame.scale.is_some() {
                    Op::ScaleOn
                } else {
                    Op::ScaleOff
                }
            }
            Group::Coolant => self.coolant,
            _ => return None,
        })
    }

    /// The selected work offset's common number.
    pub fn work_offset(&self) -> u32 {
        self.frame.number
    }
}
