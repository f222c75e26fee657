//! Sets of variables as bits.

use crate::ir::{Class, Program, Var};
use smallvec::{SmallVec, smallvec};

/// The variables that an analysis speaks of, in order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Universe {
    vars: Vec<Var>,
    /// By class and 64 neighbours: which are in, and how many are before them.
    words: Vec<(Key, u64, usize)>,
}

/// 64 neighbours of a class, in the order of variables.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Key(u32);

impl Key {
    /// Bits that tell apart the neighbours of a class.
    const BITS: u32 = u32::BITS - 6;

    const fn of(var: Var) -> Self {
        Self(((var.class as u32) << Self::BITS) | (var.number / 64))
    }

    /// The first of them; the bits of all count from it.
    fn first(self) -> Var {
        let number = (self.0 & ((1 << Self::BITS) - 1)) * 64;
        Var { class: Class::ALL[(self.0 >> Self::BITS) as usize], number }
    }
}

/// The bit of a variable among its neighbours.
const fn bit(var: Var) -> u64 {
    1 << (var.number % 64)
}

/// A subset of a [`Universe`].
#[derive(Debug, Default, PartialEq, Eq)]
pub struct BitRow {
    /// Two words are as large as what points to more.
    bits: SmallVec<[u64; 2]>,
}

impl Universe {
    /// The universe of these variables.
    pub fn new(mut vars: Vec<Var>) -> Self {
        vars.sort_unstable();
        vars.dedup();
        let mut words: Vec<(Key, u64, usize)> = Vec::new();
        for (at, var) in vars.iter().enumerate() {
            match words.last_mut() {
                Some((last, bits, _)) if *last == Key::of(*var) => *bits |= bit(*var),
                _ => words.push((Key::of(*var), bit(*var), at)),
            }
        }
        Self { vars, words }
    }

    /// A variable's place.
    pub fn place(&self, var: Var) -> Option<usize> {
        let at = find(&self.words, Key::of(var), |(key, ..)| *key).ok()?;
        let (_, bits, before) = self.words[at];
        let bit = bit(var);
        (bits & bit != 0).then(|| before + (bits & (bit - 1)).count_ones() as usize)
    }

    /// The empty subset.
    pub fn none(&self) -> BitRow {
        BitRow { bits: smallvec![0; self.vars.len().div_ceil(64)] }
    }

    /// All of it.
    pub fn all(&self) -> BitRow {
        let mut row = BitRow { bits: smallvec![u64::MAX; self.vars.len().div_ceil(64)] };
        if let (Some(word), over @ 1..) = (row.bits.last_mut(), self.vars.len() % 64) {
            *word = (1 << over) - 1;
        }
        row
    }

    /// The variables of these classes.
    pub fn classes(&self, test: impl Fn(Class) -> bool) -> BitRow {
        let mut row = self.none();
        self.vars.iter().enumerate().filter(|(_, v)| test(v.class)).for_each(|(at, _)| row.insert(at));
        row
    }

    /// The variables of a subset.
    pub fn members<'r>(&'r self, row: &'r BitRow) -> impl Iterator<Item = Var> + 'r {
        self.vars.iter().enumerate().filter(|(at, _)| row.has(*at)).map(|(_, var)| *var)
    }

    /// The variables, in order.
    pub fn vars(&self) -> &[Var] {
        &self.vars
    }
}

/// The place of a key among entries in its order, or where it would stand.
#[inline]
fn find<T>(entries: &[T], key: Key, of: impl Fn(&T) -> Key) -> Result<usize, usize> {
    // Programs name neighbours: the entries are few.
    if entries.len() > 8 {
        return entries.binary_search_by_key(&key, of);
    }
    let before = entries.iter().take_while(|entry| of(entry) < key).count();
    if entries.get(before).is_some_and(|entry| of(entry) == key) { Ok(before) } else { Err(before) }
}

impl Clone for BitRow {
    // The derived one copies word by word.
    fn clone(&self) -> Self {
        Self { bits: SmallVec::from_slice(&self.bits) }
    }
}

impl BitRow {
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
    pub fn join(&mut self, other: &BitRow) -> bool {
        let mut changed = false;
        for (word, more) in self.bits.iter_mut().zip(&other.bits) {
            changed |= *more & !*word != 0;
            *word |= more;
        }
        changed
    }

    /// Keeps what is in another too.
    pub fn intersect(&mut self, other: &BitRow) {
        self.bits.iter_mut().zip(&other.bits).for_each(|(word, keep)| *word &= keep);
    }

    /// Takes out all of another.
    pub fn subtract(&mut self, other: &BitRow) {
        self.bits.iter_mut().zip(&other.bits).for_each(|(word, less)| *word &= !less);
    }
}

/// Any set of variables: 64 neighbours of a class are a word.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct VarSet {
    /// In order, and none empty.
    words: Vec<(Key, u64)>,
}

impl VarSet {
    /// The variables that a program names.
    pub fn of(program: &Program) -> Self {
        let mut all = Self::default();
        program.variables(&mut |var| _ = all.insert(var));
        all
    }

    fn find(&self, key: Key) -> Result<usize, usize> {
        find(&self.words, key, |(key, _)| *key)
    }

    /// Adds a variable; true where it was not in.
    pub fn insert(&mut self, var: Var) -> bool {
        self.add(Key::of(var), bit(var))
    }

    fn add(&mut self, key: Key, more: u64) -> bool {
        match self.find(key) {
            Ok(at) => {
                let before = self.words[at].1;
                self.words[at].1 |= more;
                more & !before != 0
            }
            Err(at) => {
                self.words.insert(at, (key, more));
                true
            }
        }
    }

    /// True where the variable is in.
    pub fn contains(&self, var: Var) -> bool {
        self.find(Key::of(var)).is_ok_and(|at| self.words[at].1 & bit(var) != 0)
    }

    /// True where none is in.
    pub fn is_empty(&self) -> bool {
        self.words.is_empty()
    }

    /// Adds the variables of another that are of these classes; true where that changed it.
    pub fn join(&mut self, other: &Self, test: impl Fn(Class) -> bool) -> bool {
        let wanted = other.words.iter().filter(|(key, _)| test(key.first().class));
        wanted.fold(false, |changed, (key, more)| self.add(*key, *more) || changed)
    }

    /// Takes out the variables of a class.
    pub fn remove_class(&mut self, class: Class) {
        self.words.retain(|(key, _)| key.first().class != class);
    }

    /// The variables, in order.
    pub fn iter(&self) -> impl Iterator<Item = Var> + '_ {
        self.words.iter().flat_map(|(key, bits)| {
            let Var { class, number } = key.first();
            let set = (0..64).filter(move |bit| bits >> bit & 1 == 1);
            set.map(move |bit| Var { class, number: number + bit })
        })
    }
}

impl Extend<Var> for VarSet {
    fn extend<I: IntoIterator<Item = Var>>(&mut self, vars: I) {
        for var in vars {
            self.insert(var);
        }
    }
}

impl FromIterator<Var> for VarSet {
    fn from_iter<I: IntoIterator<Item = Var>>(vars: I) -> Self {
        let mut set = Self::default();
        set.extend(vars);
        set
    }
}
