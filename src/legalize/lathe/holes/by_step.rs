//! Cycles for a target whose retract planes are ways from where the cycle began, with one code for all drilling along an axis.

use super::by_place::length;
use super::levels::{lasts, way};
use super::pecks;
use super::walk::{Hole, Refused};
use crate::canon::{Op, Role};
use crate::ir::{Expr, Nc, NcItem};

/// Gives a block the target's words and code; how often it runs.
pub(super) fn change(hole: &mut Hole<'_>) -> Result<usize, Refused> {
    plane(hole)?;
    let (_, step) = hole.depth();
    if hole.nc.word(step).is_some() {
        return Err((DEPTH, "write the depth as a place"));
    }
    let (whole, _) = hole.depth();
    if let (Some(bottom), Some(plane), Some(initial)) =
        (hole.nc.word(whole).and_then(Expr::constant), hole.cycle.plane, hole.cycle.initial)
        && (initial - plane) * (bottom - plane) > 0.0
    {
        if !begins_at(hole, plane) {
            return Err((BELOW, "begin the cycle at the retract plane or beyond it"));
        }
        hole.put(Role::CycleRStep, Role::CycleRStep, Expr::Number(0.0));
    }
    match hole.op {
        Op::FaceTapMain => {
            end_wait(hole);
            hole.write_if_begun(Op::FaceTap);
        }
        Op::FaceTapLive | Op::SideTapLive => live_tap(hole)?,
        Op::FaceTapMainLeft | Op::FaceTapLiveLeft | Op::SideTapLiveLeft => return Err((LEFT, LEFT_HELP)),
        Op::FaceBoreStop | Op::SideBoreStop => return Err((STOPS, STOPS_HELP)),
        Op::FaceBoreDwell | Op::SideBoreDwell => {
            if hole.begins && hole.nc.word(Role::CycleDwell).is_none() {
                last_wait(hole)?;
            }
            hole.write_if_begun(if hole.side() { Op::SideBore } else { Op::FaceBore });
        }
        Op::FaceBore | Op::SideBore => end_wait(hole),
        op => drill(hole, op)?,
    }
    Ok(1)
}

/// Lets a hole begin at its plane, where both controls go first and the source ends it (docs/lathe.md Q5, Q9): the way there is a block of its own.
fn begins_at(hole: &mut Hole<'_>, plane: f64) -> bool {
    let (along, across, at) = match hole.side() {
        true => (Role::X, [Role::Z, Role::StepZ], hole.place.z()),
        false => (Role::Z, [Role::X, Role::StepX], hole.place.x()),
    };
    let [place, step] = across.map(|role| hole.nc.word(role));
    let stays = step.is_none() && place.is_none_or(|place| at.is_some() && place.constant() == at);
    let turns = [Role::Y, Role::C, Role::StepY, Role::StepC].iter().any(|role| hole.nc.word(*role).is_some());
    let may = hole.fresh && hole.begins && hole.rapid && stays && !turns;
    if may {
        hole.before.push(Nc { items: vec![NcItem::Op(Op::Rapid), NcItem::Word(along, Expr::Number(plane))] });
        hole.cycle.initial = Some(plane);
    }
    may
}

/// A tap of a live tool: the code before it makes it rigid, and turns the tool at the speed beside it.
fn live_tap(hole: &mut Hole<'_>) -> Result<(), Refused> {
    let op = if hole.side() { Op::SideTap } else { Op::FaceTap };
    if !hole.has(op) || !hole.has(Op::RigidTaps) {
        return Err((TAP, "write the tap for the target by hand"));
    }
    if !hole.turning.by_turn {
        return Err((BY_MINUTE, "write G99 before it, with the lead as F"));
    }
    if !hole.begins {
        return Ok(());
    }
    end_wait(hole);
    let speed = hole.turning.speed.ok_or((NO_SPEED, "write S in a block before the tap"))?;
    let rigid = vec![NcItem::Op(Op::RigidTaps), NcItem::Word(Role::Speed, Expr::Number(speed))];
    hole.before.push(Nc { items: rigid });
    hole.write(op);
    hole.asked.push((LIVE, LIVE_HELP, op, false));
    Ok(())
}

/// A wait that an earlier code of the cycle in force was told is none of a code that has none.
fn end_wait(hole: &mut Hole<'_>) {
    if !hole.fresh {
        no_wait(hole);
    }
}

/// A wait that an earlier code was told is none of this one.
fn no_wait(hole: &mut Hole<'_>) {
    if hole.begins && hole.nc.word(Role::CycleDwell).is_none() && !hole.all.dwells.is_empty() {
        hole.nc.items.push(NcItem::Word(Role::CycleDwell, Expr::Number(0.0)));
    }
}

/// The retract plane as a way.
fn plane(hole: &mut Hole<'_>) -> Result<(), Refused> {
    if hole.fresh {
        hole.cycle.initial = hole.level();
    }
    let Some(place) = hole.nc.word(Role::CycleR).cloned() else {
        // A tap along X is written without one: it begins at its plane.
        if hole.fresh && hole.side() && hole.op.is_live_tap() {
            hole.cycle.plane = hole.cycle.initial;
            return Ok(());
        }
        if hole.fresh {
            // Q9, Q5: the plane is where the cycle began.
            hole.cycle.plane = hole.cycle.initial;
            hole.add_before_feed(Role::CycleRStep, Expr::Number(0.0));
        }
        return Ok(());
    };
    let (Some(initial), Some(place)) = (hole.cycle.initial, place.constant()) else {
        return computed_plane(hole, length(place)?);
    };
    hole.cycle.plane = Some(place);
    let half = if hole.side() { 0.5 } else { 1.0 };
    let step = ((place - initial) * half * 1e6).round() / 1e6;
    hole.put(Role::CycleR, Role::CycleRStep, Expr::Number(step));
    Ok(())
}

