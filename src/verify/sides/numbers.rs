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
        let texts = || files.iter().map(|file| file.parsed.source);
        let computes = |text| control.classes().iter().any(|class| computes(text, class.name.as_bytes()));
        if texts().any(computes) {
            return Self { named: None };
        }
        // A builder's code may read and set variables that only the machine's profile names.
        let sites = control.profile().site.iter();
        let by_codes = sites.flat_map(|code| code.reads.keys().chain(code.sets.keys())).map(String::as_bytes);
        Self { named: Some(texts().chain(by_codes).flat_map(numbers).collect()) }
    }

    /// True if a text may mean a variable of this number or of one beside it, as the ends of a range do, and for one of
    /// several others; `place` is its place among all.
    pub fn may_mean(&self, number: u32, place: usize) -> bool {
        let Some(named) = &self.named else { return true };
        let beside = number.saturating_sub(1)..=number.saturating_add(1);
        place.is_multiple_of(ONE_IN) || named.range(beside).next().is_some()
    }
}

/// The whole numbers that stand in a text; what has more digits than the number of a variable is none.
fn numbers(text: &[u8]) -> impl Iterator<Item = u32> + '_ {
    let all = text.split(|sign| !sign.is_ascii_digit()).filter(|digits| !digits.is_empty());
    all.filter_map(|digits| str::from_utf8(digits).ok()?.parse().ok())
}

/// True where something follows the name of a variable, in letters of either case, that computes its number.
fn computes(text: &[u8], name: &[u8]) -> bool {
    let Some(first) = name.first() else { return false };
    memchr::memchr2_iter(first.to_ascii_lowercase(), first.to_ascii_uppercase(), text).any(|at| {
        let (name_there, after) =
            text.get(at..).and_then(|rest| rest.split_at_checked(name.len())).unwrap_or_default();
        name_there.eq_ignore_ascii_case(name)
            && after.trim_ascii_start().first().is_some_and(|sign| COMPUTED.contains(sign))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::syntax::parse_file;

    fn of(text: &str) -> Numbers {
        on(&Control::plain("fanuc").unwrap(), text)
    }

    fn on(control: &Control, text: &str) -> Numbers {
        let parsed = parse_file(text.as_bytes(), control.entry().parse);
        Numbers::of(control, &[LoadedFile { name: "a.nc", parsed: &parsed }])
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
        // A Fadal takes small letters.
        let fadal = Control::plain("fadal").unwrap();
        assert!(on(&fadal, "#v(r1)=1\nM2\n").may_mean(777, 1));
        assert!(!on(&fadal, "#v1=1\nM2\n").may_mean(777, 1));
    }

    #[test]
    fn a_builders_code_may_mean_what_the_profile_names() {
        let profile = "dialect = \"fanuc\"\n[[site]]\ncode = \"M150\"\nname = \"air\"\ntext = \"reads the air\"\n\
                       sets = { \"#777\" = \"pressure\" }\n";
        let control = Control::from_profile(profile).unwrap();
        assert!(on(&control, "O1\nM150\nM30\n").may_mean(777, 1));
        assert!(!on(&control, "O1\nM150\nM30\n").may_mean(770, 1));
    }
}
