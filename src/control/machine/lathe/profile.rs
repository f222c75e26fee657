//! From the blocks of a contour to its lines and arcs (R4 to R9).

use super::contour::{Contour, Contoured};
use super::drawn::{self, Move};
use super::shape::Piece;
use super::way::Point;
use super::{EXACT, alarm, corner, said};
use crate::canon::{Auxiliary, Group, Op, Role};
use crate::control::machine::arc::{self, Flat};
use crate::control::machine::rules::NoCentre;
use crate::control::machine::{Command, Machine};
use crate::control::outcome::Stop;
use crate::control::trace::Trace;
use std::ops::Range;

/// A contour in work coordinates, X as a radius. The first piece leads from where the tool stands to its beginning.
pub struct Profile {
    pub pieces: Vec<Piece>,
    /// The pieces of each block.
    pub blocks: Vec<Range<usize>>,
    /// True where the first block goes in rapid.
    pub rapid: bool,
    /// True where the first block names X, and Z.
    pub names: [bool; 2],
    /// True where its increments make it count from where the cycle began (F4).
    pub by_steps: bool,
}

impl Profile {
    /// Reads the blocks, as a cycle allows them.
    pub fn read(machine: &Machine, op: Op, contour: &Contour, trace: &mut Trace) -> Result<Self, Stop> {
        let incremental = machine.is_incremental();
        let mut reader = Reader { machine, at: machine.tool_at(), motion: Op::Rapid, incremental };
        let mut moves = Vec::new();
        for (block, found) in contour.blocks.iter().enumerate() {
            check(op, &found.command, machine.rules.turning.nose_alarms, trace)?;
            if block == 0 {
                reader.begin(found)?;
            }
            reader.block((block, &found.command), &mut moves, trace)?;
        }
        let first = contour.blocks.first().map(|block| &block.command);
        let is_first = |moved: &Move| moved.block == 0;
        if !moves.first().is_some_and(is_first) {
            return Err(alarm("PS0065", "the first block of the contour does not move"));
        }
        let has = |role: Role| first.is_some_and(|command| command.word(role).is_some());
        let steps = |role: Role| contour.blocks.iter().all(|block| block.command.word(role).is_none());
        let told = contour.blocks.iter().any(|block| block.command.has(Op::Incremental));
        let by_steps = machine.incremental || told || (steps(Role::X) && steps(Role::Z));
        let names = [has(Role::X) || has(Role::StepX), has(Role::Z) || has(Role::StepZ)];
        let rapid = moves.first().is_some_and(|moved| moved.piece.rapid);
        let (pieces, blocks) = drawn::cornered(moves, contour.blocks.len())?;
        Ok(Self { pieces, blocks, rapid, names, by_steps })
    }

    /// Where it begins.
    pub fn begin(&self) -> Point {
        self.pieces.first().map_or([0.0; 2], |piece| piece.to)
    }

    /// Where it ends.
    pub fn end(&self) -> Point {
        self.pieces.last().map_or([0.0; 2], |piece| piece.to)
    }
}

/// R7: what may stand in a contour.
fn check(op: Op, command: &Command, nose_alarms: bool, trace: &mut Trace) -> Result<(), Stop> {
    use Op::{ArcCcw, ArcCw, Dwell, Linear, OptionalStop, Rapid, Stop as Halt};
    let number = if op == Op::Finish { "PS0325" } else { "PS0066" };
    for found in &command.ops {
        use Group::{Distance, FeedMode, RadiusComp, SpeedMode};
        let mode = matches!(found.group(), RadiusComp | SpeedMode | FeedMode | Distance);
        let own = matches!(found.auxiliary(), Some(kind) if kind != Auxiliary::Change);
        let m = matches!(found, Op::MachineSpecific | Op::Builder | Op::Act | Halt | OptionalStop);
        if nose_alarms && op != Op::Finish && found.group() == RadiusComp {
            return Err(alarm("PS0325", "nose radius compensation between the blocks of a contour"));
        }
        let fine = matches!(found, Rapid | Linear | ArcCw | ArcCcw | Dwell | Op::TurretIndex);
        if !(mode || own || m || fine) {
            return Err(alarm(
                number,
                &format!("'{}' between the blocks of a contour", said(found.meaning())),
            ));
        }
        if op != Op::Finish && matches!(found, Op::RadiusLeft | Op::RadiusRight) {
            trace.doubt("machine:lathe.nose.roughing");
        }
        if matches!(found.group(), SpeedMode | FeedMode) {
            trace.doubt("machine:lathe.contour.modes");
        }
    }
    match command.words.iter().find(|(role, _)| !may_stand(*role)) {
        Some((role, _)) => {
            Err(Stop::unnamed(format!("'{}' between the blocks of a contour", said(role.meaning()))))
        }
        None => Ok(()),
    }
}

