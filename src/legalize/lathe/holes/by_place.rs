//! Cycles for a target whose retract planes are places, with a code for each way of drilling.

use super::walk::{Hole, Refused};
use crate::canon::{Op, Role, Sys};
use crate::ir::{BinOp, Expr, Nc, NcItem};
use crate::legalize::lathe::thread_loops::sums::counts;

/// The most blocks that a repeat becomes.
const MOST: f64 = 200.0;

/// Gives a block the target's words and code; how often it runs.
pub(super) fn change(hole: &mut Hole<'_>) -> Result<usize, Refused> {
    let plane = plane(hole)?;
    let ends_higher = bottom(hole, plane)?;
    code(hole)?;
    let times = times(hole)?;
    if ends_higher {
        go_back(hole, times)?;
    }
    Ok(times)
}

/// The target ends a hole at its plane where the cycle begins deeper than that: the way back to where it began is a block of its own, which ends the
/// target's cycle, so the next hole has its code again.
fn go_back(hole: &mut Hole<'_>, times: usize) -> Result<(), Refused> {
    let along = if hole.side() { Role::X } else { Role::Z };
    match hole.cycle.initial.filter(|_| hole.rapid && times == 1) {
        Some(level) => {
            hole.after
                .push(Nc { items: vec![NcItem::Op(Op::Rapid), NcItem::Word(along, Expr::Number(level))] });
            hole.cycle.is_ended = true;
            Ok(())
        }
        None => Err((BELOW, BELOW_HELP)),
    }
}

/// A retract plane of this block: a number, or a value that is computed.
type Plane = Option<Expr>;

/// The retract plane as a place.
fn plane(hole: &mut Hole<'_>) -> Result<Plane, Refused> {
    if hole.fresh {
        hole.cycle.initial = hole.level();
    }
    let written = hole.nc.word(Role::CycleRStep).cloned();
    let step = match (&written, hole.fresh) {
        (Some(step), _) => step.clone(),
        // Without the word the plane is where the cycle begins.
        (None, true) => Expr::Number(0.0),
        (None, false) => return Ok(None),
    };
    let step = match (length(step)?, hole.side()) {
        // Along X it is a radius, and the place a diameter.
        (step, true) => scaled(step, 2.0),
        (step, false) => step,
    };
    let value = match (hole.cycle.initial, step.constant()) {
        (Some(initial), Some(step)) => {
            let plane = ((initial + step) * 1e6).round() / 1e6;
            hole.cycle.plane = Some(plane);
            Expr::Number(plane)
        }
        (Some(initial), None) => {
            hole.cycle.plane = None;
            Expr::binary(BinOp::Add, step, Expr::Number(initial))
        }
        (None, _)
            if hole.fresh
                && !hole.side()
                && !hole.place.is_shifted()
                && hole.target.system_runs(Sys::EndPosition).next().is_some() =>
        {
            hole.cycle.plane = None;
            from(Expr::System(Sys::EndPosition, [Expr::Number(3.0)].into()), step)
        }
        (None, _) if hole.fresh && !hole.place.is_shifted() => {
            let level = hole.computed.take().ok_or((LEVEL, LEVEL_HELP))?;
            hole.cycle.plane = None;
            hole.asked.push((COMPUTED, COMPUTED_HELP, hole.op, true));
            from(level, step)
        }
        _ => return Err((LEVEL, LEVEL_HELP)),
    };
    hole.put(Role::CycleRStep, Role::CycleR, value.clone());
    Ok(Some(value))
}

/// A value to work with; a count of increments whose unit is not known is none.
pub(super) fn length(value: Expr) -> Result<Expr, Refused> {
    match value {
        Expr::Increments(0.0) => Ok(Expr::Number(0.0)),
        value if counts(&value) => Err((COUNT, COUNT_HELP)),
        value => Ok(value),
    }
}

const COUNT: &str = "a hole counts its plane or its depth in increments, and whether inches or millimetres are in force here is not known";
const COUNT_HELP: &str =
    "write the unit (G20, G21) at the head of this program, or a decimal point into R and the depth";

fn scaled(value: Expr, by: f64) -> Expr {
    match value.constant() {
        Some(number) => Expr::Number(number * by),
        None => Expr::binary(BinOp::Mul, value, Expr::Number(by)),
    }
}

/// A sum as people write it.
fn from(base: Expr, step: Expr) -> Expr {
    match step.constant() {
        Some(0.0) => base,
        Some(step) if step < 0.0 => Expr::binary(BinOp::Sub, base, Expr::Number(-step)),
        Some(step) => Expr::binary(BinOp::Add, base, Expr::Number(step)),
        None => Expr::binary(BinOp::Add, base, step),
    }
}

