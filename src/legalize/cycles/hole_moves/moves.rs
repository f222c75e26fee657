//! The moves of one hole.

use super::drill::{Cycle, Drill, Height, Known, Told, Value};
use crate::canon::{Group, Op, Role};
use crate::dialect::{Control, Question};
use crate::ir::analysis::Modal;
use crate::ir::{BinOp, Expr, Nc, NcItem};

/// One thing that a hole is made of.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Part {
    /// A move along Z, at feed or in rapid traverse.
    Move(bool, Expr),
    /// Words of their own.
    Words(Vec<NcItem>),
    /// The steps of a peck drill whose numbers the program computes.
    Pecks { retract: Expr, bottom: Expr, peck: Expr, clear: f64, out: bool },
}

/// How a hole is drilled.
pub(super) struct Hole {
    /// True where its words are absolute and the program's are not.
    pub switch: bool,
    pub parts: Vec<Part>,
}

/// What says whether a cycle's own block drills that has no position.
pub(super) fn of_unplaced(nc: &Nc, source: &Control) -> Question {
    let told = nc.names_axis() || nc.word(Role::CycleR).is_some();
    if told { Question::CycleRunsWithoutAxes } else { source.of_wordless_cycles() }
}

/// True where the planes were told under the other of G90 and G91, or under either.
pub(super) fn mixes(drill: &Drill, modal: &Modal) -> bool {
    let now = modal.op(Group::Distance).map(|op| op == Op::Incremental);
    drill.incremental.iter().any(|told| told.is_some() && *told != now)
        && drill.told(Told::Bottom) != Value::None
        && !(drill.told(Told::Retract) == Value::None && drill.incremental[1] == Some(false))
}

/// True where a block moves the retract plane and leaves the bottom that an increment told: that is a place by then, and no
/// distance from the new plane. `drill` is the cycle after the block.
pub(super) fn lifts(nc: &Nc, before: &Known, drill: &Drill) -> bool {
    let Cycle::On(was) = &before.cycle else { return false };
    let retract = drill.told(Told::Retract);
    let moved =
        nc.word(Role::CycleR).is_some() && (retract != was.told(Told::Retract) || retract == Value::Held);
    let by_steps = drill.incremental[1] != Some(false);
    moved && by_steps && nc.word(Role::Z).is_none() && was.told(Told::Bottom) != Value::None
}

/// True where the last move of a cycle's holes may be at feed: the way out of a bored one.
pub(super) fn may_end_at_feed(cycle: &Cycle) -> bool {
    match cycle {
        Cycle::On(drill) | Cycle::Maybe(drill) => {
            drill.op.is_none_or(|op| matches!(op, Op::CycleBore | Op::CycleBoreDwell))
        }
        Cycle::Mixed => true,
        Cycle::Off | Cycle::Outside => false,
    }
}

/// True for a cycle whose moves are known.
pub fn has_moves(op: Op) -> bool {
    use Op::*;
    matches!(
        op,
        CycleDrill
            | CycleDrillDwell
            | CycleBore
            | CycleBoreDwell
            | CycleBoreStop
            | CyclePeck
            | CycleChipBreak
    )
}

/// What no moves are known for.
pub(super) const RETURN: &str = "which plane this cycle returns to is not known: write G98 or G99 before it";
const STRANGE: &str = "the target has no such cycle, and this one has words that no moves are known for";
const OTHER: &str = "the target has no such cycle, and its moves are not known: write them out";
const DEPTH: &str = "the depth of this cycle is not known here: write R and Z into its block";
const WAIT: &str = "how long this cycle waits at the bottom is not known here: write P into its block";
const INITIAL: &str =
    "the plane that this cycle begins from is not known: write Z in absolute coordinates before the cycle";
const DISTANCE: &str = "it is not known whether G90 or G91 is in force at this cycle: write one before it";
pub(super) const CLEAR: &str = "the target has no such cycle, and how far over the last depth the source begins each step is a setting of the \
     machine: give it to the source's profile, [behaviours] \"cycle.peck.clearance\" = millimetres";
const UNEVEN: &str = "pecks that become less are written as moves, and these are too many, or a plane of theirs is not a number here: \
     write G0 and G1 moves, or a depth of its own for all pecks (Q)";
const STEPS: &str =
    "a peck drill in incremental words whose numbers are computed: write R and Z in absolute coordinates";

/// A constant, or what a register holds.
pub(super) fn of(value: Value, what: Told, first: u32) -> Option<Expr> {
    match value {
        Value::Is(number) => Some(Expr::Number(number)),
        Value::Held => Some(Expr::Var(what.register(first))),
        Value::None | Value::Lost => None,
    }
}

/// True for a number of least increments, whose size is not known yet.
pub(super) fn counts(word: &Expr) -> bool {
    let mut found = false;
    word.walk(&mut |e| found |= matches!(e, Expr::Increments(_)));
    found
}

