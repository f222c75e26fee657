//! Lines with corners and angles, as a drawing gives them, and where they and their corners go.
//!
//! X is a diameter in words and a radius here; lengths and angles are real ones. The lines follow one another: all but the last have a
//! corner after them, or end where the next one meets them.

use crate::canon::{Auxiliary, Group, Op, Role};
use crate::ir::{Expr, Nc, NcItem};

/// X as a radius, and Z.
pub type Place = [f64; 2];

/// A coordinate of a line's end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Coordinate {
    /// The line stays there.
    Same,
    /// A place.
    At(f64),
    /// How far from its beginning.
    By(f64),
}

/// What the words of a block say.
#[derive(Clone, Copy, Debug)]
pub struct Line {
    /// X, a radius, and Z.
    pub to: [Coordinate; 2],
    /// The angle from Z, degrees, counter-clockwise.
    pub angle: Option<f64>,
    /// The corner after it: true for a chamfer, and its size.
    pub corner: Option<(bool, f64)>,
}

/// Where a line goes once its corners are cut.
#[derive(Clone, Copy, Debug)]
pub struct Drawn {
    pub from: Place,
    pub to: Place,
    /// The corner after it.
    pub corner: Option<Corner>,
}

/// A corner that is cut.
#[derive(Clone, Copy, Debug)]
pub struct Corner {
    pub to: Place,
    /// None for a chamfer.
    pub arc: Option<Arc>,
}

/// The arc of a round.
#[derive(Clone, Copy, Debug)]
pub struct Arc {
    radius: f64,
    /// True where it goes from Z to X.
    pub ccw: bool,
    centre: Place,
    /// True where it turns so far that the rounding of its ends would move a centre that its radius gives.
    sharp: bool,
}

/// Why lines are not written out.
#[derive(Clone, Debug)]
pub enum Fault {
    /// The source stops at an alarm, or no source says what it does.
    Source(String),
    /// It cannot be worked out here.
    Unknown(String),
}

impl From<&str> for Fault {
    fn from(what: &str) -> Self {
        Self::Source(what.to_owned())
    }
}

/// Lines that lie within a degree of each other do not meet, and have no corner.
const LEAST_TURN: f64 = 1.0;

/// An arc that turns farther is written by its centre, degrees.
const SHARP: f64 = 120.0;

/// What is no length, millimetres or inches.
const NONE: f64 = 1e-9;

/// True for a block that the next one must follow to say where it goes.
pub fn waits(nc: &Nc) -> bool {
    is_open(nc) || nc.items.iter().any(|item| matches!(item, NcItem::Word(role, _) if is_corner(*role)))
}

/// True for a line by its angle alone.
pub fn is_open(nc: &Nc) -> bool {
    nc.word(Role::LineAngle).is_some() && !nc.names_axis()
}

fn is_corner(role: Role) -> bool {
    role.is_drawn() && role != Role::LineAngle
}

/// What a block says, by its shape alone: none where it is well.
pub fn fault(nc: &Nc, before: Option<&Nc>) -> Option<&'static str> {
    let has = |role: Role| nc.word(role).is_some();
    let (x, z, angle) =
        (has(Role::X) || has(Role::StepX), has(Role::Z) || has(Role::StepZ), has(Role::LineAngle));
    let steps = has(Role::StepX) || has(Role::StepZ);
    if let Some(op) = nc.ops().find(|op| op.group() == Group::Motion && *op != Op::Linear) {
        return Some(match (before, op) {
            (Some(_), Op::ArcCw | Op::ArcCcw) => {
                "an arc beside a corner: no source says where the corner begins and ends"
            }
            (Some(_), _) => "the block after a corner is no straight feed move: the source stops at an alarm",
            (None, _) => "a corner or an angle in a block that is no straight feed move",
        });
    }
    if before.is_some() && !nc.names_axis() && !angle {
        return Some(match nc.has(Op::Dwell) {
            true => {
                "a wait between a corner and the next block: no source says before which part of the corner it comes"
            }
            false => "the block after a corner does not move: the source stops at an alarm",
        });
    }
    let comp = nc.ops().any(|op| op.group() == Group::RadiusComp);
    if comp && nc.items.iter().any(|item| matches!(item, NcItem::Word(role, _) if is_corner(*role))) {
        return Some(
            "a corner in a block that begins or ends the compensation of the nose: the source stops at an alarm",
        );
    }
    match before.is_some_and(is_open) {
        true if !(x && z && angle) => Some(
            "the block after a line by its angle alone must have X, Z and an angle: otherwise the source stops at an alarm",
        ),
        true if steps => Some(
            "increments in the block after a line by its angle alone: where that line ends is worked out from the places X and Z",
        ),
        false if x && z && angle => {
            Some("the angle of a line beside X and Z of its end: no source says which counts")
        }
        _ => None,
    }
}