/// The bottom as a place; a depth that counts from the plane needs it. True where the cycle begins between its plane and the bottom.
fn bottom(hole: &mut Hole<'_>, plane: Plane) -> Result<bool, Refused> {
    let (whole, step) = hole.depth();
    if let Some(depth) = hole.nc.word(step).cloned() {
        let depth = length(depth)?;
        let plane = hole.cycle.plane.map(Expr::Number).or(plane).ok_or((DEPTH, DEPTH_HELP))?;
        let value = match (plane.constant(), depth.constant()) {
            (Some(plane), Some(depth)) => Expr::Number(((plane + depth) * 1e6).round() / 1e6),
            _ => from(plane, depth),
        };
        hole.put(step, whole, value);
    }
    hole.cycle.bottom = hole.nc.word(whole).cloned().or(hole.cycle.bottom.take());
    if hole.fresh && hole.cycle.bottom.is_none() {
        return Err(("a drilling cycle without its depth", "write the depth into its block"));
    }
    let constant = hole.cycle.bottom.as_ref().and_then(Expr::constant);
    let places = (hole.cycle.initial, hole.cycle.plane, constant);
    let (Some(initial), Some(plane), Some(bottom)) = places else { return Ok(false) };
    Ok((initial - plane) * (bottom - plane) > 0.0)
}

/// The code of the way that the block drills.
fn code(hole: &mut Hole<'_>) -> Result<(), Refused> {
    let peck = hole.nc.word(Role::CycleQ).filter(|peck| peck.constant() != Some(0.0)).is_some();
    if !peck {
        hole.drop(Role::CycleQ);
    } else if hole.nc.word(Role::CycleQ).is_some_and(|peck| peck.constant().is_none()) {
        hole.asked.push((PECKS, PECKS_HELP, hole.op, true));
    }
    let told = hole.nc.word(Role::CycleDwell).cloned();
    if hole.fresh {
        hole.cycle.dwell = Some(Expr::Number(0.0));
    }
    let last = hole.cycle.dwell.clone().or_else(|| match hole.all.dwells.as_slice() {
        [] => Some(Expr::Number(0.0)),
        _ => None,
    });
    let dwell = told.or(last).ok_or((WAIT, WAIT_HELP))?;
    hole.cycle.dwell = Some(dwell.clone());
    let waits = dwell.constant() != Some(0.0);
    let side = hole.side();
    let op = match (hole.op, peck, waits) {
        (Op::FaceHole | Op::SideHole, true, _) => {
            if side {
                Op::SidePeck
            } else {
                Op::FacePeck
            }
        }
        (Op::FaceHole | Op::SideHole, _, true) => {
            if side {
                Op::SideDrillDwell
            } else {
                Op::FaceDrillDwell
            }
        }
        (Op::FaceHole | Op::SideHole, ..) => {
            if side {
                Op::SideDrill
            } else {
                Op::FaceDrill
            }
        }
        (Op::FaceBore, _, true) if hole.has(Op::FaceBoreDwell) => Op::FaceBoreDwell,
        (Op::SideBore, _, true) if hole.has(Op::SideBoreDwell) => Op::SideBoreDwell,
        (_, _, true) => return Err((NO_WAIT, "leave P out, or write the hole as moves")),
        (Op::FaceTap | Op::SideTap, ..) => tap(hole)?,
        (op, ..) => op,
    };
    let ended = std::mem::take(&mut hole.cycle.is_ended);
    let alone = !hole.begins && !ended && hole.cycle.written == Some(op);
    // What else a block that goes on may be under is the same code, where the program has but one way of drilling.
    let one_way = hole.all.dwells.is_empty() && (hole.all.pecks.is_empty() || !hole.all.without_peck);
    if !alone && (hole.begins || hole.cycle.written.is_some() || !one_way) {
        again(hole, op, ended)?;
        if waits || peck && (hole.all.other_waits || !hole.all.dwells.is_empty()) {
            hole.put(Role::CycleDwell, Role::CycleDwell, dwell);
            return Ok(());
        }
    }
    if !waits {
        hole.drop(Role::CycleDwell);
    }
    Ok(())
}

/// Writes a code, with the planes where it is another than before, or one that `ended`: what lasts over codes is not left to the control.
fn again(hole: &mut Hole<'_>, op: Op, ended: bool) -> Result<(), Refused> {
    let (whole, _) = hole.depth();
    let other = ended || hole.cycle.written.is_some_and(|written| written != op);
    hole.write(op);
    if other {
        let known = hole.cycle.bottom.clone().filter(|bottom| bottom.constant().is_some());
        for (role, value) in [(Role::CycleR, hole.cycle.plane.map(Expr::Number)), (whole, known)] {
            if let Some(value) = value.filter(|_| hole.nc.word(role).is_none()) {
                hole.put(role, role, value);
            }
        }
    }
    Ok(())
}

/// A tap: on the centre line with the target's main spindle, elsewhere with a live tool.
fn tap(hole: &mut Hole<'_>) -> Result<Op, Refused> {
    let turned = hole.nc.word(Role::C).or(hole.nc.word(Role::StepC)).is_some();
    let x = match (hole.nc.word(Role::X), hole.nc.word(Role::StepX)) {
        (Some(x), None) => x.constant(),
        (None, None) => hole.place.x(),
        _ => None,
    };
    let live = matches!(hole.cycle.written, Some(Op::FaceTapLive | Op::SideTapLive));
    if hole.side() || turned || x != Some(0.0) || live {
        return live_tap(hole);
    }
    if !hole.has(Op::FaceTapMain) {
        return Err((TAP, TAP_HELP));
    }
    hole.asked.push((MAIN, MAIN_HELP, Op::FaceTap, true));
    Ok(Op::FaceTapMain)
}

