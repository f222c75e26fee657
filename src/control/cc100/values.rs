//! What stands after an equals sign, and the active values of addresses.

use super::Interpreter;
use super::store::Cell;
use crate::canon::{Func, Sys};
use crate::control::outcome::Stop;
use crate::control::session::{Flow, Halt};
use crate::dialect::Question;
use crate::syntax::{BinaryOp, Expr, ExprKind, Index, VarRef};

impl Interpreter<'_, '_> {
    /// The value of a constant, a variable, a step of arithmetic or a function.
    pub(super) fn value(&mut self, expr: &Expr) -> Flow<f64> {
        let value = match &expr.kind {
            ExprKind::Binary(op, operands) => {
                let [a, b] = &**operands;
                let (a, b) = (self.operand(a)?, self.operand(b)?);
                self.step_of(*op, a, b)?
            }
            ExprKind::Call { function, arguments, .. } => {
                let argument = match arguments.first() {
                    Some(argument) => self.operand(argument)?,
                    None => return Err(Halt::Error("a function without its argument".into())),
                };
                self.function(*function, argument)?
            }
            _ => return self.operand(expr),
        };
        if !value.is_finite() {
            self.session.trace.doubt("machine:overflow");
            return Err(Stop::unnamed("the result is too large").into());
        }
        Ok(self.session.kept(value))
    }

    /// A constant or a variable, with its sign.
    pub(super) fn operand(&mut self, expr: &Expr) -> Flow<f64> {
        let (inner, sign) = match &expr.kind {
            ExprKind::Negate(inner) => (&**inner, -1.0),
            ExprKind::Plus(inner) => (&**inner, 1.0),
            _ => (expr, 1.0),
        };
        match &inner.kind {
            ExprKind::Number(number) => Ok(sign * number.value),
            ExprKind::Variable(variable) => Ok(sign * self.read(variable)?),
            _ => Err(Halt::Error("only one operation may follow the equals sign".into())),
        }
    }

    /// The value of a variable, or of an address: `V1=X`.
    fn read(&mut self, variable: &VarRef) -> Flow<f64> {
        if variable.index == Index::None {
            return self.active(&variable.name);
        }
        let cell = self.cell(variable)?;
        Ok(self.store.get(cell).unwrap_or_else(|| {
            // Nothing has set it since the control was switched on.
            self.session.act_as(Question::InitialValue, "zero");
            0.0
        }))
    }

    /// The place of a variable.
    pub(super) fn cell(&self, variable: &VarRef) -> Flow<Cell> {
        Cell::of(variable).ok_or_else(|| Stop::unnamed("there is no such variable").into())
    }

    fn active(&mut self, letter: &str) -> Flow<f64> {
        let session = &mut self.session;
        let control = session.control;
        let Some((state, subscripts, row)) = control.read_system(&format!("={letter}"), None) else {
            return Err(Halt::Error(format!("the active {letter} cannot be read")));
        };
        session.trace.rest_on(row);
        let state = match state {
            Sys::Address => {
                let last = letter.chars().next().and_then(|letter| self.last.get(&letter)).copied();
                return Ok(last.unwrap_or_else(|| {
                    session.trace.doubt("machine:address.not.programmed");
                    0.0
                }));
            }
            Sys::AxisPosition => {
                session.rest_on(Question::PositionFrame);
                match session.control.behaviour(Question::PositionFrame).map(|row| row.value.as_str()) {
                    Some("machine") => Sys::MachinePosition,
                    _ => Sys::WorkPosition,
                }
            }
            other => other,
        };
        let value = session.machine.read(state, &subscripts, &mut session.trace);
        value.ok_or_else(|| Halt::Error(format!("the active {letter} cannot be read")))
    }

    fn step_of(&mut self, op: BinaryOp, a: f64, b: f64) -> Flow<f64> {
        Ok(match op {
            BinaryOp::Add => a + b,
            BinaryOp::Subtract => a - b,
            BinaryOp::Multiply => a * b,
            BinaryOp::Divide if b == 0.0 => {
                self.session.act_as(Question::DivideByZero, "alarm");
                return Err(Stop::unnamed("a division by zero").into());
            }
            BinaryOp::Divide => a / b,
            _ => return Err(Halt::Error("the control has no such operator".into())),
        })
    }

    /// How far from zero the argument of a sine may lie; any number where that is no answer.
    fn angle_limit(&mut self) -> Option<f64> {
        self.session.rest_on(Question::AngleLimit);
        self.session.control.behaviour(Question::AngleLimit)?.value.parse().ok()
    }

    fn function(&mut self, function: Func, x: f64) -> Flow<f64> {
        Ok(match function {
            Func::Sin | Func::Cos if self.angle_limit().is_some_and(|limit| x.abs() > limit) => {
                return Err(Stop::unnamed("the angle of SIN or COS is beyond 360 degrees").into());
            }
            Func::Sin => x.to_radians().sin(),
            Func::Cos => x.to_radians().cos(),
            Func::Atan => {
                self.session.act_as(Question::AtanRange, "-90..90");
                x.atan().to_degrees()
            }
            Func::Sqrt if x < 0.0 => {
                self.session.act_as(Question::SqrtOfNegative, "alarm");
                return Err(Stop::unnamed("SQR of a negative number").into());
            }
            Func::Sqrt => x.sqrt(),
            _ => return Err(Halt::Error("the control has no such function".into())),
        })
    }
}
