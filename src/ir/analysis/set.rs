//! Sets of variables as bits.

use crate::ir::{Class, Var};
use smallvec::{SmallVec, smallvec};

/// The variables that an analysis speaks of, in order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Universe {
    vars: Vec<Var>,
}

/// A subset of a [`Universe`].
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Row {
    /// Two words are as large as what points to more.
    bits: SmallVec<[u64; 2]>,
}

impl Universe {
    /// The universe of these variables.
    pub fn new(mut vars: Vec<Var>) -> Self {
        vars.sort_unstable();
        vars.dedup();
        Self { vars }
    }

    /// A variable's place.
    pub fn place(&self, var: Var) -> Option<usize> {
        self.vars.binary_search(&var).ok()
    }

    /// The empty subset.
    pub fn none(&self) -> Row {
        Row { bits: smallvec![0; self.vars.len().div_ceil(64)] }
    }

    /// All of it.
    pub fn all(&self) -> Row {
        self.classes(|_| true)
    }

    /// The variables of these classes.
    pub fn classes(&self, test: impl Fn(Class) -> bool) -> Row {
        let mut row = self.none();
        self.vars.iter().enumerate().filter(|(_, v)| test(v.class)).for_each(|(at, _)| row.insert(at));
        row
    }

    /// The variables of a subset.
    pub fn members<'r>(&'r self, row: &'r Row) -> impl Iterator<Item = Var> + 'r {
        self.vars.iter().enumerate().filter(|(at, _)| row.has(*at)).map(|(_, var)| *var)
    }

    /// The variables, in order.
    pub fn vars(&self) -> &[Var] {
        &self.vars
    }
}

impl Row {
    /// Adds the variable at a place.
    pub fn insert(&mut self, at: usize) {
        if let Some(word) = self.bits.get_mut(at / 64) {
            *word |= 1 << (at % 64);
        }
    }

    /// Takes out the variable at a place.
    pub fn remove(&mut self, at: usize) {
        if let Some(word) = self.bits.get_mut(at / 64) {
            *word &= !(1 << (at % 64));
        }
    }

    /// True where the variable at a place is in.
    pub fn has(&self, at: usize) -> bool {
        self.bits.get(at / 64).is_some_and(|word| word >> (at % 64) & 1 == 1)
    }

    /// Adds all of another; true where that changed it.
    pub fn join(&mut self, other: &Row) -> bool {
        let mut changed = false;
        for (word, more) in self.bits.iter_mut().zip(&other.bits) {
            changed |= *more & !*word != 0;
            *word |= more;
        }
        changed
    }

    /// Keeps what is in another too.
    pub fn intersect(&mut self, other: &Row) {
        self.bits.iter_mut().zip(&other.bits).for_each(|(word, keep)| *word &= keep);
    }

    /// Takes out all of another.
    pub fn subtract(&mut self, other: &Row) {
        self.bits.iter_mut().zip(&other.bits).for_each(|(word, less)| *word &= !less);
    }
}
