//! Checks expressions and conditions.

use super::{Check, Problem, exists};
use crate::ir::eval::MAX_DEPTH;
use crate::ir::{Cond, Expr};

impl Check<'_> {
    /// The whole value of a word or an argument, where increments may stand.
    pub(super) fn word(&mut self, e: &Expr) {
        let inner = if let Expr::Negate(inner) = e { inner } else { e };
        match inner {
            Expr::Increments(count) if count.is_finite() => {}
            Expr::Increments(_) => self.add(Problem::NotFinite),
            _ => self.value(e.count().unwrap_or(e)),
        }
    }

    /// A value elsewhere.
    pub(super) fn value(&mut self, e: &Expr) {
        self.expr(e, MAX_DEPTH);
    }

    /// A condition of a branch.
    pub(super) fn cond(&mut self, cond: &Cond) {
        self.condition(cond, MAX_DEPTH);
    }

    fn expr(&mut self, e: &Expr, depth: usize) {
        let Some(depth) = depth.checked_sub(1) else { return self.add(Problem::Depth) };
        match e {
            Expr::Number(value) if value.is_finite() => {}
            Expr::Number(_) => self.add(Problem::NotFinite),
            Expr::Increments(_) => self.add(Problem::Increments),
            Expr::Var(var) if !exists(*var) => self.add(Problem::Variable(*var)),
            Expr::Call(func, arguments) if !func.arity().contains(&arguments.len()) => {
                self.add(Problem::Arity { func: *func, count: arguments.len() });
            }
            Expr::Truth(cond) => self.condition(cond, depth),
            e => e.exprs(&mut |operand| self.expr(operand, depth)),
        }
    }

    fn condition(&mut self, cond: &Cond, depth: usize) {
        let Some(depth) = depth.checked_sub(1) else { return self.add(Problem::Depth) };
        match cond {
            Cond::Compare(_, a, b) => {
                self.expr(a, depth);
                self.expr(b, depth);
            }
            Cond::And(all) | Cond::Or(all) => all.iter().for_each(|cond| self.condition(cond, depth)),
            Cond::Not(inner) => self.condition(inner, depth),
            Cond::Switch(number) if !(1..=9).contains(number) => self.add(Problem::Skip(*number)),
            Cond::Switch(_) => {}
        }
    }
}
