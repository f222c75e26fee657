//! Arithmetic of the control: vacancy, digits, domains.

use super::Alarms;
use super::digits::Digits;
use crate::canon::Func;
use crate::control::fewer::FewerDigits;
use crate::control::outcome::Stop;
use crate::control::scenario::Scenario;
use crate::control::trace::Trace;
use crate::dialect::{Control, Question};
use crate::syntax::BinaryOp;

/// A value; none is vacant.
pub type Value = Option<f64>;

/// An answer of the table, and its fact where it is not confirmed.
#[derive(Clone, Debug)]
pub struct Answer<T> {
    value: T,
    unsure: Option<&'static str>,
}

impl<T: Copy> Answer<T> {
    /// Reads a question of behaviour; unknown and missing answers give `otherwise`, unsure.
    pub fn new(
        control: &Control,
        question: Question,
        read: impl Fn(&str) -> Option<T>,
        otherwise: T,
    ) -> Self {
        let row = control.behaviour(question);
        let known = row.and_then(|row| Some((read(&row.value)?, row.origin.is_settled())));
        let sure = known.is_some_and(|(_, confirmed)| confirmed);
        let value = known.map_or(otherwise, |(value, _)| value);
        Self { value, unsure: (!sure).then(|| question.fact()) }
    }

    /// The answer, where it matters.
    pub fn ask(&self, trace: &mut Trace) -> T {
        if let Some(fact) = self.unsure {
            trace.doubt(fact);
        }
        self.value
    }

    /// The answer, where nothing rests on it.
    pub fn peek(&self) -> T {
        self.value
    }
}

/// The answer to a yes-or-no question.
pub fn yes(control: &Control, question: Question, otherwise: bool) -> Answer<bool> {
    let read = |value: &str| match value {
        "true" => Some(true),
        "false" => Some(false),
        _ => None,
    };
    Answer::new(control, question, read, otherwise)
}

fn is(word: &'static str, no: &'static str) -> impl Fn(&str) -> Option<bool> {
    move |value| (value == word || value == no).then_some(value == word)
}

/// The answers of a control's table that arithmetic rests on, read once.
#[derive(Debug)]
pub struct Answers {
    /// How far values may be off, where few digits are kept.
    short: Option<Digits>,
    /// Digits that the control keeps, where it keeps few.
    own_digits: Option<u32>,
    largest: f64,
    smallest: f64,
    alarms: &'static Alarms,
    vacant_equals_zero: Answer<bool>,
    vacant_orders_as_zero: Answer<bool>,
    vacant_adds_as_zero: Answer<bool>,
    mod_rounds: Answer<bool>,
    mod_sign_of_dividend: Answer<bool>,
    bits_round: Answer<bool>,
    round_half_away: Answer<bool>,
    fix_toward_zero: Answer<bool>,
    atan2_full_turn: Answer<bool>,
    asin_full_turn: Answer<bool>,
    divide_by_zero: Answer<bool>,
    root_of_negative: Answer<bool>,
    tangent_by_quotient: bool,
}

impl Answers {
    /// The answers of a control, whose alarms have these names.
    pub fn new(control: &Control, alarms: &'static Alarms) -> Self {
        let short = control.numbers().arithmetic == "decimal8";
        let alarm = |value: &str| (value == "alarm").then_some(true);
        Self {
            short: Digits::of(&control.numbers().arithmetic),
            own_digits: short.then_some(8),
            largest: if short { 1e47 } else { f64::MAX },
            smallest: if short { 1e-29 } else { 0.0 },
            alarms,
            vacant_equals_zero: yes(control, Question::VacantEqZero, false),
            vacant_orders_as_zero: yes(control, Question::VacantComparesAsZero, true),
            vacant_adds_as_zero: yes(control, Question::VacantArithmeticZero, true),
            mod_rounds: yes(control, Question::ModRoundsOperands, true),
            mod_sign_of_dividend: Answer::new(control, Question::ModSign, is("dividend", "divisor"), true),
            bits_round: Answer::new(control, Question::BitsOfFraction, is("round", "truncate"), true),
            round_half_away: yes(control, Question::RoundHalfAway, true),
            fix_toward_zero: yes(control, Question::FixTowardZero, true),
            atan2_full_turn: Answer::new(control, Question::Atan2Range, is("0..360", "-180..180"), false),
            asin_full_turn: Answer::new(control, Question::AsinRange, is("270..90", "-90..90"), false),
            divide_by_zero: Answer::new(control, Question::DivideByZero, alarm, true),
            root_of_negative: Answer::new(control, Question::SqrtOfNegative, alarm, true),
            tangent_by_quotient: short,
        }
    }
}

/// How the control calculates.
#[derive(Debug)]
pub struct Numeric<'c> {
    /// Significant digits that are kept.
    digits: FewerDigits,
    /// How far values may be off, where few digits are kept.
    pub short: Option<&'c Digits>,
    answers: &'c Answers,
}

