//! AND, OR and XOR of the bits of whole numbers.
//!
//! Law: a bit of `a` that counts 2^n is `FIX[a/2^n] - FIX[a/2^(n+1)]*2`. AND with a constant is the sum of the bits that it has;
//! `a OR m` is `a + m` without it, and `a XOR m` without it twice. Exact: divisions by powers of two lose nothing. A negative
//! number has the low bits of itself and 2^31, as in two's complement. Side condition: whole numbers from -2^31 to 2^31 - 1.
//! Of two computed operands a loop takes one bit a round, from the lowest, until one of them has no more: 31 rounds at the
//! most; two negative ones have -2^31 in common too. OR and XOR follow as above. Counter-example: `5000000000 AND #1`.

use super::emulated::{Emulated, apply, number};
use super::rounding::nearest;
use crate::canon::Func;
use crate::dialect::{Control, Question};
use crate::ir::{BinOp, Cond, Expr, Relation};
use crate::legalize::{PreStatement, Rewriter};

/// Bits of a number that these operations are known for.
const WIDTH: u32 = 31;
/// Most bits that a constant may have.
const MOST: u32 = 8;

/// The operation as the target can write it.
pub fn bits(op: BinOp, a: Expr, b: Expr, rewriter: &mut Rewriter<'_>, target: &Control) -> Emulated {
    let rounds = target.behaviour(Question::BitsOfFraction).is_some_and(|row| row.value == "round");
    let mut whole = |e: Expr| match e.constant() {
        _ if rounds || e.is_whole() => e,
        Some(value) => number(value.round()),
        // ROUND inside a word is another function, in its subscripts too.
        None if target.function(Func::Round, 1).is_some() && !rewriter.in_word => apply(Func::Round, e),
        None => nearest(e, rewriter, target),
    };
    let (a, b) = (whole(a), whole(b));
    if target.operator(name(op)).is_some() {
        return Emulated::Exact(Expr::binary(op, a, b));
    }
    let title = &target.dialect().title;
    match (a.constant(), b.constant()) {
        (Some(mask), _) => by_arithmetic(op, b, mask, rewriter, title),
        (_, Some(mask)) => by_arithmetic(op, a, mask, rewriter, title),
        (None, None) => by_loop(op, a, b, rewriter),
    }
}

/// What the operator means in the tables of controls.
fn name(op: BinOp) -> &'static str {
    match op {
        BinOp::And => "and.bits",
        BinOp::Or => "or.bits",
        _ => "xor.bits",
    }
}

fn by_arithmetic(op: BinOp, a: Expr, mask: f64, rewriter: &mut Rewriter<'_>, title: &str) -> Emulated {
    let Some(mask) = crate::ir::eval::whole(mask).filter(|mask| mask >> WIDTH == 0) else {
        return Emulated::Missing(format!(
            "{title} has no operation on bits, and arithmetic gives it for whole constants from 0 to 2147483647 alone"
        ));
    };
    if mask.count_ones() > MOST {
        return Emulated::Missing(format!(
            "{title} has no operation on bits, and this constant has more than {MOST} of them: split it"
        ));
    }
    let a = rewriter.held(a);
    let raised = rewriter.materialize(a.clone());
    let higher = Expr::binary(BinOp::Add, a.clone(), number(2f64.powi(WIDTH as i32)));
    rewriter.first(PreStatement::When(Cond::Compare(Relation::Less, a.clone(), number(0.0)), raised, higher));
    let common = with(&Expr::Var(raised), mask, rewriter);
    let all = Expr::binary(BinOp::Add, a, number(f64::from(mask)));
    let value = match op {
        BinOp::And => common,
        BinOp::Or => Expr::binary(BinOp::Sub, all, common),
        _ => Expr::binary(BinOp::Sub, all, Expr::binary(BinOp::Mul, common, number(2.0))),
    };
    Emulated::Near(value, "by arithmetic, for numbers from -2147483648 to 2147483647".into())
}

/// Of two computed numbers, bit by bit.
fn by_loop(op: BinOp, a: Expr, b: Expr, rewriter: &mut Rewriter<'_>) -> Emulated {
    let (a, b) = (rewriter.held(a), rewriter.held(b));
    let negative = |e: &Expr| Cond::Compare(Relation::Less, e.clone(), number(0.0));
    let sign = number(2f64.powi(WIDTH as i32));
    let rest = [&a, &b].map(|e| {
        let raised = rewriter.materialize(e.clone());
        let higher = Expr::binary(BinOp::Add, e.clone(), sign.clone());
        rewriter.first(PreStatement::When(negative(e), raised, higher));
        raised
    });
    let common = rewriter.materialize(number(0.0));
    let both = Cond::And(vec![negative(&a), negative(&b)]);
    rewriter.first(PreStatement::When(both, common, Expr::Negate(Box::new(sign))));
    let worth = rewriter.materialize(number(1.0));
    let mut steps = Vec::new();
    let more = rest.map(|rest| Cond::Compare(Relation::Greater, Expr::Var(rest), number(0.0)));
    let halves = rest.map(|rest| {
        let half = rewriter.temp();
        let value = apply(Func::Fix, Expr::binary(BinOp::Div, Expr::Var(rest), number(2.0)));
        steps.push(PreStatement::Assign(half, value));
        half
    });
    let [one, other] = [0, 1].map(|at| {
        let twice = Expr::binary(BinOp::Mul, Expr::Var(halves[at]), number(2.0));
        Expr::binary(BinOp::Sub, Expr::Var(rest[at]), twice)
    });
    let bit = Expr::binary(BinOp::Mul, Expr::binary(BinOp::Mul, one, other), Expr::Var(worth));
    steps.push(PreStatement::Assign(common, Expr::binary(BinOp::Add, Expr::Var(common), bit)));
    let twice = Expr::binary(BinOp::Mul, Expr::Var(worth), number(2.0));
    steps.push(PreStatement::Assign(worth, twice));
    for (rest, half) in rest.iter().zip(halves) {
        steps.push(PreStatement::Assign(*rest, Expr::Var(half)));
    }
    rewriter.first(PreStatement::While(Cond::And(more.into()), steps));
    let all = Expr::binary(BinOp::Add, a, b);
    let common = Expr::Var(common);
    let value = match op {
        BinOp::And => common,
        BinOp::Or => Expr::binary(BinOp::Sub, all, common),
        _ => Expr::binary(BinOp::Sub, all, Expr::binary(BinOp::Mul, common, number(2.0))),
    };
    let why = "by a loop over the bits, for numbers from -2147483648 to 2147483647; it takes up to 31 rounds, in which \
               nothing moves";
    Emulated::Near(value, why.into())
}

/// The bits that a value has in common with a constant.
fn with(a: &Expr, mask: u32, rewriter: &mut Rewriter<'_>) -> Expr {
    let mut sum = None;
    for at in (0..WIDTH).filter(|at| mask >> at & 1 == 1) {
        let shifted = |by: u32| match by {
            0 => a.clone(),
            by => apply(Func::Fix, Expr::binary(BinOp::Div, a.clone(), number(2f64.powi(by as i32)))),
        };
        let twice = Expr::binary(BinOp::Mul, shifted(at + 1), number(2.0));
        let bit = Expr::binary(BinOp::Sub, shifted(at), twice);
        let worth = match at {
            0 => bit,
            at => Expr::binary(BinOp::Mul, bit, number(2f64.powi(at as i32))),
        };
        sum = Some(match sum {
            None => worth,
            Some(sum) => Expr::Var(rewriter.materialize(Expr::binary(BinOp::Add, sum, worth))),
        });
    }
    sum.unwrap_or(number(0.0))
}
