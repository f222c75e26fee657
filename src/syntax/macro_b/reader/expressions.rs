//! Expressions, by precedence climbing.

use super::super::expressions::{function, operator};
use super::super::shape::DEEPEST;
use super::super::tree::MOST_OPERATORS;
use super::cursor::Reader;
use crate::canon::Func;
use crate::syntax::{BinaryOp, CallForm, Expr, ExprKind, Index, Number, TokenKind, VarRef};
use crate::text::Span;
use thin_vec::{ThinVec, thin_vec};

/// What operators stand between.
#[derive(Clone, Copy)]
enum Between {
    /// The operands of an expression.
    Operands,
    /// The groups of a condition.
    Groups,
}

impl Between {
    fn takes(self, op: BinaryOp) -> bool {
        match self {
            Self::Operands => true,
            Self::Groups => matches!(op, BinaryOp::And | BinaryOp::Or | BinaryOp::Xor),
        }
    }
}

impl<const ITEMS: bool, const TOKENS: bool> Reader<'_, ITEMS, TOKENS> {
    /// `#1+#2*3`
    pub fn expression(&mut self) -> Option<Expr> {
        self.joined(0, Between::Operands)
    }

    /// `[#1 EQ #2]`, and several joined: `[#1 EQ #2] AND [#3 EQ #4]`.
    pub fn condition(&mut self) -> Option<Expr> {
        self.joined(0, Between::Groups)
    }

    /// Operands with operators of at least this rank between them, from left to right.
    fn joined(&mut self, least: u8, between: Between) -> Option<Expr> {
        let mut left = self.operand(between)?;
        while let Some((op, length)) = operator(self.rest()) {
            let rank = (self.rules.rank)(op);
            if rank < least || !between.takes(op) {
                break;
            }
            self.operators += 1;
            if self.operators > MOST_OPERATORS {
                return None;
            }
            self.take(TokenKind::Operator, length);
            let right = self.joined(rank + 1, between)?;
            let span = left.span.to(right.span);
            let kind = if ITEMS {
                ExprKind::Binary(op, Box::new([left, right]))
            } else {
                self.doubt_if(self.may_lack_value(op, &right))?;
                COMPUTED
            };
            left = Expr { kind, span };
        }
        Some(left)
    }

    /// True for an operation that may have no value, or that a control may take for another.
    fn may_lack_value(&self, op: BinaryOp, right: &Expr) -> bool {
        match op {
            BinaryOp::Divide if self.met_atan && self.rules.atan_slash_needs_bracket => true,
            BinaryOp::Divide | BinaryOp::Modulo => constant(right).is_some_and(|number| number.value == 0.0),
            _ => false,
        }
    }

    fn operand(&mut self, between: Between) -> Option<Expr> {
        match between {
            Between::Operands => self.signed_operand(),
            Between::Groups => self.group(),
        }
    }

    fn signed_operand(&mut self) -> Option<Expr> {
        self.signed(|reader| match reader.byte() {
            b'A'..=b'Z' | b'a'..=b'z' => reader.call(),
            _ => reader.value(),
        })
    }

    /// The value of a word: a number, variable or bracket with the sign before it.
    #[inline]
    pub fn signed_value(&mut self) -> Option<Expr> {
        self.signed(Self::value)
    }

    #[inline]
    fn signed(&mut self, operand: impl FnOnce(&mut Self) -> Option<Expr>) -> Option<Expr> {
        let sign = self.byte();
        if !matches!(sign, b'-' | b'+') {
            return operand(self);
        }
        let start = self.take(TokenKind::Operator, 1);
        let operand = operand(self)?;
        let span = start.to(operand.span);
        let kind = match (ITEMS, sign) {
            (true, b'-') => ExprKind::Negate(Box::new(operand)),
            (true, _) => ExprKind::Plus(Box::new(operand)),
            // The sign of a constant counts for nothing but its value.
            (false, _) => constant(&operand)
                .filter(|_| sign == b'-')
                .map_or(operand.kind, |number| ExprKind::Number(Number { value: -number.value, ..number })),
        };
        Some(Expr { kind, span })
    }

    /// A number, variable or bracket.
    #[inline]
    pub fn value(&mut self) -> Option<Expr> {
        match self.byte() {
            b'0'..=b'9' | b'.' => {
                let (number, span) = self.number()?;
                Some(Expr { kind: ExprKind::Number(number), span })
            }
            b'#' => {
                let variable = self.variable()?;
                let span = variable.span;
                let kind = if ITEMS { ExprKind::Variable(Box::new(variable)) } else { COMPUTED };
                Some(Expr { kind, span })
            }
            b'[' => self.group(),
            _ => None,
        }
    }

    /// `[#1+2]`
    fn group(&mut self) -> Option<Expr> {
        let (inner, span) = self.bracketed(|reader| reader.expression())?;
        let kind = if ITEMS { ExprKind::Group(Box::new(inner)) } else { inner.kind };
        Some(Expr { kind, span })
    }

    /// What stands in a pair of brackets, and the span of both.
    fn bracketed<T>(&mut self, inner: impl FnOnce(&mut Self) -> Option<T>) -> Option<(T, Span)> {
        let open = self.take_sign(b'[', TokenKind::Bracket)?;
        self.brackets += 1;
        // Deeper ones are a fault.
        if self.brackets > self.rules.bracket_depth.map_or(DEEPEST, |most| most as usize) {
            return None;
        }
        let inner = inner(self)?;
        self.brackets -= 1;
        Some((inner, open.to(self.take_sign(b']', TokenKind::Bracket)?)))
    }

    /// `SIN[#1]`, `POW[#1,2]`, `ATAN[#1]/[#2]`
    fn call(&mut self) -> Option<Expr> {
        let text = self.rest();
        let length = text.iter().take_while(|byte| byte.is_ascii_alphabetic()).count();
        let function = function(&text[..length])?;
        let word = self.take(TokenKind::Keyword, length);
        self.met_atan |= function == Func::Atan;
        let ((mut arguments, mut form), brackets) =
            self.bracketed(|reader| reader.arguments(has_domain(function)))?;
        let mut span = word.to(brackets);
        if matches!(function, Func::Atan | Func::Parameter) && self.second_part_follows() {
            self.take(TokenKind::Operator, 1);
            let (second, brackets) = self.bracketed(|reader| reader.expression())?;
            if ITEMS {
                arguments.push(second);
            }
            form = CallForm::Slash;
            span = span.to(brackets);
        }
        Some(Expr { kind: ExprKind::Call { function, arguments, form }, span })
    }

    /// The arguments of a function, the first of which may lie outside of a `domain`.
    fn arguments(&mut self, domain: bool) -> Option<(ThinVec<Expr>, CallForm)> {
        let first = self.expression()?;
        if !ITEMS {
            self.doubt_if(domain && constant(&first).is_some())?;
            if self.take_sign(b',', TokenKind::Operator).is_some() {
                self.expression()?;
            }
            return Some((ThinVec::new(), CallForm::Plain));
        }
        if self.take_sign(b',', TokenKind::Operator).is_none() {
            return Some((thin_vec![first], CallForm::Plain));
        }
        Some((thin_vec![first, self.expression()?], CallForm::Comma))
    }

    /// A slash divides unless a bracket comes after it.
    fn second_part_follows(&self) -> bool {
        let text = self.rest();
        text.strip_prefix(b"/").is_some_and(|after| after.trim_ascii_start().first() == Some(&b'['))
    }

    /// `#1`, `#[#1+2]`, `#30057.21`
    pub fn variable(&mut self) -> Option<VarRef> {
        let hash = self.take_sign(b'#', TokenKind::Variable)?;
        let index = if self.byte() == b'[' {
            let (inner, _) = self.bracketed(|reader| reader.expression())?;
            if ITEMS { Index::Computed(Box::new(inner)) } else { Index::None }
        } else {
            match self.index()? {
                (number, None) => Index::Number(number),
                (number, Some(bit)) => Index::Bit(number, bit),
            }
        };
        Some(VarRef { name: "#".into(), index, span: self.since(hash.start) })
    }
}

/// What stands for everything that is computed, where no items are gathered: it takes no memory.
const COMPUTED: ExprKind =
    ExprKind::Call { function: Func::Abs, arguments: ThinVec::new(), form: CallForm::Plain };

/// A constant, where no items are gathered: with its sign, and without its brackets.
pub fn constant(e: &Expr) -> Option<Number> {
    if let ExprKind::Number(number) = e.kind { Some(number) } else { None }
}

/// True for a function that takes no number outside of some.
fn has_domain(function: Func) -> bool {
    matches!(function, Func::Asin | Func::Acos | Func::Sqrt | Func::Ln)
}
