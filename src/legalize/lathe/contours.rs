//! Contours: the blocks that a cycle of a lathe finds by the sequence numbers of the first and the last one.
//!
//! Law: a cycle reads the same contour if the same blocks stand between the two numbers, and each number stands once. Side condition: nothing
//! but moves and comments stands there, on one way; a jump that comes in from elsewhere runs the same blocks as they stand. Counter-example: a
//! macro call between them, which the cycle does not look into.

use super::place::Place;
use super::straight::{entered_straight, goes_on_to};
use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Control;
use crate::ir::{Module, Nc, Program, Stmt, StmtKind};
use crate::legalize::features::Features;
use crate::legalize::{Context, ModalFacts};
use crate::text::Span;
use std::sync::Arc;

/// True where cycles read contours.
pub fn concerns(features: &Features) -> bool {
    features.any_op(Op::reads_contour)
}

/// Checks that each contour that a cycle names is there, as a contour.
pub fn run(module: &Module, context: &mut Context<'_>) {
    for (index, program) in module.programs.iter().enumerate() {
        let straight = entered_straight(program);
        let mut place = Place::default();
        let stmts = program.blocks.iter().zip(straight).flat_map(|(block, straight)| {
            block.stmts.iter().enumerate().map(move |(at, stmt)| (stmt, straight || at > 0))
        });
        for (stmt, goes_on) in stmts {
            if !goes_on {
                place.forget();
            }
            place.enter(stmt);
            let from = place;
            place.step(stmt);
            let StmtKind::Nc(nc) = &stmt.kind else { continue };
            if !nc.ops().any(Op::reads_contour) {
                continue;
            }
            let beyond = beyond(program, nc, from, [context.source, context.target]);
            for (span, what, help) in returns(program, nc, from).into_iter().chain(beyond) {
                let told = Diagnostic::new(Code::NoEquivalent, span, what.as_str()).with_help(help);
                context.add_once(index, &format!("{what} {:?}", stmt.site.span), told);
            }
            if let Err((what, help)) = check(program, nc, context.target.text().sequence_max) {
                // The pass runs twice.
                let fact = format!("{what} {:?}", stmt.site.span);
                let told = Diagnostic::new(Code::NoEquivalent, stmt.site.span, what);
                context.add_once(index, &fact, told.with_help(help));
            }
        }
    }
}

