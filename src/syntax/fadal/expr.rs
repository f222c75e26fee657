//! Expressions: pest gives operands and operators in a row, this ranks them.

use super::builder::Build;
use super::grammar::Rule;
use crate::canon::Func;
use crate::diag::Code;
use crate::syntax::support::number;
use crate::syntax::{BinaryOp, CallForm, Expr, ExprKind, Index, VarRef};
use crate::text::Span;
use pest::iterators::{Pair, Pairs};
use std::borrow::Cow;
use std::iter::Peekable;
use thin_vec::ThinVec;

type Operands<'p> = Peekable<Pairs<'p, Rule>>;

/// Rank of what stands after NOT: a comparison and all that binds closer.
const BEHIND_NOT: u8 = 3;

/// An operator and how close it binds. The manual ranks functions, the minus,
/// `* /`, `+ -`, then AND OR NOT; that comparisons stand before these and AND
/// before OR is the usual reading, which no source confirms.
fn infix(rule: Rule) -> Option<(BinaryOp, u8)> {
    Some(match rule {
        Rule::or => (BinaryOp::Or, 1),
        Rule::and => (BinaryOp::And, 2),
        Rule::equal => (BinaryOp::Equal, 3),
        Rule::not_equal => (BinaryOp::NotEqual, 3),
        Rule::less => (BinaryOp::Less, 3),
        Rule::less_equal => (BinaryOp::LessEqual, 3),
        Rule::greater => (BinaryOp::Greater, 3),
        Rule::greater_equal => (BinaryOp::GreaterEqual, 3),
        Rule::add => (BinaryOp::Add, 4),
        Rule::subtract => (BinaryOp::Subtract, 4),
        Rule::multiply => (BinaryOp::Multiply, 5),
        Rule::divide => (BinaryOp::Divide, 5),
        _ => return None,
    })
}

impl Build<'_> {
    pub(super) fn expr(&mut self, pair: Pair<'_, Rule>) -> Expr {
        let span = self.span(&pair);
        self.ranked(&mut pair.into_inner().peekable(), 0, span)
    }

    /// Operands and operators from here on, as long as they bind at least so close.
    fn ranked(&mut self, row: &mut Operands<'_>, least: u8, whole: Span) -> Expr {
        let mut left = self.operand(row, whole);
        while let Some((op, rank)) = row.peek().and_then(|pair| infix(pair.as_rule())) {
            if rank < least {
                break;
            }
            row.next();
            let right = self.ranked(row, rank + 1, whole);
            let span = left.span.to(right.span);
            left = Expr { kind: ExprKind::Binary(op, Box::new([left, right])), span };
        }
        left
    }

    fn operand(&mut self, row: &mut Operands<'_>, whole: Span) -> Expr {
        let Some(pair) = row.next() else { return self.hole(whole) };
        let span = self.span(&pair);
        let (kind, inner): (fn(Box<Expr>) -> ExprKind, Expr) = match pair.as_rule() {
            Rule::number => return self.number(&pair),
            Rule::variable => {
                let variable = self.variable(pair);
                return Expr { span: variable.span, kind: ExprKind::Variable(Box::new(variable)) };
            }
            Rule::call => return self.call(pair),
            Rule::group => {
                let inner = pair.into_inner().nth(1).map(|inner| self.expr(inner));
                let inner = Box::new(inner.unwrap_or_else(|| self.hole(span)));
                return Expr { kind: ExprKind::Group(inner), span };
            }
            Rule::minus => (ExprKind::Negate, self.operand(row, whole)),
            Rule::plus => (ExprKind::Plus, self.operand(row, whole)),
            Rule::not => (ExprKind::Not, self.ranked(row, BEHIND_NOT, whole)),
            _ => return self.hole(span),
        };
        let span = span.to(inner.span);
        Expr { kind: kind(Box::new(inner)), span }
    }

    fn call(&mut self, pair: Pair<'_, Rule>) -> Expr {
        let span = self.span(&pair);
        let mut parts = pair.into_inner();
        let function = match parts.next().map(|name| name.as_str().to_ascii_uppercase()).as_deref() {
            Some("ABS") => Func::Abs,
            Some("ATN") => Func::Atan,
            Some("COS") => Func::Cos,
            Some("INT") => Func::Fix,
            Some("RND") => Func::RoundPlaces,
            Some("SGN") => Func::Sign,
            Some("SIN") => Func::Sin,
            Some("SQR") => Func::Sqrt,
            _ => return self.hole(span),
        };
        let Some(argument) = parts.nth(1) else { return self.hole(span) };
        let arguments = ThinVec::from([self.expr(argument)]);
        Expr { kind: ExprKind::Call { function, arguments, form: CallForm::Plain }, span }
    }

    pub(super) fn number(&mut self, pair: &Pair<'_, Rule>) -> Expr {
        Expr { kind: ExprKind::Number(number(pair.as_str())), span: self.span(pair) }
    }

    pub(super) fn variable(&mut self, pair: Pair<'_, Rule>) -> VarRef {
        let span = self.span(&pair);
        let mut parts = pair.into_inner();
        let name = parts.next().map(|name| upper(name.as_str())).unwrap_or_default();
        let index = match parts.find(|part| matches!(part.as_rule(), Rule::digits | Rule::expr)) {
            None => Index::None,
            Some(digits) if digits.as_rule() == Rule::digits => Index::Number(self.whole(&digits)),
            Some(inner) => match whole_number(&inner) {
                Some(number) => Index::Number(number),
                None => Index::Computed(Box::new(self.expr(inner))),
            },
        };
        VarRef { name, index, span }
    }

    /// Stands for what the grammar promised and did not hold: nothing reaches it.
    pub(super) fn hole(&mut self, span: Span) -> Expr {
        self.fault(Code::Unreadable, span, "the expression cannot be read");
        Expr { kind: ExprKind::Number(number("0")), span }
    }
}

/// The number of a subscript that is nothing but digits: `V(5)`.
fn whole_number(expr: &Pair<'_, Rule>) -> Option<u32> {
    let text = expr.as_str().trim();
    text.bytes().all(|byte| byte.is_ascii_digit()).then(|| text.parse().ok())?
}

/// The name of a variable; the usual ones take no memory.
pub(super) fn upper(name: &str) -> Cow<'static, str> {
    match name {
        "R" | "r" => Cow::Borrowed("R"),
        "V" | "v" => Cow::Borrowed("V"),
        _ => Cow::Owned(name.to_ascii_uppercase()),
    }
}