/// The same of values that are computed, where the words of the blocks before tell the level.
fn computed_plane(hole: &mut Hole<'_>, place: Expr) -> Result<(), Refused> {
    let level = hole.computed.take().filter(|_| hole.fresh && !hole.place.is_shifted());
    let Some(level) = level.filter(|_| lasts(&place)) else { return Err((LEVEL, LEVEL_HELP)) };
    hole.cycle.plane = place.constant();
    hole.put(Role::CycleR, Role::CycleRStep, way(level, place, hole.side()));
    hole.asked.push((COMPUTED, COMPUTED_HELP, hole.op, false));
    Ok(())
}

/// Writes the wait that was told last; where the P of a contour came after it, that is asked.
fn last_wait(hole: &mut Hole<'_>) -> Result<(), Refused> {
    let last = hole.waits.last().ok_or((WAIT, "write P into this block"))?;
    hole.nc.items.push(NcItem::Word(Role::CycleDwell, last));
    if hole.waits.is_doubted() {
        hole.asked.push((CONTOUR, "write P into this block", hole.op, false));
    }
    Ok(())
}

const CONTOUR: &str = "the wait of this hole is the last P that was a wait, and the cycle of a contour came after it: its P, the number of a block, is taken to be \
                       none";

const OFFSET: &str = "a hole without a wait of its own comes after a work offset that P names, and no other P: that P is taken to be no wait";
const OFFSET_HELP: &str = "as milliseconds it would be a tenth of a second at the most; write P into the block of the hole if that matters";

/// Drilling: the wait and the peck where the target needs them told.
fn drill(hole: &mut Hole<'_>, op: Op) -> Result<(), Refused> {
    let waits = matches!(op, Op::FaceDrillDwell | Op::SideDrillDwell);
    let pecks = matches!(op, Op::FacePeck | Op::SidePeck);
    let told = hole.nc.word(Role::CycleDwell).cloned();
    let earlier = hole.all.other_waits || !hole.all.dwells.is_empty();
    let known = hole.cycle.peck.clone();
    if pecks {
        // Known to the next holes even where this one is refused.
        hole.cycle.peck = hole.nc.word(Role::CycleQ).cloned().or(hole.cycle.peck.take());
        hole.cycle.pecked = Some(true);
    } else {
        pecks::end(hole)?;
    }
    if hole.begins && told.is_none() {
        if (waits || pecks) && hole.waits.is_offset() {
            hole.asked.push((OFFSET, OFFSET_HELP, op, true));
        }
        if waits && !hole.waits.is_offset() || pecks && earlier && !hole.waits.none_yet() {
            last_wait(hole)?;
        }
        no_wait(hole);
    }
    if pecks {
        let own = hole.nc.word(Role::CycleQ).cloned();
        let only = match hole.all.pecks.as_slice() {
            [only] => Some(only.clone()),
            _ => None,
        };
        let last = known.or(only);
        if own.is_none() {
            if hole.begins {
                return Err((PECK, "write Q into this block"));
            }
            let peck = last.ok_or((PECK, "write Q into this block"))?;
            hole.nc.items.push(NcItem::Word(Role::CycleQ, peck));
        }
        hole.cycle.peck = hole.nc.word(Role::CycleQ).cloned();
    }
    hole.write_if_begun(if hole.side() { Op::SideHole } else { Op::FaceHole });
    Ok(())
}

impl Hole<'_> {
    /// Writes a code where the source has one.
    fn write_if_begun(&mut self, op: Op) {
        if self.begins {
            self.write(op);
        }
    }
}

const TAP: &str = "the target has no code for this tap, or none that makes it rigid";
const BY_MINUTE: &str = "a tap of a live tool while F is a feed a minute, or nobody knows: no source says what the source's cycle does with it";
const NO_SPEED: &str =
    "the source's tap turns its live tool at the last S, and which speed that is, is not known here";
const LIVE: &str = "this tap of a live tool becomes a rigid tap, which turns the tool that codes of the target's builder have chosen";
const LIVE_HELP: &str =
    "make sure that the live tool is chosen before it, and that the code for rigid taps is the machine's";
const LEFT: &str = "a left-hand tap: no source says how the target is told one";
const LEFT_HELP: &str = "write it for the target by hand";
const STOPS: &str = "a bore whose spindle stops at the bottom: the target has no such cycle";
const STOPS_HELP: &str = "write the bore as moves: feed in, M5, rapid out, M3";
const DEPTH: &str = "no source says what an increment of the depth counts from on the source";
const BELOW: &str = "this drilling cycle begins between its retract plane and the bottom: it ends at the plane, and on the target where it began";
const LEVEL: &str = "the target takes the retract plane as a way from where the cycle begins, which is not known here, or the plane is computed";
const LEVEL_HELP: &str = "write the place of the tool (G0 X.. Z..) into a block before the cycle, and R, as numbers or calculations";
pub(super) const COMPUTED: &str = "the retract plane of this hole is computed, and holes of the target end where their cycle began: the source's end at the plane where the cycle begins below it";
const COMPUTED_HELP: &str =
    "make sure that the tool stands at the plane or beyond it before the cycle, whatever the variables hold";
const WAIT: &str = "the wait of this hole is the last P of any code: the target needs it told";
const PECK: &str =
    "the peck of this hole is not known here, and on the target it counts in its own block alone";
