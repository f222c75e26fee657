//! Angles of rotary axes, where the two controls go to an angle by two ways: what was turned, the shorter one, or that of the sign.
//!
//! Law: an axis turns by as much as it turned by, and the same way. On a control of signs an absolute word is a place within one
//! turn, and its sign the way there, that of zero too where the control reads it; elsewhere it is what the axis has turned by, or the shorter way is taken. Side conditions:
//! where the axis stands before is known from the text, and the angle is a number; less than a whole turn; less than half of one
//! where the shorter way is taken. From there to a control that turns back by all turns the words stay: a rapid move to an angle, that to a hole too, ends there
//! either way, and is told of; a cut must turn by less than half a turn, within one. What is in increments stays. Where how many whole turns were made before is not known, but how
//! far it turns is, and where the shorter way is another, the target turns by that in increments, if the block moves nothing else.
//! Counter-example: `A360.` after `A0.`, a whole turn, which no place with a sign says.

use super::rotary_places::{AXES, Places, RotaryPlaces, Stands, TURN, Way, degrees, is_aside, parts};
use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question};
use crate::ir::{BlockId, Expr, Module, Nc, NcItem, SourceInfo, Stmt, StmtKind, Stmts};
use crate::legalize::assumptions::shop::are_mills;
use crate::legalize::features::Features;
use crate::legalize::{Context, Modal};
use crate::text::Span;
use std::collections::BTreeMap;

/// Whether the sign of zero is a way on a control, where somebody says it.
pub(in crate::legalize) fn zero_sign(control: &Control) -> Option<bool> {
    let row = control.behaviour(Question::RotaryZeroSign).filter(|row| row.origin.is_settled())?;
    row.value.parse().ok()
}

/// True between two mills that go to an angle by two ways, if rotary axes move; and where the sign is the way on both, but
/// it is not known that both read the sign of zero.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let sides = [context.source, context.target];
    let zeros = sides.iter().all(|control| Way::of(control) == Way::Sign)
        && sides.iter().any(|control| zero_sign(control) != Some(true));
    (zeros || Way::differ(context.source, context.target))
        && are_mills(context)
        && AXES.iter().any(|role| features.role(*role))
}

/// Writes the angles; true if one is another.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let facts = context.modal_facts(module);
    let source = context.source;
    let places = RotaryPlaces::of(module, &facts, source, &context.origins);
    let ways = (Way::of(source), Way::of(context.target));
    let same = ways.0 == ways.1;
    // Where the axes of a target stand that turns back by all turns.
    let there = (ways == (Way::Shortest, Way::Turns))
        .then(|| RotaryPlaces::by(Way::Turns, module, &facts, source, &context.origins));
    let mut changed = false;
    for (index, program) in module.programs.iter_mut().enumerate() {
        for (at, block) in program.blocks.iter_mut().enumerate() {
            let id = BlockId(at as u32);
            let (mut state, mut here) = (facts.at(index, id), places.at(index, id));
            let mut there = there.as_ref().map(|there| there.at(index, id));
            let stmts = Stmts::with_capacity(block.stmts.len());
            for mut stmt in std::mem::replace(&mut block.stmts, stmts) {
                let (before, from) = (state.clone(), here.clone());
                state.step(&stmt);
                here.step(&stmt, (&before, &state), ways.0, source);
                let target = there.clone();
                there.iter_mut().for_each(|there| there.step(&stmt, (&before, &state), ways.1, source));
                let span = stmt.site.span;
                let aside = is_alone(&stmt, &state, context).then(|| back(span));
                let kind = Kind { alone: aside.is_some(), rapid: is_rapid(&stmt, &state) };
                let mut after = None;
                if let StmtKind::Nc(nc) = &mut stmt.kind {
                    match state.op(Group::Distance) {
                        Some(Op::Incremental) => changed |= ways.1 == Way::Sign && unsigned(nc, source),
                        Some(_) => {
                            let done =
                                angles(nc, (&from, target.as_ref()), ways, ((index, span), kind), context);
                            changed |= done != Done::Nothing;
                            after = aside.filter(|_| done == Done::Turns);
                        }
                        None if moves_axis(nc) && (!same || minus_zero(nc, source)) => {
                            refuse(MODE, MODE_HELP, (index, span), context)
                        }
                        None => {}
                    }
                }
                block.stmts.push(stmt);
                block.stmts.extend(after);
            }
        }
    }
    changed
}

