//! The machine: one for all controls, driven in common terms.
//!
//! An interpreter resolves the letters of a block by its control's tables and hands on a
//! [`Command`]; the machine changes its state and records what happens. Values come in the
//! units of the program (inch or millimetres as the units in force say) and are kept in
//! millimetres.

mod arc;
mod auxiliary;
mod awaited;
mod block;
mod command;
mod cycle;
mod entry;
mod exit_state;
mod expand;
mod frame;
mod holes;
mod inverse;
mod lathe;
mod motion;
mod offsets;
mod one_table;
mod outside;
mod pauses;
mod places;
mod pockets;
mod polar;
mod returns;
mod rigid;
mod rounding;
mod rules;
mod spoken;
mod state;
mod system;
#[cfg(test)]
mod tests;
mod tooling;
mod turns;

pub use command::Command;
pub use exit_state::ExitState;
pub use frame::{Frame, Rotation};
pub use lathe::{Contour, Contoured};
pub use outside::LEFT;
pub(super) use rules::{BareChange, Rules};

use super::outcome::Stop;
use super::scenario::{Axes, Probe, Scenario, SharedRows, Tool};
use super::table::Table;
use super::trace::{FeedMode, Plane, Side, Spindle, Trace, Zero};
use crate::canon::{Group, Op, Pause, Role, Sys};
use crate::dialect::{Control, Units};
use cycle::Cycle;
use rounding::Rounding;
use std::collections::HashMap;
use std::sync::Arc;
use tooling::Lost;

/// The groups of modes that a called program finds as its caller left them.
pub const GIVEN: [Group; 5] = [Group::Units, Group::Motion, Group::Distance, Group::Plane, Group::FeedMode];

/// Millimetres of an inch.
pub const INCH: f64 = 25.4;

/// The state of the machine.
#[derive(Debug)]
pub struct Machine {
    rules: Arc<Rules>,
    rounding: Rounding,
    /// Machine position.
    position: Axes,
    /// Machine position at the end of the last block that moved.
    probed: Axes,
    frame: Frame,
    /// True where the work offset in force was written since it was selected.
    stale: bool,
    /// True where the tool length in force was written since it was named.
    stale_length: bool,
    /// Program coordinates, millimetres, at which the last rotation found the machine: without
    /// the rotation before it.
    unturned: Axes,
    /// True where a rotation with its centre began, and no absolute word followed yet.
    fresh_rotation: bool,
    work_offsets: Table<Axes>,
    inch: bool,
    /// True once the program named its unit.
    unit_named: bool,
    incremental: bool,
    motion: Op,
    cycle: Option<Cycle>,
    rigid: rigid::Rigid,
    return_to_r: bool,
    plane: Plane,
    feed: f64,
    /// True where the feed was told per turn.
    feed_by_turn: bool,
    feed_mode: FeedMode,
    speed: f64,
    surface_speed: bool,
    spindle: Spindle,
    /// How a code of the program last told the spindle to turn, or to stop; none before the first.
    commanded: Option<Spindle>,
    /// The last S as a number of turns, and the builder's code that turns a tool at it.
    spoken: spoken::Spoken,
    coolant: Op,
    /// What stopped the program last, if nobody knows what it did with spindle and coolant, which ran.
    unsure_running: [Option<Pause>; 2],
    tool_ready: f64,
    /// True if a tool was named since the last change, or none was changed yet.
    tool_named: bool,
    /// The tool that the last change put back.
    tool_back: f64,
    tool: f64,
    tools: Table<Tool>,
    one_table: Option<Arc<SharedRows>>,
    length_op: Op,
    length_offset: u32,
    /// True once the number of a length was named.
    length_named: bool,
    /// What may have cancelled the length since the program named it.
    length_lost: Option<Lost>,
    side: Side,
    /// True where compensation was switched on or off, and no move in the plane followed yet.
    side_switched: bool,
    radius_offset: u32,
    /// True where the word of the length named it.
    radius_with_length: bool,
    path_mode: Op,
    /// Polar coordinates in force, and their last words.
    polar: Option<polar::Words>,
    references: [Axes; 4],
    /// The point that the last return to the reference position went through.
    by_way_of: Option<Axes>,
    /// What only a lathe has.
    lathe: lathe::Lathe,
    probes: std::vec::IntoIter<Probe>,
    peck_clearance: f64,
    /// Simulated time, milliseconds, and where the timers were set to zero in it.
    clock: f64,
    timer_ms_from: f64,
    timer_hours_from: f64,
    tick: f64,
    date: f64,
    time: f64,
    /// State that nothing here models.
    cells: HashMap<(Sys, [u32; 2]), f64>,
    /// What the codes of the machine's builder put into variables, by the numbers of their names.
    given_acts: HashMap<u32, f64>,
    /// Whether the program waits for inputs; none if they stay as they are.
    awaited: Option<awaited::Awaited>,
}

