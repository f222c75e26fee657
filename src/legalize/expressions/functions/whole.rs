//! The whole part of a number, on a control that has it for numbers that are not negative.
//!
//! Law: `FIX[a]` is `FIX[|a|]` with the sign of a, because FIX is toward zero. Exact.
//! Counter-example: `FIX[-1.5]` by INC and DEC, of which no source says what they make of a negative number.

use super::emulated::{apply, number};
use crate::canon::Func;
use crate::dialect::Control;
use crate::ir::{BinOp, Cond, Expr, Program, Relation};
use crate::legalize::{PreStatement, Rewriter, rewrite_program};

/// True if the control has the whole part of magnitudes only.
pub fn of_magnitudes_only(target: &Control) -> bool {
    target.function(Func::Fix, 1).is_some_and(|row| row.domain.as_deref() == Some(">=0"))
}

/// Takes the whole parts of a program from magnitudes.
pub fn run(program: &mut Program, target: &Control) -> bool {
    let fix = |e: &Expr| matches!(e, Expr::Call(Func::Fix, _));
    of_magnitudes_only(target)
        && rewrite_program(program, fix, &mut |e, _, rewriter| match e {
            Expr::Call(function, mut arguments) => match arguments.pop() {
                Some(value) => whole(value, rewriter),
                None => Expr::Call(function, arguments),
            },
            other => other,
        })
}

fn whole(value: Expr, rewriter: &mut Rewriter<'_>) -> Expr {
    if let Some(value) = value.constant() {
        return number(value.trunc());
    }
    let value = rewriter.held(value);
    let size = magnitude(value.clone(), rewriter);
    let whole = rewriter.materialize(apply(Func::Fix, size));
    let below = Cond::Compare(Relation::Less, value, number(0.0));
    rewriter.first(PreStatement::When(
        below,
        whole,
        Expr::binary(BinOp::Mul, Expr::Var(whole), number(-1.0)),
    ));
    Expr::Var(whole)
}

/// Law: `a`, and `a*-1` where it is below zero. Exact.
pub fn magnitude(value: Expr, rewriter: &mut Rewriter<'_>) -> Expr {
    let size = rewriter.materialize(value);
    let below = Cond::Compare(Relation::Less, Expr::Var(size), number(0.0));
    rewriter.first(PreStatement::When(below, size, Expr::binary(BinOp::Mul, Expr::Var(size), number(-1.0))));
    Expr::Var(size)
}