/// What is wrong with a contour, and what to do about it.
type Fault = (String, &'static str);

const NUMBERS_HELP: &str =
    "write P and Q as the sequence numbers of the first and the last block of the contour";
const ORDER_HELP: &str =
    "give the first block of the contour the number that P names, and the last one the number that Q names";
const TWICE_HELP: &str = "give one of the blocks another number";
const STRAIGHT_HELP: &str = "write the blocks of the contour one after another: where a condition chooses between two contours, write the cycle with each of them";

/// `most` is the last sequence number of the target.
fn check(program: &Program, nc: &Nc, most: u32) -> Result<(), Fault> {
    let number = |role: Role| {
        let value = nc.word(role).and_then(|value| value.constant());
        value.filter(|value| *value > 0.0).map(|value| value as u32)
    };
    let (first, last) = match (number(Role::ContourFirst), number(Role::ContourLast)) {
        (Some(first), Some(last)) => (first, last),
        (Some(_), None) if nc.word(Role::ContourLast).is_none() => {
            return Err((
                "the cycle has no Q, the number of the last block of its contour".into(),
                NUMBERS_HELP,
            ));
        }
        _ => {
            let what = "the cycle does not say as numbers with which block its contour begins and ends";
            return Err((what.into(), NUMBERS_HELP));
        }
    };
    if let Some(number) = [first, last].into_iter().find(|number| *number > most) {
        let what =
            format!("the target's sequence numbers end at {most}, and N{number} begins or ends a contour");
        return Err((what, "give the blocks of the contour lower numbers"));
    }
    let from = find(program, first)?;
    let to = find(program, last)?;
    if from > to {
        let what = format!("N{last}, the end of the contour, stands before N{first}, its beginning");
        return Err((what, ORDER_HELP));
    }
    if from == to {
        let what = format!(
            "P and Q both name N{first}: no source says what the cycle does with a contour of one block"
        );
        return Err((what, ORDER_HELP));
    }
    let begins = program.blocks.get(from.0).and_then(|block| block.stmts.get(from.1));
    let moves = |nc: &Nc| nc.has(Op::Rapid) || nc.has(Op::Linear);
    if !begins.is_some_and(|stmt| stmt.kind.nc().is_some_and(moves)) {
        let what = format!(
            "N{first}, the first block of the contour, has no G0 or G1 of its own, which the cycle needs"
        );
        return Err((what, "write G0 or G1 into that block"));
    }
    let goes_on = |at: usize| program.blocks.get(at).is_some_and(|b| goes_on_to(&b.term.kind, at + 1));
    if !(from.0..to.0).all(goes_on) {
        let what =
            format!("a jump or a call stands between N{first} and N{last}: a contour goes straight through");
        return Err((what, STRAIGHT_HELP));
    }
    let part = |at: usize| {
        let stmts = program.blocks.get(at).map_or(&[][..], |block| &block.stmts);
        let begin = if at == from.0 { from.1 } else { 0 };
        let end = if at == to.0 { to.1 + 1 } else { stmts.len() };
        stmts.get(begin..end).unwrap_or_default()
    };
    if let Some(what) = (from.0..=to.0).flat_map(part).find_map(foreign) {
        let what = format!("{what} stands between N{first} and N{last}: a contour has only moves");
        return Err((what, "take it out of the contour, and write it before the cycle or after the contour"));
    }
    if is_split(program, to) {
        let what = format!(
            "an M code in N{last}, the last block of the contour, acts otherwise beside a move on the target, and in a block of its own it \
             would stand after the contour"
        );
        return Err((what, "take it out, and write it after the block that finishes the contour"));
    }
    Ok(())
}

/// Where the last block of a contour to be turned goes back along Z, as far as the words say it: the control stops there (docs/lathe.md R10).
fn returns(program: &Program, nc: &Nc, from: Place) -> Option<(Span, String, &'static str)> {
    if !nc.has(Op::RoughTurning) {
        return None;
    }
    let number = |role: Role| nc.word(role).and_then(|value| value.constant()).map(|number| number as u32);
    let (first, last) = (number(Role::ContourFirst)?, number(Role::ContourLast)?);
    let (begin, end) = (find(program, first).ok()?, find(program, last).ok()?);
    let stmts =
        program.blocks.iter().enumerate().flat_map(|(block, found)| {
            found.stmts.iter().enumerate().map(move |(at, stmt)| ((block, at), stmt))
        });
    let mut at = from.z()?;
    let mut along = 0.0;
    for (place, stmt) in stmts.filter(|(place, _)| (begin..=end).contains(place)) {
        let Some(nc) = stmt.kind.nc() else { continue };
        let steps = nc.has(Op::Incremental) || nc.word(Role::StepZ).is_some();
        if steps || from.counts_steps() {
            return None;
        }
        let Some(z) = nc.word(Role::Z) else { continue };
        let way = z.constant()? - at;
        at += way;
        if place == end && way * along < 0.0 {
            let what = format!(
                "N{last}, the last block of this contour, goes back along Z, and the control stops there: Z of a contour may not turn back"
            );
            return Some((stmt.site.span, what, RETURNS_HELP));
        }
        along = if way == 0.0 { along } else { way };
    }
    None
}

const RETURNS_HELP: &str = "end the contour with the move along X, and write the move back in Z after it";

/// Where the last block of a contour goes beyond the start of the cycle, which the source allows and the target does not (docs/lathe.md
/// R11), as far as its words are places.
fn beyond(
    program: &Program,
    nc: &Nc,
    from: Place,
    [source, target]: [&Control; 2],
) -> Option<(Span, String, &'static str)> {
    let (axis, letter, start) = match nc.ops().find(|op| op.reads_contour())? {
        Op::RoughTurning => (Role::X, 'X', from.x()?),
        Op::RoughFacing => (Role::Z, 'Z', from.z()?),
        _ => return None,
    };
    if stops_beyond(source) || !stops_beyond(target) || from.counts_steps() {
        return None;
    }
    let number = |role: Role| nc.word(role).and_then(|value| value.constant()).map(|number| number as u32);
    let block = |number: u32| {
        let (block, place) = find(program, number).ok()?;
        program.blocks.get(block)?.stmts.get(place)
    };
    let last = number(Role::ContourLast)?;
    let place = |stmt: &Stmt| stmt.kind.nc()?.word(axis)?.constant();
    let (begin, end) = (block(number(Role::ContourFirst)?)?, block(last)?);
    let (first, to) = (place(begin)?, place(end)?);
    ((first - start) * (to - start) < 0.0).then(|| {
        let what = format!(
            "N{last}, the last block of this contour, goes to {letter}{to}, beyond {letter}{start} where the cycle begins: the target stops there"
        );
        (end.site.span, what, BEYOND_HELP)
    })
}

/// True for a control that lets no point of a contour lie beyond the start of the cycle: it has the blocks before its cycles alone.
pub(super) fn stops_beyond(control: &Control) -> bool {
    control.dialect().settings.iter().any(|row| row.otherwise == Some(Role::ThreadLeast))
}

const BEYOND_HELP: &str =
    "begin the cycle as far out as its contour ends, or end the contour where the cycle begins";

/// True where what stood in one block of the source goes on after a statement.
fn is_split(program: &Program, (at, place): (usize, usize)) -> bool {
    let after = |at: usize| program.blocks.get(at).map_or(&[][..], |block| &block.stmts);
    let this = after(at).get(place);
    let next = after(at).get(place + 1).or_else(|| after(at + 1).first());
    this.zip(next)
        .is_some_and(|(this, next)| this.site.span == next.site.span && this.site.span != Span::default())
}

/// True where the contour of a cycle is one with valleys by its first block, which names both axes; none where that is not known.
pub(super) fn has_valleys(program: &Program, nc: &Nc) -> Option<bool> {
    let first = nc.word(Role::ContourFirst).and_then(|value| value.constant())?;
    let (block, place) = find(program, first as u32).ok()?;
    let first = program.blocks.get(block)?.stmts.get(place)?.kind.nc()?;
    let names = |axis: Role, step: Role| first.word(axis).or(first.word(step)).is_some();
    Some(names(Role::X, Role::StepX) && names(Role::Z, Role::StepZ))
}

/// What is in force where runs begin without compensation of a radius, as after a reset and the end of a program.
pub(super) fn facts_uncompensated(module: &Module, context: &Context<'_>) -> Arc<ModalFacts> {
    let mut entry = context.entry.clone();
    entry.start_in(Op::RadiusOff);
    context.modal_facts_from(module, &entry)
}

/// The blocks of words between the first and the last block of a cycle's contour; none if one of the two is not found.
pub(super) fn contour<'p>(program: &'p Program, nc: &Nc) -> impl Iterator<Item = &'p Nc> {
    let number = |role: Role| nc.word(role).and_then(|value| value.constant()).map(|number| number as u32);
    let end = |role: Role| find(program, number(role)?).ok();
    let ends = end(Role::ContourFirst).zip(end(Role::ContourLast));
    let stmts =
        program.blocks.iter().enumerate().flat_map(|(block, found)| {
            found.stmts.iter().enumerate().map(move |(at, stmt)| ((block, at), stmt))
        });
    let inside = move |place| ends.is_some_and(|(begin, end)| (begin..=end).contains(&place));
    stmts.filter(move |(place, _)| inside(*place)).filter_map(|(_, stmt)| stmt.kind.nc())
}

