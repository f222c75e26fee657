//! Drilling cycles: their planes, their repeats, where they run.

use super::command::axis;
use super::rules::NoPlane;
use super::{Command, Machine, expand, inverse, lathe};
use crate::canon::{Op, Role};
use crate::control::entry::Drilling;
use crate::control::outcome::Stop;
use crate::control::trace::{EventKind, Plane, Trace};

/// A cycle in force. Depths are program coordinates along the drilling axis, millimetres.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Cycle {
    pub op: Op,
    pub initial: f64,
    /// Retract plane: the word, and whether it was incremental.
    pub r: Option<(f64, bool)>,
    /// Bottom: the word, and whether it was incremental.
    pub z: Option<(f64, bool)>,
    pub peck: Option<f64>,
    pub dwell: f64,
    /// The time of a wait since the cycle was told its dwell, where that may be the dwell too.
    pub waited: Option<f64>,
    pub without_dwell: bool,
    pub first_peck: Option<f64>,
    pub less: f64,
    pub least: f64,
    /// How far over the last depth a peck begins to feed, where the cycle says it.
    pub clear: Option<f64>,
    pub shift: (f64, f64),
    /// By how much a tap advances each turn, where the cycle is given that in place of a feed.
    pub lead: Option<f64>,
}

/// The planes of a hole, program coordinates along the drilling axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Planes {
    pub initial: f64,
    pub r: f64,
    pub bottom: f64,
}

pub(super) fn run(machine: &mut Machine, command: &Command, trace: &mut Trace) -> Result<(), Stop> {
    if machine.rules.lathe {
        return lathe::holes::run(machine, command, trace);
    }
    let (first, second, along) = machine.plane.axes();
    let begins = command.ops.iter().rev().copied().find(|op| op.is_cycle());
    if let Some(op) = begins {
        let height = machine.frame.program(&machine.position)[along];
        let cycle = machine.cycle.get_or_insert_with(|| Cycle::new(op, height));
        cycle.op = op;
        if op != Op::CycleTapByLead {
            // A lead is of the tap that is told it.
            cycle.lead = None;
        }
    }
    let (unit, incremental) = (machine.unit(), machine.incremental);
    let Some(cycle) = &mut machine.cycle else {
        return Err(Stop::unnamed("no drilling cycle is in force"));
    };
    let alone = !command.has_axes() && !command.has(Op::CycleHere) && is_alone(command);
    let rules = &machine.rules;
    let drills = begins.is_some() && rules.cycle_runs_without_words.peek();
    if !alone || drills || rules.lone_words_kept.ask(trace) {
        let kept = cycle.bottom_kept(command, along);
        let kept = kept.filter(|_| rules.planes_frozen.ask(trace));
        cycle.read(command, (unit, incremental), along);
        cycle.stay(kept);
    }
    machine.round_cycle(command, along, begins.is_some());
    machine.round_in(&across(command, along), trace);
    let in_plane = |axis: usize| axis == first || axis == second;
    let by_others = command.axes().any(|(axis, _)| axis != along && !in_plane(axis));
    let places = command.axes().any(|(axis, _)| in_plane(axis))
        || command.has(Op::CycleHere)
        || by_others && machine.rules.cycle_runs_by_rotary.ask(trace);
    let depths = command.word(Role::CycleR).is_some() || command.axes().any(|(axis, _)| axis == along);
    let rules = &machine.rules;
    let count = command.number(Role::Repeat).unwrap_or(1);
    let runs = match (begins.is_some(), places) {
        _ if count == 0 => false,
        (true, true) => rules.cycle_block_runs.ask(trace),
        (false, true) => true,
        (true, false) if depths || by_others => rules.cycle_runs_without_axes.ask(trace),
        (true, false) => rules.cycle_runs_without_words.ask(trace),
        (false, false) => depths && rules.cycle_runs_by_depth.ask(trace),
    };
    if count == 0 && places {
        // What L0 does elsewhere than storing is not known.
        rules.zero_repeats_stores.ask(trace);
    }
    if !runs || count == 0 {
        place_only(machine, command, count, trace);
        return Ok(());
    }
    for turn in 0..count {
        if turn > 0 {
            machine.round_in(&across(command, along), trace);
        }
        let mut to = machine.target(&across(command, along));
        machine.keep_polar(command);
        to[along] = machine.position[along];
        if to[first] != machine.position[first]
            || to[second] != machine.position[second]
            || to != machine.position
        {
            machine.rapid_to(to, trace);
        }
        hole(machine, trace)?;
        if trace.is_full() {
            break;
        }
    }
    Ok(())
}

