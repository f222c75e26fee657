//! Expressions of macro lines.

use crate::canon::Func;
use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::{BinOp, Expr};
use crate::lower::fadal::build::Lowering;
use crate::lower::fadal::flow::DEFAULT_PLACES;
use crate::syntax::{self, BinaryOp, ExprKind};
use crate::text::Span;
use thin_vec::ThinVec;

/// How deep expressions may nest.
const DEEPEST: u32 = 200;

impl<'b> Lowering<'b> {
    /// The value of an expression; none if it is not understood, which is then reported.
    pub fn expr(&mut self, e: &syntax::Expr) -> Option<Expr> {
        self.nested(e, 0)
    }

    fn nested(&mut self, e: &syntax::Expr, depth: u32) -> Option<Expr> {
        if depth > DEEPEST {
            return self.refuse(e.span, "the expression nests too deeply");
        }
        Some(match &e.kind {
            ExprKind::Number(number) if !number.value.is_finite() => {
                return self.refuse(e.span, "the number is too large");
            }
            ExprKind::Number(number) => Expr::Number(number.value),
            ExprKind::Variable(var) => self.read(var)?,
            ExprKind::Plus(inner) | ExprKind::Group(inner) => self.nested(inner, depth + 1)?,
            ExprKind::Negate(inner) => negate(self.nested(inner, depth + 1)?),
            ExprKind::Not(_) => {
                return self.refuse(e.span, "NOT gives no value: it stands in conditions only");
            }
            ExprKind::Binary(op, operands) => {
                let [a, b] = &**operands;
                let Some(op) = arithmetic(*op) else {
                    let _ = self.rely(Question::ComparisonIsValue, e.span);
                    return self.refuse(e.span, "a comparison gives no value here: it stands in IF only");
                };
                if op == BinOp::Div && divides_whole(a, b) {
                    self.suppose(Question::IntegerDivides, "false", e.span);
                }
                let a = self.nested(a, depth + 1)?;
                let b = self.nested(b, depth + 1)?;
                Expr::binary(op, a, b)
            }
            ExprKind::Call { function, arguments, .. } => {
                let mut values = ThinVec::with_capacity(arguments.len());
                for argument in arguments {
                    values.push(self.nested(argument, depth + 1)?);
                }
                self.function(*function, values, e.span)?
            }
        })
    }

    fn function(&mut self, function: Func, mut values: ThinVec<Expr>, span: Span) -> Option<Expr> {
        let Some(row) = self.control.function(function, values.len()) else {
            return self.refuse(
                span,
                format!("the control has no function '{function}' of {} values", values.len()),
            );
        };
        self.findings.rest_on(row, span);
        match function {
            Func::Sin | Func::Cos => {
                let radians = self.radians(span)?;
                let value = values.pop()?;
                let angle = if radians { scale(value, 1f64.to_degrees()) } else { value };
                Some(Expr::Call(function, [angle].into()))
            }
            Func::Atan => {
                let radians = self.radians(span)?;
                self.suppose(Question::AtanRange, "-90..90", span);
                let angle = Expr::Call(function, values);
                Some(if radians { scale(angle, 1f64.to_radians()) } else { angle })
            }
            Func::RoundPlaces => {
                let places = self.places(span)?;
                self.suppose(Question::RoundHalfAway, "true", span);
                values.push(Expr::Number(places));
                Some(Expr::Call(function, values))
            }
            _ => Some(Expr::Call(function, values)),
        }
    }

    /// Whether angles are radians here.
    fn radians(&mut self, span: Span) -> Option<bool> {
        match self.control.behaviour(Question::AnglesUnit).map(|row| row.value.as_str()) {
            Some("modal") => {}
            _ => return Some(false),
        }
        let radians = match self.state.radians.set.list() {
            // Nothing leads here.
            [] => false,
            [radians] => *radians,
            _ => {
                let message = "angles are in degrees on one path to this block and in radians on another";
                self.findings.add(
                    Diagnostic::new(Code::ModalConflict, span, message)
                        .with_help("put SET DEGREES before it"),
                );
                return None;
            }
        };
        if self.state.radians.is_from_outside() {
            let note =
                "degrees by default, but SET RADIANS may have been given before or outside the program";
            self.findings.unconfirmed(Question::AnglesUnit.fact().into(), Some(note), span);
        }
        Some(radians)
    }

    fn places(&mut self, span: Span) -> Option<f64> {
        let places = match self.state.places.set.list() {
            [] => 0,
            [places] => *places,
            _ => {
                let message = "the paths to this block set different places for RND";
                self.findings.add(
                    Diagnostic::new(Code::ModalConflict, span, message).with_help("put SET RND before it"),
                );
                return None;
            }
        };
        if self.state.places.called {
            let message = "the programs called since SET RND are taken to leave the places as they were";
            self.once(Code::ModalAssumed, "places", span, message.into());
        }
        if places != DEFAULT_PLACES {
            return Some(f64::from(places));
        }
        let stated =
            self.findings.behaviour(Question::RoundPlacesDefault, span).and_then(|value| value.parse().ok());
        if stated.is_none() {
            let message = "no SET RND comes before this, and it is not known how many places RND keeps by \
                           default";
            let help = "put SET RND before it, or 'round.places.default' under [behaviours] in the \
                        machine profile";
            self.findings.add(Diagnostic::new(Code::ModalConflict, span, message).with_help(help));
        }
        stated
    }
}

/// The negative of a value.
pub fn negate(value: Expr) -> Expr {
    match value {
        Expr::Number(number) => Expr::Number(0.0 - number),
        Expr::Increments(number) => Expr::Increments(0.0 - number),
        other => Expr::Negate(Box::new(other)),
    }
}

fn scale(value: Expr, factor: f64) -> Expr {
    Expr::binary(BinOp::Mul, value, Expr::Number(factor))
}

fn arithmetic(op: BinaryOp) -> Option<BinOp> {
    match op {
        BinaryOp::Add => Some(BinOp::Add),
        BinaryOp::Subtract => Some(BinOp::Sub),
        BinaryOp::Multiply => Some(BinOp::Mul),
        BinaryOp::Divide => Some(BinOp::Div),
        _ => None,
    }
}

/// True for a quotient of whole-number constants that is no whole number: there
/// it matters whether numbers without a point are divided as whole numbers.
fn divides_whole(a: &syntax::Expr, b: &syntax::Expr) -> bool {
    match (whole(a, 0), whole(b, 0)) {
        (Some(a), Some(b)) => b != 0.0 && (a / b).fract() != 0.0,
        _ => false,
    }
}

fn whole(e: &syntax::Expr, depth: u32) -> Option<f64> {
    if depth > 16 {
        return None;
    }
    match &e.kind {
        ExprKind::Number(number) if !number.point => Some(number.value),
        ExprKind::Plus(inner) | ExprKind::Group(inner) => whole(inner, depth + 1),
        ExprKind::Negate(inner) => whole(inner, depth + 1).map(|value| -value),
        ExprKind::Binary(op, operands) => {
            let [a, b] = &**operands;
            let (a, b) = (whole(a, depth + 1)?, whole(b, depth + 1)?);
            match op {
                BinaryOp::Add => Some(a + b),
                BinaryOp::Subtract => Some(a - b),
                BinaryOp::Multiply => Some(a * b),
                _ => None,
            }
        }
        _ => None,
    }
}