/// Where the last block of a cycle's contour stands.
pub(super) fn last_block(program: &Program, nc: &Nc) -> Option<(usize, usize)> {
    let last = nc.word(Role::ContourLast)?.constant()?;
    find(program, last as u32).ok()
}

/// The only block and statement with a sequence number.
fn find(program: &Program, number: u32) -> Result<(usize, usize), Fault> {
    let mut all = program.blocks.iter().enumerate().flat_map(|(at, block)| {
        let with =
            block.stmts.iter().enumerate().filter(|(_, stmt)| stmt.site.sequence.get() == Some(number));
        with.map(move |(place, _)| (at, place))
    });
    match (all.next(), all.next()) {
        (Some(place), None) => Ok(place),
        (None, _) => Err((format!("no block of this program has the number N{number}"), ORDER_HELP)),
        _ => Err((
            format!("N{number} stands more than once: which block the cycle takes is not sure"),
            TWICE_HELP,
        )),
    }
}

/// What a statement is that no contour may have; none for those that it may.
fn foreign(stmt: &Stmt) -> Option<String> {
    let what = match &stmt.kind {
        StmtKind::Comment => return None,
        StmtKind::Nc(nc) => {
            let op = nc.ops().find(|op| {
                let mode = matches!(op.group(), Group::Units | Group::Plane);
                mode || op.is_lathe_cycle() || op.is_lathe_setup() || op.is_pass()
            })?;
            let meaning = op.meaning().trim().trim_end_matches('.');
            return Some(format!("a code that does not move ({op}: {meaning})"));
        }
        StmtKind::Assign { .. } => "an assignment",
        StmtKind::Alarm { .. } => "an alarm",
        StmtKind::StopMessage { .. } => "a message",
        StmtKind::ModalCall(_) | StmtKind::ModalCallOff => "a modal call",
        StmtKind::Output(_) | StmtKind::OpenPort | StmtKind::ClosePort | StmtKind::Print { .. } => {
            "an output"
        }
        _ => "a statement that is no move",
    };
    Some(what.into())
}