impl<'c> Numeric<'c> {
    /// The arithmetic of a control; the digits of the scenario in place of its own where given.
    pub fn new(answers: &'c Answers, scenario: &Scenario) -> Self {
        let digits = FewerDigits::of(scenario, answers.own_digits);
        Self { digits, short: answers.short.as_ref(), answers }
    }

    /// A result as the control keeps it.
    pub fn keep(&self, value: f64) -> Result<f64, Stop> {
        self.in_range(value).map(|value| self.digits.keep(value))
    }

    /// The same for a result that doubles give exactly, or rounded once.
    fn keep_exact(&self, value: f64) -> Result<f64, Stop> {
        self.in_range(value).map(|value| self.digits.keep_of_operands(value))
    }

    /// A result that is no larger than the control takes; one that is too small is zero.
    fn in_range(&self, value: f64) -> Result<f64, Stop> {
        if value.is_nan() || value.abs() > self.answers.largest {
            return Err(Stop::alarm(self.answers.alarms.overflow, "the result is too large"));
        }
        if value.abs() < self.answers.smallest {
            return Ok(0.0);
        }
        Ok(value)
    }

    /// True where a result needed more digits than are kept.
    pub fn lacked_digits(&self) -> bool {
        self.digits.lacked()
    }

    /// An operand of arithmetic.
    pub fn number(&self, value: Value, trace: &mut Trace) -> f64 {
        value.unwrap_or_else(|| {
            self.answers.vacant_adds_as_zero.ask(trace);
            0.0
        })
    }

    /// Two operands joined.
    pub fn binary(&self, op: BinaryOp, a: Value, b: Value, trace: &mut Trace) -> Result<f64, Stop> {
        use BinaryOp::*;
        let truth = |yes: bool| Ok(f64::from(u8::from(yes)));
        match op {
            Equal | NotEqual => {
                let holds = self.equal(a, b, trace) == (op == Equal);
                trace.compared(a.unwrap_or(0.0), b.unwrap_or(0.0), holds);
                return truth(holds);
            }
            Less | LessEqual | Greater | GreaterEqual => {
                if a.is_none() || b.is_none() {
                    self.answers.vacant_orders_as_zero.ask(trace);
                }
                let (a, b) = (a.unwrap_or(0.0), b.unwrap_or(0.0));
                let holds = match op {
                    Less => a < b,
                    LessEqual => a <= b,
                    Greater => a > b,
                    _ => a >= b,
                };
                trace.compared(a, b, holds);
                return truth(holds);
            }
            _ => {}
        }
        let (a, b) = (self.number(a, trace), self.number(b, trace));
        let result = match op {
            Add => a + b,
            Subtract => a - b,
            Multiply => a * b,
            Divide if b == 0.0 => {
                self.answers.divide_by_zero.ask(trace);
                return Err(Stop::alarm(self.answers.alarms.division, "division by zero"));
            }
            Divide => a / b,
            Modulo => return self.modulo(a, b, trace).and_then(|result| self.keep_exact(result)),
            _ => self.bits(op, a, b, trace),
        };
        self.keep_exact(result)
    }

    fn equal(&self, a: Value, b: Value, trace: &mut Trace) -> bool {
        if a.is_some() == b.is_some() {
            return a == b;
        }
        // A vacant one against a number: it matters what it counts as where that is zero.
        let other = a.or(b).unwrap_or(0.0);
        other == 0.0 && self.answers.vacant_equals_zero.ask(trace)
    }

    fn modulo(&self, a: f64, b: f64, trace: &mut Trace) -> Result<f64, Stop> {
        let fractions = a.fract() != 0.0 || b.fract() != 0.0;
        let rounds = if fractions { self.answers.mod_rounds.ask(trace) } else { true };
        let (a, b) = if rounds { (a.round(), b.round()) } else { (a, b) };
        if b == 0.0 {
            return Err(Stop::alarm(self.answers.alarms.division, "division by zero"));
        }
        if a < 0.0 || b < 0.0 {
            self.answers.mod_sign_of_dividend.ask(trace);
        }
        Ok(a % b)
    }

    fn bits(&self, op: BinaryOp, a: f64, b: f64, trace: &mut Trace) -> f64 {
        let round =
            if a.fract() == 0.0 && b.fract() == 0.0 { true } else { self.answers.bits_round.ask(trace) };
        let whole = |value: f64| (if round { value.round() } else { value.trunc() }) as i64 as i32;
        let (a, b) = (whole(a), whole(b));
        f64::from(match op {
            BinaryOp::And => a & b,
            BinaryOp::Or => a | b,
            _ => a ^ b,
        })
    }

