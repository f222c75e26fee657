//! Sets of temporaries, which are alive for a few statements each: many sets of few.

use smallvec::SmallVec;

/// A set of temporaries, by number: some, or all but some.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Temps {
    /// True where `some` are those that are not in.
    but: bool,
    /// In order.
    some: SmallVec<[u32; 4]>,
}

impl Temps {
    /// All of them.
    pub fn all() -> Self {
        Self { but: true, some: SmallVec::new() }
    }

    /// True where none is in.
    pub fn is_empty(&self) -> bool {
        !self.but && self.some.is_empty()
    }

    /// True where one is in.
    pub fn has(&self, temp: u32) -> bool {
        self.some.binary_search(&temp).is_ok() != self.but
    }

    /// Adds one.
    pub fn insert(&mut self, temp: u32) {
        self.set(temp, true);
    }

    /// Takes one out.
    pub fn remove(&mut self, temp: u32) {
        self.set(temp, false);
    }

    fn set(&mut self, temp: u32, into: bool) {
        match self.some.binary_search(&temp) {
            Err(at) if into != self.but => self.some.insert(at, temp),
            Ok(at) if into == self.but => drop(self.some.remove(at)),
            _ => {}
        }
    }

    /// Adds all of another; true where that changed it.
    pub fn join(&mut self, other: &Self) -> bool {
        let before = (self.but, self.some.len());
        match (self.but, other.but) {
            (true, _) => self.some.retain(|temp| !other.has(*temp)),
            (false, false) => other.some.iter().for_each(|temp| self.insert(*temp)),
            (false, true) => {
                let left: SmallVec<_> = other.some.iter().copied().filter(|temp| !self.has(*temp)).collect();
                *self = Self { but: true, some: left };
            }
        }
        before != (self.but, self.some.len())
    }

    /// Adds all of several.
    pub fn join_all(&mut self, others: &[&Self]) {
        for other in others {
            self.join(other);
        }
    }

    /// Takes out all of another, which is not all but some.
    pub fn subtract(&mut self, other: &Self) {
        other.some.iter().for_each(|temp| self.remove(*temp));
    }

    /// Those that are in, where it is not all but some.
    pub fn iter(&self) -> impl Iterator<Item = u32> + '_ {
        self.some.iter().copied().filter(|_| !self.but)
    }
}

#[cfg(test)]
mod tests {
    use super::Temps;

    /// Five temporaries and one that stands for all others, as bits.
    const ALL: u32 = 0b11_1111;

    fn of(bits: u32) -> Temps {
        let mut temps = if bits >> 5 == 1 { Temps::all() } else { Temps::default() };
        (0..5).for_each(|temp| if bits >> temp & 1 == 1 { temps.insert(temp) } else { temps.remove(temp) });
        temps
    }

    fn bits(temps: &Temps) -> u32 {
        (0..5).chain([999]).enumerate().map(|(at, temp)| u32::from(temps.has(temp)) << at).sum()
    }

    #[test]
    fn are_sets() {
        for a in 0..=ALL {
            assert_eq!((bits(&of(a)), of(a).is_empty()), (a, a == 0));
            for b in 0..=ALL {
                let mut joined = of(a);
                assert_eq!(joined.join(&of(b)), a | b != a, "{a:b} {b:b}");
                assert_eq!(bits(&joined), a | b, "{a:b} {b:b}");
                if b >> 5 == 0 {
                    let mut less = of(a);
                    less.subtract(&of(b));
                    assert_eq!(bits(&less), a & !b, "{a:b} {b:b}");
                }
            }
        }
    }
}
