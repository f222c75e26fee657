//! Dates with the century, on a target that has them without, and the other way.
//!
//! Law: a date as yyyymmdd is the one as yymmdd and 20000000, while the year is one of 2000 to 2099. Counter-example: a program
//! that compares `#3011` with 20260101, on a control whose `#3011` is 260101.

use crate::canon::Sys;
use crate::dialect::Control;
use crate::ir::{BinOp, Expr, Program};
use crate::legalize::features::{Feature, Features};
use crate::legalize::{Context, Position, Rewriter, rewrite_program};

/// What a year has before its last two digits, and what takes the place of each form.
const CENTURY: f64 = 20_000_000.0;
const FORMS: [(Sys, Sys, BinOp); 2] =
    [(Sys::Date, Sys::ShortDate, BinOp::Add), (Sys::ShortDate, Sys::Date, BinOp::Sub)];

/// True if the library uses state, and the controls have dates of two forms.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    features.has(Feature::System) && FORMS.iter().any(|(date, ..)| form(*date, context.target).is_some())
}

/// The form that the target has in place of this one, and what makes the one of the other.
fn form(date: Sys, target: &Control) -> Option<(Sys, BinOp)> {
    let other = FORMS.iter().find(|(form, ..)| *form == date).map(|(_, other, op)| (*other, *op))?;
    (target.system_run(date).is_none() && target.system_run(other.0).is_some()).then_some(other)
}

/// Writes dates in the target's form; true if the program reads any.
pub fn run(program: &mut Program, _: usize, context: &mut Context<'_>) -> bool {
    let target = context.target;
    let wanted = |e: &Expr| matches!(e, Expr::System(Sys::Date | Sys::ShortDate, _));
    rewrite_program(program, wanted, &mut |e, _: Position, _: &mut Rewriter<'_>| match e {
        Expr::System(date, subscripts) => match form(date, target) {
            Some((other, op)) => Expr::binary(op, Expr::System(other, subscripts), Expr::Number(CENTURY)),
            None => Expr::System(date, subscripts),
        },
        e => e,
    })
}
