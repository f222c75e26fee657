//! What expressions may be, and what a condition that holds tells of variables.

use super::values::Values;
use crate::canon::Func;
use crate::ir::{BinOp, Cond, Expr, Relation, Var};

/// Expressions that nest deeper may be anything.
const DEPTH: usize = 64;

/// Bits of whole numbers on every control.
const BITS: u32 = 31;

/// What an expression may be, where variables may be what `var` says.
pub fn evaluate(expr: &Expr, var: &dyn Fn(Var) -> Values) -> Values {
    value(expr, &|leaf| if let Expr::Var(name) = leaf { var(*name) } else { Values::ANY }, DEPTH)
}

/// The same, where variables and machine state may be what `leaf` says.
pub fn evaluate_of(expr: &Expr, leaf: &dyn Fn(&Expr) -> Values) -> Values {
    value(expr, leaf, DEPTH)
}

fn value(expr: &Expr, leaf: &dyn Fn(&Expr) -> Values, depth: usize) -> Values {
    let Some(depth) = depth.checked_sub(1) else { return Values::ANY };
    let of = |e: &Expr| value(e, leaf, depth);
    match expr {
        Expr::Number(number) => Values::one(*number),
        Expr::Vacant => Values::one(0.0),
        Expr::Var(_) | Expr::System(..) => leaf(expr),
        Expr::Negate(inner) => of(inner).negated(),
        Expr::Binary(op, operands) => binary(*op, &of(&operands[0]), &of(&operands[1])),
        Expr::Call(function, arguments) => match arguments.as_slice() {
            [argument] => call(*function, &of(argument)),
            _ => Values::ANY,
        },
        Expr::Truth(_) => Values::whole(0.0, 1.0),
        Expr::Increments(_) | Expr::Indirect(..) => Values::ANY,
    }
}

fn binary(op: BinOp, a: &Values, b: &Values) -> Values {
    if a.is_empty() || b.is_empty() {
        return Values::Few(Vec::new());
    }
    match op {
        BinOp::Add => a.corners(b, true, |a, b| a + b),
        BinOp::Sub => a.corners(b, true, |a, b| a - b),
        BinOp::Mul => a.corners(b, true, |a, b| a * b),
        BinOp::Div => match b.bounds() {
            Some((low, high)) if low > 0.0 || high < 0.0 => a.corners(b, false, |a, b| a / b),
            _ => Values::ANY,
        },
        BinOp::Mod => remainder(a, b),
        BinOp::And => match (mask(a), mask(b)) {
            (Some(a), Some(b)) => Values::whole(0.0, a.min(b)),
            (Some(most), None) | (None, Some(most)) => Values::whole(0.0, most),
            (None, None) => Values::ANY,
        },
        BinOp::Or | BinOp::Xor => match (mask(a), mask(b)) {
            (Some(a), Some(b)) => {
                // All bits up to the highest that either has.
                let bits = (0..BITS).find(|bits| 2f64.powi(*bits as i32) > a.max(b)).unwrap_or(BITS);
                Values::whole(0.0, 2f64.powi(bits as i32) - 1.0)
            }
            _ => Values::ANY,
        },
    }
}

/// The greatest of whole numbers none of which is negative.
fn mask(values: &Values) -> Option<f64> {
    let (low, high) = values.bounds()?;
    (low >= 0.0 && high < 2f64.powi(BITS as i32)).then(|| high.ceil())
}

/// The remainder has the dividend's sign, and is nearer to 0 than both operands.
fn remainder(a: &Values, b: &Values) -> Values {
    let (Some((low, high)), Some((c, d))) = (a.bounds(), b.bounds()) else { return Values::ANY };
    let divisor = c.abs().max(d.abs()).ceil();
    let most = divisor.min(low.abs().max(high.abs()).ceil() + 1.0) - 1.0;
    if let (Values::Few(_), Values::Few(_), true) = (a, b, a.is_whole() && b.is_whole() && !b.contains(0.0)) {
        return a.corners(b, true, |a, b| a % b);
    }
    if !most.is_finite() {
        return Values::ANY;
    }
    // A dividend that rounds to 0 leaves 0.
    Values::whole(if low < 0.0 { -most.max(0.0) } else { 0.0 }, if high > 0.0 { most.max(0.0) } else { 0.0 })
}

fn call(function: Func, argument: &Values) -> Values {
    match function {
        Func::Fix => argument.rising(f64::trunc),
        Func::Fup => argument.rising(|value| if value < 0.0 { value.floor() } else { value.ceil() }),
        Func::Round => argument.rising(f64::round),
        Func::Abs => match argument.bounds() {
            Some((low, _)) if low >= 0.0 => argument.clone(),
            Some((_, high)) if high <= 0.0 => argument.negated(),
            Some((low, high)) => argument.join(&argument.negated()).within(0.0, high.max(-low)),
            None => argument.clone(),
        },
        _ => Values::ANY,
    }
}

/// What a condition that holds tells of variables: each with what is left of its values.
pub fn narrow(cond: &Cond, var: &dyn Fn(Var) -> Values, keep: &mut dyn FnMut(Var, Values)) {
    let mut work = vec![(cond, true)];
    while let Some((cond, holds)) = work.pop() {
        match (cond, holds) {
            (Cond::Not(inner), _) => work.push((inner, !holds)),
            (Cond::And(all), true) | (Cond::Or(all), false) => work.extend(all.iter().map(|c| (c, holds))),
            (Cond::Compare(relation, a, b), _) => {
                let relation = if holds { *relation } else { relation.negated() };
                compare(relation, a, b, var, keep);
                compare(relation.swapped(), b, a, var, keep);
            }
            _ => {}
        }
    }
}

fn compare(
    relation: Relation,
    a: &Expr,
    b: &Expr,
    var: &dyn Fn(Var) -> Values,
    keep: &mut dyn FnMut(Var, Values),
) {
    let Expr::Var(name) = a else { return };
    let (mine, other) = (var(*name), evaluate(b, var));
    let Some((low, high)) = other.bounds() else { return };
    let whole = mine.all_whole() && other.all_whole();
    // The next whole number, where there are no others.
    let step = if whole { 1.0 } else { 0.0 };
    keep(
        *name,
        match relation {
            Relation::Equal => mine.within(low, high),
            Relation::Less => mine.within(f64::NEG_INFINITY, high - step),
            Relation::LessEqual => mine.within(f64::NEG_INFINITY, high),
            Relation::Greater => mine.within(low + step, f64::INFINITY),
            Relation::GreaterEqual => mine.within(low, f64::INFINITY),
            // Vacant counts as 0 here, and is not equal to it.
            Relation::NotEqual if low == high && low != 0.0 && whole => mine.without(low),
            Relation::NotEqual => return,
        },
    );
}
