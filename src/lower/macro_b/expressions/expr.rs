//! Expressions.

use super::cond::is_condition;
use super::place::{At, MAX_DEPTH};
use crate::canon::{Func, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::{BinOp, Expr};
use crate::lower::common::{constant, relation};
use crate::lower::macro_b::build::Lowering;
use crate::syntax::{self, BinaryOp, ExprKind};
use crate::text::Span;

const NEVER_CHANGES: &str = "these two numbers are compared with each other, which never changes: the comparison comes before AND, OR and XOR on this control";
const BRACKETS: &str =
    "if it was meant the other way round, put brackets round what comes first: [#1 AND 4] EQ 4";

/// True for a comparison of two numbers, without brackets round it.
fn compares_numbers(e: &syntax::Expr) -> bool {
    let ExprKind::Binary(op, operands) = &e.kind else { return false };
    relation(*op).is_some() && operands.iter().all(|operand| matches!(operand.kind, ExprKind::Number(_)))
}

impl<'a> Lowering<'a> {
    /// The value of an expression. What has no meaning is reported, and the value is 0.
    pub fn expr(&mut self, expr: &'a syntax::Expr, at: At) -> Expr {
        self.expr_at(expr, at, 0)
    }

    pub fn expr_at(&mut self, expr: &'a syntax::Expr, at: At, depth: u32) -> Expr {
        if depth > MAX_DEPTH {
            self.findings.not_understood(expr.span, "the expression nests too deep");
            return Expr::Number(0.0);
        }
        let depth = depth + 1;
        match &expr.kind {
            ExprKind::Number(number) if !number.value.is_finite() => {
                self.findings.not_understood(expr.span, "the number is too large");
                Expr::Number(0.0)
            }
            ExprKind::Number(number) => Expr::Number(number.value),
            ExprKind::Variable(variable) => self.read(variable, depth),
            ExprKind::Negate(inner) => match self.expr_at(inner, at, depth) {
                Expr::Number(value) => Expr::Number(-value),
                inner => Expr::Negate(Box::new(inner)),
            },
            // Brackets and a plus sign are no arithmetic: what is vacant stays so.
            ExprKind::Plus(inner) | ExprKind::Group(inner) => self.expr_at(inner, at, depth),
            ExprKind::Not(_) => self.truth(expr, depth),
            ExprKind::Binary(op, operands) => self.binary(*op, operands, expr, at, depth),
            ExprKind::Call { function, arguments, .. } => {
                self.call_function(*function, arguments, expr.span, at, depth)
            }
        }
    }

    fn binary(
        &mut self,
        op: BinaryOp,
        [a, b]: &'a [syntax::Expr; 2],
        whole: &'a syntax::Expr,
        at: At,
        depth: u32,
    ) -> Expr {
        if is_condition(whole) {
            return self.truth(whole, depth);
        }
        self.ranks(op, a, b, false);
        let op = match op {
            BinaryOp::Add => BinOp::Add,
            BinaryOp::Subtract => BinOp::Sub,
            BinaryOp::Multiply => BinOp::Mul,
            BinaryOp::Divide => BinOp::Div,
            BinaryOp::Modulo => BinOp::Mod,
            BinaryOp::And => BinOp::And,
            BinaryOp::Or => BinOp::Or,
            BinaryOp::Xor => BinOp::Xor,
            // The comparisons are conditions.
            _ => return self.truth(whole, depth),
        };
        if op == BinOp::Div && is_open_atan(a) {
            let message =
                "ATAN[..]/ takes its second argument in brackets; put the quotient's dividend in brackets";
            self.findings.not_understood(whole.span, message);
        }
        let (x, y) = (self.expr_at(a, at, depth), self.expr_at(b, at, depth));
        match op {
            BinOp::Mod => self.remainder(&x, &y, whole.span),
            BinOp::And | BinOp::Or | BinOp::Xor => return self.bits(op, x, y, whole.span),
            _ => {}
        }
        Expr::binary(op, x, y)
    }

    /// The rank of an operator matters where an operand is another operation without brackets. `joins`
    /// is true for AND, OR and XOR between conditions.
    pub fn ranks(&mut self, op: BinaryOp, a: &syntax::Expr, b: &syntax::Expr, joins: bool) {
        let bits = matches!(op, BinaryOp::Modulo | BinaryOp::And | BinaryOp::Or | BinaryOp::Xor);
        for operand in [a, b] {
            let inner = match &operand.kind {
                ExprKind::Binary(inner, ..) if *inner != op => meaning(*inner, joins),
                // The sign of a product or a sum changes nothing of it.
                ExprKind::Negate(_) if bits => "negate",
                _ => continue,
            };
            for name in [meaning(op, joins), inner] {
                let bits = || self.control.operator(&format!("{name}.bits"));
                if let Some(row) = self.control.operator(name).or_else(bits) {
                    self.findings.rest_on(row, operand.span);
                }
            }
            if matches!(op, BinaryOp::And | BinaryOp::Or | BinaryOp::Xor) && compares_numbers(operand) {
                self.findings
                    .add(Diagnostic::new(Code::Conditional, operand.span, NEVER_CHANGES).with_help(BRACKETS));
            }
        }
    }

    /// The remainder of the common form rounds its operands; between whole constants nobody can tell.
    fn remainder(&mut self, a: &Expr, b: &Expr, span: Span) {
        let known = |e: &Expr| e.constant().is_some_and(|n| n.fract() == 0.0 && n >= 0.0);
        if known(a) && known(b) {
            return;
        }
        match self.findings.behaviour(Question::ModRoundsOperands, span) {
            Some("true") => {}
            Some(_) => {
                self.findings.not_understood(span, "MOD may get fractions here: that is not converted")
            }
            None => self.unknown_behaviour(Question::ModRoundsOperands, span),
        }
        match self.findings.behaviour(Question::ModSign, span) {
            Some("dividend") => {}
            _ => self.unknown_behaviour(Question::ModSign, span),
        }
    }

    /// Bit operations of the common form round their operands.
    fn bits(&mut self, op: BinOp, a: Expr, b: Expr, span: Span) -> Expr {
        let fractional = [&a, &b].into_iter().any(|e| !e.is_whole());
        let rule =
            if fractional { self.findings.behaviour(Question::BitsOfFraction, span) } else { Some("round") };
        let cut = |e: Expr| match e.constant() {
            Some(value) => Expr::Number(value.trunc()),
            None if e.is_whole() => e,
            None => Expr::Call(Func::Fix, [e].into()),
        };
        if wide(op, &a, &b) && self.findings.behaviour(Question::BitsWidth, span).is_none() {
            self.unknown_behaviour(Question::BitsWidth, span);
        }
        let (a, b) = match rule {
            Some("truncate") => (cut(a), cut(b)),
            Some(_) => (a, b),
            None => {
                self.unknown_behaviour(Question::BitsOfFraction, span);
                (a, b)
            }
        };
        Expr::binary(op, a, b)
    }

    /// A condition as a value: 1 or 0.
    fn truth(&mut self, expr: &'a syntax::Expr, depth: u32) -> Expr {
        match self.findings.behaviour(Question::ComparisonIsValue, expr.span) {
            Some("true") => {}
            Some(_) => self.findings.not_understood(expr.span, "a comparison gives no value on this control"),
            None => self.unknown_behaviour(Question::ComparisonIsValue, expr.span),
        }
        Expr::Truth(Box::new(self.cond_at(expr, depth)))
    }

    fn call_function(
        &mut self,
        function: Func,
        arguments: &'a [syntax::Expr],
        span: Span,
        at: At,
        depth: u32,
    ) -> Expr {
        match self.control.function(function, arguments.len()) {
            Some(row) => self.findings.rest_on(row, span),
            None => {
                let message =
                    format!("the control has no function '{function}' of {} values", arguments.len());
                self.findings.not_understood(span, message);
            }
        }
        for question in ranges(function, arguments.len()) {
            // The ranges are told apart by legalization.
            let told = match question {
                Question::RoundHalfAway | Question::FixTowardZero => {
                    self.findings.only(*question, "true", span)
                }
                _ => self.findings.behaviour(*question, span).map(|_| ()),
            };
            if told.is_none() {
                self.unknown_behaviour(*question, span);
            }
        }
        let values = arguments.iter().map(|argument| self.expr_at(argument, at, depth)).collect();
        let function = if function == Func::Round { self.rounding(at, span) } else { function };
        Expr::Call(function, values)
    }

    /// ROUND rounds to whole numbers, but in a word to the least increment of its address.
    fn rounding(&mut self, at: At, span: Span) -> Func {
        let fraction = |role: Role| !role.is_integer();
        match at {
            At::Word(role) if fraction(role) => match self.findings.behaviour(Question::RoundInAddress, span)
            {
                Some("increment") => Func::RoundIncrement,
                Some(_) => Func::Round,
                None => {
                    self.unknown_behaviour(Question::RoundInAddress, span);
                    Func::RoundIncrement
                }
            },
            At::Argument => {
                self.unknown_behaviour(Question::RoundInAddress, span);
                Func::Round
            }
            _ => Func::Round,
        }
    }
}

/// Questions of range that a function's value rests on.
fn ranges(function: Func, arguments: usize) -> &'static [Question] {
    match (function, arguments) {
        (Func::Atan, 1) => &[Question::AtanRange],
        (Func::Atan, _) => &[Question::Atan2Range],
        (Func::Asin, _) => &[Question::AsinRange],
        (Func::Acos, _) => &[Question::AcosRange],
        (Func::Round, _) => &[Question::RoundHalfAway],
        (Func::Fix, _) => &[Question::FixTowardZero],
        _ => &[],
    }
}

