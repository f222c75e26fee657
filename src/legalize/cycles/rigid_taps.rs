//! Rigid taps: by a code of their own on one control, always on another.
//!
//! Law: a code before a tap that makes it rigid goes where all taps of the target are rigid, and its speed stays; it is
//! written before each tap where the target's taps are rigid only by it. For a lathe it is written wherever they are not known to be
//! rigid always, as it does no harm there; live tools get it where their cycle is written. Side conditions: the tap is the next thing
//! that moves, and nothing turns the spindle between; the spindle does not turn to the left before a right-hand tap; S is a speed of
//! turns. A target whose rigid taps are cycles of their own may have a code that gets the spindle ready for them: it stands
//! in its place. A speed that the program computes is read back where the target can: `M29 S#4119`.
//! Counter-example: a tap without the code on a control that has it feeds beside a spindle that follows nothing, and a
//! rigid holder takes up no difference.

use super::tap_leads::{Speed, Speeds};
use crate::canon::{Group, Op, Role, Sys};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Machine, Question};
use crate::ir::analysis::over_calls::OverCalls;
use crate::ir::{Block, BlockId, Expr, Module, Nc, NcItem, SourceInfo, Stmt, StmtKind};
use crate::legalize::features::Features;
use crate::legalize::{Context, Modal};
use std::collections::BTreeMap;

/// True if there are taps, and one of the two controls has more to say of rigid ones than the other.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let taps = always(context.source) && features.any_op(|op| is_asked(op, context.target));
    if context.target.machine() == Machine::Lathe {
        return taps && by_code(context.target);
    }
    taps && !always(context.target) || features.op(Op::RigidTaps)
}

/// True for a tap that this pass writes the code for: the taps of live tools get theirs with their cycle.
fn is_asked(op: Op, target: &Control) -> bool {
    op.is_tap() && !(target.machine() == Machine::Lathe && op.is_live_tap())
}

pub(super) fn always(control: &Control) -> bool {
    control.behaviour(Question::TapRigid).is_some_and(|row| row.value == "always")
}

/// True where the code is written: a mill is asked where it is not known, on a lathe it does no harm.
fn by_code(control: &Control) -> bool {
    let told = control.behaviour(Question::TapRigid).is_some_and(|row| row.value == "code");
    let wanted = told || control.machine() == Machine::Lathe && !always(control);
    wanted && control.code_for(Op::RigidTaps, &BTreeMap::new()).is_some()
}

/// True for a control that has a tapping cycle of some kind.
fn has_taps(control: &Control) -> bool {
    [Op::CycleTap, Op::CycleTapLeft, Op::CycleTapRigid, Op::CycleTapByLead]
        .iter()
        .any(|op| control.code_for(*op, &BTreeMap::new()).is_some())
}