/// The sum, folded where both are known.
fn sum(a: Expr, b: Expr) -> Expr {
    match (a.constant(), b.constant()) {
        (Some(a), Some(b)) => Expr::Number(clean(a + b)),
        (Some(0.0), None) => b,
        (None, Some(0.0)) => a,
        _ => Expr::binary(BinOp::Add, a, b),
    }
}

/// Without what binary arithmetic adds to decimal digits.
pub(super) fn clean(number: f64) -> f64 {
    let rounded = (number * 1e6).round() / 1e6;
    if (rounded - number).abs() < 1e-9 { rounded } else { number }
}

fn opposite(a: Expr) -> Expr {
    match a.constant() {
        Some(number) => Expr::Number(-number),
        None => Expr::Negate(Box::new(a)),
    }
}

/// The planes of a hole.
struct Planes {
    retract: Expr,
    bottom: Expr,
    initial: Option<Expr>,
}

/// What is done at a hole: `before` is where the tool stands, `modal` and `back` what is in force in the block, `clear` how far
/// over the last depth the source begins to peck, `dwells` whether its code waits.
pub(super) fn hole(
    drill: &Drill,
    before: (Height, Option<f64>),
    (modal, back): (&Modal, Option<Op>),
    first: u32,
    (clear, dwells): (Option<f64>, bool),
) -> Result<Hole, &'static str> {
    let op = drill.op.ok_or(OTHER)?;
    if drill.strange {
        return Err(STRANGE);
    }
    let back = back.ok_or(RETURN)?;
    let absolute = modal.op(Group::Distance).ok_or(DISTANCE)? == Op::Absolute;
    let told = |what| of(drill.told(what), what, first);
    let initial = told(Told::Initial);
    let by = |value: Value, what| match value {
        Value::None if what == Told::Retract => Ok(Expr::Number(0.0)),
        value => of(value, what, first).ok_or(DEPTH),
    };
    let (r, z) = (by(drill.told(Told::Retract), Told::Retract)?, by(drill.told(Told::Bottom), Told::Bottom)?);
    let [r_by, z_by] = drill.incremental;
    let (r_by, z_by) = (r_by.ok_or(DEPTH)?, z_by.ok_or(DEPTH)?);
    let relative = !absolute && r_by && z_by && (before.0 != Height::Unknown);
    let (mut parts, planes) = if relative {
        (Vec::new(), None)
    } else {
        let retract = if r_by { sum(initial.clone().ok_or(INITIAL)?, r.clone()) } else { r.clone() };
        let bottom = if z_by { sum(retract.clone(), z.clone()) } else { z.clone() };
        if back == Op::ReturnInitial && initial.is_none() {
            return Err(INITIAL);
        }
        (Vec::new(), Some(Planes { retract, bottom, initial }))
    };
    if dwells && drill.told(Told::Dwell) == Value::Lost {
        return Err(WAIT);
    }
    let dwell = told(Told::Dwell).filter(|time| dwells && time.constant() != Some(0.0));
    let dwell = dwell.map(|time| Part::Words(vec![NcItem::Op(Op::Dwell), NcItem::Word(Role::DwellMs, time)]));
    let turns = || modal.op(Group::Spindle).filter(|op| matches!(op, Op::SpindleCw | Op::SpindleCcw));
    let stop = |op| Part::Words(vec![NcItem::Op(op)]);
    // The heights, in the words that the block takes.
    let (down, cut, up, away) = match &planes {
        Some(planes) => (
            (before.1.is_none() || before.1 != planes.retract.constant()).then(|| planes.retract.clone()),
            planes.bottom.clone(),
            planes.retract.clone(),
            planes.initial.clone().filter(|initial| {
                back == Op::ReturnInitial
                    && (initial.constant().is_none() || initial.constant() != planes.retract.constant())
            }),
        ),
        None => (
            Some(r.clone()).filter(|r| before.0 == Height::Initial && r.constant() != Some(0.0)),
            z.clone(),
            opposite(z.clone()),
            Some(opposite(r)).filter(|r| back == Op::ReturnInitial && r.constant() != Some(0.0)),
        ),
    };
    parts.extend(down.map(|to| Part::Move(false, to)));
    match op {
        Op::CycleDrill | Op::CycleDrillDwell => {
            parts.push(Part::Move(true, cut));
            parts.extend(dwell);
            parts.push(Part::Move(false, up));
        }
        Op::CycleBore | Op::CycleBoreDwell => {
            parts.push(Part::Move(true, cut));
            parts.extend(dwell);
            parts.push(Part::Move(true, up));
        }
        Op::CycleBoreStop => {
            let turns = turns()
                .ok_or("which way the spindle turns is not known at this cycle, which starts it again")?;
            parts.extend([Part::Move(true, cut), stop(Op::SpindleStop), Part::Move(false, up)]);
            parts.extend(away.map(|to| Part::Move(false, to)));
            parts.push(stop(turns));
            return Ok(Hole { switch: !absolute && !relative, parts });
        }
        Op::CyclePeck | Op::CycleChipBreak => {
            let clear = match drill.told(Told::Clear) {
                Value::None => clear.ok_or(CLEAR)?,
                Value::Is(clear) => clear.abs(),
                _ => return Err(DEPTH),
            };
            let out = op == Op::CyclePeck;
            match drill.uneven {
                // What Q says beside them nobody knows.
                [Some(_), ..] if drill.told(Told::Peck) != Value::None => return Err(STRANGE),
                [Some(first), less, least] => {
                    let by = (first, less.unwrap_or(0.0), least.unwrap_or(0.0));
                    let ends = planes.as_ref().map(|planes| (&planes.retract, &planes.bottom));
                    let (from, to) =
                        ends.map_or((Some(0.0), z.constant()), |(r, z)| (r.constant(), z.constant()));
                    let (from, to) = (from.ok_or(UNEVEN)?, to.ok_or(UNEVEN)?);
                    let depths = depths((to - from).abs(), by).ok_or(UNEVEN)?;
                    one_by_one(&mut parts, (from, to, planes.is_some()), &depths, (clear, out));
                }
                [None, None, None] => {
                    let peck = told(Told::Peck).ok_or(DEPTH)?;
                    pecks(&mut parts, planes.as_ref(), (peck, clear, out), &z)?;
                }
                [None, ..] => return Err(STRANGE),
            }
            parts.extend(dwell);
            parts.push(Part::Move(false, up));
        }
        _ => return Err(OTHER),
    }
    parts.extend(away.map(|to| Part::Move(false, to)));
    Ok(Hole { switch: !absolute && !relative, parts })
}

