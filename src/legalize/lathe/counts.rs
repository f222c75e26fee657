//! Words of a lathe's cycles that count least increments on one of the two controls.
//!
//! Law: n increments are `n * increment` of the unit in force. Side condition: the unit is known where a number must change its form.
//! Counter-example: a peck of 0.0005 mm, which is no whole count.

use crate::canon::Role;
use crate::dialect::{Control, Units};
use crate::ir::{Block, Expr, Module, Nc, NcItem, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::Features;
use crate::legalize::moves::increments::{Counted, Texts, each};

/// The roles that count increments on some control.
const ROLES: [Role; 5] =
    [Role::GrooveX, Role::GrooveZ, Role::ThreadHeight, Role::ThreadFirst, Role::ThreadLeast];

const TEXTS: Texts = Texts {
    unknown: "a peck or a depth counts least increments on the target, and their size depends on the unit in force, which is \
              not known here",
    guessed: "a peck or a depth is taken in the unit that the program names: a called program outside the library must not \
              change it",
};

/// True where such a word counts on the source.
pub fn counts_there(features: &Features, context: &Context<'_>) -> bool {
    ROLES.iter().any(|role| features.role(*role) && counted(context.source, *role))
}

/// True where one counts on the target.
pub fn counts_here(features: &Features, context: &Context<'_>) -> bool {
    let stands = features.any_op(|op| op.is_lathe_cycle() || op.is_lathe_setup());
    stands && ROLES.iter().any(|role| counted(context.target, *role))
}

/// True where the words of a role count increments.
fn counted(control: &Control, role: Role) -> bool {
    control.dialect().codes.iter().any(|row| {
        let mut letters = row.words.iter().filter(|(_, found)| **found == role);
        row.preferred && letters.any(|(letter, _)| letter.chars().any(|l| row.counts.contains(&l)))
    })
}

/// Makes lengths of all such words.
pub fn to_lengths(module: &mut Module, context: &mut Context<'_>) -> bool {
    all(module, context, |_, _| false)
}

/// Makes counts of those that count on the target.
pub fn to_counts(module: &mut Module, context: &mut Context<'_>) -> bool {
    all(module, context, counted)
}

fn all(module: &mut Module, context: &mut Context<'_>, counts: impl Fn(&Control, Role) -> bool) -> bool {
    let target = context.target;
    let chosen =
        |block: &Block| block.stmts.iter().any(|stmt| matches!(&stmt.kind, StmtKind::Nc(nc) if has(nc)));
    each(module, context, TEXTS, chosen, &mut |kind, units| match kind {
        Counted::Stmt(StmtKind::Nc(nc)) => nc.items.iter_mut().all(|item| match item {
            NcItem::Word(role, value) if ROLES.contains(role) => {
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

fn has(nc: &Nc) -> bool {
    nc.items.iter().any(|item| matches!(item, NcItem::Word(role, _) if ROLES.contains(role)))
}

/// The value in the other form; none where it has none.
fn changed(value: &Expr, units: Option<Units>, counts: bool, target: &Control) -> Option<Expr> {
    let numbers = target.numbers();
    let size = match units {
        Some(Units::Inch) => numbers.increment_inch,
        Some(Units::Metric) => numbers.increment_mm,
        None if value.constant() == Some(0.0) => 1.0,
        None => return None,
    };
    let whole = |number: f64| (number - number.round()).abs() < 1e-6;
    match (value, counts) {
        (Expr::Increments(count), false) => Some(Expr::Number(count * size)),
        (Expr::Number(number), true) if whole(number / size) => {
            Some(Expr::Increments((number / size).round()))
        }
        (Expr::Increments(_), true) | (Expr::Number(_), false) => Some(value.clone()),
        _ => None,
    }
}
