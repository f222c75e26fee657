//! Roughing a contour by passes along Z or along X (R5, R10, R11, K1 to K13).

use super::levels::{Levels, sense_of};
use super::profile::Profile;
use super::shape::Piece;
use super::stretches::{DEEPER, Rough};
use super::way::Point;
use super::{Cut, alarm, along, sense};
use crate::canon::{CycleSetting, Op, Role};
use crate::control::machine::{Command, Machine};
use crate::control::outcome::Stop;
use crate::control::trace::{EventKind, Leg, Position, Trace};

/// What stays on the part: for finishing, and for the last roughing pass; X as a radius.
struct Allowances {
    finish: Point,
    rough: Point,
}

/// Roughs; `axis` is that of the infeed: 0 for X, 1 for Z.
pub fn run(
    machine: &mut Machine,
    command: &Command,
    profile: &Profile,
    axis: usize,
    trace: &mut Trace,
) -> Result<(), Stop> {
    let cut = cut(machine, command, axis)?;
    let valleys = has_valleys(machine, command, profile, axis)?;
    let a = machine.tool_at();
    let (whole, held) = (profile, without_end(machine, profile, (a, axis), trace));
    let profile = held.as_ref().unwrap_or(whole);
    let (begin, end) = (profile.begin(), profile.end());
    let infeed = infeed(profile, a, axis);
    let along = sense_of(begin, end, 1 - axis);
    monotone(profile, (a, axis), (infeed, along), valleys)?;
    beyond(machine, profile, (a, axis), infeed)?;
    let left = allowances(machine, command);
    let into = |place: usize, sense: f64| left.finish[place] * sense > 0.0;
    if into(axis, infeed) || into(1 - axis, along) {
        trace.doubt("machine:lathe.allowance.into.part");
    }
    let off: Point = std::array::from_fn(|place| left.finish[place] + left.rough[place]);
    let corner: Point = std::array::from_fn(|place| a[place] + off[place]);
    tell(machine, (command, profile), cut.0, &left, trace);
    machine.go(true, corner, trace);
    if infeed != 0.0 && along != 0.0 {
        let parts = profile.pieces.iter().flat_map(|piece| piece.moved(off).parts()).collect();
        let rough = Rough { parts, axis, sense: infeed, zero: corner[axis] };
        let bottom = !machine.rules.roughing_along.ask(trace);
        let levels = Levels {
            rough: &rough,
            corner,
            cut: along,
            depth: cut.0,
            retract: cut.1,
            rapid: profile.rapid,
            bottom,
        };
        if valleys { levels.valleys(machine, trace)? } else { levels.steps(machine, trace)? }
    }
    along_contour(machine, whole, &left, valleys, trace)
}

/// What is roughed of a contour whose last block is no stock: one that lies no deeper than the start, and goes back along the cut or beyond the
/// start. Only a control takes it where roughing has no first block (R10, R11).
fn without_end(
    machine: &Machine,
    profile: &Profile,
    (a, axis): (Point, usize),
    trace: &mut Trace,
) -> Option<Profile> {
    let infeed = sense_of(a, profile.begin(), axis);
    if machine.rules.turning.two_blocks || axis != 0 || infeed == 0.0 {
        return None;
    }
    let last = profile.blocks.iter().rposition(|pieces| !pieces.is_empty())?;
    let start = profile.blocks[last].start;
    let [piece] = profile.pieces.get(start..)? else { return None };
    let outside = |at: Point| (at[axis] - a[axis]) * infeed <= DEEPER;
    let along = sense_of(profile.begin(), piece.from, 1 - axis);
    let back = (piece.to[1 - axis] - piece.from[1 - axis]) * along < -DEEPER;
    let beyond = (piece.to[axis] - a[axis]) * infeed < -DEEPER;
    if start < 2 || piece.arc.is_some() || !outside(piece.from) || !outside(piece.to) || !(back || beyond) {
        return None;
    }
    if back {
        trace.doubt("machine:lathe.contour.returns");
    }
    Some(Profile {
        pieces: profile.pieces[..start].to_vec(),
        blocks: profile.blocks[..last].to_vec(),
        rapid: profile.rapid,
        names: profile.names,
        by_steps: profile.by_steps,
    })
}

/// Says what is roughed, ahead of the passes.
fn tell(
    machine: &Machine,
    (command, profile): (&Command, &Profile),
    depth: f64,
    left: &Allowances,
    trace: &mut Trace,
) {
    let cycle = command.ops.iter().copied().find(|op| op.reads_contour()).unwrap_or(Op::RoughTurning);
    let at = |place: Point| Position(machine.placed(Some(place[0]), Some(place[1])));
    let legs = profile.pieces.iter().map(|piece| Leg {
        to: at(piece.to),
        centre: piece.arc.map(|(centre, _)| at(centre)),
        ccw: piece.arc.is_some_and(|(_, sweep)| sweep > 0.0),
    });
    trace.push(EventKind::Roughing {
        cycle,
        depth,
        allowance: [2.0 * left.finish[0], left.finish[1]],
        contour: legs.collect(),
        rapid: profile.rapid,
        feed: machine.feed,
        mode: machine.feed_mode,
    });
    trace.roughs = true;
}

