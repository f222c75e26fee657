//! What is known of a variable's value.

use crate::syntax::BinaryOp;

/// What is known of a program from outside its text.
#[derive(Clone, Copy, Default)]
pub struct Given<'g> {
    /// The locals that every call gives a value.
    pub locals: &'g [String],
    /// The code of the one unit that the machine is in.
    pub unit: Option<f64>,
}

/// What is known of a variable.
#[derive(Clone, Debug, PartialEq)]
pub enum Known {
    /// It is vacant.
    Vacant,
    /// It is a number.
    Number(Range),
}

/// The numbers that a value can be.
#[derive(Clone, Debug, PartialEq)]
pub struct Range {
    /// The least.
    pub low: f64,
    /// The greatest.
    pub high: f64,
    /// The variable of which it is the whole part, cut toward zero.
    pub whole_of: Option<String>,
}

impl Range {
    /// Any number.
    pub const ANY: Range = Range { low: f64::NEG_INFINITY, high: f64::INFINITY, whole_of: None };

    /// One number.
    pub fn one(value: f64) -> Self {
        Self { low: value, high: value, whole_of: None }
    }

    /// The sum with another. Between whole numbers no control rounds.
    pub fn plus(&self, other: &Self) -> Self {
        let whole = |bound: f64| bound.is_infinite() || (bound.fract() == 0.0 && bound.abs() < 1e6);
        let (low, high) = (self.low + other.low, self.high + other.high);
        let all = [self.low, self.high, other.low, other.high, low, high];
        if all.into_iter().all(whole) { Self { low, high, whole_of: None } } else { Self::rounded(low, high) }
    }

    /// The product with another.
    pub fn times(&self, other: &Self) -> Self {
        self.of_pairs(other, |a, b| a * b)
    }

    /// The quotient by another.
    pub fn by(&self, other: &Self) -> Self {
        self.of_pairs(other, |a, b| a / b)
    }

    /// What a product or a quotient can be: between those of the ends, and never of the other sign.
    fn of_pairs(&self, other: &Self, result: impl Fn(f64, f64) -> f64) -> Self {
        let sign = |range: &Self| match range {
            range if range.low >= 0.0 => Some(1.0),
            range if range.high <= 0.0 => Some(-1.0),
            _ => None,
        };
        let by_sign = match (sign(self), sign(other)) {
            (Some(a), Some(b)) if a == b => Self { low: 0.0, ..Self::ANY },
            (Some(_), Some(_)) => Self { high: 0.0, ..Self::ANY },
            _ => Self::ANY,
        };
        let ends = [self.low, self.high].into_iter().flat_map(|a| [(a, other.low), (a, other.high)]);
        let ends: Vec<f64> = ends.map(|(a, b)| result(a, b)).collect();
        // Across 0 a quotient has no bounds.
        if sign(other).is_none()
            || other.low == 0.0
            || other.high == 0.0
            || !ends.iter().all(|end| end.is_finite())
        {
            return by_sign;
        }
        let low = ends.iter().copied().fold(f64::INFINITY, f64::min);
        let high = ends.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let Self { low, high, .. } = Self::rounded(low, high);
        Self { low: low.max(by_sign.low), high: high.min(by_sign.high), whole_of: None }
    }

    /// What a control may compute where the exact value lies between these two: no control rounds by more than 0.002, or
    /// one part in a million.
    fn rounded(low: f64, high: f64) -> Self {
        if low.is_nan() || high.is_nan() {
            return Self::ANY;
        }
        let by = |bound: f64| if bound.is_finite() { 0.002 + bound.abs() * 1e-6 } else { 0.0 };
        Self { low: low - by(low), high: high + by(high), whole_of: None }
    }

    /// What is rounded to a whole number, whichever way halves go.
    pub fn to_whole(&self) -> Self {
        Self { low: self.low.floor(), high: self.high.ceil(), whole_of: None }
    }

    /// Its values without their signs.
    pub fn absolute(&self) -> Self {
        let (low, high) = (self.low.abs(), self.high.abs());
        let least = if self.low <= 0.0 && self.high >= 0.0 { 0.0 } else { low.min(high) };
        Self { low: least, high: low.max(high), whole_of: None }
    }

    /// What lies in it or in a later one, whose bounds may go on growing: a bound that grew is none.
    pub fn widened(&self, later: &Self) -> Self {
        let low = if later.low < self.low { f64::NEG_INFINITY } else { self.low };
        let high = if later.high > self.high { f64::INFINITY } else { self.high };
        let whole_of = self.whole_of.clone().filter(|of| later.whole_of.as_ref() == Some(of));
        Self { low, high, whole_of }
    }

    /// The same with its sign turned.
    pub fn negated(&self) -> Self {
        Self { low: -self.high, high: -self.low, whole_of: None }
    }

    /// What is cut toward zero from a variable in this range.
    pub fn whole(&self, of: Option<String>) -> Self {
        Self { low: self.low.trunc(), high: self.high.trunc(), whole_of: of }
    }

    /// Whether a comparison with another holds, where that is the same for all their numbers.
    pub fn compare(&self, op: BinaryOp, other: &Self) -> Option<bool> {
        use BinaryOp::*;
        let decide = |yes: bool, no: bool| if yes { Some(true) } else { no.then_some(false) };
        // A whole number is no fraction.
        let parts = |a: &Self, b: &Self| a.whole_of.is_some() && b.low == b.high && b.low.fract() != 0.0;
        match op {
            Less => decide(self.high < other.low, self.low >= other.high),
            LessEqual => decide(self.high <= other.low, self.low > other.high),
            Greater => other.compare(Less, self),
            GreaterEqual => other.compare(LessEqual, self),
            Equal => decide(
                self.low == self.high && (other.low, other.high) == (self.low, self.low),
                self.high < other.low || self.low > other.high || parts(self, other) || parts(other, self),
            ),
            NotEqual => self.compare(Equal, other).map(|same| !same),
            _ => None,
        }
    }

    /// What is left of it where a comparison with a number holds.
    pub fn where_holds(&self, op: BinaryOp, number: f64) -> Self {
        use BinaryOp::*;
        let mut out = Self { whole_of: None, ..self.clone() };
        match op {
            Greater | GreaterEqual => out.low = out.low.max(number),
            Less | LessEqual => out.high = out.high.min(number),
            Equal => (out.low, out.high) = (number, number),
            _ => {}
        }
        out
    }
}

/// The comparison that holds where another does not.
pub fn opposite(op: BinaryOp) -> Option<BinaryOp> {
    use BinaryOp::*;
    Some(match op {
        Equal => NotEqual,
        NotEqual => Equal,
        Less => GreaterEqual,
        LessEqual => Greater,
        Greater => LessEqual,
        GreaterEqual => Less,
        _ => return None,
    })
}