/// True for a word that may stand in a contour.
pub(super) fn may_stand(role: Role) -> bool {
    use Role::{
        Act, ArcI, ArcK, ArcRadius, Builder, DwellMs, DwellS, Feed, Output, Speed, StepX, StepZ, Turret, X, Z,
    };
    matches!(role, X | Z | StepX | StepZ | ArcI | ArcK | ArcRadius | DwellS | DwellMs)
        || matches!(role, Feed | Speed | Turret | Act | Output | Builder)
        || role.is_drawn()
        || role.is_act_word()
}

/// What is in force from block to block.
struct Reader<'m> {
    machine: &'m Machine,
    at: Point,
    motion: Op,
    incremental: bool,
}

impl Reader<'_> {
    /// R5: the first block has a code of its own.
    fn begin(&mut self, first: &Contoured) -> Result<(), Stop> {
        match first.command.of(Group::Motion) {
            Some(Op::Rapid | Op::Linear) => Ok(()),
            _ => Err(alarm(
                "PS0065",
                "the first block of the contour has neither rapid nor a straight feed move",
            )),
        }
    }

    fn block(
        &mut self,
        (block, command): (usize, &Command),
        moves: &mut Vec<Move>,
        trace: &mut Trace,
    ) -> Result<(), Stop> {
        self.motion = command.of(Group::Motion).unwrap_or(self.motion);
        if let Some(mode) = command.of(Group::Distance) {
            self.incremental = mode == Op::Incremental;
        }
        let (corner, turn) = corner::of(self.machine, command)?;
        let angled = command.word(Role::LineAngle).is_some();
        // The axis words of a wait are its time.
        let arcs = matches!(self.motion, Op::ArcCw | Op::ArcCcw);
        let goes = command.has_axes() || angled || (arcs && arc::has_centre(command));
        let waits = moves.last().is_some_and(Move::waits);
        if !goes || command.has(Op::Dwell) {
            return match corner {
                Some(_) => Err(Stop::unnamed("a corner in a block of a contour that does not move")),
                None if waits && command.has(Op::Dwell) => {
                    Err(Stop::unnamed("a wait between a corner of a contour and the next block"))
                }
                None if waits && !command.is_empty() => {
                    Err(alarm("PS0052", "the block after a corner does not move"))
                }
                None => Ok(()),
            };
        }
        if self.motion != Op::Linear {
            if angled {
                return Err(Stop::unnamed("an angle in a block that is no straight feed move"));
            }
            if moves.last().is_some_and(|moved| moved.open.is_some()) {
                return Err(alarm(
                    "PS0056",
                    "the block after a line by its angle alone is no straight feed move",
                ));
            }
        }
        if !arcs && arc::has_centre(command) {
            return Err(Stop::unnamed("a corner without a comma in a contour"));
        }
        let incremental = self.incremental;
        let (from, to) = (self.at, self.machine.drawn_to(command, self.at, incremental));
        let (piece, open) = if self.motion == Op::Linear {
            let steps = incremental || command.words.iter().any(|(role, _)| role.is_step());
            drawn::line(command, steps, (from, to), moves.last_mut())?
        } else {
            let straight = arcs
                && !arc::has_centre(command)
                && self.machine.rules.no_centre.ask(trace) == NoCentre::Straight;
            let arc = if arcs && !straight { Some(self.arc(command, from, to, trace)?) } else { None };
            (Piece { from, to, arc, rapid: self.motion == Op::Rapid }, None)
        };
        self.at = piece.to;
        moves.push(Move { piece, block, corner, turn, open });
        Ok(())
    }

    fn arc(
        &self,
        command: &Command,
        from: Point,
        to: Point,
        trace: &mut Trace,
    ) -> Result<(Point, f64), Stop> {
        if !arc::has_centre(command) {
            return Err(alarm("PS0022", "an arc without centre and radius"));
        }
        let clockwise = self.motion == Op::ArcCw;
        let flat = Flat { from: (from[1], from[0]), to: (to[1], to[0]), clockwise };
        let Some((z, x)) = flat.centre(self.machine, command, trace)? else {
            return Err(Stop::unnamed("an arc by its radius that ends where it begins"));
        };
        let off = (to[0] - x).hypot(to[1] - z) - (from[0] - x).hypot(from[1] - z);
        if self.machine.rules.turning.arc_limit.is_some_and(|limit| off.abs() > limit + EXACT) {
            return Err(alarm("PS0020", "the end of the arc is not on its circle"));
        }
        Ok(([x, z], flat.sweep((z, x)).to_radians()))
    }
}