/// True for words of a cycle without a plane or a count of it.
fn is_alone(command: &Command) -> bool {
    use Role::{CycleDwell, CycleI, CycleJ, CycleQ, PeckClear, PeckFirst, PeckLeast, PeckLess};
    let of_cycle = |role: Role| {
        matches!(role, CycleDwell | CycleQ | CycleI | CycleJ | PeckFirst | PeckLess | PeckLeast | PeckClear)
    };
    let planes = command.word(Role::CycleR).is_some() || command.word(Role::Repeat).is_some();
    !planes && command.words.iter().any(|(role, _)| of_cycle(*role))
}

/// A block that stores a cycle and does not drill still goes to its place; what it does with a count of zero is asked.
fn place_only(machine: &mut Machine, command: &Command, count: u32, trace: &mut Trace) {
    let (_, _, along) = machine.plane.axes();
    let named = command.axes().any(|(axis, _)| axis != along);
    if count != 0 || named && machine.rules.zero_repeats_moves.ask(trace) {
        let mut to = machine.target(&across(command, along));
        machine.keep_polar(command);
        to[along] = machine.position[along];
        machine.rapid_to(to, trace);
    }
}

/// The block without its word along the drilling axis, which is the depth.
pub(super) fn across(command: &Command, along: usize) -> Command {
    let words = command.words.iter().copied().filter(|(role, _)| axis(*role) != Some(along));
    Command {
        ops: command.ops.clone(),
        words: words.collect(),
        rounded: command.rounded.clone(),
        own_code: None,
        without_dwell: command.without_dwell,
        steps: command.steps.clone(),
        distance_after: command.distance_after,
    }
}

/// Drills at the present place.
pub(super) fn hole(machine: &mut Machine, trace: &mut Trace) -> Result<(), Stop> {
    let Some(mut cycle) = machine.cycle.clone() else { return Ok(()) };
    inverse::cycle(machine)?;
    if machine.plane != Plane::Xy && !machine.rules.lathe && !machine.rules.cycles_in_any_plane.ask(trace) {
        return Err(Stop::unnamed(
            "a drilling cycle under G18 or G19, and this control drills under G17 alone",
        ));
    }
    if cycle.without_dwell {
        // The dwell that an earlier cycle was given is none of this one.
        cycle.dwell = 0.0;
    } else if let Some(waited) = cycle.waited
        && machine.rules.dwell_is_of_cycle.ask(trace)
    {
        cycle.dwell = waited;
    }
    if machine.frame.scale.is_some() {
        machine.rules.scale_reaches_cycle.ask(trace);
    }
    if cycle.r.is_none() && !machine.rules.lathe {
        match machine.rules.no_plane.ask(trace) {
            NoPlane::Here => {}
            NoPlane::Zero => cycle.r = Some((0.0, machine.incremental)),
            NoPlane::Alarm => return Err(Stop::unnamed("a drilling cycle without its retract plane")),
        }
    }
    let frozen = machine.rules.planes_frozen.peek();
    if cycle.mixes(machine.incremental) {
        machine.rules.planes_frozen.ask(trace);
    }
    let mode = if frozen { None } else { Some(machine.incremental) };
    let planes = cycle.planes(mode).ok_or_else(|| Stop::unnamed("a drilling cycle without its depth"))?;
    if cycle.op == Op::CycleOther {
        trace.doubt("machine:cycle.other");
        trace.push(EventKind::Other { operation: cycle.op, code: None });
        return Ok(());
    }
    if cycle.pecks_nothing() {
        if machine.rules.pecks_need_depth {
            return Err(Stop::alarm("PS0045", "a peck cycle without the depth of its pecks"));
        }
        trace.doubt("machine:cycle.peck.missing");
    }
    let along = machine.plane.axes().2;
    expand::hole(machine, &cycle, (planes, along), trace);
    Ok(())
}

