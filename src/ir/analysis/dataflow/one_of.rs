//! What may be one of a few values.

use super::Lattice;

/// How many values are told apart; more count as any.
const MOST: usize = 8;

/// The values that something may have at a place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OneOf<T> {
    /// In order.
    list: Vec<T>,
    any: bool,
}

impl<T> Default for OneOf<T> {
    fn default() -> Self {
        Self::NONE
    }
}

impl<T> OneOf<T> {
    /// No value: nothing was set, or no way leads here.
    pub const NONE: Self = Self { list: Vec::new(), any: false };

    /// Any value at all.
    pub fn any() -> Self {
        Self { list: Vec::new(), any: true }
    }

    /// This value only.
    pub fn one(value: T) -> Self {
        Self { list: vec![value], any: false }
    }

    /// True where nothing is known.
    pub fn is_any(&self) -> bool {
        self.any
    }

    /// The values, in order; none if nothing is known.
    pub fn list(&self) -> &[T] {
        &self.list
    }

    /// The value, where there is but one.
    pub fn only(&self) -> Option<&T> {
        if let [value] = self.list.as_slice() { Some(value) } else { None }
    }
}

impl<T: Copy + Ord> OneOf<T> {
    /// What each of the values becomes.
    pub fn map(&self, f: impl Fn(T) -> T) -> Self {
        let mut mapped = Self { list: Vec::new(), any: self.any };
        for value in &self.list {
            mapped.join(&Self::one(f(*value)));
        }
        mapped
    }
}

impl<T: Copy + Ord> Lattice for OneOf<T> {
    fn join(&mut self, other: &Self) -> bool {
        if self.any {
            return false;
        }
        let before = self.list.len();
        for value in &other.list {
            if let Err(at) = self.list.binary_search(value) {
                self.list.insert(at, *value);
            }
        }
        if other.any || self.list.len() > MOST {
            *self = Self::any();
        }
        self.any || self.list.len() != before
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
