//! EXP, LN and POW by series that need no loop.

use super::emulated::{Emulated, apply, number};
use crate::assume::Domain;
use crate::canon::Func;
use crate::dialect::Control;
use crate::ir::{BinOp, Expr};
use crate::legalize::Rewriter;

/// How often the argument is halved, and the result squared.
const HALVINGS: i32 = 10;

/// Law: `EXP[a] = EXP[a/1024]^1024`, the inner one by its series to the seventh power. For `a` from
/// -20 to 20 the relative difference is below 1e-12 in binary64.
pub fn exp(a: Expr, rewriter: &mut Rewriter<'_>) -> Emulated {
    let small = rewriter.materialize(Expr::binary(BinOp::Div, a, number(2f64.powi(HALVINGS))));
    // Horner: 1 + s(1 + s/2(1 + s/3(..))).
    let series = (1..=7).rev().fold(number(1.0), |inner, k| {
        let term =
            Expr::binary(BinOp::Div, Expr::binary(BinOp::Mul, Expr::Var(small), inner), number(f64::from(k)));
        Expr::Var(rewriter.materialize(Expr::binary(BinOp::Add, number(1.0), term)))
    });
    let value = (0..HALVINGS)
        .fold(series, |v, _| Expr::Var(rewriter.materialize(Expr::binary(BinOp::Mul, v.clone(), v))));
    let why = "computed by its series, with a relative error of at most 1e-12 for arguments from -20 to 20";
    Emulated::Inside(value, why.into(), Domain::Range(-20.0, 20.0))
}

/// Law: `LN[a] = 1024*LN[z]` with z the root of a taken ten times, and `LN[z] = 2*(w + w^3/3 + w^5/5 + w^7/7)`
/// with `w = (z-1)/(z+1)`. For `a` from 1e-9 to 1e9 the difference is below 1e-11 in binary64.
pub fn ln(a: Expr, rewriter: &mut Rewriter<'_>) -> Emulated {
    let root = (0..HALVINGS).fold(a, |v, _| Expr::Var(rewriter.materialize(apply(Func::Sqrt, v))));
    let (below, above) =
        (Expr::binary(BinOp::Sub, root.clone(), number(1.0)), Expr::binary(BinOp::Add, root, number(1.0)));
    let w = Expr::Var(rewriter.materialize(Expr::binary(BinOp::Div, below, above)));
    let square = Expr::Var(rewriter.materialize(Expr::binary(BinOp::Mul, w.clone(), w.clone())));
    let series = [5.0, 3.0, 1.0].into_iter().fold(number(1.0 / 7.0), |inner, k| {
        let step = Expr::binary(BinOp::Add, number(1.0 / k), Expr::binary(BinOp::Mul, square.clone(), inner));
        Expr::Var(rewriter.materialize(step))
    });
    let scale = number(2f64.powi(HALVINGS + 1));
    let value = rewriter.materialize(Expr::binary(BinOp::Mul, scale, Expr::binary(BinOp::Mul, w, series)));
    let why = "computed by its series, with an error of at most 1e-11 for arguments from 1e-9 to 1e9; 0 \
               raises no alarm";
    Emulated::Inside(Expr::Var(value), why.into(), Domain::Range(1e-9, 1e9))
}

/// Law: a product for a small whole constant power; else `EXP[b*LN[a]]`, for a above zero.
pub fn pow(a: Expr, power: Expr, rewriter: &mut Rewriter<'_>, target: &Control) -> Emulated {
    if let Some(n) = power.constant().filter(|n| n.fract() == 0.0 && (1.0..=8.0).contains(n)) {
        let a = rewriter.held(a);
        let product = (1..n as u32).fold(a.clone(), |p, _| Expr::binary(BinOp::Mul, p, a.clone()));
        return Emulated::Near(product, "computed as a product; the last digit may differ".into());
    }
    let native = target.function(Func::Ln, 1).is_some() && target.function(Func::Exp, 1).is_some();
    let log = if native { apply(Func::Ln, a) } else { value(ln(a, rewriter)) };
    let product = Expr::binary(BinOp::Mul, power, log);
    let result = if native { apply(Func::Exp, product) } else { value(exp(product, rewriter)) };
    // What the series hold for: the base, and the power times its logarithm.
    let domain = match native {
        true => Domain::Range(1e-300, 1e300),
        false => Domain::Power([1e-9, 1e9], [-20.0, 20.0]),
    };
    Emulated::Inside(result, "computed as EXP[b*LN[a]]: only for bases above 0".into(), domain)
}

fn value(emulated: Emulated) -> Expr {
    match emulated {
        Emulated::Exact(e) | Emulated::Near(e, _) | Emulated::Inside(e, ..) => e,
        Emulated::Missing(_) => number(0.0),
    }
}
