//! Conditions of IF.

use crate::dialect::Question;
use crate::ir::{Cond, Expr, Relation};
use crate::lower::common::relation;
use crate::lower::fadal::build::Lowering;
use crate::syntax::{self, BinaryOp, ExprKind};

/// How deep conditions may nest.
const DEEPEST: u32 = 100;

impl<'b> Lowering<'b> {
    /// A condition; none if it is not understood, which is then reported.
    pub fn condition(&mut self, e: &syntax::Expr) -> Option<Cond> {
        self.nested_condition(e, 0)
    }

    fn nested_condition(&mut self, e: &syntax::Expr, depth: u32) -> Option<Cond> {
        if depth > DEEPEST {
            return self.refuse(e.span, "the condition nests too deeply");
        }
        match &e.kind {
            ExprKind::Group(inner) => self.nested_condition(inner, depth + 1),
            ExprKind::Not(inner) => {
                if !matches!(inner.kind, ExprKind::Group(_)) {
                    self.rank("not", e.span);
                }
                Some(Cond::Not(Box::new(self.nested_condition(inner, depth + 1)?)))
            }
            ExprKind::Binary(op @ (BinaryOp::And | BinaryOp::Or), operands) => {
                let [a, b] = &**operands;
                let bare = [a, b].into_iter().any(|side| {
                    !matches!(&side.kind, ExprKind::Group(_))
                        && !matches!(&side.kind, ExprKind::Binary(inner, ..) if inner == op)
                });
                if bare {
                    self.rank(if *op == BinaryOp::And { "and" } else { "or" }, e.span);
                }
                let a = self.nested_condition(a, depth + 1)?;
                let b = self.nested_condition(b, depth + 1)?;
                Some(join(*op, a, b))
            }
            ExprKind::Binary(op, operands) => {
                let [a, b] = &**operands;
                let Some(relation) = relation(*op) else { return self.number(e) };
                if matches!(relation, Relation::Equal | Relation::NotEqual) {
                    self.suppose(Question::EqualTolerance, "0", e.span);
                }
                let a = self.expr(a)?;
                let b = self.expr(b)?;
                Some(Cond::Compare(relation, a, b))
            }
            _ => self.number(e),
        }
    }

    /// A number in place of a condition.
    fn number(&mut self, e: &syntax::Expr) -> Option<Cond> {
        if self.rely(Question::NumberIsCondition, e.span) == Some("false") {
            return self.refuse(e.span, "a number is not a condition: write a comparison");
        }
        let value = self.expr(e)?;
        Some(Cond::Compare(Relation::NotEqual, value, Expr::Number(0.0)))
    }

    /// What stands here without brackets rests on the rank of a logical operator.
    fn rank(&mut self, meaning: &str, span: crate::text::Span) {
        if let Some(row) = self.control.operator(meaning) {
            self.findings.rest_on(row, span);
        }
    }
}

fn join(op: BinaryOp, a: Cond, b: Cond) -> Cond {
    match (op, a) {
        (BinaryOp::And, Cond::And(mut all)) => {
            all.push(b);
            Cond::And(all)
        }
        (BinaryOp::Or, Cond::Or(mut any)) => {
            any.push(b);
            Cond::Or(any)
        }
        (BinaryOp::And, a) => Cond::And(vec![a, b]),
        (_, a) => Cond::Or(vec![a, b]),
    }
}
