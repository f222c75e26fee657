//! Evaluates expressions and conditions, exactly as the contract of [`crate::ir`] words it.
//!
//! This is the reference for passes and emulations: what they rewrite must evaluate
//! alike here. It is not a control: a control's own arithmetic is emulated in `control`.

mod env;
mod functions;
mod memory;
mod run;

pub use env::{Alarm, AtanRange, Env, MAX_DEPTH, Value};
pub use memory::Memory;
pub use run::{Ending, Trace, run};

use super::{BinOp, Cond, Expr, Relation};
use crate::canon::{Func, Sys};

/// The value of an expression.
pub fn eval(expr: &Expr, env: &dyn Env) -> Result<Value, Alarm> {
    value(expr, env, MAX_DEPTH)
}

/// The value of an expression as arithmetic takes it: vacant counts as 0.
pub fn number(expr: &Expr, env: &dyn Env) -> Result<f64, Alarm> {
    Ok(eval(expr, env)?.unwrap_or(0.0))
}

/// Whether a condition holds. Every operand is evaluated.
pub fn holds(cond: &Cond, env: &dyn Env) -> Result<bool, Alarm> {
    truth(cond, env, MAX_DEPTH)
}

/// Whether `a relation b`.
pub fn compare(relation: Relation, a: Value, b: Value) -> bool {
    let (x, y) = (a.unwrap_or(0.0), b.unwrap_or(0.0));
    match relation {
        Relation::Equal => a == b,
        Relation::NotEqual => a != b,
        Relation::Less => x < y,
        Relation::LessEqual => x <= y,
        Relation::Greater => x > y,
        Relation::GreaterEqual => x >= y,
    }
}

/// `a op b`.
pub fn binary(op: BinOp, a: f64, b: f64) -> Result<f64, Alarm> {
    finite(match op {
        BinOp::Add => a + b,
        BinOp::Sub => a - b,
        BinOp::Mul => a * b,
        BinOp::Div if b == 0.0 => return Err(Alarm::DivideByZero),
        BinOp::Div => a / b,
        BinOp::Mod if b.round() == 0.0 => return Err(Alarm::DivideByZero),
        BinOp::Mod => a.round() % b.round(),
        BinOp::And => f64::from(bits(a)? & bits(b)?),
        BinOp::Or => f64::from(bits(a)? | bits(b)?),
        BinOp::Xor => f64::from(bits(a)? ^ bits(b)?),
    })
}

/// A function of numbers. Those that ask the environment are not among them.
pub fn function(func: Func, arguments: &[f64], env: &dyn Env) -> Result<f64, Alarm> {
    finite(functions::call(func, arguments, env)?)
}

/// A computed variable or label number, rounded to nearest.
pub fn whole(value: f64) -> Option<u32> {
    let rounded = value.round();
    (0.0..=f64::from(u32::MAX)).contains(&rounded).then_some(rounded as u32)
}

fn value(expr: &Expr, env: &dyn Env, depth: usize) -> Result<Value, Alarm> {
    let Some(depth) = depth.checked_sub(1) else { return Err(Alarm::Depth) };
    let number = |e: &Expr| Ok(value(e, env, depth)?.unwrap_or(0.0));
    let numbers = |all: &[Expr]| all.iter().map(number).collect::<Result<Vec<f64>, Alarm>>();
    Ok(Some(match expr {
        Expr::Number(n) => *n,
        Expr::Increments(n) => finite(n * env.increment()?)?,
        Expr::Vacant => return Ok(None),
        Expr::Var(var) => return Ok(env.var(*var)),
        Expr::Indirect(bank, index) => {
            return env.indirect(*bank, whole(number(index)?).ok_or(Alarm::Variable)?);
        }
        Expr::System(Sys::Empty, _) => return Ok(None),
        Expr::System(Sys::Pi, _) => std::f64::consts::PI,
        Expr::System(Sys::Euler, _) => std::f64::consts::E,
        Expr::System(state, subscripts) => return env.system(*state, &numbers(subscripts)?),
        Expr::Negate(a) => -number(a)?,
        Expr::Binary(op, operands) => binary(*op, number(&operands[0])?, number(&operands[1])?)?,
        Expr::Call(func, arguments) => function(*func, &numbers(arguments)?, env)?,
        Expr::Truth(cond) => f64::from(u8::from(truth(cond, env, depth)?)),
    }))
}

fn truth(cond: &Cond, env: &dyn Env, depth: usize) -> Result<bool, Alarm> {
    let Some(depth) = depth.checked_sub(1) else { return Err(Alarm::Depth) };
    let all = |conds: &[Cond]| conds.iter().map(|c| truth(c, env, depth)).collect::<Result<Vec<_>, _>>();
    Ok(match cond {
        Cond::Compare(relation, a, b) => compare(*relation, value(a, env, depth)?, value(b, env, depth)?),
        Cond::And(conds) => all(conds)?.into_iter().all(|holds| holds),
        Cond::Or(conds) => all(conds)?.into_iter().any(|holds| holds),
        Cond::Not(inner) => !truth(inner, env, depth)?,
        Cond::Switch(number) => env.switch(*number),
    })
}

fn bits(value: f64) -> Result<i32, Alarm> {
    let rounded = value.round();
    let fits = (f64::from(i32::MIN)..=f64::from(i32::MAX)).contains(&rounded);
    if fits { Ok(rounded as i32) } else { Err(Alarm::Bits) }
}

fn finite(value: f64) -> Result<f64, Alarm> {
    if value.is_finite() { Ok(value) } else { Err(Alarm::Overflow) }
}

#[cfg(test)]
mod tests;
