//! Words of a lathe's cycles that count least increments on one of the two controls.
//!
//! Law: n increments are `n * increment` of the unit in force. Side condition: the unit is known where a number must change its form.
//! Error bound: half of a least increment, to which a control takes such a word anyway.
//! Counter-example: a peck of 0.0004 mm, of which no count is left.

use crate::canon::Role;
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Units};
use crate::ir::{BinOp, Block, Expr, Module, Nc, NcItem, Place, Program, Stmt, StmtKind, TermKind, Var};
use crate::legalize::Context;
use crate::legalize::features::Features;
use crate::legalize::moves::increments::{Counted, Texts, each};
use crate::text::Span;
use std::collections::BTreeSet;

/// The roles that count increments on some control.
const ROLES: [Role; 6] =
    [Role::GrooveX, Role::GrooveZ, Role::ThreadHeight, Role::ThreadFirst, Role::ThreadLeast, Role::CycleQ];

/// Lengths that a control may take from a setting, which is a length: a count of increments must not meet it.
const SET: [Role; 2] = [Role::CutRetract, Role::ThreadAllowance];

const TEXTS: Texts = Texts {
    unknown: "a peck or a depth counts least increments on the target, and their size depends on the unit in force, which is \
              not known here",
    guessed: "a peck or a depth is taken in the unit that the program names: a called program outside the library must not \
              change it",
};

/// True where such a word counts on the source alone.
pub fn counts_there(features: &Features, context: &Context<'_>) -> bool {
    lengths(context.source, context.target).iter().any(|role| features.role(*role))
}

/// The roles whose counts must become lengths.
fn lengths(source: &Control, target: &Control) -> Vec<Role> {
    let there = ROLES.into_iter().filter(|role| counted(source, *role) && !counted(target, *role));
    let given = |role: &Role| target.dialect().settings.iter().any(|setting| setting.gives == Some(*role));
    there.chain(SET.into_iter().filter(given)).collect()
}

/// True where one counts on the target.
pub fn counts_here(features: &Features, context: &Context<'_>) -> bool {
    let stands = features.any_op(|op| op.is_lathe_cycle() || op.is_lathe_setup() || op.is_hole());
    stands && ROLES.iter().any(|role| counted(context.target, *role))
}

/// True where the words of a role count increments.
pub(super) fn counted(control: &Control, role: Role) -> bool {
    control.dialect().codes.iter().any(|row| {
        let mut letters = row.words.iter().filter(|(_, found)| **found == role);
        row.preferred && letters.any(|(letter, _)| letter.chars().any(|l| row.counts.contains(&l)))
    })
}

/// Makes lengths of all such words.
pub fn to_lengths(module: &mut Module, context: &mut Context<'_>) -> bool {
    let roles = lengths(context.source, context.target);
    may_be_left_out(module, context, &roles, &|value| value.count().is_some_and(Expr::may_be_vacant));
    all(module, context, &roles, |_, _| false)
}

/// Says where the value is a variable alone, which drops the word where it is vacant: what is computed of it is 0 then.
fn may_be_left_out(module: &Module, context: &mut Context<'_>, roles: &[Role], open: &dyn Fn(&Expr) -> bool) {
    for (index, program) in module.programs.iter().enumerate() {
        if let Some(span) = first_open(program, roles, open) {
            let told = Diagnostic::new(Code::Conditional, span, VACANT).with_help(VACANT_HELP);
            context.add_once(index, VACANT, told);
        }
    }
}

/// The first block with such a value. A variable has one that the first blocks of a program without calls give it, and none of it takes
/// away.
fn first_open(program: &Program, roles: &[Role], open: &dyn Fn(&Expr) -> bool) -> Option<Span> {
    let assigned = |stmt: &Stmt| match &stmt.kind {
        StmtKind::Assign { target: Place::Var(var), value } => Some((*var, value.may_be_vacant())),
        _ => None,
    };
    let stmts = || program.blocks.iter().flat_map(|block| &block.stmts);
    let calls = program.blocks.iter().any(|block| matches!(block.term.kind, TermKind::Call { .. }));
    let known =
        |var: &Var| !calls && !stmts().filter_map(assigned).any(|(found, vacant)| found == *var && vacant);
    let mut given = BTreeSet::new();
    for (at, block) in program.blocks.iter().enumerate() {
        for stmt in &block.stmts {
            let mut items = stmt.kind.nc().map_or(&[][..], |nc| &nc.items).iter();
            let asks = items.any(|item| match item {
                NcItem::Word(role, value) if roles.contains(role) && open(value) => {
                    !matches!(value.count().unwrap_or(value), Expr::Var(var) if given.contains(var))
                }
                _ => false,
            });
            if asks {
                return Some(stmt.site.span);
            }
            given.extend(assigned(stmt).map(|(var, _)| var).filter(|var| at == 0 && known(var)));
        }
    }
    None
}

