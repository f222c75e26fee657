//! What is known of a variable's value.

use crate::syntax::BinaryOp;

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

    /// The sum with another. Only whole bounds are kept: those no control rounds.
    pub fn plus(&self, other: &Self) -> Self {
        let whole = |bound: f64| bound.is_infinite() || (bound.fract() == 0.0 && bound.abs() < 1e6);
        let (low, high) = (self.low + other.low, self.high + other.high);
        let all = [self.low, self.high, other.low, other.high, low, high];
        if all.into_iter().all(whole) { Self { low, high, whole_of: None } } else { Self::ANY }
    }

    /// The product or the quotient with another: its sign is all that is kept, since a control may round.
    pub fn times(&self, other: &Self) -> Self {
        let sign = |range: &Self| match range {
            range if range.low >= 0.0 => Some(1.0),
            range if range.high <= 0.0 => Some(-1.0),
            _ => None,
        };
        match (sign(self), sign(other)) {
            (Some(a), Some(b)) if a == b => Self { low: 0.0, ..Self::ANY },
            (Some(_), Some(_)) => Self { high: 0.0, ..Self::ANY },
            _ => Self::ANY,
        }
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
        match op {
            Less => decide(self.high < other.low, self.low >= other.high),
            LessEqual => decide(self.high <= other.low, self.low > other.high),
            Greater => other.compare(Less, self),
            GreaterEqual => other.compare(LessEqual, self),
            Equal => decide(
                self.low == self.high && (other.low, other.high) == (self.low, self.low),
                self.high < other.low || self.low > other.high,
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