    /// A function of one argument.
    pub fn call(&self, function: Func, value: Value, trace: &mut Trace) -> Result<f64, Stop> {
        let x = self.number(value, trace);
        if matches!(function, Func::Ln | Func::Exp | Func::Bin | Func::Bcd) {
            trace.argument(function, x, 0.0);
        }
        let domain = |inside: bool| {
            if inside {
                Ok(())
            } else {
                Err(Stop::alarm(self.answers.alarms.domain, format!("{function} of {x}")))
            }
        };
        let result = match function {
            Func::Sin => sin_cos(x).0,
            Func::Cos => sin_cos(x).1,
            Func::Tan => {
                let (sin, cos) = sin_cos(x);
                if cos == 0.0 {
                    trace.doubt("function:tan");
                    return Err(Stop::alarm(self.answers.alarms.domain, "tan of a right angle"));
                }
                if self.answers.tangent_by_quotient { self.keep(sin)? / self.keep(cos)? } else { sin / cos }
            }
            Func::Asin => {
                domain(x.abs() <= 1.0)?;
                let angle = x.asin().to_degrees();
                if angle < 0.0 && self.answers.asin_full_turn.ask(trace) { angle + 360.0 } else { angle }
            }
            Func::Acos => {
                domain(x.abs() <= 1.0)?;
                x.acos().to_degrees()
            }
            Func::Atan => x.atan().to_degrees(),
            Func::Sqrt => {
                if x < 0.0 {
                    self.answers.root_of_negative.ask(trace);
                }
                domain(x >= 0.0)?;
                x.sqrt()
            }
            Func::Abs => x.abs(),
            Func::Round => self.round(x, trace),
            Func::Fix => {
                if x < 0.0 && x.fract() != 0.0 {
                    self.answers.fix_toward_zero.ask(trace);
                }
                x.trunc()
            }
            Func::Fup => {
                if x < 0.0 {
                    x.floor()
                } else {
                    x.ceil()
                }
            }
            Func::Sign => {
                if x < 0.0 {
                    -1.0
                } else {
                    1.0
                }
            }
            Func::Ln => {
                domain(x > 0.0)?;
                x.ln()
            }
            Func::Exp => {
                let result = x.exp();
                domain(result <= self.answers.largest)?;
                result
            }
            Func::Bin => digits_to(x, 10, 16),
            Func::Bcd => digits_to(x, 16, 10),
            _ => return Err(Stop::unnamed(format!("no rule for the function {function}"))),
        };
        if is_exact(function) { self.keep_exact(result) } else { self.keep(result) }
    }

    /// The nearest whole number.
    pub fn round(&self, x: f64, trace: &mut Trace) -> f64 {
        if x < 0.0 && x.fract() == -0.5 {
            self.answers.round_half_away.ask(trace);
        }
        x.round()
    }

    /// A function of two arguments.
    pub fn call2(&self, function: Func, a: Value, b: Value, trace: &mut Trace) -> Result<f64, Stop> {
        let (a, b) = (self.number(a, trace), self.number(b, trace));
        match function {
            Func::Atan => {
                // Zero over zero has no angle; no source says what a control makes of it, so nothing goes on from there.
                if a == 0.0 && b == 0.0 {
                    trace.doubt("function:atan/2");
                    return Err(Stop::alarm(self.answers.alarms.domain, "ATAN of 0 and 0"));
                }
                let angle = (a + 0.0).atan2(b + 0.0).to_degrees();
                self.keep(if angle < 0.0 && self.answers.atan2_full_turn.ask(trace) {
                    angle + 360.0
                } else {
                    angle
                })
            }
            Func::Pow => {
                trace.argument(function, a, b);
                let result = a.powf(b);
                if result.is_nan() {
                    return Err(Stop::alarm(self.answers.alarms.domain, format!("{a} to the power of {b}")));
                }
                self.keep(result)
            }
            _ => Err(Stop::unnamed(format!("no rule for the function {function} of two"))),
        }
    }
}

/// True for a function that has no last digit to be off by: its result stands in its argument.
fn is_exact(function: Func) -> bool {
    use Func::{Abs, Bcd, Bin, Fix, Fup, Round, Sign};
    matches!(function, Abs | Round | Fix | Fup | Sign | Bin | Bcd)
}

/// Reads the digits of a whole number in one base as digits of another: BIN and BCD.
fn digits_to(value: f64, write: u64, read: u64) -> f64 {
    let (mut rest, mut place, mut out) = (value.abs().round() as u64, 1u64, 0u64);
    while rest > 0 {
        out = out.saturating_add((rest % read).saturating_mul(place));
        place = place.saturating_mul(write);
        rest /= read;
    }
    (out as f64).copysign(value)
}

/// Sine and cosine of degrees, exact at the quarters.
fn sin_cos(degrees: f64) -> (f64, f64) {
    match degrees.rem_euclid(360.0) {
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        turn => turn.to_radians().sin_cos(),
    }
}
