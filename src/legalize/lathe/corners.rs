//! Corners of a lathe without a comma, whose sign says which way the next block goes.
//!
//! Law: a corner after a move along one axis, before one along the other, is the corner between two lines, of the size without its
//! sign. Side conditions: the next block goes the way that the sign says, which is asked where one of them is computed: otherwise the source
//! stops at an alarm. Counter-example: `Z-20. R-2.` before `X50.`, which goes outward.
//! Where the source writes them with C and R, as a drawing gives them, a corner without a sign stands between any two lines.

use super::place::Place;
use super::straight::{entered_straight, goes_on_to};
use crate::canon::{Func, Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question};
use crate::ir::{Expr, Module, Nc, NcItem, Program, Stmt, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::Features;

/// The words, and what each is without its sign.
const WORDS: [(Role, Role); 4] = [
    (Role::ChamferX, Role::CornerChamfer),
    (Role::ChamferZ, Role::CornerChamfer),
    (Role::ChamferNext, Role::CornerChamfer),
    (Role::RoundNext, Role::CornerRadius),
];

/// True where there are such words.
pub fn concerns(features: &Features) -> bool {
    WORDS.iter().any(|(role, _)| features.role(*role))
}

/// Takes the signs away; true where there were any.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let mut changed = false;
    let by_letters = |control: &Control| {
        control.behaviour(Question::CornerLetters).is_some_and(|row| row.value == "letters")
    };
    let (letters, same) = (by_letters(context.source), by_letters(context.target));
    for (index, program) in module.programs.iter_mut().enumerate() {
        let mut found = Vec::new();
        for (at, place, known) in corners(program) {
            let next = next_of(program, at, place);
            let Some(stmt) = program.blocks.get(at).and_then(|block| block.stmts.get(place)) else {
                continue;
            };
            let span = stmt.site.span;
            // A computed size has the sign that it has, and the target reads it by the same letters.
            if letters && same && stmt.kind.nc().is_some_and(is_computed) {
                continue;
            }
            let made =
                stmt.kind.nc().ok_or_else(String::new).and_then(|nc| plain(nc, next, (known, letters)));
            let result = made.map(|(nc, is_known)| {
                let block = program.blocks.get_mut(at);
                if let Some(stmt) = block.and_then(|block| block.stmts.get_mut(place)) {
                    stmt.kind = StmtKind::Nc(nc);
                    changed = true;
                }
                is_known
            });
            found.push((span, result));
        }
        for (span, result) in found {
            context.rests_on_source(index, span, Question::CornerLetters);
            let told = match result {
                Ok(true) => continue,
                Ok(false) => Diagnostic::new(Code::Conditional, span, OTHER_WAY).with_help(OTHER_WAY_HELP),
                Err(what) => Diagnostic::new(Code::NoEquivalent, span, what)
                    .with_help("write the place of the next block, or the corner as moves"),
            };
            context.add(index, told);
        }
    }
    changed
}

/// True for a block with one corner whose size is computed.
fn is_computed(nc: &Nc) -> bool {
    let mut sizes = WORDS.iter().filter_map(|(role, _)| nc.word(*role));
    matches!((sizes.next(), sizes.next()), (Some(size), None) if size.constant().is_none())
}

/// The statements with such a word, and where the tool stands before each.
fn corners(program: &Program) -> Vec<(usize, usize, Place)> {
    let straight = entered_straight(program);
    let (mut all, mut place) = (Vec::new(), Place::default());
    for (at, (block, straight)) in program.blocks.iter().zip(straight).enumerate() {
        if !straight {
            place = Place::default();
        }
        for (count, stmt) in block.stmts.iter().enumerate() {
            place.enter(stmt);
            if stmt.kind.nc().is_some_and(|nc| WORDS.iter().any(|(role, _)| nc.word(*role).is_some())) {
                all.push((at, count, place));
            }
            place.step(stmt);
        }
    }
    all
}

/// The block after one, where the run goes straight on to it.
fn next_of(program: &Program, at: usize, place: usize) -> Option<&Nc> {
    let here = program.blocks.get(at)?;
    let goes_on = goes_on_to(&here.term.kind, at + 1);
    let there = program.blocks.get(at + 1).filter(|_| goes_on).map_or(&[][..], |block| &block.stmts);
    let mut rest = here.stmts.get(place + 1..)?.iter().chain(there);
    rest.find(|stmt: &&Stmt| !matches!(stmt.kind, StmtKind::Comment))?.kind.nc()
}

