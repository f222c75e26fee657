//! Blocks that wait for the next one: with a corner after them, or with a line whose end the next block gives (Q2, Q3).
//!
//! The control reads ahead, and nothing of such a block is done before the next one is read.

use super::corner;
use super::drawn::{self, Move};
use super::shape::Piece;
use super::way::{self, Point};
use super::{alarm, profile};
use crate::canon::{Auxiliary, Group, Op, Role};
use crate::control::machine::{Command, Machine, block};
use crate::control::outcome::Stop;
use crate::control::trace::{Place, Trace};

/// A block that waits.
#[derive(Clone, Debug)]
pub struct Waiting {
    command: Command,
    /// Where it stands.
    at: Place,
    /// Its move, as far as it is known.
    drawn: Move,
    /// True where its words are increments by a mode.
    incremental: bool,
}

/// Takes a block that waits, or that others wait for. False for any other: it is done as it stands.
pub fn takes(machine: &mut Machine, command: &Command, trace: &mut Trace) -> Result<bool, Stop> {
    let first = machine.lathe.waiting.is_empty();
    // What mills a face or a side refuses such words itself.
    let mills = machine.lathe.surface.is_some();
    if first && (mills || !command.words.iter().any(|(role, _)| role.is_drawn())) {
        return Ok(false);
    }
    let told = command.of(Group::Motion);
    if command.has(Op::Dwell) {
        return Err(Stop::unnamed("a wait beside a corner or an angle, or before the next block"));
    }
    match told.unwrap_or(if first { machine.motion } else { Op::Linear }) {
        Op::Linear => {}
        // It has an alarm of its own.
        Op::Thread | Op::ThreadVariable if first => return Ok(false),
        Op::ArcCw | Op::ArcCcw
            if !first && machine.lathe.waiting.iter().all(|one| one.drawn.turn.is_none()) =>
        {
            return Err(Stop::unnamed("a corner beside an arc: no source says where it begins and ends"));
        }
        _ if first => {
            return Err(Stop::unnamed("a corner or an angle in a block that is no straight feed move"));
        }
        _ => return Err(alarm("PS0052", "the block after a corner is no straight feed move")),
    }
    if first && told.is_none() && machine.cycle.is_some() {
        return Err(Stop::unnamed("a corner or an angle in a drilling cycle"));
    }
    allows(command)?;
    if first && told.is_none() {
        way::doubt_motion(machine, trace);
    }
    let waiting = machine.waiting(command, trace.at)?;
    let ready = !waiting.drawn.waits();
    machine.lathe.waiting.push(waiting);
    if ready {
        run(machine, trace)?;
    }
    Ok(true)
}

/// What may stand in a block that waits, or that others wait for.
fn allows(command: &Command) -> Result<(), Stop> {
    let fine = |op: Op| {
        let own = matches!(op.auxiliary(), Some(kind) if kind != Auxiliary::Change);
        matches!(op.group(), Group::RadiusComp | Group::FeedMode)
            || matches!(op, Op::Linear | Op::Absolute | Op::Incremental)
            || matches!(op, Op::MachineSpecific | Op::Builder | Op::Act)
            || own
    };
    if let Some(op) = command.ops.iter().find(|op| !fine(**op)) {
        return Err(Stop::unnamed(format!(
            "{op} in a block with a corner or an angle, or in the one after it"
        )));
    }
    match command.words.iter().find(|(role, _)| *role == Role::Turret || !profile::may_stand(*role)) {
        Some((role, _)) => {
            Err(Stop::unnamed(format!("{role} in a block with a corner or an angle, or in the one after it")))
        }
        None => Ok(()),
    }
}

impl Machine {
    /// True while a block waits for the next one.
    pub fn waits(&self) -> bool {
        !self.lathe.waiting.is_empty()
    }

    /// The alarm of a program that goes elsewhere while a block waits.
    pub fn waits_in_vain(&self) -> Stop {
        match self.lathe.waiting.last().is_some_and(|one| one.drawn.open.is_some()) {
            true => alarm("PS0056", "no block gives the end of a line by its angle alone"),
            false => alarm("PS0052", "no straight feed move comes after a corner"),
        }
    }

