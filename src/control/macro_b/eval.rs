//! Evaluates expressions.

use super::code::Ex;
use super::numeric::Value;
use super::run::Runner;
use crate::canon::Func;
use crate::control::outcome::Stop;
use crate::control::session::Halt;

impl Runner<'_> {
    /// The value of an expression outside a word.
    pub fn eval(&mut self, ex: &Ex) -> Result<Value, Halt> {
        self.eval_in(ex, None)
    }

    /// The value of an expression; in a word ROUND rounds to so many units' least increment.
    pub fn eval_in(&mut self, ex: &Ex, increment: Option<f64>) -> Result<Value, Halt> {
        Ok(match ex {
            Ex::Number(value) => {
                self.off = self.reading_off(*value);
                Some(*value)
            }
            Ex::Read(var) => {
                self.off = 0.0;
                self.read(var)?
            }
            Ex::Group(inner) => {
                let value = self.eval_in(inner, increment)?;
                if value.is_none() && !self.rules.bracket_copies_vacancy.ask(&mut self.session.trace) {
                    Some(0.0)
                } else {
                    value
                }
            }
            Ex::Plus(inner) => self.eval_in(inner, increment)?,
            Ex::Negate(inner) => {
                let value = self.eval_in(inner, increment)?;
                Some(-self.numeric.number(value, &mut self.session.trace))
            }
            Ex::Binary(op, a, b) => {
                let a = self.eval_in(a, increment)?;
                let off_a = self.off;
                let b = self.eval_in(b, increment)?;
                let result = self.numeric.binary(*op, a, b, &mut self.session.trace)?;
                if let Some(short) = self.numeric.short {
                    let (a, b) = ((a.unwrap_or(0.0), off_a), (b.unwrap_or(0.0), self.off));
                    self.off = short.binary(*op, a, b, result, &mut self.session.trace);
                }
                Some(result)
            }
            Ex::Call(Func::Round, inner) if increment.is_some() => {
                let value = self.eval_in(inner, increment)?;
                let value = self.numeric.number(value, &mut self.session.trace);
                let count = increment.map_or(1.0, |increment| (1.0 / increment).round());
                if let Some(short) = self.numeric.short {
                    short.place(self.off, 1.0 / count, &mut self.session.trace);
                    self.off = 0.0;
                }
                Some(self.numeric.round(value * count, &mut self.session.trace) / count)
            }
            Ex::Call(Func::AddPoint, inner) => {
                let value = self.eval(inner)?;
                Some(self.numeric.number(value, &mut self.session.trace) * self.length_increment())
            }
            Ex::Call(Func::Parameter, inner) => {
                let number = self.eval(inner)?;
                Some(self.parameter(number, None))
            }
            Ex::Call2(Func::Parameter, a, b) => {
                let (number, bit) = (self.eval(a)?, self.eval(b)?);
                Some(self.parameter(number, bit))
            }
            Ex::Call(function, inner) => {
                let value = self.eval_in(inner, increment)?;
                let result = self.numeric.call(*function, value, &mut self.session.trace)?;
                if let Some(short) = self.numeric.short {
                    let value = (value.unwrap_or(0.0), self.off);
                    self.off = short.call(*function, value, result, &mut self.session.trace);
                }
                Some(result)
            }
            Ex::Call2(function, a, b) => {
                let a = self.eval_in(a, increment)?;
                let off_a = self.off;
                let b = self.eval_in(b, increment)?;
                let result = self.numeric.call2(*function, a, b, &mut self.session.trace)?;
                if let Some(short) = self.numeric.short {
                    let (a, b) = ((a.unwrap_or(0.0), off_a), (b.unwrap_or(0.0), self.off));
                    self.off = short.call2(*function, a, b, result, &mut self.session.trace);
                }
                Some(result)
            }
        })
    }

    /// By how much a value is off that the text or the machine gives.
    pub fn reading_off(&self, value: f64) -> f64 {
        self.numeric.short.map_or(0.0, |short| short.read(value))
    }

    /// Notes a value that is about to be rounded to a whole number.
    pub fn rounds_to_whole(&mut self, value: f64) {
        if let Some(short) = self.numeric.short {
            short.whole(value, self.off, &mut self.session.trace);
        }
    }

    fn parameter(&mut self, number: Value, bit: Value) -> f64 {
        let whole = |value: Value| value.unwrap_or(0.0).round() as u32;
        let subscripts = [whole(number), whole(bit)];
        self.session.machine.peek(crate::canon::Sys::Parameter, &subscripts).unwrap_or(0.0)
    }

    /// A subscript.
    pub fn index(&mut self, ex: &Ex) -> Result<u32, Halt> {
        let value = self.eval(ex)?.unwrap_or(0.0);
        if let Some(short) = self.numeric.short.filter(|_| self.off > 0.0) {
            // Rounded or cut, either may name another variable.
            short.call(Func::Fix, (value, self.off), value, &mut self.session.trace);
            short.whole(value, self.off, &mut self.session.trace);
        }
        let whole = if value.fract() == 0.0 {
            value
        } else if self.rules.index_rounds.ask(&mut self.session.trace) {
            value.round()
        } else {
            value.trunc()
        };
        if (0.0..=f64::from(u32::MAX)).contains(&whole) {
            // In range by the test.
            Ok(whole as u32)
        } else {
            let text = format!("#{whole} is no variable");
            Err(Halt::Alarm(Stop::alarm(self.style.alarms.no_variable, text)))
        }
    }

    /// The least increment of a length in the units in force.
    pub fn length_increment(&self) -> f64 {
        if self.session.machine.is_inch() { self.rules.increment_inch } else { self.rules.increment_mm }
    }
}