const OTHER_WAY: &str = "the sign of this corner, or which way the next block goes, is computed: where the two differ, the source stops at an alarm, and the target makes the corner";
const OTHER_WAY_HELP: &str =
    "make sure that the sign is the way of the next block, as it is in a program that runs";

/// A size without its sign.
fn size_of(value: &Expr) -> Expr {
    match value {
        Expr::Negate(inner) => size_of(inner),
        _ => match value.constant() {
            Some(size) => Expr::Number(size.abs()),
            None => Expr::Call(Func::Abs, [value.clone()].into()),
        },
    }
}

/// The block with the corner without its sign; true where the sign is known to be the way of the next block.
fn plain(nc: &Nc, next: Option<&Nc>, (place, letters): (Place, bool)) -> Result<(Nc, bool), String> {
    let mut words = WORDS.iter().filter_map(|(role, plain)| Some((*role, *plain, nc.word(*role)?)));
    let (Some((role, plain, value)), None) = (words.next(), words.next()) else {
        return Err("two corners in one block".into());
    };
    let size = value.constant();
    if size == Some(0.0) {
        return Err("the size of this corner is 0: its sign says which way the next block must go".into());
    }
    let without_sign = || {
        let item = |item: &NcItem| match item {
            NcItem::Word(found, _) if WORDS.iter().any(|(role, _)| role == found) => {
                NcItem::Word(plain, size_of(value))
            }
            other => other.clone(),
        };
        Nc { items: nc.items.iter().map(item).collect() }
    };
    if letters && size.is_some_and(|size| size > 0.0) {
        return Ok((without_sign(), true));
    }
    let axes = |nc: &Nc| {
        [[Role::X, Role::StepX], [Role::Z, Role::StepZ]]
            .map(|roles| roles.into_iter().find(|role| nc.word(*role).is_some()))
    };
    if nc.word(Role::LineAngle).is_some() {
        return Err("a corner with a sign, or one that names an axis, stands after a line by its angle: the source stops at an alarm".into());
    }
    let along_x = match axes(nc) {
        [Some(_), None] => true,
        [None, Some(_)] => false,
        _ => return Err("a corner without a comma stands after a move along X alone or Z alone, and this one goes along both, or neither".into()),
    };
    let named = match role {
        Role::ChamferX => Some(false),
        Role::ChamferZ => Some(true),
        _ => None,
    };
    if named.is_some_and(|along| along != along_x) {
        return Err("this chamfer names the axis of its own block, not that of the next one: the source stops at an alarm".into());
    }
    let other =
        |role: &Role| role.is_axis() && !matches!(role, Role::X | Role::StepX | Role::Z | Role::StepZ);
    let straight = |nc: &Nc| {
        let own = nc.ops().filter(|op| op.group() == Group::Motion).all(|op| op == Op::Linear);
        own && nc.word(Role::LineAngle).is_none()
            && !nc.ops().any(|op| op.takes_axes())
            && !nc.items.iter().any(|item| matches!(item, NcItem::Word(role, _) if other(role)))
    };
    let next = next.filter(|next| straight(next)).map(|next| (next, axes(next)));
    let (next, role) = match (next, along_x) {
        (Some((next, [None, Some(z)])), true) => (next, z),
        (Some((next, [Some(x), None])), false) => (next, x),
        _ => {
            return Err("the block after this corner must go straight along the other axis alone: otherwise the source stops at an alarm".into());
        }
    };
    let before = if along_x { place.z() } else { place.x() };
    let value = next.word(role).and_then(Expr::constant);
    let way = if role.is_step() || place.counts_steps() {
        value
    } else {
        value.zip(before).map(|(to, from)| to - from)
    };
    match way.zip(size) {
        Some((way, size)) if way * size > 0.0 => Ok((without_sign(), true)),
        Some(_) => Err(
            "the sign of this corner says another way than the next block goes: the source stops at an alarm"
                .into(),
        ),
        None => Ok((without_sign(), false)),
    }
}
