//! Sets of whole numbers: of variables, of blocks, of programs.

use std::fmt;

/// Whole numbers from 0 on, as runs in order that do not touch.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Numbers(Vec<(u32, u32)>);

impl Numbers {
    /// All of these runs, each from its first to its last.
    pub fn of(runs: impl IntoIterator<Item = (u32, u32)>) -> Self {
        let mut all: Vec<(u32, u32)> = runs.into_iter().filter(|(first, last)| first <= last).collect();
        all.sort_unstable();
        let mut merged: Vec<(u32, u32)> = Vec::with_capacity(all.len());
        for (first, last) in all {
            match merged.last_mut() {
                Some((_, end)) if first <= end.saturating_add(1) => *end = last.max(*end),
                _ => merged.push((first, last)),
            }
        }
        Self(merged)
    }

    /// The runs.
    pub fn runs(&self) -> &[(u32, u32)] {
        &self.0
    }

    /// True where there are none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The greatest.
    pub fn last(&self) -> Option<u32> {
        self.0.last().map(|(_, last)| *last)
    }

    /// True for a number among them.
    pub fn contains(&self, number: u32) -> bool {
        let at = self.0.partition_point(|(_, last)| *last < number);
        self.0.get(at).is_some_and(|(first, _)| *first <= number)
    }

    /// True where all of another are among them.
    pub fn holds(&self, other: &Self) -> bool {
        other.0.iter().all(|(first, last)| self.0.iter().any(|(from, to)| from <= first && last <= to))
    }

    /// Adds all of another.
    pub fn join(&mut self, other: &Self) {
        if !self.holds(other) {
            *self = Self::of(self.0.iter().chain(&other.0).copied());
        }
    }

    /// Without these.
    #[must_use]
    pub fn without(&self, taken: impl IntoIterator<Item = u32>) -> Self {
        let mut runs = self.0.clone();
        for number in taken {
            let Some(at) = runs.iter().position(|(first, last)| (*first..=*last).contains(&number)) else {
                continue;
            };
            let (first, last) = runs[at];
            let before = (first < number).then(|| (first, number - 1));
            let behind = (number < last).then(|| (number + 1, last));
            runs.splice(at..=at, before.into_iter().chain(behind));
        }
        Self(runs)
    }
}

impl Numbers {
    /// In words, where this stands before the number of a variable: `V1-V33, V100`. Runs of one length at one distance, as the
    /// axes of work offsets are, are told by the first and the last: `#5221-#5225 and so on by 20 to #5321-#5325`.
    pub fn in_words(&self, name: &str) -> String {
        self.words(name).join(", ")
    }

    /// The same, each range by itself.
    pub fn words(&self, name: &str) -> Vec<String> {
        let word = |(first, last): (u32, u32)| match first == last {
            true => format!("{name}{first}"),
            false => format!("{name}{first}-{name}{last}"),
        };
        let mut words = Vec::new();
        let mut rest = self.0.as_slice();
        while let [first, after @ ..] = rest {
            let alike = alike(rest);
            if alike >= SO_ON {
                let by = after[0].0 - first.0;
                words.push(format!("{} and so on by {by} to {}", word(*first), word(rest[alike - 1])));
                rest = &rest[alike..];
            } else {
                words.push(word(*first));
                rest = after;
            }
        }
        words
    }
}

/// From how many runs on the first and the last say it.
const SO_ON: usize = 4;

/// How many runs at the start have one length and one distance.
fn alike(runs: &[(u32, u32)]) -> usize {
    let [(first, last), (second, _), ..] = runs else { return runs.len() };
    let (length, by) = (last - first, second - first);
    let fits = |(at, (from, to)): &(usize, &(u32, u32))| {
        to - from == length && u64::from(*from) == u64::from(*first) + u64::from(by) * *at as u64
    };
    runs.iter().enumerate().take_while(fits).count()
}

/// As people write numbers of variables: `#1-#33, #100`.
impl fmt::Display for Numbers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.in_words("#"))
    }
}
