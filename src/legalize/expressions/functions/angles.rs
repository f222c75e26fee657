//! SIN and COS of angles that the target takes near zero only.
//!
//! Law: with q the whole turns in an angle, `a - q*360` has the same sine and cosine and lies within one turn of zero; an
//! angle there stays as it is, to the last digit. Off by the last digit of the angle where it lies outside, which changes
//! the sine by as little. An angle that is such a difference already, as an earlier conversion wrote it, is left as it is.
//! Counter-example: `SIN[400]` where the control stops at more than 360.

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
        (None, angle) => !matches!(angle, Expr::Call(Func::Atan, _)) && !is_within(angle),
    }
}

/// True for `a - FIX[a/360]*360`, of one variable.
fn is_within(angle: &Expr) -> bool {
    let Expr::Binary(BinOp::Sub, operands) = angle else { return false };
    matches!(&operands[0], a @ Expr::Var(_) if operands[1] == whole_turns(a))
}

/// The whole turns in an angle, in degrees.
fn whole_turns(angle: &Expr) -> Expr {
    let turns = Expr::binary(BinOp::Div, angle.clone(), number(TURN));
    Expr::binary(BinOp::Mul, apply(Func::Fix, turns), number(TURN))
}

fn within(angle: Expr, rewriter: &mut Rewriter<'_>) -> Expr {
    if let Some(angle) = angle.constant() {
        return number(angle % TURN);
    }
    // Nothing writes a variable between the two reads.
    let angle = if matches!(angle, Expr::Var(_)) { angle } else { rewriter.held(angle) };
    let over = whole_turns(&angle);
    Expr::binary(BinOp::Sub, angle, over)
}