impl Machine {
    /// A machine of a control, which has these facts, as a scenario finds it.
    pub(super) fn new(rules: Arc<Rules>, control: &Control, scenario: &Scenario) -> Self {
        let peck_clearance = rules.peck_clearance.unwrap_or(scenario.peck_clearance);
        let mut machine = Self {
            rules,
            rounding: Rounding::new(control),
            position: scenario.start,
            probed: scenario.start,
            frame: Frame::new(scenario),
            stale: false,
            stale_length: false,
            unturned: scenario.start,
            fresh_rotation: false,
            work_offsets: scenario.work_offsets.clone(),
            inch: scenario.inch.unwrap_or(control.units() == Some(Units::Inch)),
            unit_named: false,
            incremental: false,
            motion: Op::Rapid,
            cycle: None,
            rigid: rigid::Rigid::No,
            return_to_r: false,
            plane: Plane::Xy,
            feed: 0.0,
            feed_by_turn: false,
            feed_mode: FeedMode::PerMinute,
            speed: 0.0,
            surface_speed: false,
            spindle: Spindle::Stopped,
            commanded: None,
            spoken: spoken::Spoken::default(),
            coolant: Op::CoolantOff,
            unsure_running: [None; 2],
            tool_ready: f64::from(scenario.tool),
            tool_named: true,
            tool_back: f64::from(scenario.tool),
            tool: f64::from(scenario.tool),
            tools: one_table::tools(scenario),
            one_table: scenario.one_table.clone(),
            length_op: Op::LengthOff,
            length_offset: 0,
            length_named: false,
            length_lost: None,
            side: Side::Off,
            side_switched: false,
            radius_offset: 0,
            radius_with_length: false,
            path_mode: Op::CuttingMode,
            polar: None,
            references: scenario.reference_positions(),
            by_way_of: None,
            lathe: lathe::Lathe::default(),
            probes: scenario.probes.clone().into_iter(),
            peck_clearance,
            clock: 0.0,
            timer_ms_from: 0.0,
            timer_hours_from: 0.0,
            tick: scenario.tick_ms,
            date: scenario.date,
            time: scenario.time,
            cells: HashMap::new(),
            given_acts: HashMap::new(),
            awaited: awaited::Awaited::of(scenario),
        };
        if !scenario.settings.is_empty() || !scenario.left.is_empty() || scenario.set_to_inch.is_some() {
            let turning = lathe::settings::Turning::with(control, &scenario.settings, scenario.set_to_inch);
            let turning = lathe::Turning { left: scenario.left.clone(), ..turning };
            let mut rules = Rules::clone(&machine.rules);
            rules.turning = turning;
            machine.rules = Arc::new(rules);
        }
        machine.start_turning(control);
        for cell in &scenario.state {
            machine.preset(cell.state, &cell.subscripts, cell.value);
        }
        scenario.modes.iter().for_each(|op| machine.start_in(*op));
        machine.enter(&scenario.entry);
        for mode in control.start().iter().filter(|mode| scenario.as_stated.contains(&mode.op.group())) {
            match mode.work_offset() {
                Some(number) => machine.select(number),
                // The unit is the scenario's, or as the profile says it.
                None if mode.op.group() == Group::Units => {}
                None => machine.start_in(mode.op),
            }
        }
        machine
    }

    /// Does what a block says. What it moved and switched stands in the trace; an alarm
    /// leaves the machine where it was when the alarm came.
    pub fn run(&mut self, command: &Command, trace: &mut Trace) -> Result<(), Stop> {
        if self.rules.lathe && lathe::waiting::takes(self, command, trace)? {
            return Ok(());
        }
        let bare = command.has(Op::ToolChange) && command.word(Role::Tool).is_none();
        if bare && !self.tool_named && self.rules.bare_change.peek() == BareChange::Alarm {
            return Err(Stop::unnamed("a tool change without a tool"));
        }
        block::run(self, command, trace)
    }

    /// True where dimensions are inches.
    pub fn is_inch(&self) -> bool {
        self.inch
    }

    /// True where a feed is millimetres a minute.
    pub fn feeds_millimetres(&self) -> bool {
        !self.inch && self.feed_mode == FeedMode::PerMinute
    }

    /// Takes the unit that a block names, ahead of the block's words.
    pub fn name_unit(&mut self, op: Op) {
        match op {
            Op::Inch => self.inch = true,
            Op::Metric => self.inch = false,
            _ => return,
        }
        self.unit_named = true;
    }

    /// True where coordinates are incremental.
    pub fn is_incremental(&self) -> bool {
        self.incremental
    }

    /// The drilling cycle in force.
    pub fn cycle(&self) -> Option<Op> {
        self.cycle.as_ref().map(|cycle| cycle.op)
    }

    /// The interpolation in force, a drilling cycle left out.
    pub fn motion(&self) -> Op {
        if self.waits() { Op::Linear } else { self.motion }
    }

    /// Machine position, millimetres.
    pub fn position(&self) -> Axes {
        self.position
    }

    /// Simulated time, milliseconds.
    pub fn clock(&self) -> f64 {
        self.clock
    }

    /// Where the program counts from.
    fn zero(&self) -> Zero {
        let at = std::array::from_fn(|axis| self.frame.shift(axis) - self.frame.local[axis]);
        Zero { at, inch: self.inch, plane: self.plane, diameters: self.rules.lathe }
    }

    /// True for a lathe.
    pub fn is_lathe(&self) -> bool {
        self.rules.lathe
    }

    /// What the value of a word is multiplied by: X of a lathe may be written as a radius (C1).
    pub fn scale_of(&self, role: Role) -> f64 {
        let along = matches!(role, Role::X | Role::StepX | Role::AllowanceX);
        if along && self.rules.lathe && self.rules.turning.radii { 2.0 } else { 1.0 }
    }

    /// What a length along an axis is multiplied by to be a real one: X of a lathe is a diameter.
    fn real(&self, axis: usize) -> f64 {
        if self.rules.lathe && axis == 0 { 0.5 } else { 1.0 }
    }

    /// The number of an alarm, on a lathe; mills have no name for it here.
    fn lathe_name<'n>(&self, number: &'n str) -> &'n str {
        if self.rules.lathe { number } else { "" }
    }

    /// Millimetres of one unit of length of the program.
    pub fn unit(&self) -> f64 {
        if self.inch { INCH } else { 1.0 }
    }
}
