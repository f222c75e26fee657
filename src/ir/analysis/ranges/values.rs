//! Sets of values: a few numbers, or all between two bounds.

use super::numbers::Numbers;

/// So many numbers are told apart; more are taken for all between the least and the greatest.
const FEW: usize = 16;

/// Whole numbers up to here are exact on every control.
const EXACT: f64 = 1e7;

/// Arithmetic with fractions is off by no more than this share of a value.
const SHARE: f64 = 1e-5;

/// What an expression may be. Vacant counts as 0.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// One of these, in order; none of them where control does not come.
    Few(Vec<f64>),
    /// Anything between two bounds.
    Between {
        /// The least.
        low: f64,
        /// The greatest.
        high: f64,
        /// True where all are whole numbers.
        whole: bool,
    },
}

impl Values {
    /// Any number at all.
    pub const ANY: Self = Self::Between { low: f64::NEG_INFINITY, high: f64::INFINITY, whole: false };

    /// One number.
    pub fn one(value: f64) -> Self {
        if value.is_finite() { Self::Few(vec![value]) } else { Self::ANY }
    }

    /// All whole numbers between two.
    pub const fn whole(low: f64, high: f64) -> Self {
        Self::Between { low, high, whole: true }
    }

    /// One of some numbers.
    pub fn of(mut values: Vec<f64>) -> Self {
        if values.iter().any(|value| !value.is_finite()) {
            return Self::ANY;
        }
        values.sort_unstable_by(f64::total_cmp);
        values.dedup();
        match (values.first(), values.last()) {
            (Some(&low), Some(&high)) if values.len() > FEW => {
                Self::Between { low, high, whole: values.iter().all(|value| value.fract() == 0.0) }
            }
            _ => Self::Few(values),
        }
    }

    /// The least and the greatest; none if there is no value.
    pub fn bounds(&self) -> Option<(f64, f64)> {
        match self {
            Self::Few(values) => Some((*values.first()?, *values.last()?)),
            Self::Between { low, high, .. } => Some((*low, *high)),
        }
    }

    /// True where no value is left.
    pub fn is_empty(&self) -> bool {
        matches!(self, Self::Few(values) if values.is_empty())
    }

    /// True where every value is a whole number that arithmetic keeps.
    pub fn is_whole(&self) -> bool {
        match self {
            Self::Few(values) => values.iter().all(|v| v.fract() == 0.0 && v.abs() <= EXACT),
            Self::Between { low, high, whole } => *whole && -EXACT <= *low && *high <= EXACT,
        }
    }

    /// True where a value may be among them.
    pub fn contains(&self, value: f64) -> bool {
        match self {
            Self::Few(values) => values.contains(&value),
            Self::Between { low, high, whole } => {
                (*low..=*high).contains(&value) && (!whole || value.fract() == 0.0)
            }
        }
    }

    /// True where it is plain to see that joining the other would change nothing.
    pub fn has_all_of(&self, other: &Self) -> bool {
        *self == Self::ANY || self == other
    }

    /// The values of both.
    #[must_use]
    pub fn join(&self, other: &Self) -> Self {
        match (self, other) {
            (Self::Few(a), Self::Few(b)) => Self::of(a.iter().chain(b).copied().collect()),
            _ => match (self.bounds(), other.bounds()) {
                (Some((a, b)), Some((c, d))) => Self::Between {
                    low: a.min(c),
                    high: b.max(d),
                    whole: self.all_whole() && other.all_whole(),
                },
                (None, _) => other.clone(),
                (_, None) => self.clone(),
            },
        }
    }

    /// Those from `low` to `high`.
    #[must_use]
    pub fn within(&self, low: f64, high: f64) -> Self {
        match self {
            Self::Few(values) => {
                Self::Few(values.iter().copied().filter(|value| (low..=high).contains(value)).collect())
            }
            Self::Between { low: from, high: to, whole } => {
                let (mut low, mut high) = (low.max(*from), high.min(*to));
                if *whole {
                    (low, high) = (low.ceil(), high.floor());
                }
                if low <= high { Self::Between { low, high, whole: *whole } } else { Self::Few(Vec::new()) }
            }
        }
    }

    /// The values that are in both.
    #[must_use]
    pub fn meet(&self, other: &Self) -> Self {
        match (self, other) {
            (_, Self::Few(few)) => Self::Few(few.iter().copied().filter(|v| self.contains(*v)).collect()),
            (_, Self::Between { low, high, .. }) => self.within(*low, *high),
        }
    }

