//! Feeds that are worked out as a speed times a lead.
//!
//! Law: s * l a minute at s turns is l a turn. Side condition: one value is both the speed and a factor of the feed, and nothing changes it between.
//! Counter-example: `F[#19*#6]` after another value of `#19` than the one that S was given.

use crate::ir::{BinOp, Expr, Place, Stmt, StmtKind};

/// A product without one of its factors; none if the value is no factor of it.
pub(super) fn without(product: &Expr, factor: &Expr) -> Option<Expr> {
    if product == factor {
        return Some(Expr::Number(1.0));
    }
    let Expr::Binary(op, parts) = product else { return None };
    let [a, b] = &**parts;
    match op {
        BinOp::Mul => match without(a, factor) {
            Some(rest) => Some(times(rest, b.clone())),
            None => without(b, factor).map(|rest| times(a.clone(), rest)),
        },
        BinOp::Div => without(a, factor).map(|rest| Expr::Binary(BinOp::Div, Box::new([rest, b.clone()]))),
        _ => None,
    }
}

/// A product; a factor of 1 goes.
fn times(a: Expr, b: Expr) -> Expr {
    match (a.constant(), b.constant()) {
        (Some(1.0), _) => b,
        (_, Some(1.0)) => a,
        _ => Expr::Binary(BinOp::Mul, Box::new([a, b])),
    }
}

/// True of a value that stays the same until one of its variables changes.
pub(super) fn is_kept(value: &Expr) -> bool {
    match value {
        Expr::Number(_) | Expr::Var(_) => true,
        Expr::Negate(inner) => is_kept(inner),
        Expr::Binary(_, parts) => parts.iter().all(is_kept),
        Expr::Call(_, parts) => parts.iter().all(is_kept),
        _ => false,
    }
}

/// True of a value that is known to be a whole number above 0.
pub(super) fn is_whole(value: &Expr) -> bool {
    value.constant().is_some_and(|number| number.fract() == 0.0 && number > 0.0)
}

/// True of a statement that may change what a value is.
pub(super) fn assigns(stmt: &Stmt, value: &Expr) -> bool {
    let StmtKind::Assign { target, .. } = &stmt.kind else { return false };
    let mut changes = false;
    value.walk(&mut |part| {
        if let Expr::Var(var) = part {
            changes |= match target {
                Place::Var(other) => other == var,
                Place::Indirect(..) => true,
                Place::System(..) => false,
            };
        }
    });
    changes
}
