//! Tables of the machine that many runs share until one of them writes.

use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::collections::BTreeMap;
use std::ops::{Deref, DerefMut};
use std::sync::Arc;

/// Values by number, as a map has them. Copies share the values until one of them is written.
#[derive(Clone, Debug)]
pub struct Table<T>(Arc<BTreeMap<u32, T>>);

impl<T> Table<T> {
    /// True for copies that nobody wrote since: they hold the same.
    pub fn is_shared_with(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl<T> Default for Table<T> {
    fn default() -> Self {
        Self(Arc::default())
    }
}

impl<T, const N: usize> From<[(u32, T); N]> for Table<T> {
    fn from(rows: [(u32, T); N]) -> Self {
        Self(Arc::new(rows.into()))
    }
}

impl<T> Deref for Table<T> {
    type Target = BTreeMap<u32, T>;

    fn deref(&self) -> &BTreeMap<u32, T> {
        &self.0
    }
}

impl<T: Clone> DerefMut for Table<T> {
    fn deref_mut(&mut self) -> &mut BTreeMap<u32, T> {
        Arc::make_mut(&mut self.0)
    }
}

impl<T: PartialEq> PartialEq for Table<T> {
    fn eq(&self, other: &Self) -> bool {
        self.0 == other.0
    }
}

impl<T: Serialize> Serialize for Table<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        (**self).serialize(serializer)
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Table<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Ok(Self(Arc::new(BTreeMap::deserialize(deserializer)?)))
    }
}

#[cfg(test)]
mod tests {
    use super::Table;

    #[test]
    fn what_one_copy_writes_the_others_do_not_hold() {
        let mut first = Table::default();
        first.insert(1, 2.5);
        let mut second = first.clone();
        assert!(second.is_shared_with(&first));
        second.insert(1, 7.0);
        assert_eq!((first.get(&1), second.get(&1)), (Some(&2.5), Some(&7.0)));
        assert!(!second.is_shared_with(&first) && second != first);
    }
}