    /// What is known of a block that waits, or that others wait for; the one before it gets its end.
    fn waiting(&mut self, command: &Command, at: Place) -> Result<Waiting, Stop> {
        let (corner, turn) = corner::of(self, command)?;
        let before = self.lathe.waiting.last();
        let mode = before.map_or(self.incremental, |one| one.incremental);
        let incremental = command.of(Group::Distance).map_or(mode, |op| op == Op::Incremental);
        let from = before.map_or_else(|| self.tool_at(), |one| one.drawn.piece.to);
        if corner.is_some() && command.ops.iter().any(|op| op.group() == Group::RadiusComp) {
            return Err(alarm(
                "PS0039",
                "a corner in a block that begins or ends the compensation of the nose",
            ));
        }
        if command.words.iter().all(|(role, _)| !role.is_axis() && *role != Role::LineAngle) {
            return Err(match before {
                Some(_) => alarm("PS0052", "the block after a corner does not move"),
                None => Stop::unnamed("a corner in a block that does not move"),
            });
        }
        let steps = incremental || command.words.iter().any(|(role, _)| role.is_step());
        let to = self.drawn_to(command, from, incremental);
        let block = self.lathe.waiting.len();
        let before = self.lathe.waiting.last_mut().map(|one| &mut one.drawn);
        let (piece, open) = drawn::line(command, steps, (from, to), before)?;
        let drawn = Move { piece, block, corner, turn, open };
        Ok(Waiting { command: command.clone(), at, drawn, incremental })
    }

    /// The place that the words of a block say, from another one, in work coordinates; X as a radius.
    pub(super) fn drawn_to(&self, command: &Command, from: Point, incremental: bool) -> Point {
        let (unit, mut to) = (self.unit(), from);
        for (axis, value, steps) in command.places() {
            let (place, scale) = match axis {
                0 => (0, 0.5),
                2 => (1, 1.0),
                _ => continue,
            };
            let value = value * unit * scale;
            to[place] = if steps || incremental { to[place] + value } else { value };
        }
        to
    }

    /// Takes in the words of a block that goes along these pieces, and how far rounding puts their ends off.
    fn round_drawn(&mut self, command: &Command, pieces: &[Piece], trace: &mut Trace) {
        self.round_in(command, trace);
        let [x, z] = self.off_ends(pieces);
        self.round_place(0, x);
        self.round_place(2, z);
        // An arc between two such ends is off by more than they are.
        trace.rounded = trace.rounded.max(self.off_by()) + x.max(z);
    }

    /// How far the rounding of the ends of some pieces to least increments puts them off, along X (a diameter) and Z.
    pub(super) fn off_ends(&self, pieces: &[Piece]) -> [f64; 2] {
        let off = |axis: usize, scale: f64| {
            let ends = pieces.iter().map(|piece| self.off_place(piece.to[axis] * scale));
            ends.fold(0.0, f64::max)
        };
        [off(0, 2.0), off(1, 1.0)]
    }
}

/// Does the blocks that waited, in their order.
fn run(machine: &mut Machine, trace: &mut Trace) -> Result<(), Stop> {
    let waiting = std::mem::take(&mut machine.lathe.waiting);
    let moves = waiting.iter().map(|one| one.drawn).collect();
    let (pieces, blocks) = drawn::cornered(moves, waiting.len())?;
    let here = trace.at;
    for (mut one, pieces) in waiting.into_iter().zip(blocks.into_iter().map(|range| pieces.get(range))) {
        let pieces = pieces.unwrap_or_default().to_vec();
        one.command.words.retain(|(role, _)| !role.is_drawn());
        trace.at = one.at;
        machine.round_drawn(&one.command, &pieces, trace);
        machine.lathe.way = Some(pieces);
        block::run(machine, &one.command, trace)?;
        machine.lathe.way = None;
        if trace.is_full() {
            break;
        }
    }
    trace.at = here;
    Ok(())
}