/// The cycle at the place that a rotation puts the last programmed one to: rotations by 36 and
/// then by 72 degrees drill at 36 and at 72, not at 108.
pub(super) fn at_turned_place(machine: &mut Machine, trace: &mut Trace) -> Result<(), Stop> {
    let (first, second, along) = machine.plane.axes();
    let mut to = machine.frame.machine(&machine.unturned);
    to[along] = machine.position[along];
    if to[first] != machine.position[first] || to[second] != machine.position[second] {
        machine.rapid_to(to, trace);
    }
    hole(machine, trace)
}

impl Cycle {
    /// A cycle that begins at a height.
    pub(super) fn new(op: Op, initial: f64) -> Self {
        Self {
            op,
            initial,
            r: None,
            z: None,
            peck: None,
            dwell: 0.0,
            waited: None,
            without_dwell: false,
            first_peck: None,
            less: 0.0,
            least: 0.0,
            clear: None,
            shift: (0.0, 0.0),
            lead: None,
        }
    }

    /// A drilling cycle that was left in force, from an initial plane.
    pub(super) fn drilling(initial: f64, left: Drilling) -> Self {
        let (r, z) = (Some((left.retract, false)), Some((left.bottom, false)));
        Self { r, z, ..Self::new(Op::CycleDrill, initial) }
    }

    /// The bottom of before a block that moves the retract plane alone, if increments told it: it was a place when its block was read.
    fn bottom_kept(&self, command: &Command, along: usize) -> Option<f64> {
        let deeper = command.axes().any(|(axis, _)| axis == along);
        let lifts = !deeper && command.word(Role::CycleR).is_some();
        (lifts && self.z.is_some_and(|(_, given)| given))
            .then(|| self.planes(None).map(|planes| planes.bottom))?
    }

    /// Keeps the bottom where it was, under another retract plane.
    fn stay(&mut self, kept: Option<f64>) {
        let Some(((r, given), bottom)) = self.r.zip(kept) else { return };
        let plane = if given { self.initial + r } else { r };
        self.z = Some((bottom - plane, true));
    }

    /// Takes the block's words; those it does not have stay.
    fn read(&mut self, command: &Command, (unit, incremental): (f64, bool), along: usize) {
        let length = |role| command.word(role).map(|value| value * unit);
        if let Some(r) = length(Role::CycleR) {
            self.r = Some((r, incremental));
        }
        if let Some((_, z)) = command.axes().filter(|(axis, _)| *axis == along).last() {
            self.z = Some((z * unit, incremental));
        }
        self.peck = length(Role::CycleQ).or(self.peck);
        self.dwell = command.word(Role::CycleDwell).map_or(self.dwell, |ms| ms / 1000.0);
        self.waited = self.waited.filter(|_| command.word(Role::CycleDwell).is_none());
        self.without_dwell = command.without_dwell;
        self.first_peck = length(Role::PeckFirst).or(self.first_peck);
        self.less = length(Role::PeckLess).unwrap_or(self.less);
        self.least = length(Role::PeckLeast).unwrap_or(self.least);
        self.clear = length(Role::PeckClear).or(self.clear);
        self.lead = length(Role::Lead).or(self.lead);
        self.shift =
            (length(Role::CycleI).unwrap_or(self.shift.0), length(Role::CycleJ).unwrap_or(self.shift.1));
    }

    /// True for pecks that are told no depth.
    pub(super) fn pecks_nothing(&self) -> bool {
        let none = |depth: Option<f64>| depth.is_none_or(|depth| depth == 0.0);
        matches!(self.op, Op::CyclePeck | Op::CycleChipBreak) && none(self.first_peck.or(self.peck))
    }

    /// True where a plane was given in the other mode of coordinates than the present one.
    fn mixes(&self, incremental: bool) -> bool {
        [self.r, self.z].iter().flatten().any(|(_, given)| *given != incremental)
    }

    /// The planes; none without a bottom. Incremental, the retract plane counts from the initial
    /// one and the bottom from the retract plane.
    pub(super) fn planes(&self, mode: Option<bool>) -> Option<Planes> {
        let r = match self.r {
            Some((r, given)) if mode.unwrap_or(given) => self.initial + r,
            Some((r, _)) => r,
            None => self.initial,
        };
        let (z, given) = self.z?;
        let bottom = if mode.unwrap_or(given) { r + z } else { z };
        Some(Planes { initial: self.initial, r, bottom })
    }
}