/// Reads the words of a block; `steps` where X and Z are increments by a mode. The first line of some may have the code of that mode, and the
/// last one M codes.
pub fn read(nc: &Nc, steps: bool, (first, last): (bool, bool)) -> Result<Line, Fault> {
    let mut line = Line { to: [Coordinate::Same; 2], angle: None, corner: None };
    for item in &nc.items {
        let beside = |what: &dyn std::fmt::Display| {
            Fault::Unknown(format!("{what} stands beside a corner or an angle, or in the block after it"))
        };
        let (role, value) = match item {
            NcItem::Op(op) if *op == Op::Linear || is_mode(*op) => continue,
            NcItem::Op(op) if first && op.group() == Group::Distance => continue,
            NcItem::Op(op) if last && is_beside(*op) => continue,
            NcItem::Word(Role::Feed, _) => continue,
            NcItem::Word(role, value) => (*role, value),
            NcItem::Op(op) => return Err(beside(op)),
            NcItem::Code(..) => return Err(beside(&"a computed code")),
        };
        let number = || {
            let what = format!(
                "the value of {role} is computed, so that the corner or the angle cannot be written out as moves"
            );
            value.constant().ok_or(Fault::Unknown(what))
        };
        let place = |value: f64, step: bool| {
            if step || steps { Coordinate::By(value) } else { Coordinate::At(value) }
        };
        match role {
            Role::X | Role::StepX => line.to[0] = place(number()? / 2.0, role == Role::StepX),
            Role::Z | Role::StepZ => line.to[1] = place(number()?, role == Role::StepZ),
            Role::LineAngle => line.angle = Some(number()?),
            Role::CornerChamfer => line.corner = Some((true, number()?)),
            Role::CornerRadius => line.corner = Some((false, number()?)),
            _ => return Err(beside(&role)),
        }
    }
    match line.corner {
        Some((_, size)) if size <= 0.0 => {
            Err("the size of this corner is 0 or negative: no source says what that does".into())
        }
        _ => Ok(line),
    }
}

/// What acts beside a move, or when it is done, and moves nothing.
fn is_beside(op: Op) -> bool {
    op.auxiliary().is_some_and(|kind| kind != Auxiliary::Change)
}

/// Modes that a line may set for itself.
fn is_mode(op: Op) -> bool {
    matches!(op.group(), Group::FeedMode | Group::RadiusComp)
}

/// Which coordinates count from the beginning because nobody knows it, and lines never name a place along that axis.
pub fn relative(lines: &[Line], start: [Option<f64>; 2]) -> Result<[bool; 2], Fault> {
    let mut all = [false; 2];
    for axis in 0..2 {
        let named = lines.iter().any(|line| matches!(line.to[axis], Coordinate::At(_)));
        match start[axis] {
            Some(_) => {}
            None if named => {
                let what = format!(
                    "where the line before this corner begins along {} is not known here",
                    ["X", "Z"][axis]
                );
                return Err(Fault::Unknown(what));
            }
            None => all[axis] = true,
        }
    }
    Ok(all)
}

