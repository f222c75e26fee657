//! SIN and COS of angles that the target takes near zero only.
//!
//! Law: with q the whole turns in an angle, `a - q*360` has the same sine and cosine and lies within one turn of zero; an
//! angle there stays as it is, to the last digit. Off by the last digit of the angle where it lies outside, which changes
//! the sine by as little. Counter-example: `SIN[400]` where the control stops at more than 360.

use super::emulated::{apply, number};
use crate::canon::Func;
use crate::dialect::{Control, Question};
use crate::ir::{BinOp, Expr, Program};
use crate::legalize::{Rewriter, rewrite_program};

const TURN: f64 = 360.0;

/// Takes whole turns off the angles of a program.
pub fn run(program: &mut Program, target: &Control) -> bool {
    let limit = target.behaviour(Question::AngleLimit).and_then(|row| row.value.parse::<f64>().ok());
    // One that takes less than a turn, or all, needs none of this.
    if limit != Some(TURN) {
        return false;
    }
    let wide = |e: &Expr| match e {
        Expr::Call(Func::Sin | Func::Cos, arguments) => arguments.first().is_some_and(may_be_far),
        _ => false,
    };
    rewrite_program(program, wide, &mut |e, _, rewriter| match e {
        Expr::Call(function, mut arguments) => match arguments.pop() {
            Some(angle) => apply(function, within(angle, rewriter)),
            None => Expr::Call(function, arguments),
        },
        other => other,
    })
}

/// True unless the angle is known to be near.
fn may_be_far(angle: &Expr) -> bool {
    match (angle.constant(), angle) {
        (Some(angle), _) => angle.abs() > TURN,
        (None, angle) => !matches!(angle, Expr::Call(Func::Atan, _)),
    }
}

fn within(angle: Expr, rewriter: &mut Rewriter<'_>) -> Expr {
    if let Some(angle) = angle.constant() {
        return number(angle % TURN);
    }
    let angle = rewriter.held(angle);
    let turns = rewriter.materialize(Expr::binary(BinOp::Div, angle.clone(), number(TURN)));
    let whole = apply(Func::Fix, Expr::Var(turns));
    let over = rewriter.materialize(Expr::binary(BinOp::Mul, whole, number(TURN)));
    Expr::Var(rewriter.materialize(Expr::binary(BinOp::Sub, angle, Expr::Var(over))))
}
