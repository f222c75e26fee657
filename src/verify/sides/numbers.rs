//! Which variables the texts of a library may mean, by their numbers alone.

use crate::control::LoadedFile;
use crate::dialect::Control;
use std::collections::BTreeSet;

/// Signs after the name of a variable that begin a computed number.
const COMPUTED: &[u8] = b"[(#<_";

/// Of variables that no text names one in so many is looked at: what clears them clears them all.
const ONE_IN: usize = 8;

/// The numbers that stand in the texts of a library: more than those of variables, never fewer.
#[derive(Debug)]
pub struct Numbers {
    /// None if a text computes the number of a variable, so that any may be meant.
    named: Option<BTreeSet<u32>>,
}

impl Numbers {
    /// Those of files.
    pub fn of(control: &Control, files: &[LoadedFile<'_>]) -> Self {
        let mut named = BTreeSet::new();
        for file in files {
            let text = file.parsed.source;
            if control.classes().iter().any(|class| computes(text, class.name.as_bytes())) {
                return Self { named: None };
            }
            for digits in text.split(|sign| !sign.is_ascii_digit()).filter(|digits| !digits.is_empty()) {
                // What has more digits than a number of a variable is none.
                let number = digits.iter().try_fold(0_u32, |number, sign| {
                    number.checked_mul(10)?.checked_add(u32::from(sign - b'0'))
                });
                named.extend(number);
            }
        }
        Self { named: Some(named) }
    }

    /// True if a text may mean a variable of this number or of one beside it, as the ends of a range do, and for one of
    /// several others; `place` is its place among all.
    pub fn may_mean(&self, number: u32, place: usize) -> bool {
        let Some(named) = &self.named else { return true };
        let beside = number.saturating_sub(1)..=number.saturating_add(1);
        place.is_multiple_of(ONE_IN) || named.range(beside).next().is_some()
    }
}

/// True where something follows the name of a variable that computes its number.
fn computes(text: &[u8], name: &[u8]) -> bool {
    let Some(first) = name.first() else { return false };
    memchr::memchr_iter(*first, text).any(|at| {
        let after = text.get(at..).and_then(|rest| rest.strip_prefix(name)).unwrap_or_default();
        after.trim_ascii_start().first().is_some_and(|sign| COMPUTED.contains(sign))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::syntax::parse_file;

    fn of(text: &str) -> Numbers {
        let control = Control::plain("fanuc").unwrap();
        let parsed = parse_file(text.as_bytes(), control.entry().parse);
        Numbers::of(&control, &[LoadedFile { name: "a.nc", parsed: &parsed }])
    }

    #[test]
    fn numbers_of_a_text_and_those_beside_them_may_be_meant() {
        let numbers = of("O1\n#0105=1\nG65 P9000 A107\nM30\n");
        let meant: Vec<u32> = (100..112).filter(|number| numbers.may_mean(*number, 1)).collect();
        assert_eq!(meant, [104, 105, 106, 107, 108]);
        assert!(numbers.may_mean(300, 8), "one in eight of the others");
    }

    #[test]
    fn any_may_be_meant_where_a_number_is_computed() {
        for text in ["O1\n#[#1+500]=1\nM30\n", "O1\n##1=1\nM30\n", "O1\nX# [#1]\nM30\n"] {
            assert!(of(text).may_mean(777, 1), "{text}");
        }
        assert!(!of("O1\n#1=[2]\nM30\n").may_mean(777, 1));
    }
}
