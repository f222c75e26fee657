//! Halves that are doubled, in what an earlier conversion wrote.
//!
//! Law: `(D5/2.)*2.` is D5. A control whose table holds radii doubles what a program reads there, and one whose table
//! holds diameters halves it: going round, an expression would get both each time. A number halved and doubled is that
//! number, as it is doubled and halved, but below 2^-1021, where the last binary digit is lost.
//!
//! Side conditions: an earlier conversion wrote the library; the number is never vacant, which its half is not either:
//! half of a vacant value is 0. Counter-example: `#1/2*2` with `#1` vacant.

use crate::ir::{BinOp, Expr, Module};
use crate::legalize::Context;
use crate::legalize::features::Features;

/// True in a library that an earlier conversion wrote.
pub fn concerns(_: &Features, context: &Context<'_>) -> bool {
    context.earlier.is_written()
}

/// Makes the numbers of them; true if there were any.
pub fn run(module: &mut Module, _: &mut Context<'_>) -> bool {
    let mut changed = false;
    let mut settle = |e: &mut Expr| {
        e.walk_mut(&mut |part| {
            while let Some(number) = whole(part).cloned() {
                *part = number;
                changed = true;
            }
        });
    };
    for block in module.programs.iter_mut().flat_map(|program| &mut program.blocks) {
        block.stmts.iter_mut().for_each(|stmt| stmt.kind.exprs_mut(&mut settle));
        block.term.kind.exprs_mut(&mut settle);
    }
    changed
}

/// The number of which this is the half, doubled.
fn whole(e: &Expr) -> Option<&Expr> {
    let two = |e: &Expr| e.constant() == Some(2.0);
    let Expr::Binary(BinOp::Mul, outer) = e else { return None };
    let Expr::Binary(BinOp::Div, inner) = &outer[0] else { return None };
    (two(&outer[1]) && two(&inner[1]) && !inner[0].may_be_vacant()).then_some(&inner[0])
}