/// True for `ATAN[..]` without brackets round it.
fn is_open_atan(expr: &syntax::Expr) -> bool {
    matches!(&expr.kind, ExprKind::Call { function: Func::Atan, arguments, .. } if arguments.len() == 1)
}

/// True where the result may need more bits than any control has for sure.
fn wide(op: BinOp, a: &Expr, b: &Expr) -> bool {
    let narrow = |e: &Expr| e.constant().is_some_and(|value| (0.0..65_536.0).contains(&value));
    !(op == BinOp::And && (narrow(a) || narrow(b)) || narrow(a) && narrow(b))
}

/// The name of an operator in the tables.
fn meaning(op: BinaryOp, joins: bool) -> &'static str {
    match op {
        BinaryOp::Add => "add",
        BinaryOp::Subtract => "subtract",
        BinaryOp::Multiply => "multiply",
        BinaryOp::Divide => "divide",
        BinaryOp::Modulo => "modulo",
        BinaryOp::And if joins => "and",
        BinaryOp::Or if joins => "or",
        BinaryOp::Xor if joins => "xor",
        BinaryOp::And => "and.bits",
        BinaryOp::Or => "or.bits",
        BinaryOp::Xor => "xor.bits",
        BinaryOp::Equal => "eq",
        BinaryOp::NotEqual => "ne",
        BinaryOp::Greater => "gt",
        BinaryOp::GreaterEqual => "ge",
        BinaryOp::Less => "lt",
        BinaryOp::LessEqual => "le",
    }
}

/// True for a plain constant.
pub fn is_constant(expr: &syntax::Expr) -> bool {
    constant(expr).is_some()
}