/// What a block does besides turning an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Kind {
    /// It moves nothing else.
    alone: bool,
    /// It goes at rapid.
    rapid: bool,
}

/// True for a move at rapid, and for one to the place of a hole, which goes at rapid whatever is in force.
fn is_rapid(stmt: &Stmt, state: &Modal) -> bool {
    let Some(nc) = stmt.kind.nc() else { return false };
    let cycle = state.op(Group::Cycle);
    let to_hole = cycle.is_some_and(Op::is_cycle) && nc.ops().all(|op| op.group() != Group::Motion);
    let rapid = state.op(Group::Motion) == Some(Op::Rapid) && cycle == Some(Op::CycleOff);
    (rapid || to_hole) && !state.may_call() && nc.moves()
}

/// What was done to a block.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Done {
    Nothing,
    /// An angle is another.
    Angle,
    /// It turns in increments.
    Turns,
}

/// True for a block that turns one axis and moves nothing else.
fn is_alone(stmt: &Stmt, state: &Modal, context: &Context<'_>) -> bool {
    let Some(nc) = stmt.kind.nc() else { return false };
    let mut axes = 0;
    let plain = nc.items.iter().all(|item| match item {
        NcItem::Op(op) => matches!(op, Op::Rapid | Op::Linear | Op::Absolute | Op::SelectWork),
        NcItem::Word(role, _) => {
            axes += usize::from(AXES.contains(role));
            AXES.contains(role) || matches!(role, Role::Feed | Role::WorkOffset)
        }
        NcItem::Code(..) => false,
    });
    let straight = matches!(state.op(Group::Motion), Some(Op::Rapid | Op::Linear));
    let has = |op| context.target.code_for(op, &BTreeMap::new()).is_some();
    plain
        && axes == 1
        && straight
        && state.op(Group::Cycle) == Some(Op::CycleOff)
        && !state.may_call()
        && stmt.site.skip.is_none()
        && has(Op::Incremental)
        && has(Op::Absolute)
}

/// The block after one in increments.
fn back(span: Span) -> Stmt {
    let kind = StmtKind::Nc(Nc { items: vec![NcItem::Op(Op::Absolute)] });
    Stmt { kind, site: SourceInfo { span, ..SourceInfo::default() } }
}

fn moves_axis(nc: &Nc) -> bool {
    AXES.iter().any(|role| nc.word(*role).is_some())
}