/// Takes the code away, or writes it.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let facts = context.modal_facts(module);
    let speeds = OverCalls::of(module, &Speeds);
    let keeps = context.target.code_for(Op::RigidTaps, &BTreeMap::new()).is_some();
    let readies =
        context.target.code_for(Op::TapReady, &BTreeMap::new()).is_some() && !always(context.target);
    let lathe = context.target.machine() == Machine::Lathe;
    // A control without taps is asked nothing of them: each is refused as a code that it lacks.
    let has_taps = has_taps(context.target);
    let (all, writes) = (always(context.source), by_code(context.target));
    let mut changed = false;
    let stmts = || module.programs.iter().flat_map(|program| &program.blocks).flat_map(|block| &block.stmts);
    let taps_somewhere =
        stmts().any(|stmt| stmt.kind.nc().is_some_and(|nc| nc.ops().any(Op::is_tap) || is_open(nc)));
    // Where speeds are of surfaces too, S is not the number that was said last.
    let turns_always = !lathe && !stmts().any(|stmt| stmt.kind.has_op(Op::SurfaceSpeed));
    for (index, program) in module.programs.iter_mut().enumerate() {
        let mut found = Vec::new();
        for (at, block) in program.blocks.iter_mut().enumerate() {
            let id = BlockId(at as u32);
            let mut state = facts.at(index, id);
            if !lathe && taps_somewhere {
                found.extend(misplaced(block, state.clone()));
            } else if !lathe && !keeps {
                untapped(block, index, context);
            }
            let mut coded = false;
            // What no run reaches may be left of a subroutine that was given a program of its own.
            let mut speed = speeds.at(index, id).copied().unwrap_or(Speed::Said);
            for mut stmt in std::mem::take(&mut block.stmts) {
                state.step(&stmt);
                let said = if turns_always { speed } else { Speed::Unknown };
                speed.step(&stmt);
                let rigid = stmt.kind.has_op(Op::RigidTaps);
                let taps = stmt.kind.nc().is_some_and(|nc| nc.ops().any(|op| is_asked(op, context.target)));
                coded |= rigid;
                if (rigid || all && taps) && !always(context.target) && !lathe && has_taps {
                    context.rests_on_target(index, stmt.site.span, Question::TapRigid);
                }
                if rigid && !keeps {
                    changed = true;
                    take(&mut stmt, said);
                    if readies && taps {
                        block.stmts.push(ready(&stmt));
                    } else if readies && stmt.kind == StmtKind::Comment {
                        stmt.kind = ready(&stmt).kind;
                    } else if readies {
                        let code = ready(&stmt);
                        block.stmts.push(std::mem::replace(&mut stmt, code));
                    }
                    if stmt.kind == StmtKind::Comment
                        && stmt.site.comments.is_empty()
                        && stmt.site.sequence.is_none()
                    {
                        continue;
                    }
                }
                if rigid && keeps && taps && stmt.kind.nc().is_some_and(|nc| nc.word(Role::Lead).is_some()) {
                    // The tap itself says that it is rigid: the code stands before it, with the speed.
                    changed = true;
                    match speed_word(speed, &stmt, context.target) {
                        Some(speed) => {
                            remove(&mut stmt);
                            block.stmts.push(code(speed, &stmt));
                        }
                        None => found.push((stmt.site.span, SPEED)),
                    }
                }
                if all && taps && writes && !(lathe && coded) {
                    changed = true;
                    let turns = state.op(Group::SpeedMode) != Some(Op::SurfaceSpeed);
                    match speed_word(speed, &stmt, context.target) {
                        Some(speed) if turns => {
                            block.stmts.push(code(speed, &stmt));
                            told_before(&mut stmt, block.stmts.last());
                        }
                        _ => found.push((stmt.site.span, SPEED)),
                    }
                }
                coded &= !taps;
                block.stmts.push(stmt);
            }
        }
        for (span, (what, help)) in found {
            context.add(index, Diagnostic::new(Code::NoEquivalent, span, what).with_help(help));
        }
    }
    changed
}

pub(super) type Told = (&'static str, &'static str);

pub(super) const SPEED: Told = (
    "the code for a rigid tap takes the speed of the spindle, which is not known here, or is not the same for all who \
     call this program",
    "write S before the tap in this program",
);

const MOVES: Told = (
    "between the code for a rigid tap and the tap stands a move or a speed, at which the source's control stops with an \
     alarm (PS0203, PS0204)",
    "write the code right before the block of the tap, or in it",
);

const TURNS: Told = (
    "between the code for a rigid tap and the tap stands a code that turns or stops the spindle; what the tap does then is \
     up to the machine's builder",
    "write the spindle's code before the one for the rigid tap",
);

const LEFT: Told = (
    "the spindle turns to the left here, and the rigid tap is right-handed",
    "write M5 before the code for the rigid tap",
);

/// True for a block with a code that is known only when it runs.
fn is_open(nc: &Nc) -> bool {
    nc.items.iter().any(|item| matches!(item, NcItem::Code('G', _)))
}

const UNTAPPED: &str = "this code makes the next tap rigid on the source, and no program of the library taps: it may be another function of \
     the machine's builder";

/// Asks what the code for a rigid tap is in a library that has no taps.
fn untapped(block: &Block, index: usize, context: &mut Context<'_>) {
    let row = context.source.code_for(Op::RigidTaps, &BTreeMap::new());
    let Some((letter, number)) =
        row.and_then(|row| Some((row.code.chars().next()?, row.code.get(1..)?.parse().ok()?)))
    else {
        return;
    };
    for stmt in block.stmts.iter().filter(|stmt| stmt.kind.has_op(Op::RigidTaps)) {
        let help = "say under [[site]] of the source's profile what it does, or take it out";
        let finding = Diagnostic::new(Code::NoEquivalent, stmt.site.span, UNTAPPED).with_help(help);
        context.add(index, finding.asking(letter, number));
    }
}

