//! SGN, FUP, ROUND and rounding to places.

use super::emulated::{Emulated, apply, number};
use crate::canon::Func;
use crate::dialect::Control;
use crate::ir::{BinOp, Cond, Expr, Relation};
use crate::legalize::{PreStatement, Rewriter};

/// Law: `r = 1`, then `r = -1` where the argument is below zero. Exact; zero counts as positive.
pub fn sign(a: Expr, rewriter: &mut Rewriter<'_>) -> Emulated {
    let a = rewriter.held(a);
    let r = rewriter.materialize(number(1.0));
    rewriter.first(PreStatement::When(Cond::Compare(Relation::Less, a, number(0.0)), r, number(-1.0)));
    Emulated::Exact(Expr::Var(r))
}

/// Law: `f = FIX[a]`; `f+1` where `a > f`, `f-1` where `a < f`, else `f`. Exact: FIX
/// is toward zero, so `a` and `f` have one sign and differ by less than one.
pub fn fup(a: Expr, rewriter: &mut Rewriter<'_>) -> Emulated {
    let a = rewriter.held(a);
    let f = Expr::Var(rewriter.materialize(apply(Func::Fix, a.clone())));
    let r = rewriter.materialize(f.clone());
    for (relation, step) in [(Relation::Greater, 1.0), (Relation::Less, -1.0)] {
        let cond = Cond::Compare(relation, a.clone(), f.clone());
        rewriter.first(PreStatement::When(cond, r, Expr::binary(BinOp::Add, f.clone(), number(step))));
    }
    Emulated::Exact(Expr::Var(r))
}

/// Law: the target's own ROUND; else, with `f = FIX[a]`, `f+1` where `a-f` is a half or more, `f-1` where it is minus a
/// half or less, else `f`. Exact: the fraction `a-f` is a number of its own, where `a+0.5` is rounded
/// (0.49999999999999994 plus a half is 1). The target must have FIX.
pub fn nearest(a: Expr, rewriter: &mut Rewriter<'_>, target: &Control) -> Expr {
    if target.function(Func::Round, 1).is_some() {
        return Expr::Var(rewriter.materialize(apply(Func::Round, a)));
    }
    // Nothing writes a variable between the two reads, and both take one that is vacant for 0. FIX of magnitudes holds it itself.
    let stays = matches!(a, Expr::Var(_)) && !super::whole::of_magnitudes_only(target);
    let a = if stays { a } else { rewriter.held(a) };
    let f = Expr::Var(rewriter.materialize(apply(Func::Fix, a.clone())));
    let rest = Expr::Var(rewriter.materialize(Expr::binary(BinOp::Sub, a, f.clone())));
    let r = rewriter.materialize(f.clone());
    for (relation, half, step) in [(Relation::GreaterEqual, 0.5, 1.0), (Relation::LessEqual, -0.5, -1.0)] {
        let cond = Cond::Compare(relation, rest.clone(), number(half));
        rewriter.first(PreStatement::When(cond, r, Expr::binary(BinOp::Add, f.clone(), number(step))));
    }
    Expr::Var(r)
}

/// Law: `ROUND[a*10^n]/10^n`. The product is rounded once more than the original's, so a
/// value within one unit of the last binary digit of a half may go the other way
/// (1.005 to two places is the classic).
pub fn round_places(a: Expr, places: &Expr, rewriter: &mut Rewriter<'_>, target: &Control) -> Emulated {
    let Some(places) = places.constant().filter(|p| (0.0..=9.0).contains(p) && p.fract() == 0.0) else {
        return Emulated::Missing("the number of places to round to is computed: write a constant".into());
    };
    if target.function(Func::Round, 1).is_none() && target.function(Func::Fix, 1).is_none() {
        return super::missing(Func::Round.name(), target);
    }
    let scale = number(10f64.powi(places as i32));
    let scaled = rewriter.materialize(Expr::binary(BinOp::Mul, a, scale.clone()));
    let rounded = nearest(Expr::Var(scaled), rewriter, target);
    let value = Expr::binary(BinOp::Div, rounded, scale);
    Emulated::Near(
        value,
        format!("rounding to {places} places; a half within the last digit may go the other way"),
    )
}