    /// Those but the whole number `value`, as far as bounds can say it.
    #[must_use]
    pub fn without(&self, value: f64) -> Self {
        match self {
            Self::Few(values) => Self::Few(values.iter().copied().filter(|other| *other != value).collect()),
            Self::Between { low, high, whole: true } if *low == value => self.within(low + 1.0, *high),
            Self::Between { low, high, whole: true } if *high == value => self.within(*low, high - 1.0),
            _ => self.clone(),
        }
    }

    /// The numbers of variables or blocks that they may name, however a fraction is rounded.
    pub fn numbers(&self) -> Numbers {
        let ends = |low: f64, high: f64, whole: bool| {
            let off = |value: f64| if whole { 0.0 } else { 1e-3 + value.abs() * SHARE };
            // Nothing has a negative number: there the control stops.
            let (low, high) = ((low - off(low)).floor(), (high + off(high)).ceil());
            (high >= 0.0).then_some((low.max(0.0) as u32, high.min(f64::from(u32::MAX)) as u32))
        };
        match self {
            Self::Few(values) => {
                Numbers::of(values.iter().filter_map(|value| ends(*value, *value, value.fract() == 0.0)))
            }
            Self::Between { low, high, whole } => Numbers::of(ends(*low, *high, *whole)),
        }
    }

    /// The result of a function that never falls where its argument rises.
    #[must_use]
    pub fn rising(&self, f: impl Fn(f64) -> f64) -> Self {
        match (self, self.loose().bounds()) {
            (Self::Few(values), _) if self.is_whole() => Self::of(values.iter().map(|v| f(*v)).collect()),
            (_, Some((low, high))) => Self::whole(f(low), f(high)),
            _ => self.clone(),
        }
    }

    /// The negatives.
    #[must_use]
    pub fn negated(&self) -> Self {
        match self {
            Self::Few(values) => Self::of(values.iter().map(|value| 0.0 - value).collect()),
            Self::Between { low, high, whole } => Self::Between { low: -high, high: -low, whole: *whole },
        }
    }

    /// The result of `f` on each pair of values, which is greatest and least where both operands are. `whole` tells
    /// that whole operands give whole results.
    #[must_use]
    pub fn corners(&self, other: &Self, whole: bool, f: impl Fn(f64, f64) -> f64) -> Self {
        // Beyond the bounds that are exact, sums and products stay beyond.
        let keeps = |values: &Self| {
            let ends = values.bounds().map_or([0.0; 2], |(low, high)| [low, high]);
            values.all_whole() && ends.iter().all(|end| end.is_infinite() || end.abs() <= EXACT)
        };
        let exact = whole && keeps(self) && keeps(other);
        if let (Self::Few(a), Self::Few(b), true) = (self, other, exact) {
            return Self::of(
                a.iter().flat_map(|a| b.iter().map(|b| f(*a, *b)).collect::<Vec<_>>()).collect(),
            );
        }
        let (Some((a, b)), Some((c, d))) = (self.bounds(), other.bounds()) else {
            return Self::Few(Vec::new());
        };
        let all = [f(a, c), f(a, d), f(b, c), f(b, d)];
        if all.iter().any(|value| value.is_nan()) {
            return Self::ANY;
        }
        let (low, high) = (
            all.iter().copied().fold(f64::INFINITY, f64::min),
            all.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        );
        let result = Self::Between { low, high, whole: exact };
        if exact && keeps(&result) { result } else { Self::Between { low, high, whole: false }.loose() }
    }

    /// With room for what arithmetic with fractions may be off by.
    fn loose(&self) -> Self {
        match self.bounds() {
            Some((low, high)) if !self.all_whole() => {
                let off = |value: f64| 1e-6 + value.abs() * SHARE;
                Self::Between { low: low - off(low), high: high + off(high), whole: false }
            }
            _ => self.clone(),
        }
    }

    /// True where every value is a whole number, however large.
    pub fn all_whole(&self) -> bool {
        match self {
            Self::Few(values) => values.iter().all(|value| value.fract() == 0.0),
            Self::Between { whole, .. } => *whole,
        }
    }

    /// What takes the place of these values where each turn of a loop adds to them: bounds that moved go on to the
    /// next of some constants, or to no bound.
    #[must_use]
    pub fn widened(&self, before: &Self, stops: &[f64]) -> Self {
        let (Some((low, high)), Some((old_low, old_high))) = (self.bounds(), before.bounds()) else {
            return self.clone();
        };
        let below = || stops.iter().rev().copied().find(|stop| *stop <= low).unwrap_or(f64::NEG_INFINITY);
        let above = || stops.iter().copied().find(|stop| *stop >= high).unwrap_or(f64::INFINITY);
        Self::Between {
            low: if low < old_low { below() } else { low },
            high: if high > old_high { above() } else { high },
            whole: self.all_whole(),
        }
    }
}