/// Writes the angles of a block.
fn angles(
    nc: &mut Nc,
    (from, there): (&Places, Option<&Places>),
    (ours, theirs): (Way, Way),
    (place, kind): ((usize, Span), Kind),
    context: &mut Context<'_>,
) -> Done {
    if nc.has(Op::MachineOnce) && moves_axis(nc) && ours != theirs {
        refuse(MACHINE, MACHINE_HELP, place, context);
    }
    if is_aside(nc) {
        return Done::Nothing;
    }
    let mut done = Done::Nothing;
    let selects = nc.has(Op::SelectWork) || nc.has(Op::ShiftCancel);
    // The angle that it comes to is the same, and nothing is cut on the way.
    let pair = (ours, theirs);
    let round = kind.rapid && matches!(pair, (Way::Turns, Way::Shortest) | (Way::Shortest, Way::Turns));
    for item in &mut nc.items {
        let NcItem::Word(role, value) = item else { continue };
        let Some(axis) = AXES.iter().position(|axis| axis == role) else { continue };
        let Some(angle) = degrees(value, context.source) else {
            match round {
                // Where it is computed to zero, its sign is read or not.
                _ if ours == theirs => {
                    if matches!(value, Expr::Negate(_)) {
                        zero_rests(place, context);
                    }
                }
                true => other_way_round(place, context),
                false => refuse(COMPUTED, HELP, place, context),
            }
            continue;
        };
        let stands = from.of(axis);
        let turned = turned(stands, angle, ours);
        if ours == theirs && !is_minus_zero(angle) {
            continue;
        }
        if is_minus_zero(angle)
            && ours == Way::Sign
            && turned != Some(0.0)
            && zero_sign(context.source).is_none()
        {
            context.rests_on_source(place.0, place.1, Question::RotaryZeroSign);
        }
        // The words stay there.
        if let Some(there) = there {
            match alike(stands, there.of(axis), angle) {
                true => {}
                false if kind.rapid => other_way_round(place, context),
                false => refuse(HALF, HELP, place, context),
            }
            continue;
        }
        let written = match (written(stands, angle, ours, theirs), turned) {
            (Ok(written), Some(by))
                if is_minus_zero(written) && by < 0.0 && kind.alone && !reads_zero(context) =>
            {
                done = Done::Turns;
                by
            }
            (Ok(written), _) if is_minus_zero(written) && theirs == Way::Sign && !reads_zero(context) => {
                zero_rests(place, context);
                written
            }
            // The same word does the same there.
            (Err((UNKNOWN | EITHER, _)), _) if ours == theirs => {
                zero_rests(place, context);
                continue;
            }
            (Err((UNKNOWN | TURNED, _)), Some(by)) if kind.alone && theirs == Way::Turns => {
                done = Done::Turns;
                by
            }
            (Err((HALF, _)), Some(by)) if kind.alone => {
                done = Done::Turns;
                by
            }
            (Err((HALF | UNKNOWN, _)), _) if round => {
                other_way_round(place, context);
                continue;
            }
            (Ok(written), _) => written,
            (Err((what, help)), _) => {
                refuse(what, help, place, context);
                continue;
            }
        };
        // Another work offset may have another zero of the axis.
        if stands.assumed || selects {
            rests(place, context);
        }
        if written.to_bits() != angle.to_bits() {
            *value = Expr::Number(written);
            done = if done == Done::Turns { done } else { Done::Angle };
        }
    }
    if done == Done::Turns {
        nc.items.retain(|item| *item != NcItem::Op(Op::Absolute));
        nc.items.insert(0, NcItem::Op(Op::Incremental));
    }
    done
}

fn is_minus_zero(angle: f64) -> bool {
    angle == 0.0 && angle.is_sign_negative()
}

/// True for a block with an angle that is zero with a minus.
fn minus_zero(nc: &Nc, control: &Control) -> bool {
    let zero = |value| degrees(value, control).is_some_and(is_minus_zero);
    nc.items
        .iter()
        .any(|item| matches!(item, NcItem::Word(role, value) if AXES.contains(role) && zero(value)))
}

/// Writes zeros of increments without a sign, as they are no way; true if there was one.
fn unsigned(nc: &mut Nc, control: &Control) -> bool {
    let mut changed = false;
    for item in &mut nc.items {
        if let NcItem::Word(role, value) = item
            && AXES.contains(role)
            && degrees(value, control).is_some_and(is_minus_zero)
        {
            *value = Expr::Number(0.0);
            changed = true;
        }
    }
    changed
}

/// True where the target is known to read the sign of zero.
fn reads_zero(context: &Context<'_>) -> bool {
    zero_sign(context.target) == Some(true)
}

/// Asks whether the target reads the sign of a zero; refuses the block where it is known not to.
fn zero_rests((index, span): (usize, Span), context: &mut Context<'_>) {
    match zero_sign(context.target) {
        Some(false) => {
            let finding = Diagnostic::new(Code::NoEquivalent, span, ZERO).with_help(ZERO_HELP);
            context.add_once(index, ZERO, finding);
        }
        Some(true) => {}
        None => context.rests_on_target(index, span, Question::RotaryZeroSign),
    }
}

/// True where an axis that takes the shorter way and one that turns back all turns go to an angle alike.
fn alike(shortest: &Stands, turns: &Stands, angle: f64) -> bool {
    let [ours, theirs] = [turned(shortest, angle, Way::Shortest), turned(turns, angle, Way::Turns)];
    ours.is_some() && ours == theirs
}

/// How far an axis turns, where that is the same from wherever it may stand.
fn turned(stands: &Stands, angle: f64, way: Way) -> Option<f64> {
    let turns = stands.turns(way, angle)?;
    let mut by = turns.iter().map(|(_, by)| *by);
    let first = by.next()?;
    by.all(|by| by == first).then_some(first as f64 / 1e6)
}

