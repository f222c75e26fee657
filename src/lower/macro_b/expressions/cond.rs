//! Conditions.

use super::place::{At, MAX_DEPTH};
use crate::canon::Sys;
use crate::dialect::Question;
use crate::ir::{BinOp, Cond, Expr, Relation};
use crate::lower::common::relation;
use crate::lower::macro_b::build::Lowering;
use crate::syntax::{self, BinaryOp, ExprKind};
use crate::text::Span;

/// True for a comparison, and for AND, OR and XOR between such: elsewhere those are bit operations.
pub fn is_condition(expr: &syntax::Expr) -> bool {
    let mut at = expr;
    loop {
        match &at.kind {
            ExprKind::Group(inner) => at = inner,
            ExprKind::Not(_) => return true,
            ExprKind::Binary(op, _) if relation(*op).is_some() => return true,
            // A chain of joined conditions leans to the left; its right ends decide too.
            ExprKind::Binary(BinaryOp::And | BinaryOp::Or | BinaryOp::Xor, operands) => {
                let [a, b] = &**operands;
                if !compares(b) {
                    return false;
                }
                at = a;
            }
            _ => return false,
        }
    }
}

/// As [`is_condition`], for the right side of a join, whose own joins are in brackets.
fn compares(expr: &syntax::Expr) -> bool {
    let mut rest = vec![expr];
    while let Some(at) = rest.pop() {
        match &at.kind {
            ExprKind::Group(inner) => rest.push(inner),
            ExprKind::Not(_) => {}
            ExprKind::Binary(op, _) if relation(*op).is_some() => {}
            ExprKind::Binary(BinaryOp::And | BinaryOp::Or | BinaryOp::Xor, operands) => {
                rest.extend(&**operands)
            }
            _ => return false,
        }
    }
    true
}

impl<'a> Lowering<'a> {
    /// A condition.
    pub fn cond(&mut self, expr: &'a syntax::Expr) -> Cond {
        self.cond_at(expr, 0)
    }

    pub fn cond_at(&mut self, expr: &'a syntax::Expr, depth: u32) -> Cond {
        if depth > MAX_DEPTH {
            self.findings.not_understood(expr.span, "the condition nests too deep");
            return Cond::Switch(1);
        }
        let depth = depth + 1;
        match &expr.kind {
            ExprKind::Group(inner) => self.cond_at(inner, depth),
            ExprKind::Not(inner) => Cond::Not(Box::new(self.cond_at(inner, depth))),
            ExprKind::Binary(op, operands) => self.binary_cond(*op, operands, expr, depth),
            _ => self.bare(expr, depth),
        }
    }

    /// A comparison, or conditions that are joined.
    fn binary_cond(
        &mut self,
        op: BinaryOp,
        [a, b]: &'a [syntax::Expr; 2],
        whole: &'a syntax::Expr,
        depth: u32,
    ) -> Cond {
        match (relation(op), op) {
            (Some(relation), _) => {
                self.ranks(op, a, b, false);
                let (a, b) = (self.expr_at(a, At::Value, depth), self.expr_at(b, At::Value, depth));
                Cond::Compare(relation, a, b)
            }
            (None, BinaryOp::And | BinaryOp::Or | BinaryOp::Xor) if is_condition(whole) => {
                match self.findings.behaviour(Question::ConditionAndOr, whole.span) {
                    Some("true") => {}
                    Some(_) => self
                        .findings
                        .not_understood(whole.span, "this control does not join conditions by AND or OR"),
                    None => self.unknown_behaviour(Question::ConditionAndOr, whole.span),
                }
                self.ranks(op, a, b, true);
                let (a, b) = (self.cond_at(a, depth), self.cond_at(b, depth));
                join(op, a, b)
            }
            _ => self.bare(whole, depth),
        }
    }

    /// A number as a condition: it holds when it is not 0.
    ///
    /// A vacant variable differs from 0 under `NotEqual`, yet nothing says that it is
    /// "not zero" here, so the value goes through arithmetic first, which makes 0 of vacant.
    fn bare(&mut self, expr: &'a syntax::Expr, depth: u32) -> Cond {
        let span = expr.span;
        match self.findings.behaviour(Question::NumberIsCondition, span) {
            Some("true") => {}
            Some(_) => self.findings.not_understood(
                span,
                "a number alone is not a condition on this \
                                                           control: write a comparison",
            ),
            None => self.unknown_behaviour(Question::NumberIsCondition, span),
        }
        let value = self.mixed(expr, depth);
        let value = self.vacant_as_zero(value, span);
        Cond::Compare(Relation::NotEqual, value, Expr::Number(0.0))
    }

    /// `[#1024] OR [#1022 EQ 0]`: bits of a number and of a truth value; inputs are 0 or 1 already.
    fn mixed(&mut self, expr: &'a syntax::Expr, depth: u32) -> Expr {
        self.expr_at(expr, At::Value, depth)
    }

    fn vacant_as_zero(&mut self, value: Expr, span: Span) -> Expr {
        let vacant = value.may_be_vacant() && !matches!(value, Expr::System(Sys::Input, _));
        if !vacant {
            return value;
        }
        let fact = Question::NumberIsCondition.fact().into();
        let note = "a vacant variable as a condition is taken as false";
        self.findings.unconfirmed(fact, Some(note), span);
        Expr::binary(BinOp::Add, value, Expr::Number(0.0))
    }
}

fn join(op: BinaryOp, a: Cond, b: Cond) -> Cond {
    let flat = |and: bool, a: Cond, b: Cond| {
        let mut all = match a {
            Cond::And(all) if and => all,
            Cond::Or(any) if !and => any,
            other => vec![other],
        };
        all.push(b);
        if and { Cond::And(all) } else { Cond::Or(all) }
    };
    match op {
        BinaryOp::And => flat(true, a, b),
        BinaryOp::Or => flat(false, a, b),
        // Written out, the operands of a chain would be doubled again and again.
        _ if !is_plain(&a) || !is_plain(&b) => {
            let truth = |cond| Expr::Truth(Box::new(cond));
            Cond::Compare(Relation::NotEqual, truth(a), truth(b))
        }
        _ => {
            let (not_a, not_b) = (a.clone().negated(), b.clone().negated());
            Cond::Or(vec![Cond::And(vec![a, not_b]), Cond::And(vec![not_a, b])])
        }
    }
}

/// True for a comparison of values that hold no comparison.
fn is_plain(cond: &Cond) -> bool {
    let Cond::Compare(_, a, b) = cond else { return false };
    let mut plain = true;
    for side in [a, b] {
        side.walk(&mut |e| plain &= !matches!(e, Expr::Truth(_)));
    }
    plain
}