/// The depth of a pass and how far it goes back (R1, K1).
fn cut(machine: &Machine, command: &Command, axis: usize) -> Result<(f64, f64), Stop> {
    let (unit, turning) = (machine.unit(), &machine.rules.turning);
    let told = if axis == 0 { machine.lathe.turning } else { machine.lathe.facing };
    let Cut { depth, retract } = match command.word(Role::CutDepth) {
        Some(depth) => Cut { depth: Some(depth * unit), retract: None },
        None => told,
    };
    let depth = depth.or(turning.depth);
    let left = turning.left.contains(&CycleSetting::RoughRetract);
    let retract = if left { Some(0.0) } else { retract.or(turning.retract) };
    let depth =
        depth.ok_or_else(|| Stop::unnamed("a roughing whose depth no block and no parameter says"))?;
    if depth <= 0.0 {
        return Err(alarm("PS0062", "the depth of a roughing pass is not over 0"));
    }
    let retract =
        retract.ok_or_else(|| Stop::unnamed("a roughing whose way back no block and no parameter says"))?;
    Ok((depth, retract))
}

/// R5 and R6: the letters of the first block say it, or a word of the cycle.
fn has_valleys(machine: &Machine, command: &Command, profile: &Profile, axis: usize) -> Result<bool, Stop> {
    if axis == 0 && machine.rules.turning.valleys_by_word {
        return Ok(command.word(Role::ContourType) == Some(1.0));
    }
    match (profile.names[axis], profile.names[1 - axis]) {
        (true, across) => Ok(across),
        (false, _) => {
            Err(alarm("PS0323", "the first block of the contour does not name the axis of the infeed"))
        }
    }
}

/// K2: the sense of the infeed; 0 where there is none.
fn infeed(profile: &Profile, a: Point, axis: usize) -> f64 {
    let first = sense_of(a, profile.begin(), axis);
    if first != 0.0 {
        return first;
    }
    let parts = profile.pieces.iter().flat_map(Piece::parts);
    let ways = parts.map(|part| part.to[axis] - a[axis]);
    sense(ways.fold(0.0, |most: f64, way| if way.abs() > most.abs() { way } else { most }))
}

/// A contour that turns back by less, in millimetres, does not turn: no word can say it, but the top of an arc may lie so far beyond its end.
const TURNED: f64 = 0.001;

/// R10.
fn monotone(
    profile: &Profile,
    (a, axis): (Point, usize),
    (infeed, along): (f64, f64),
    valleys: bool,
) -> Result<(), Stop> {
    let (first, second) = if axis == 0 { ("PS0064", "PS0329") } else { ("PS0329", "PS0064") };
    let back = || alarm(first, "the contour turns back along the cut");
    let other = 1 - axis;
    if valleys && (profile.begin()[other] - a[other]) * along < -TURNED {
        return Err(back());
    }
    for part in profile.pieces.iter().skip(1).flat_map(Piece::parts) {
        let way = |axis: usize| part.to[axis] - part.from[axis];
        if way(other) * along < -TURNED || (along == 0.0 && way(other).abs() > TURNED) {
            return Err(back());
        }
        if !valleys && way(axis) * infeed > TURNED {
            return Err(alarm(second, "the contour turns back along the infeed"));
        }
    }
    Ok(())
}

/// R11: nothing lies beyond the start of the cycle; where roughing has no first block, its last block may.
fn beyond(machine: &Machine, profile: &Profile, (a, axis): (Point, usize), infeed: f64) -> Result<(), Stop> {
    if !machine.rules.turning.checks_start {
        return Ok(());
    }
    let lies = |at: Point| (at[axis] - a[axis]) * infeed < -DEEPER;
    let two_blocks = machine.rules.turning.two_blocks;
    let last = profile.blocks.iter().rfind(|pieces| !pieces.is_empty()).map_or(0, |pieces| pieces.start);
    let held = profile.pieces.iter().enumerate().filter(|(at, _)| two_blocks || *at < last);
    match held.flat_map(|(_, piece)| piece.parts()).any(|part| lies(part.to)) {
        true => Err(alarm("PS0322", "the contour goes beyond the start of the cycle")),
        false => Ok(()),
    }
}

fn allowances(machine: &Machine, command: &Command) -> Allowances {
    let unit = machine.unit();
    let length = |role| command.word(role).map_or(0.0, |value| value * unit);
    Allowances {
        finish: [length(Role::AllowanceX) / 2.0, length(Role::AllowanceZ)],
        rough: [length(Role::RoughX), length(Role::RoughZ)],
    }
}

/// K9.
fn along_contour(
    machine: &mut Machine,
    profile: &Profile,
    left: &Allowances,
    valleys: bool,
    trace: &mut Trace,
) -> Result<(), Stop> {
    let skips = machine.rules.turning.skips_along[usize::from(valleys)];
    let always = machine.rules.roughing_along.ask(trace) && !skips;
    if !always && left.rough == [0.0; 2] {
        return Ok(());
    }
    along::run(machine, profile, left.finish, trace)
}
