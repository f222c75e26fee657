//! Expressions.

use super::Interpreter;
use crate::canon::Func;
use crate::control::outcome::Stop;
use crate::control::session::{Flow, Halt};
use crate::dialect::Question;
use crate::syntax::{BinaryOp, Expr, ExprKind};

/// How near two numbers lie that a control with other digits might take for equal.
const NEAR: f64 = 1e-9;

/// How deep an expression may be nested; a macro line has 63 characters.
const DEEPEST: u32 = 200;

impl Interpreter<'_, '_> {
    /// The value of an expression.
    pub(super) fn value(&mut self, expr: &Expr) -> Flow<f64> {
        self.nested(expr, 0)
    }

    fn nested(&mut self, expr: &Expr, depth: u32) -> Flow<f64> {
        if depth > DEEPEST {
            return Err(Halt::Error("the expression is nested too deep".into()));
        }
        let depth = depth + 1;
        let value = match &expr.kind {
            ExprKind::Number(number) => return Ok(number.value),
            ExprKind::Variable(variable) => return self.variable(variable),
            ExprKind::Group(inner) | ExprKind::Plus(inner) => return self.nested(inner, depth),
            ExprKind::Negate(inner) => return Ok(-self.nested(inner, depth)?),
            ExprKind::Not(inner) => f64::from(u8::from(!self.truth(inner, depth)?)),
            ExprKind::Binary(op, operands) => {
                let [a, b] = &**operands;
                match op {
                    BinaryOp::And | BinaryOp::Or => {
                        // Both sides are worked out; neither has an effect.
                        let (a, b) = (self.truth(a, depth)?, self.truth(b, depth)?);
                        f64::from(u8::from(if *op == BinaryOp::And { a && b } else { a || b }))
                    }
                    _ => self.binary(*op, a, b, depth)?,
                }
            }
            ExprKind::Call { function, arguments, .. } => {
                let Some(argument) = arguments.first() else {
                    return Err(Stop::unnamed("a function without its argument").into());
                };
                let argument = self.nested(argument, depth)?;
                self.function(*function, argument)?
            }
        };
        if !value.is_finite() {
            self.session.trace.doubt("machine:overflow");
            return Err(Stop::unnamed("the result is too large").into());
        }
        Ok(self.session.kept(value))
    }

    /// The truth of a condition.
    pub(super) fn condition(&mut self, expr: &Expr) -> Flow<bool> {
        self.truth(expr, 0)
    }

    fn truth(&mut self, expr: &Expr, depth: u32) -> Flow<bool> {
        if !is_condition(expr, depth) {
            self.session.act_as(Question::NumberIsCondition, "true");
        }
        Ok(self.nested(expr, depth)? != 0.0)
    }

    fn binary(&mut self, op: BinaryOp, left: &Expr, right: &Expr, depth: u32) -> Flow<f64> {
        let a = self.nested(left, depth)?;
        let b = self.nested(right, depth)?;
        if matches!(op, BinaryOp::Equal | BinaryOp::NotEqual)
            && a != b
            && (a - b).abs() <= NEAR * a.abs().max(1.0)
        {
            self.session.act_as(Question::EqualTolerance, "0");
        }
        Ok(match op {
            BinaryOp::Add => a + b,
            BinaryOp::Subtract => a - b,
            BinaryOp::Multiply => a * b,
            BinaryOp::Divide if b == 0.0 => {
                self.session.act_as(Question::DivideByZero, "alarm");
                return Err(Stop::unnamed("a division by zero").into());
            }
            BinaryOp::Divide => {
                if whole(left) && whole(right) && (a / b).fract() != 0.0 {
                    self.session.act_as(Question::IntegerDivides, "false");
                }
                a / b
            }
            BinaryOp::Equal => self.compared((a, b), a == b),
            BinaryOp::NotEqual => self.compared((a, b), a != b),
            BinaryOp::Less => self.compared((a, b), a < b),
            BinaryOp::LessEqual => self.compared((a, b), a <= b),
            BinaryOp::Greater => self.compared((a, b), a > b),
            BinaryOp::GreaterEqual => self.compared((a, b), a >= b),
            BinaryOp::Modulo | BinaryOp::And | BinaryOp::Or | BinaryOp::Xor => {
                return Err(Halt::Error("the control has no such operator".into()));
            }
        })
    }

    fn compared(&mut self, (a, b): (f64, f64), holds: bool) -> f64 {
        self.session.trace.compared(a, b, holds);
        f64::from(u8::from(holds))
    }

    fn function(&mut self, function: Func, x: f64) -> Flow<f64> {
        let angle = if self.registers.radians { x } else { x.to_radians() };
        Ok(match function {
            Func::Sin => angle.sin(),
            Func::Cos => angle.cos(),
            Func::Atan => {
                let angle = x.atan();
                if self.registers.radians { angle } else { angle.to_degrees() }
            }
            Func::Sqrt if x < 0.0 => return Err(Stop::unnamed("SQR of a negative number").into()),
            Func::Sqrt => x.sqrt(),
            Func::Abs => x.abs(),
            Func::Sign => {
                if x < 0.0 {
                    -1.0
                } else {
                    1.0
                }
            }
            Func::Fix => x.trunc(),
            Func::RoundPlaces | Func::Round => self.rounded(x),
            _ => return Err(Halt::Error("the control has no such function".into())),
        })
    }

    /// RND: to the places of the last SET.
    fn rounded(&mut self, x: f64) -> f64 {
        let places = self.registers.places.unwrap_or_else(|| {
            self.session.rest_on(Question::RoundPlacesDefault);
            let row = self.session.control.behaviour(Question::RoundPlacesDefault);
            row.and_then(|row| row.value.parse().ok()).unwrap_or(0)
        });
        let scale = 10f64.powi(i32::from(places));
        let scaled = x * scale;
        if (scaled.abs().fract() - 0.5).abs() < NEAR {
            self.session.act_as(Question::RoundHalfAway, "true");
        }
        let rounded = scaled.round() / scale;
        if rounded.is_finite() { rounded } else { x }
    }
}

/// True for a comparison, and for conditions joined.
fn is_condition(expr: &Expr, depth: u32) -> bool {
    use BinaryOp::*;
    match &expr.kind {
        ExprKind::Group(inner) if depth <= DEEPEST => is_condition(inner, depth + 1),
        ExprKind::Not(_) => true,
        ExprKind::Binary(op, ..) => {
            matches!(op, Equal | NotEqual | Less | LessEqual | Greater | GreaterEqual | And | Or)
        }
        _ => false,
    }
}

/// True for a number without a point.
fn whole(expr: &Expr) -> bool {
    matches!(&expr.kind, ExprKind::Number(number) if !number.point)
}