/// Where the lines go.
pub fn solve(lines: &[Line], start: Place) -> Result<Vec<Drawn>, Fault> {
    let mut corners = vec![start];
    for (at, line) in lines.iter().enumerate() {
        let (from, open) =
            (corners[at], at.checked_sub(1).and_then(|before| lines.get(before)).filter(|line| alone(line)));
        let mut to: Place = std::array::from_fn(|axis| match line.to[axis] {
            Coordinate::Same => from[axis],
            Coordinate::At(place) => place,
            Coordinate::By(way) => from[axis] + way,
        });
        if let (Some(open), Some(angle)) = (open.and_then(|line| line.angle), line.angle) {
            // Its own beginning was not known until now.
            corners[at] = meeting((corners[at - 1], open), (to, angle))?;
        } else if let Some(angle) = line.angle.filter(|_| !alone(line)) {
            let named = line.to[0] != Coordinate::Same;
            let way = if named { to[0] - from[0] } else { to[1] - from[1] };
            to = by_angle(from, way, angle, named)?;
        }
        corners.push(to);
    }
    let mut drawn: Vec<Drawn> =
        corners.windows(2).map(|ends| Drawn { from: ends[0], to: ends[1], corner: None }).collect();
    for (at, line) in lines.iter().enumerate() {
        let Some((chamfer, size)) = line.corner else { continue };
        let (Some(this), Some(next)) = (drawn.get(at).copied(), drawn.get(at + 1).copied()) else {
            return Err("no straight feed move comes after this corner: the source stops at an alarm".into());
        };
        let corner = cut(&this, &next, chamfer, size)?;
        let (end, begin) = corner.0;
        drawn[at].to = end;
        drawn[at].corner = Some(Corner { to: begin, arc: corner.1 });
        drawn[at + 1].from = begin;
    }
    Ok(drawn)
}

/// True for a line by its angle alone.
fn alone(line: &Line) -> bool {
    line.angle.is_some() && line.to == [Coordinate::Same; 2]
}

/// The end of a line at an angle, of which one coordinate is known: that of X, or of Z.
fn by_angle(from: Place, way: f64, angle: f64, along_x: bool) -> Result<Place, Fault> {
    let from_axis = if along_x { angle.rem_euclid(180.0) } else { (angle + 90.0).rem_euclid(180.0) };
    if from_axis <= LEAST_TURN + NONE || from_axis >= 180.0 - LEAST_TURN - NONE {
        return Err("a line by its angle does not come to its end: the source stops at an alarm".into());
    }
    let tangent = angle.to_radians().tan();
    Ok(match along_x {
        true => [from[0] + way, from[1] + way / tangent],
        false => [from[0] + way * tangent, from[1] + way],
    })
}

/// Where a line from a place meets one through another place, each at its angle.
fn meeting((from, angle): (Place, f64), (through, other): (Place, f64)) -> Result<Place, Fault> {
    let between = (angle - other).rem_euclid(180.0);
    if between <= LEAST_TURN + NONE || between >= 180.0 - LEAST_TURN - NONE {
        return Err("two lines by their angles do not meet: the source stops at an alarm".into());
    }
    // How far the first place lies from the other line, and how fast its own line comes nearer.
    let (sin, cos) = other.to_radians().sin_cos();
    let away = (from[0] - through[0]) * cos - (from[1] - through[1]) * sin;
    let (rise, run) = angle.to_radians().sin_cos();
    let way = away / (run * sin - rise * cos);
    Ok([from[0] + way * rise, from[1] + way * run])
}

/// Where a corner begins and ends, and its arc.
type Cut = ((Place, Place), Option<Arc>);

fn cut(this: &Drawn, next: &Drawn, chamfer: bool, size: f64) -> Result<Cut, Fault> {
    let way = |line: &Drawn| [line.to[0] - line.from[0], line.to[1] - line.from[1]];
    let (one, two) = (way(this), way(next));
    let (long, longer) = (one[0].hypot(one[1]), two[0].hypot(two[1]));
    let too_long =
        || Fault::from("this corner is longer than a line beside it: the source stops at an alarm");
    if long <= NONE || longer <= NONE {
        return Err(too_long());
    }
    let cos = ((one[0] * two[0] + one[1] * two[1]) / (long * longer)).clamp(-1.0, 1.0);
    // Positive from Z to X.
    let sense = one[1] * two[0] - one[0] * two[1];
    let turn = cos.acos().to_degrees();
    if turn <= LEAST_TURN || turn >= 180.0 - LEAST_TURN {
        return Err(
            "the lines beside this corner hardly turn, or turn right back: no source says what the corner is"
                .into(),
        );
    }
    let short = if chamfer { size } else { size * ((1.0 - cos) / (1.0 + cos)).sqrt() };
    if short > long + NONE || short > longer + NONE {
        return Err(too_long());
    }
    let at = this.to;
    let begin = [at[0] - one[0] / long * short, at[1] - one[1] / long * short];
    let end = [at[0] + two[0] / longer * short, at[1] + two[1] / longer * short];
    // The centre lies to the side that the lines turn to.
    let side = if sense > 0.0 { size } else { -size };
    let centre = [begin[0] + side * one[1] / long, begin[1] - side * one[0] / long];
    let arc = Arc { radius: size, ccw: sense > 0.0, centre, sharp: turn > SHARP };
    Ok(((begin, end), (!chamfer).then_some(arc)))
}