/// A tap whose cycle turns the live tool by itself, to the right, at the last speed, and whose F is the lead.
fn live_tap(hole: &mut Hole<'_>) -> Result<Op, Refused> {
    let op = if hole.side() { Op::SideTapLive } else { Op::FaceTapLive };
    if !hole.has(op) {
        return Err((TAP, TAP_HELP));
    }
    if !hole.turning.by_turn {
        return Err((BY_MINUTE, BY_MINUTE_HELP));
    }
    if !hole.turning.is_said {
        return Err((NO_SPEED, NO_SPEED_HELP));
    }
    if hole.cycle.written != Some(op) {
        if !hole.turning.stands {
            if !hole.all.is_stopped {
                return Err((TURNS, TURNS_HELP));
            }
            hole.asked.push((STOPPED, STOPPED_HELP, op, true));
        }
        hole.asked.push(match hole.turning.rigid {
            true => (RIGID, RIGID_HELP, op, true),
            false => (LIVE, LIVE_HELP, op, false),
        });
    }
    Ok(op)
}

/// How often the block runs: the target has no repeats.
fn times(hole: &mut Hole<'_>) -> Result<usize, Refused> {
    let Some(count) = hole.nc.word(Role::Repeat).cloned() else { return Ok(1) };
    hole.drop(Role::Repeat);
    match count.constant() {
        Some(count) if count.fract() == 0.0 && (1.0..=MOST).contains(&count) => Ok(count as usize),
        _ => Err((REPEAT, "write the holes one by one, or a loop over them")),
    }
}

const LEVEL: &str = "the retract plane counts from where the cycle begins, which is not known here, and the target takes it as a place";
const LEVEL_HELP: &str = "write the place of the tool as numbers (G0 X.. Z..) in a block before the cycle";
pub(super) const COMPUTED: &str = "the retract plane of this hole is computed, from where the blocks before say that its cycle begins: the target ends the hole \
                                   at the plane, if it begins below it";
const COMPUTED_HELP: &str = "make sure that the cycle begins at its retract plane or beyond it";
pub(super) const PECKS: &str = "the depth of the pecks is computed: where it is 0 the source drills in one go, and of the target no source says what it does";
const PECKS_HELP: &str = "make sure that Q is above 0";
const DEPTH: &str =
    "the depth counts from the retract plane, which is not known here, and the target takes it as a place";
const DEPTH_HELP: &str = "write the depth as a place, or the place of the tool as numbers before the cycle";
const BELOW: &str = "this drilling cycle begins between its retract plane and the bottom: the target ends such a hole at the plane";
const BELOW_HELP: &str =
    "begin the cycle at the retract plane or beyond it, or have G0 in force before it, and no repeats";
const WAIT: &str = "which wait of an earlier hole is still in force here depends on the path";
const WAIT_HELP: &str = "write P into this block";
const NO_WAIT: &str = "the target's code for this hole takes no wait at the bottom";
const TAP: &str = "the target has no code for this tap";
const TAP_HELP: &str = "write the tap for the target by hand";
const BY_MINUTE: &str = "a tap of a live tool while F is a feed a minute, or nobody knows: the target's cycle takes F as the lead";
const BY_MINUTE_HELP: &str = "write S and F as numbers before the tap, and G80 after its holes; or tap in feed a turn, with the lead as F";
const NO_SPEED: &str =
    "the target's tap turns its live tool at the last S, and which speed that is, is not known here";
const NO_SPEED_HELP: &str =
    "write S in a block before the tap, also where a code of the builder turns the tool";
const TURNS: &str = "the spindle may turn here (M3, M4), which on the target is the one that turns the part, while a live tool taps";
const TURNS_HELP: &str =
    "write M5 before the tap, and turn the live tool by the code of the builder that does only that";
const STOPPED: &str = "all programs of the library that call this one stop the spindle before (M5), and the target's tap of a live tool needs that";
const STOPPED_HELP: &str = "if something else calls it, make sure that the spindle stands there too";
const LIVE: &str = "this tap becomes the target's cycle for a live tool, which turns the tool to the right by itself, at the last S";
const LIVE_HELP: &str = "make sure that the thread is a right-hand one, and that S is the speed of the tool";
const RIGID: &str = "this rigid tap becomes the target's cycle for a live tool, which turns the tool to the right by itself, at the last S";
const RIGID_HELP: &str =
    "make sure that the rigid taps of the source's machine turn the tool to the right too";
const MAIN: &str = "the target taps on the centre line with its main spindle, which it starts itself";
const MAIN_HELP: &str = "if a live tool taps here, write the target's code for that by hand";
const REPEAT: &str = "a drilling cycle with a count of repeats that is computed, or is none of 1 to 200: the target has no repeats";