/// Where the code for a rigid tap is followed by something else than a tap that it can make rigid.
fn misplaced(block: &Block, mut state: Modal) -> Vec<(crate::text::Span, Told)> {
    let mut found = Vec::new();
    let mut waits = false;
    for stmt in &block.stmts {
        if let StmtKind::Nc(nc) = &stmt.kind {
            let taps = nc.ops().any(Op::is_tap);
            let rigid = nc.has(Op::RigidTaps);
            let left = state.op(Group::Spindle) == Some(Op::SpindleCcw);
            let told = if (waits || rigid) && nc.ops().any(|op| op.group() == Group::Spindle) {
                Some(TURNS)
            } else if (waits && !taps && (nc.names_axis() || nc.word(Role::Speed).is_some()))
                || rigid && !taps && nc.names_axis()
            {
                Some(MOVES)
            } else if (waits || rigid) && taps && left && !nc.has(Op::CycleTapLeft) {
                Some(LEFT)
            } else {
                None
            };
            waits = (waits || rigid) && !taps && told.is_none();
            found.extend(told.map(|told| (stmt.site.span, told)));
        }
        state.step(stmt);
    }
    found
}

/// Takes the code alone out of its block.
fn remove(stmt: &mut Stmt) {
    if let StmtKind::Nc(nc) = &mut stmt.kind {
        nc.items.retain(|item| *item != NcItem::Op(Op::RigidTaps));
    }
}

/// Takes the code out of its block; the speed beside it stays, unless it is the one said before.
fn take(stmt: &mut Stmt, said: Speed) {
    remove(stmt);
    let StmtKind::Nc(nc) = &mut stmt.kind else { return };
    let again = |value: &Expr| value.constant().is_some_and(|speed| said == Speed::Known(speed));
    let turns = nc.ops().any(|op| op.is_tap() || op.group() == Group::Spindle);
    if !turns {
        nc.items.retain(|item| !matches!(item, NcItem::Word(Role::Speed, value) if again(value)));
    }
    if nc.items.is_empty() {
        stmt.kind = StmtKind::Comment;
    }
}

/// Takes the speed out of a tap that the code before it has told it: another one there is an alarm of some controls (PS0203).
pub(super) fn told_before(tap: &mut Stmt, before: Option<&Stmt>) {
    let StmtKind::Nc(tap) = &mut tap.kind else { return };
    let told = before
        .and_then(|stmt| stmt.kind.nc())
        .filter(|nc| nc.has(Op::RigidTaps) && tap.ops().any(Op::is_tap));
    let told = told.and_then(|nc| nc.word(Role::Speed)?.constant());
    if told.is_some()
        && tap.word(Role::Speed).and_then(Expr::constant) == told
        && tap.word(Role::Lead).is_none()
    {
        tap.items.retain(|item| !matches!(item, NcItem::Word(Role::Speed, _)));
    }
}

/// The code that gets the spindle of the target ready for a rigid tap, in a block of its own.
pub(super) fn ready(tap: &Stmt) -> Stmt {
    let site = SourceInfo { span: tap.site.span, skip: tap.site.skip, ..SourceInfo::default() };
    Stmt { kind: StmtKind::Nc(Nc { items: vec![NcItem::Op(Op::TapReady)] }), site }
}

/// The letter number of S in [`Sys::Address`].
const ADDRESS_S: u32 = 19;

/// What the code before a tap says of the speed: a number, or, where the program has said one that is computed, what the
/// target has of the last speed. None where the tap's own block computes it.
pub(super) fn speed_word(speed: Speed, tap: &Stmt, target: &Control) -> Option<Expr> {
    let readable = || target.system_address(Sys::Address, &[ADDRESS_S]).is_some();
    match speed {
        Speed::Known(speed) => Some(Expr::Number(speed)),
        Speed::Said if tap.kind.nc()?.word(Role::Speed).is_none() && readable() => {
            Some(Expr::System(Sys::Address, [Expr::Number(f64::from(ADDRESS_S))].into()))
        }
        Speed::Said | Speed::Surface | Speed::Unknown => None,
    }
}

/// The code with its speed, for a block of its own before a tap.
pub(super) fn code(speed: Expr, tap: &Stmt) -> Stmt {
    let items = vec![NcItem::Op(Op::RigidTaps), NcItem::Word(Role::Speed, speed)];
    let site = SourceInfo { span: tap.site.span, skip: tap.site.skip, ..SourceInfo::default() };
    Stmt { kind: StmtKind::Nc(Nc { items }), site }
}