/// A value that a word has by a number of its own.
pub fn word(role: Role, value: f64) -> NcItem {
    NcItem::Word(role, Expr::Number(value))
}

/// How places are written.
pub struct Words {
    /// True where X and Z are increments by a mode.
    pub steps: bool,
    /// True for an axis along which only increments are known.
    pub relative: [bool; 2],
    /// The target's least increment.
    pub increment: f64,
}

impl Words {
    /// A length as the target can write it.
    fn rounded(&self, value: f64) -> f64 {
        let value =
            if self.increment > 0.0 { (value / self.increment).round() * self.increment } else { value };
        // A sum of rounded lengths has no digits behind the last one.
        (value * 1e6).round() / 1e6
    }

    /// The words from one place to another, of the axes that move and those that are named.
    pub fn ways(&self, from: [f64; 2], to: [f64; 2], named: [bool; 2]) -> Vec<NcItem> {
        let (roles, letters) = ([Role::X, Role::Z], [Role::StepX, Role::StepZ]);
        let word = |axis: usize| {
            let scale = if axis == 0 { 2.0 } else { 1.0 };
            let (from, to) = (self.rounded(scale * from[axis]), self.rounded(scale * to[axis]));
            let by = self.rounded(to - from);
            if by == 0.0 && !named[axis] {
                return None;
            }
            let role = if self.relative[axis] && !self.steps { letters[axis] } else { roles[axis] };
            let value = if self.relative[axis] || self.steps { by } else { to };
            // No minus before 0.
            Some(word(role, value + 0.0))
        };
        (0..2).filter_map(word).collect()
    }

    /// The words of an arc that begins at a place: its radius, or where its centre lies from there.
    pub fn arc(&self, from: Place, arc: &Arc) -> Vec<NcItem> {
        if !arc.sharp {
            return vec![word(Role::ArcRadius, arc.radius)];
        }
        let x = self.rounded(arc.centre[0] - self.rounded(2.0 * from[0]) / 2.0);
        let z = self.rounded(arc.centre[1] - self.rounded(from[1]));
        vec![word(Role::ArcI, x + 0.0), word(Role::ArcK, z + 0.0)]
    }

    /// The block of a line; `ends` where it ends where its words say.
    pub fn line(&self, nc: &Nc, line: &Drawn, ends: bool) -> Nc {
        let axis = |role: &Role| matches!(role, Role::X | Role::StepX | Role::Z | Role::StepZ);
        let by = |role: &Role| matches!(role, Role::StepX | Role::StepZ) || self.steps;
        let is_step =
            nc.items.iter().any(|item| matches!(item, NcItem::Word(role, _) if axis(role) && by(role)));
        if ends && !is_step {
            return nc.clone();
        }
        let has = |roles: [Role; 2]| roles.iter().any(|role| nc.word(*role).is_some());
        let named = [has([Role::X, Role::StepX]), has([Role::Z, Role::StepZ])];
        let places = self.ways(line.from, line.to, named);
        let stays = |item: &&NcItem| !matches!(item, NcItem::Word(role, _) if axis(role) || role.is_drawn());
        let (ops, words): (Vec<_>, Vec<_>) =
            nc.items.iter().filter(stays).cloned().partition(|item| matches!(item, NcItem::Op(_)));
        Nc { items: ops.into_iter().chain(places).chain(words).collect() }
    }
}
