//! How far a value may be off where the control keeps few digits.
//!
//! What such a control makes of 6/2 is 3.000001 on one machine and 3 on the next: the makers say how large the
//! errors are, not which. The emulated control goes on with one value, follows by how much it may be off,
//! and says so where that decides anything: a comparison, the cut to a whole number, the domain of a function.

use crate::canon::Func;
use crate::control::trace::Trace;
use crate::syntax::BinaryOp;

/// The errors of a short arithmetic. They belong to the kind of number, which a table or a setting names, and not to a
/// control: no source gives them as limits, they are the examples of two makers, taken a little larger.
#[derive(Debug)]
pub struct Digits {
    /// Relative error of a step.
    step: f64,
    /// Error of an angle that a function yields, degrees.
    angle: f64,
    /// Decimal digits that a value keeps when it is read.
    kept: i32,
}

impl Digits {
    /// By the name of the arithmetic in the table; none for that of doubles.
    pub fn of(arithmetic: &str) -> Option<Self> {
        match arithmetic {
            // 0.002*1000 may be 1.99999997, and ATAN is off by up to 3.6e-6 degrees (seed 001:1391).
            "decimal8" => Some(Self { step: 2e-8, angle: 3.6e-6, kept: 8 }),
            // 6/2 may be 3.000001, a 5 be stored as 4.999999 (seed 002:516).
            "single" => Some(Self { step: 4e-7, angle: 4e-5, kept: 7 }),
            _ => None,
        }
    }

    /// By how much a value of the text or of the machine is off when it is read: nothing where the control has its
    /// digits, since it then reads the same value wherever the same digits stand.
    pub fn read(&self, value: f64) -> f64 {
        if is_short(value) || self.has_digits(value) { 0.0 } else { value.abs() * self.step }
    }

    /// True for a value of no more decimal digits than are kept, as near as doubles tell.
    fn has_digits(&self, value: f64) -> bool {
        // Between -324 and 308: the value is finite, and zero is short.
        let first = value.abs().log10().floor() as i32;
        let whole = value.abs() * 10f64.powi(self.kept - 1 - first);
        (whole - whole.round()).abs() <= whole * NOISE
    }

    /// By how much the result of two operands may be off; says where that decides what the result is.
    pub fn binary(
        &self,
        op: BinaryOp,
        (a, off_a): (f64, f64),
        (b, off_b): (f64, f64),
        result: f64,
        trace: &mut Trace,
    ) -> f64 {
        use BinaryOp::*;
        let sum = off_a + off_b;
        let exact = sum == 0.0 && [a, b, result].iter().all(|value| is_short(*value));
        let rounded = if exact { 0.0 } else { result.abs() * self.step };
        match op {
            Add | Subtract => sum + rounded,
            Multiply => a.abs() * off_b + b.abs() * off_a + off_a * off_b + rounded,
            Divide => (off_a + result.abs() * off_b) / b.abs() + result.abs() * self.step,
            Equal | NotEqual | Less | LessEqual | Greater | GreaterEqual => {
                decides((a - b).abs(), sum, trace);
                0.0
            }
            _ => {
                for (value, off) in [(a, off_a), (b, off_b)] {
                    self.whole(value, off, trace);
                }
                0.0
            }
        }
    }

    /// The same for a function.
    pub fn call(&self, function: Func, (x, off): (f64, f64), result: f64, trace: &mut Trace) -> f64 {
        let degrees = |radians: f64| radians.to_degrees();
        let rounded = result.abs() * self.step;
        match function {
            Func::Sin | Func::Cos => off.to_radians() + self.step,
            Func::Tan => (1.0 + result * result) * (off.to_radians() + 2.0 * self.step),
            Func::Asin | Func::Acos => {
                decides(1.0 - x.abs(), off, trace);
                let (low, high) = ((x - off).max(-1.0), (x + off).min(1.0));
                degrees(high.asin() - low.asin()) + self.angle
            }
            Func::Atan => degrees(off / (1.0 + x * x)) + self.angle,
            Func::Sqrt => {
                decides(x, off, trace);
                off / (2.0 * result.max(off.sqrt() / 2.0).max(f64::MIN_POSITIVE)) + rounded
            }
            Func::Abs => off,
            Func::Fix | Func::Fup => {
                decides((x - x.round()).abs(), off, trace);
                0.0
            }
            Func::Round | Func::Bin | Func::Bcd => {
                self.whole(x, off, trace);
                0.0
            }
            Func::Sign => {
                decides(x.abs(), off, trace);
                0.0
            }
            Func::Ln => off / x.abs() + rounded.max(self.step),
            Func::Exp => result.abs() * off + rounded,
            _ => off + rounded,
        }
    }

    /// The same for a function of two arguments.
    pub fn call2(
        &self,
        function: Func,
        (a, off_a): (f64, f64),
        (b, off_b): (f64, f64),
        result: f64,
        trace: &mut Trace,
    ) -> f64 {
        if function == Func::Pow {
            let part = b.abs() * off_a / a.abs() + a.abs().ln().abs() * off_b;
            return result.abs() * (part + self.step);
        }
        // Where the first argument changes its sign an angle jumps by a turn, to one side or the other.
        decides(a.abs(), off_a, trace);
        ((a.abs() * off_b + b.abs() * off_a) / (a * a + b * b)).to_degrees() + self.angle
    }

    /// A value that is rounded to a whole number.
    pub fn whole(&self, value: f64, off: f64, trace: &mut Trace) {
        decides(((value - value.floor()) - 0.5).abs(), off, trace);
    }

    /// A condition: not zero is true.
    pub fn truth(&self, value: f64, off: f64, trace: &mut Trace) {
        decides(value.abs(), off, trace);
    }

    /// A value that a word rounds to its increment: nobody minds the next one, which any rounding may give.
    pub fn place(&self, off: f64, increment: f64, trace: &mut Trace) {
        decides(increment, off, trace);
    }
}

/// Tells of a value that lies so far from where the result would be another one.
fn decides(distance: f64, off: f64, trace: &mut Trace) {
    let far = distance > off;
    if off != 0.0 && !far {
        trace.doubt("machine:arithmetic.last.digit");
    }
}

/// What doubles make of a value with few digits that was scaled from one unit to the other, relative.
const NOISE: f64 = 1e-12;

/// True for a value that every short arithmetic holds: it has 24 binary digits at most.
fn is_short(value: f64) -> bool {
    // The cast is the test.
    f64::from(value as f32) == value
}
