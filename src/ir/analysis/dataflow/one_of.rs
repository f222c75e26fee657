//! What may be one of a few values.

use super::Lattice;
use thin_vec::ThinVec;

/// How many values are told apart; more count as any.
const MOST: usize = 8;

/// The values that something may have at a place.
///
/// One word: a state has many of them, and a program a state at each place that is jumped to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OneOf<T> {
    /// In order; none for any.
    list: Option<ThinVec<T>>,
}

impl<T> Default for OneOf<T> {
    fn default() -> Self {
        Self::NONE
    }
}

impl<T> OneOf<T> {
    /// No value: nothing was set, or no way leads here.
    pub const NONE: Self = Self { list: Some(ThinVec::new()) };

    /// Any value at all.
    pub fn any() -> Self {
        Self { list: None }
    }

    /// This value only.
    pub fn one(value: T) -> Self {
        Self { list: Some(ThinVec::from([value])) }
    }

    /// True where nothing is known.
    pub fn is_any(&self) -> bool {
        self.list.is_none()
    }

    /// The values, in order; none if nothing is known.
    pub fn list(&self) -> &[T] {
        self.list.as_deref().unwrap_or_default()
    }

    /// The value, where there is but one.
    pub fn only(&self) -> Option<&T> {
        if let [value] = self.list() { Some(value) } else { None }
    }
}

impl<T: Copy + Ord> OneOf<T> {
    /// What each of the values becomes.
    pub fn map(&self, f: impl Fn(T) -> T) -> Self {
        let mut mapped = if self.is_any() { Self::any() } else { Self::NONE };
        for value in self.list() {
            mapped.join(&Self::one(f(*value)));
        }
        mapped
    }
}

impl<T: Copy + Ord> Lattice for OneOf<T> {
    fn join(&mut self, other: &Self) -> bool {
        let Some(mine) = &mut self.list else { return false };
        let before = mine.len();
        for value in other.list() {
            if let Err(at) = mine.binary_search(value) {
                mine.insert(at, *value);
            }
        }
        let changed = mine.len() != before;
        if other.is_any() || mine.len() > MOST {
            *self = Self::any();
            return true;
        }
        changed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_values_than_are_told_apart_are_any() {
        let mut values = OneOf::one(0);
        for value in 1..8 {
            assert!(values.join(&OneOf::one(value)) && !values.is_any());
        }
        assert!(!values.join(&OneOf::one(3)));
        assert!(values.join(&OneOf::one(8)));
        assert!(values.is_any() && values.list().is_empty());
        assert!(!values.join(&OneOf::one(9)));
    }

    #[test]
    fn values_may_become_the_same() {
        let mut values = OneOf::one(3);
        values.join(&OneOf::one(4));
        assert_eq!(values.map(|value| value / 3), OneOf::one(1));
        assert_eq!(values.only(), None);
    }
}
