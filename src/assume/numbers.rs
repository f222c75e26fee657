//! Numbers of variables.

use crate::text::Span;

/// Runs of numbers, both ends among them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Numbers(Vec<(u32, u32)>);

impl Numbers {
    /// Runs in any order.
    pub fn new(runs: impl IntoIterator<Item = (u32, u32)>) -> Self {
        let mut runs: Vec<(u32, u32)> = runs.into_iter().filter(|(first, last)| first <= last).collect();
        runs.sort_unstable();
        Self(runs)
    }

    /// True for a number in one of the runs.
    pub fn contains(&self, number: u32) -> bool {
        self.0.iter().any(|(first, last)| (*first..=*last).contains(&number))
    }

    /// How far a number is from the nearest run: 0 in one of them.
    pub fn distance(&self, number: u32) -> f64 {
        let far = |&(first, last): &(u32, u32)| first.saturating_sub(number).max(number.saturating_sub(last));
        self.0.iter().map(far).min().map_or(f64::MAX, f64::from)
    }

    /// The runs.
    pub fn runs(&self) -> &[(u32, u32)] {
        &self.0
    }
}

/// Variables whose number is computed.
#[derive(Clone, Debug, PartialEq)]
pub struct Subscripts {
    /// The blocks that compute it.
    pub places: Vec<Span>,
    /// The numbers that the conversion holds for.
    pub safe: Numbers,
    /// What is added to values of the program to give numbers, as far as that is known.
    pub bases: Vec<f64>,
}

impl Subscripts {
    /// Values that make the number each end of the safe runs, one inside, one just outside, and each of the `held`
    /// registers that are taken to be safe.
    pub fn telling_numbers(&self, held: &[u32]) -> Vec<f64> {
        let of = |&(first, last): &(u32, u32)| {
            [first.saturating_sub(1), first, first + (last - first) / 2, last, last.saturating_add(1)]
        };
        let held = held.iter().copied().filter(|number| self.safe.contains(*number));
        let numbers: Vec<u32> = held.chain(self.safe.0.iter().flat_map(of)).collect();
        let value = |base: &f64| numbers.iter().map(|number| f64::from(*number) - base).collect::<Vec<_>>();
        self.bases.iter().flat_map(value).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_the_inside_and_what_lies_outside_are_tried() {
        let safe = Numbers::new([(2001, 2199), (100, 199), (5, 4)]);
        assert_eq!(safe.runs(), [(100, 199), (2001, 2199)]);
        assert!(safe.contains(199) && !safe.contains(200) && !safe.contains(2000));
        assert_eq!([7, 100, 210, 2300].map(|number| safe.distance(number)), [93.0, 0.0, 11.0, 101.0]);
        let subscripts = Subscripts { places: Vec::new(), safe, bases: vec![100.0] };
        let told = subscripts.telling_numbers(&[107, 300]);
        assert_eq!(told, [7.0, -1.0, 0.0, 49.0, 99.0, 100.0, 1900.0, 1901.0, 2000.0, 2099.0, 2100.0]);
    }
}
