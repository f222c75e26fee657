//! Lines as a drawing gives them: by their angle, one by the next one, and with corners between (Q2, Q3, R9).

use super::corner::{self, Cut, DEGREE, Way};
use super::shape::Piece;
use super::way::Point;
use super::{EXACT, alarm};
use crate::canon::Role;
use crate::control::machine::Command;
use crate::control::outcome::Stop;
use std::ops::Range;

/// A move before its corners are cut.
#[derive(Clone, Copy, Debug)]
pub struct Move {
    /// The move to the corner's own point.
    pub piece: Piece,
    /// The number of its block.
    pub block: usize,
    /// A corner after it.
    pub corner: Cut,
    /// The way that the next move must go along the other axis, where the corner has a sign.
    pub turn: Way,
    /// The angle, in degrees, of a line whose end the next block gives.
    pub open: Option<f64>,
}

impl Move {
    /// True where it takes the next block to say how it goes.
    pub fn waits(&self) -> bool {
        self.corner.is_some() || self.open.is_some()
    }
}

/// The line of a block that leads from one place to another by its words; `steps` where they count from the first. The line before
/// it gets its end, if it has none yet.
pub fn line(
    command: &Command,
    steps: bool,
    (from, to): (Point, Point),
    before: Option<&mut Move>,
) -> Result<(Piece, Option<f64>), Stop> {
    let (named, angle) = (corner::names(command), command.word(Role::LineAngle));
    let piece = |from, to| Piece { from, to, arc: None, rapid: false };
    if let Some(before) = before
        && let Some(first) = before.open
    {
        let (Some(angle), [true, true]) = (angle, named) else {
            let text = "the block after a line by its angle alone does not have X, Z and an angle";
            return Err(alarm("PS0056", text));
        };
        if steps {
            return Err(Stop::unnamed("increments after a line by its angle alone"));
        }
        let meet = meeting((before.piece.from, first), (to, angle))?;
        (before.piece.to, before.open) = (meet, None);
        return Ok((piece(meet, to), None));
    }
    match (angle, named) {
        (None, _) => Ok((piece(from, to), None)),
        (Some(_), [true, true]) => Err(Stop::unnamed("a line by its angle and by both its ends")),
        (Some(angle), [false, false]) => Ok((piece(from, from), Some(angle))),
        (Some(angle), named) => {
            let way = corner::along(angle, (named, [to[0] - from[0], to[1] - from[1]]))?;
            Ok((piece(from, [from[0] + way[0], from[1] + way[1]]), None))
        }
    }
}

/// Where two lines meet, each by a place on it and its angle from Z.
fn meeting((from, first): (Point, f64), (to, second): (Point, f64)) -> Result<Point, Stop> {
    let (sin, cos) = first.to_radians().sin_cos();
    let (sin2, cos2) = second.to_radians().sin_cos();
    let across = sin * cos2 - cos * sin2;
    if across.is_nan() || across.abs() <= DEGREE + EXACT {
        return Err(alarm("PS0058", "two lines by their angles do not meet"));
    }
    let way = ((to[0] - from[0]) * cos2 - (to[1] - from[1]) * sin2) / across;
    Ok([from[0] + way * sin, from[1] + way * cos])
}

/// Cuts the corners: the lines and arcs, and which of them each block makes.
pub fn cornered(mut moves: Vec<Move>, blocks: usize) -> Result<(Vec<Piece>, Vec<Range<usize>>), Stop> {
    let (mut pieces, mut of_block) = (Vec::new(), vec![0..0; blocks]);
    for at in 0..moves.len() {
        let begins = pieces.len();
        let (head, tail) = moves.split_at_mut(at + 1);
        let Some(here) = head.last_mut() else { break };
        if here.open.is_some() {
            return Err(alarm("PS0056", "no block gives the end of a line by its angle alone"));
        }
        let cut = match (here.corner, tail.first_mut()) {
            (None, _) => None,
            (Some(_), None) => return Err(alarm("PS0069", "the contour ends in a corner")),
            (Some((chamfer, size)), Some(next)) => {
                turns(&here.piece, &next.piece, here.turn)?;
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

/// How far a piece goes along X and along Z.
fn way(piece: &Piece) -> Point {
    [piece.to[0] - piece.from[0], piece.to[1] - piece.from[1]]
}

/// A corner with a sign stands between a move along one axis and one along the other, its sign's way.
fn turns(here: &Piece, next: &Piece, turn: Way) -> Result<(), Stop> {
    let Some((named, sign)) = turn else { return Ok(()) };
    let (one, two) = (way(here), way(next));
    let along = if one[0].abs() > EXACT { 0 } else { 1 };
    let axis = 1 - along;
    if one[axis].abs() > EXACT || named.is_some_and(|named| named != 2 * axis) {
        return Err(alarm("PS0054", "a corner after a block that does not go along one axis"));
    }
    if two[along].abs() > EXACT || two[axis] * sign <= EXACT {
        return Err(alarm("PS0051", "the block after a corner goes another way"));
    }
    Ok(())
}

/// Shortens two lines, and gives what joins them.
fn cut(before: &mut Piece, after: &mut Piece, chamfer: bool, size: f64) -> Result<Piece, Stop> {
    if [&*before, &*after].iter().any(|piece| piece.arc.is_some() || piece.rapid) {
        return Err(Stop::unnamed("a corner that is not between two straight lines"));
    }
    let (one, two) = (way(before), way(after));
    let (long, longer) = (one[0].hypot(one[1]), two[0].hypot(two[1]));
    let too_long = || alarm("PS0055", "a corner is longer than a line beside it");
    if long <= EXACT || longer <= EXACT {
        return Err(too_long());
    }
    let (one, two) = (one.map(|part| part / long), two.map(|part| part / longer));
    // In the sense from Z to X.
    let (across, on) = (one[1] * two[0] - one[0] * two[1], one[0] * two[0] + one[1] * two[1]);
    let turn = across.atan2(on);
    if across.abs() <= DEGREE {
        return Err(Stop::unnamed("a corner between lines that hardly turn, or turn right back"));
    }
    let short = if chamfer { size } else { size * (turn.abs() / 2.0).tan() };
    if short > long + EXACT || short > longer + EXACT {
        return Err(too_long());
    }
    let place = before.to;
    before.to = [place[0] - one[0] * short, place[1] - one[1] * short];
    after.from = [place[0] + two[0] * short, place[1] + two[1] * short];
    let side = turn.signum();
    let centre = [before.to[0] + side * size * one[1], before.to[1] - side * size * one[0]];
    let arc = (!chamfer).then_some((centre, turn));
    Ok(Piece { from: before.to, to: after.from, arc, rapid: false })
}