/// Most steps that are written one by one, where a loop could do it.
const MOST: usize = 12;

/// Most steps of pecks that become less, of which no loop is written.
const MOST_UNEVEN: usize = 60;

/// The steps down to the bottom.
fn pecks(
    parts: &mut Vec<Part>,
    planes: Option<&Planes>,
    (peck, clear, out): (Expr, f64, bool),
    depth: &Expr,
) -> Result<(), &'static str> {
    let zero = Expr::Number(0.0);
    let (retract, bottom) = planes.map_or((&zero, depth), |planes| (&planes.retract, &planes.bottom));
    let numbers = (retract.constant(), bottom.constant(), peck.constant());
    let (Some(from), Some(to), Some(step)) = numbers else {
        if planes.is_none() {
            return Err(STEPS);
        }
        parts.push(Part::Pecks { retract: retract.clone(), bottom: bottom.clone(), peck, clear, out });
        return Ok(());
    };
    let whole = (to - from).abs();
    let step = if step == 0.0 { whole } else { step.abs() };
    if whole / step > MOST as f64 {
        if planes.is_none() {
            return Err(STEPS);
        }
        parts.push(Part::Pecks { retract: retract.clone(), bottom: bottom.clone(), peck, clear, out });
        return Ok(());
    }
    let depths = depths(whole, (step, 0.0, 0.0)).ok_or(STEPS)?;
    one_by_one(parts, (from, to, planes.is_some()), &depths, (clear, out));
    Ok(())
}

/// How deep each peck ends: the first one, less for each later one, down to the least. None where they are too many to write.
fn depths(whole: f64, (first, less, least): (f64, f64, f64)) -> Option<Vec<f64>> {
    let (mut step, mut deep, mut all) = (first.abs(), 0.0, Vec::new());
    while deep < whole {
        // A step of nothing takes the rest.
        let next = if step > 0.0 { deep + step } else { whole };
        deep = if next >= whole - 1e-9 { whole } else { next };
        all.push(deep);
        step = (step - less.abs()).max(least.abs());
        if all.len() > MOST_UNEVEN {
            return None;
        }
    }
    Some(all)
}

/// The steps down, each of them a move.
fn one_by_one(
    parts: &mut Vec<Part>,
    (from, to, absolute): (f64, f64, bool),
    depths: &[f64],
    (clear, out): (f64, bool),
) {
    let (down, mut at, mut before) = ((to - from).signum(), from, 0.0);
    let mut go = |at: &mut f64, feed: bool, to: f64| {
        let to = clean(to);
        let word = if absolute { to } else { clean(to - *at) };
        if to != *at {
            parts.push(Part::Move(feed, Expr::Number(word)));
        }
        *at = to;
    };
    for deep in depths {
        if before > 0.0 {
            if out {
                go(&mut at, false, from);
            }
            go(&mut at, false, from + down * (before - clear).max(0.0));
        }
        go(&mut at, true, from + down * deep);
        before = *deep;
    }
}