/// Makes counts of those that count on the target.
pub fn to_counts(module: &mut Module, context: &mut Context<'_>) -> bool {
    let before = lengths_of(module, context.target);
    let counts: Vec<Role> = ROLES
        .into_iter()
        .filter(|role| counted(context.target, *role) && !counted(context.source, *role))
        .collect();
    may_be_left_out(module, context, &counts, &|value| value.count().is_none() && value.may_be_vacant());
    let made = all(module, context, &ROLES, counted);
    let after = lengths_of(module, context.target);
    for ((index, span, length), (_, _, count)) in before.into_iter().zip(after) {
        if is_rounded(&length, &count, context.target) {
            let told = Diagnostic::new(Code::NearlyEqual, span, ROUNDED).with_help(ROUNDED_HELP);
            context.add_once(index, ROUNDED, told);
        }
    }
    made
}

/// The words that count on the target, each with its program and its place.
fn lengths_of(module: &Module, target: &Control) -> Vec<(usize, Span, Expr)> {
    let of_stmt = |index: usize, stmt: &Stmt| {
        let words = stmt.kind.nc().map_or(&[][..], |nc| &nc.items).iter().filter_map(|item| match item {
            NcItem::Word(role, value) if ROLES.contains(role) && counted(target, *role) => {
                Some(value.clone())
            }
            _ => None,
        });
        let span = stmt.site.span;
        words.map(|value| (index, span, value)).collect::<Vec<_>>()
    };
    let programs = module.programs.iter().enumerate();
    let stmts = programs.flat_map(|(index, program)| {
        program.blocks.iter().flat_map(|block| &block.stmts).map(move |stmt| (index, stmt))
    });
    stmts.flat_map(|(index, stmt)| of_stmt(index, stmt)).collect()
}

/// True for a length that became another one, whatever the unit: the increments of the two are far apart.
fn is_rounded(length: &Expr, count: &Expr, target: &Control) -> bool {
    let (Expr::Number(length), Expr::Increments(count)) = (length, count) else { return false };
    let numbers = target.numbers();
    [numbers.increment_mm, numbers.increment_inch].iter().all(|size| (length / size - count).abs() > 1e-6)
}

fn all(
    module: &mut Module,
    context: &mut Context<'_>,
    roles: &[Role],
    counts: impl Fn(&Control, Role) -> bool,
) -> bool {
    let target = context.target;
    let chosen = |block: &Block| {
        block.stmts.iter().any(|stmt| matches!(&stmt.kind, StmtKind::Nc(nc) if has(nc, roles)))
    };
    each(module, context, Some(TEXTS), chosen, &mut |kind, units| match kind {
        Counted::Stmt(StmtKind::Nc(nc)) => nc.items.iter_mut().all(|item| match item {
            NcItem::Word(role, value) if roles.contains(role) => {
                let made = changed(value, units, counts(target, *role), target);
                made.is_some_and(|made| {
                    *value = made;
                    true
                })
            }
            _ => true,
        }),
        _ => true,
    })
}

fn has(nc: &Nc, roles: &[Role]) -> bool {
    nc.items.iter().any(|item| matches!(item, NcItem::Word(role, _) if roles.contains(role)))
}

/// The value in the other form; none where the unit must be known for it.
fn changed(value: &Expr, units: Option<Units>, counts: bool, target: &Control) -> Option<Expr> {
    let numbers = target.numbers();
    let is_count = matches!(value, Expr::Increments(_)) || value.count().is_some();
    // What has its form already.
    if is_count == counts {
        return Some(value.clone());
    }
    let size = match units {
        Some(Units::Inch) => numbers.increment_inch,
        Some(Units::Metric) => numbers.increment_mm,
        None if value.constant() == Some(0.0) => 1.0,
        None => return None,
    };
    let parts = Expr::Number((1.0 / size).round());
    match (value, counts) {
        (value, false) if value.count().is_some() => {
            let count = value.count().cloned()?;
            Some(Expr::binary(BinOp::Div, count, parts))
        }
        (value, true) if value.constant().is_none() => {
            Some(Expr::of_count(Expr::binary(BinOp::Mul, value.clone(), parts)))
        }
        // By a division: 2800 * 0.001 has digits that no one wrote.
        (Expr::Increments(count), false) => Some(Expr::Number(count / (1.0 / size).round())),
        (Expr::Number(number), true) if *number == 0.0 || (number / size).round() != 0.0 => {
            Some(Expr::Increments((number / size).round()))
        }
        // A length of which no count is left is refused where it is written.
        _ => Some(value.clone()),
    }
}

const VACANT: &str = "a peck or a depth is a variable alone: where it is vacant, the source has no such word, and the target one of 0";
const VACANT_HELP: &str = "make sure that it always has a value";
const ROUNDED: &str = "a peck or a depth that the target counts in least increments has more digits than that: it is rounded to the nearest one";
const ROUNDED_HELP: &str = "make sure that half of a least increment, and a pass more or less, does not matter; or write it in whole increments";
