//! From the blocks of a contour to its lines and arcs (R4 to R9).

use super::contour::{Contour, Contoured};
use super::shape::Piece;
use super::way::Point;
use super::{EXACT, alarm, corner};
use crate::canon::{Auxiliary, Group, Op, Role};
use crate::control::machine::arc::{self, Flat};
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

/// A move of the contour before its corners are cut.
struct Move {
    piece: Piece,
    block: usize,
    /// A corner after it: true for a chamfer, and its size.
    corner: Option<(bool, f64)>,
    /// The way that the next move must go along the other axis, where the corner has a sign.
    turn: Option<(Option<usize>, f64)>,
}

impl Profile {
    /// Reads the blocks, as a cycle allows them.
    pub fn read(machine: &Machine, op: Op, contour: &Contour, trace: &mut Trace) -> Result<Self, Stop> {
        let mut reader = Reader { machine, at: machine.tool_at(), motion: Op::Rapid };
        let mut moves = Vec::new();
        for (block, found) in contour.blocks.iter().enumerate() {
            check(op, &found.command, trace)?;
            if block == 0 {
                reader.begin(found)?;
            }
            moves.extend(reader.block(block, &found.command, trace)?);
        }
        let first = contour.blocks.first().map(|block| &block.command);
        let is_first = |moved: &Move| moved.block == 0;
        if !moves.first().is_some_and(is_first) {
            return Err(alarm("PS0065", "the first block of the contour does not move"));
        }
        let has = |role: Role| first.is_some_and(|command| command.word(role).is_some());
        let steps = |role: Role| contour.blocks.iter().all(|block| block.command.word(role).is_none());
        let by_steps = machine.incremental || (steps(Role::X) && steps(Role::Z));
        let names = [has(Role::X) || has(Role::StepX), has(Role::Z) || has(Role::StepZ)];
        let rapid = moves.first().is_some_and(|moved| moved.piece.rapid);
        let (pieces, blocks) = cornered(moves, contour.blocks.len())?;
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
fn check(op: Op, command: &Command, trace: &mut Trace) -> Result<(), Stop> {
    use Op::{ArcCcw, ArcCw, Dwell, Linear, OptionalStop, Rapid, Stop as Halt};
    let number = if op == Op::Finish { "PS0325" } else { "PS0066" };
    for found in &command.ops {
        let comp = found.group() == Group::RadiusComp;
        let own = matches!(found.auxiliary(), Some(kind) if kind != Auxiliary::Change);
        let m = matches!(found, Op::MachineSpecific | Op::Builder | Op::Act | Halt | OptionalStop);
        let fine = matches!(found, Rapid | Linear | ArcCw | ArcCcw | Dwell | Op::TurretIndex);
        if !(comp || own || m || fine) {
            return Err(alarm(number, &format!("{found} between the blocks of a contour")));
        }
        if op != Op::Finish && matches!(found, Op::RadiusLeft | Op::RadiusRight) {
            trace.doubt("machine:lathe.nose.roughing");
        }
    }
    let fine = |role: Role| {
        matches!(
            role,
            Role::X | Role::Z | Role::StepX | Role::StepZ | Role::ArcI | Role::ArcK | Role::ArcRadius
        ) || matches!(role, Role::CornerRadius | Role::CornerChamfer | Role::DwellS | Role::DwellMs)
            || matches!(
                role,
                Role::ChamferX | Role::ChamferZ | Role::ChamferNext | Role::RoundNext | Role::LineAngle
            )
            || matches!(
                role,
                Role::Feed | Role::Speed | Role::Turret | Role::Act | Role::Output | Role::Builder
            )
            || role.is_act_word()
    };
    match command.words.iter().find(|(role, _)| !fine(*role)) {
        Some((role, _)) => Err(Stop::unnamed(format!("{role} between the blocks of a contour"))),
        None => Ok(()),
    }
}

/// A corner: true for a chamfer, and its size.
type Cut = Option<(bool, f64)>;

/// The axis that the next move must go along, where it is named, and the way.
type Way = Option<(Option<usize>, f64)>;

/// What is in force from block to block.
struct Reader<'m> {
    machine: &'m Machine,
    at: Point,
    motion: Op,
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

    fn block(&mut self, block: usize, command: &Command, trace: &mut Trace) -> Result<Option<Move>, Stop> {
        self.motion = command.of(Group::Motion).unwrap_or(self.motion);
        let (corner, turn) = self.corner(command)?;
        // The axis words of a wait are its time.
        let arcs = matches!(self.motion, Op::ArcCw | Op::ArcCcw);
        let goes = command.has_axes() || (arcs && arc::has_centre(command));
        if !goes || command.has(Op::Dwell) {
            return match corner {
                Some(_) => Err(Stop::unnamed("a corner in a block of a contour that does not move")),
                None => Ok(None),
            };
        }
        let (from, mut to) = (self.at, self.target(command));
        if let Some(angle) = command.word(Role::LineAngle) {
            if self.motion != Op::Linear {
                return Err(Stop::unnamed("an angle in a block that is no straight feed move"));
            }
            let ways = [2.0 * (to[0] - from[0]), to[1] - from[1]];
            match corner::end(command, angle, ways)? {
                (Role::StepX, way) => to[0] += way / 2.0,
                (_, way) => to[1] += way,
            }
        }
        self.at = to;
        let arc = if arcs { Some(self.arc(command, from, to, trace)?) } else { None };
        if !arcs && arc::has_centre(command) {
            return Err(Stop::unnamed("a corner without a comma in a contour"));
        }
        let piece = Piece { from, to, arc, rapid: self.motion == Op::Rapid };
        Ok(Some(Move { piece, block, corner, turn }))
    }

    fn target(&self, command: &Command) -> Point {
        let unit = self.machine.unit();
        let mut to = self.at;
        for (axis, value, steps) in command.places() {
            let (place, scale) = match axis {
                0 => (0, 0.5),
                2 => (1, 1.0),
                _ => continue,
            };
            let value = value * unit * scale;
            to[place] = if steps || self.machine.incremental { to[place] + value } else { value };
        }
        to
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

    fn corner(&self, command: &Command) -> Result<(Cut, Way), Stop> {
        let unit = self.machine.unit();
        let word = |role, chamfer| command.word(role).map(|size| (chamfer, size * unit));
        let signed = corner::words(command);
        match (word(Role::CornerRadius, false), word(Role::CornerChamfer, true), signed.as_slice()) {
            (None, None, [(chamfer, axis, value)]) => {
                Ok((Some((*chamfer, value.abs() * unit)), Some((*axis, value.signum()))))
            }
            (round, chamfer, []) if round.is_none() || chamfer.is_none() => Ok((round.or(chamfer), None)),
            _ => Err(Stop::unnamed("two corners in one block of a contour")),
        }
    }
}

/// Cuts the corners (R9).
fn cornered(mut moves: Vec<Move>, blocks: usize) -> Result<(Vec<Piece>, Vec<Range<usize>>), Stop> {
    let (mut pieces, mut of_block) = (Vec::new(), vec![0..0; blocks]);
    for at in 0..moves.len() {
        let begins = pieces.len();
        let (head, tail) = moves.split_at_mut(at + 1);
        let Some(here) = head.last_mut() else { break };
        let cut = match (here.corner, tail.first_mut()) {
            (None, _) => None,
            (Some(_), None) => return Err(alarm("PS0069", "the contour ends in a corner")),
            (Some((chamfer, size)), Some(next)) => {
                if !goes_on(&here.piece, &next.piece, here.turn) {
                    return Err(alarm("PS0051", "the block after a corner goes another way"));
                }
                Some(cut(&mut here.piece, &mut next.piece, chamfer, size)?)
            }
        };
        pieces.push(here.piece);
        pieces.extend(cut);
        if let Some(range) = of_block.get_mut(here.block) {
            *range = begins..pieces.len();
        }
    }
    Ok((pieces, of_block))
}

/// True where a corner without a sign is, or one after a move along one axis and before one along the other, its sign's way.
fn goes_on(here: &Piece, next: &Piece, turn: Way) -> bool {
    let Some((named, sign)) = turn else { return true };
    let way = |piece: &Piece| [piece.to[0] - piece.from[0], piece.to[1] - piece.from[1]];
    let (one, two) = (way(here), way(next));
    let along = if one[0].abs() > EXACT { 0 } else { 1 };
    let axis = 1 - along;
    let named = named.is_none_or(|named| named == 2 * axis);
    named && one[axis].abs() <= EXACT && two[along].abs() <= EXACT && two[axis] * sign > EXACT
}

/// Shortens two lines, and gives what joins them.
fn cut(before: &mut Piece, after: &mut Piece, chamfer: bool, size: f64) -> Result<Piece, Stop> {
    if [&*before, &*after].iter().any(|piece| piece.arc.is_some() || piece.rapid) {
        return Err(Stop::unnamed("a corner of a contour that is not between two straight lines"));
    }
    let way = |piece: &Piece| [piece.to[0] - piece.from[0], piece.to[1] - piece.from[1]];
    let (one, two) = (way(before), way(after));
    let (long, longer) = (one[0].hypot(one[1]), two[0].hypot(two[1]));
    if long <= EXACT || longer <= EXACT || size <= 0.0 {
        return Err(Stop::unnamed("a corner of a contour at a line of no length, or without a size"));
    }
    let (one, two) = (one.map(|part| part / long), two.map(|part| part / longer));
    // In the sense from Z to X.
    let turn = (one[1] * two[0] - one[0] * two[1]).atan2(one[0] * two[0] + one[1] * two[1]);
    if turn.abs() <= EXACT || turn.abs() >= std::f64::consts::PI - EXACT {
        return Err(Stop::unnamed("a corner of a contour where no corner is"));
    }
    let short = if chamfer { size } else { size * (turn.abs() / 2.0).tan() };
    if short > long + EXACT || short > longer + EXACT {
        return Err(alarm("PS0055", "a corner of the contour is longer than a line beside it"));
    }
    let place = before.to;
    before.to = [place[0] - one[0] * short, place[1] - one[1] * short];
    after.from = [place[0] + two[0] * short, place[1] + two[1] * short];
    let side = turn.signum();
    let centre = [before.to[0] + side * size * one[1], before.to[1] - side * size * one[0]];
    let arc = (!chamfer).then_some((centre, turn));
    Ok(Piece { from: before.to, to: after.from, arc, rapid: false })
}
