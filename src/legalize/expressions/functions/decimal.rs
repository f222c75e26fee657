//! BIN and BCD, for whole numbers of up to eight digits.

use super::emulated::{Emulated, apply, number};
use crate::assume::Domain;
use crate::canon::Func;
use crate::ir::{BinOp, Expr};
use crate::legalize::Rewriter;

/// Digits of a 32-bit word.
const DIGITS: i32 = 8;

/// Law: with digits d, `x = sum d*10^i`, and `FIX[x/10^i]` is the number of the digits from i on, so
/// `sum d*16^i = x + sum over i>0 of FIX[x/10^i] * 6*16^(i-1)`. Exact for whole x from 0 to 99999999.
pub fn bcd(a: Expr, rewriter: &mut Rewriter<'_>) -> Emulated {
    let sum = digits(a, rewriter, BinOp::Add, 10.0, |i| 6.0 * 16f64.powi(i - 1));
    Emulated::Inside(sum, "exact only for whole numbers from 0 to 99999999".into(), Domain::Digits(8))
}

/// Law: the same the other way, `x - sum over i>0 of FIX[x/16^i] * 6*10^(i-1)`. Exact for valid
/// BCD words from 0 on; a word that is none alarms on the source and not here.
pub fn bin(a: Expr, rewriter: &mut Rewriter<'_>) -> Emulated {
    let sum = digits(a, rewriter, BinOp::Sub, 16.0, |i| 6.0 * 10f64.powi(i - 1));
    let why = "exact for valid BCD words of up to eight digits; the target does not notice an invalid one";
    Emulated::Inside(sum, why.into(), Domain::Bcd(8))
}

fn digits(a: Expr, rewriter: &mut Rewriter<'_>, op: BinOp, base: f64, weight: impl Fn(i32) -> f64) -> Expr {
    let a = rewriter.held(a);
    (1..DIGITS).fold(a.clone(), |sum, i| {
        let higher = apply(Func::Fix, Expr::binary(BinOp::Div, a.clone(), number(base.powi(i))));
        // One term a statement keeps lines short.
        Expr::Var(rewriter.materialize(Expr::binary(
            op,
            sum,
            Expr::binary(BinOp::Mul, higher, number(weight(i))),
        )))
    })
}