/// The word by which an axis on the target turns as it does on the source.
fn written(stands: &Stands, angle: f64, ours: Way, theirs: Way) -> Result<f64, (&'static str, &'static str)> {
    let turns = stands.turns(ours, angle).ok_or((UNKNOWN, HELP))?;
    let (mut to, mut by) = (turns.iter().map(|(from, by)| from + by), turns.iter().map(|(_, by)| *by));
    match theirs {
        Way::Sign => {
            if by.clone().any(|by| by.abs() >= TURN) {
                return Err((WHOLE, HELP));
            }
            let place = parts(angle_of(ours, angle)).rem_euclid(TURN) as f64 / 1e6;
            match (by.clone().any(|by| by > 0), by.any(|by| by < 0)) {
                (true, true) => Err((EITHER, HELP)),
                (_, true) => Ok(-place),
                (_, false) => Ok(place),
            }
        }
        Way::Shortest if by.any(|by| 2 * by.abs() >= TURN) => Err((HALF, HELP)),
        Way::Shortest => Ok(angle_of(ours, angle)),
        Way::Turns => {
            let first = to.next().filter(|_| !stands.loose).ok_or((TURNED, HELP))?;
            if to.all(|to| to == first) { Ok(first as f64 / 1e6) } else { Err((TURNED, HELP)) }
        }
    }
}

/// The place of a word: where the sign is the way, it is no part of the place.
fn angle_of(way: Way, angle: f64) -> f64 {
    if way == Way::Sign { angle.abs() } else { angle }
}

/// Says, once for the library, that an axis may go the other way round at rapid.
fn other_way_round((index, span): (usize, Span), context: &mut Context<'_>) {
    let finding = Diagnostic::new(Code::Conditional, span, ROUND).asked_once();
    context.add_once(index, ROUND, finding);
}

/// Asks where the axis stands when a program begins, of the control that goes by the sign.
fn rests((index, span): (usize, Span), context: &mut Context<'_>) {
    if Way::of(context.source) == Way::Sign {
        context.rests_on_source(index, span, Question::RotaryStart);
    } else {
        context.rests_on_target(index, span, Question::RotaryStart);
    }
}

fn refuse(what: &'static str, help: &'static str, (index, span): (usize, Span), context: &mut Context<'_>) {
    let sides = [context.source, context.target];
    let of =
        |way| sides.iter().find(|control| Way::of(control) == way).map(|control| &control.dialect().title);
    let text = match (of(Way::Sign), of(Way::Shortest)) {
        (Some(control), _) => {
            format!("{what}; on the {control} the sign of an angle is the way of its axis")
        }
        (_, Some(control)) => format!(
            "{what}; on the {control} an axis takes the shorter way to an angle, and the other control turns it back by all turns"
        ),
        _ => what.to_owned(),
    };
    context.add_once(index, what, Diagnostic::new(Code::NoEquivalent, span, text).with_help(help));
}

const UNKNOWN: &str =
    "where the rotary axis stands before this angle is not known, and so the way that it turns is not";
const COMPUTED: &str = "this angle is computed, and so the way that the rotary axis turns is not known";
const WHOLE: &str = "the rotary axis turns by a whole turn or more here";
const EITHER: &str = "the rotary axis comes to this angle from both sides";
const HALF: &str = "the rotary axis cuts here, and it is not certain that it turns by less than half a turn: one control takes the shorter way";
const ROUND: &str = "a rotary axis may go to its angle at rapid the other way round than on the source: one of the two takes the shorter way, and the \
     other turns back by all that it turned. Make sure that nothing is in its way there, a hose or a line above all";
const TURNED: &str = "how many turns the rotary axis has made before this angle is not known";
const MODE: &str = "whether G90 or G91 is in force at this angle is not known";
const MODE_HELP: &str = "write G90 or G91 before it";
const MACHINE: &str = "a rotary axis in machine coordinates: no source says which way it turns";
const MACHINE_HELP: &str = "write the move without the rotary axis, or in coordinates of the program";
const ZERO: &str =
    "the rotary axis turns to zero the minus way here, and the target does not read the sign of a zero";
const ZERO_HELP: &str = "turn the axis in a block of its own, after an angle of this program, or write how far it turns, in a block with G91";
const HELP: &str = "write how far the axis turns, in a block with G91; or bring it to a known angle before, by G28 or G92 in this \
                    program";
