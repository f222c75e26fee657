//! Programs that stand in a machine and are no part of a library: probing, tool setting, the builder's own.
//!
//! A profile that names one says that it does there, with the same arguments and variables, the same as the program of
//! that number on the machine that the calls come from.

use super::Control;
use super::overlay::Overlay;
use std::collections::BTreeMap;

/// What stands between the number on the source and another one on the target.
const AS: &str = " as ";

/// Programs that stand in a machine.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Standing {
    /// First and last number of each run, with its place in the profile.
    runs: Vec<(u32, u32)>,
    /// Those that have another number on the source, by that number.
    others: BTreeMap<u32, u32>,
}

impl Standing {
    /// The number here of the program that calls on the source name so; none if it does not stand here.
    pub fn number_of(&self, source: u32) -> Option<u32> {
        let same = || self.holds(source).then_some(source);
        self.others.get(&source).copied().or_else(same)
    }

    /// The number by which calls on the source name the program of a number here.
    pub fn source_of(&self, here: u32) -> Option<u32> {
        let other = self.others.iter().find(|(_, number)| **number == here).map(|(source, _)| *source);
        other.or_else(|| (self.holds(here) && !self.others.contains_key(&here)).then_some(here))
    }

    /// True where a program of this number stands here, whatever the source calls it.
    pub fn is_taken(&self, here: u32) -> bool {
        self.holds(here) || self.others.values().any(|number| *number == here)
    }

    /// True if there are none.
    pub fn is_empty(&self) -> bool {
        self.runs.is_empty() && self.others.is_empty()
    }

    /// True if any of them has this number or a higher one.
    pub fn any_from(&self, number: u32) -> bool {
        self.runs.iter().any(|(_, last)| *last >= number) || self.others.values().any(|here| *here >= number)
    }

    fn holds(&self, number: u32) -> bool {
        self.runs.iter().any(|(first, last)| (*first..=*last).contains(&number))
    }

    /// What names a program of this number here by itself, or as one of another number on the source; none if it is not
    /// named, or in a run of several.
    pub fn entry_of(&self, number: u32) -> Option<String> {
        let single = || self.runs.contains(&(number, number)).then(|| format!("O{number}"));
        let other = self.others.iter().find(|(source, here)| **source == number || **here == number);
        other.map(|(source, here)| format!("O{source} as O{here}")).or_else(single)
    }
}

/// What one entry says.
enum Entry {
    Run(u32, u32),
    As(u32, u32),
}

/// `O9810`, `O9700-O9999` or `O910002 as O8006`.
fn read(text: &str) -> Option<Entry> {
    if let Some((source, here)) = text.split_once(AS) {
        return Some(Entry::As(number(source)?, number(here)?));
    }
    match text.split_once('-') {
        None => number(text).map(|number| Entry::Run(number, number)),
        Some((first, last)) => {
            let last = last.trim();
            Some(Entry::Run(number(first)?, number(last).or_else(|| digits(last))?))
        }
    }
}

/// First and last number of a run of programs: `O9810` or `O9700-O9999`.
pub(super) fn run_of(text: &str) -> Option<(u32, u32)> {
    match read(text)? {
        Entry::Run(first, last) => Some((first, last)),
        Entry::As(..) => None,
    }
}

fn number(text: &str) -> Option<u32> {
    digits(text.trim().strip_prefix(['O', 'o'])?)
}

fn digits(text: &str) -> Option<u32> {
    text.bytes().all(|digit| digit.is_ascii_digit()).then(|| text.parse().ok()).flatten()
}

impl Overlay {
    /// The programs that the profile says to stand in the machine.
    pub(super) fn standing(&mut self, program_max: u32, has_locals: bool) -> Standing {
        let mut standing = Standing::default();
        if !self.profile.programs.is_empty() && !has_locals {
            let message = "calls give no arguments on this control, and its variables are others than those of \
                           another control: no program in it does with them the same as one there";
            self.fault(
                "programs",
                message.into(),
                "take the line out, and convert these programs too".into(),
            );
            return standing;
        }
        for text in self.profile.programs.clone() {
            if let Err((message, help)) = take(&mut standing, &text, program_max) {
                self.fault(&format!("programs:{text}"), message, help.into());
            }
        }
        standing
    }
}

fn take(standing: &mut Standing, text: &str, program_max: u32) -> Result<(), (String, &'static str)> {
    let form = "write 'O9810', 'O9700-O9999', or 'O910002 as O8006' where the source has another number";
    let entry =
        read(text).ok_or_else(|| (format!("'{text}' is not a program or a run of programs"), form))?;
    let (first, last) = match entry {
        Entry::Run(first, last) => (first, last),
        Entry::As(_, here) => (here, here),
    };
    if first > last {
        return Err((format!("'{text}' holds no program: its last number is before its first"), form));
    }
    if first == 0 || matches!(entry, Entry::As(0, _)) {
        return Err((format!("'{text}': no program has the number 0"), form));
    }
    if last > program_max {
        let help = "where a program has another number on this machine, write both: 'O910002 as O8006'";
        return Err((format!("'{text}': the program numbers of this control end at O{program_max}"), help));
    }
    match entry {
        Entry::Run(first, last) => standing.runs.push((first, last)),
        Entry::As(source, here) if source == here => standing.runs.push((here, here)),
        Entry::As(source, here) => {
            let other = standing.others.insert(source, here).is_some_and(|other| other != here);
            let same = standing.others.iter().any(|(from, to)| *from != source && *to == here);
            if other || same {
                let help = "name each program once";
                return Err((format!("'{text}' contradicts what stands before it"), help));
            }
        }
    }
    // A number that the source calls by another one is no longer what the source has under it.
    let clash = standing.others.iter().find(|(source, here)| {
        let single = |number: &u32| standing.runs.contains(&(*number, *number));
        single(source) || single(here)
    });
    match clash {
        Some((source, here)) => Err((
            format!("O{source} is said to be O{here} here, and one of the two is named by itself too"),
            "name each program once",
        )),
        None => Ok(()),
    }
}

impl Control {
    /// The programs that stand in the machine.
    pub fn standing(&self) -> &Standing {
        &self.standing
    }
}

#[cfg(test)]
mod tests {
    use crate::dialect::{Control, faults_as_text};

    fn standing(list: &str) -> Result<Control, String> {
        let text = format!("dialect = \"haas\"\nprograms = [{list}]\n");
        Control::from_profile(&text).map_err(|faults| faults_as_text("p.toml", &text, &faults))
    }

    #[test]
    fn programs_have_a_number_on_each_machine() {
        let control = standing("\"O9700-O9999\", \"O8006\", \"O910002 as O8007\", \"o7000-7002\"").unwrap();
        let of = |number| control.standing().number_of(number);
        assert_eq!(
            [of(9700), of(9999), of(8006), of(7002)],
            [Some(9700), Some(9999), Some(8006), Some(7002)]
        );
        assert_eq!([of(910_002), of(8007), of(9699), of(10_000)], [Some(8007), None, None, None]);
        let from = |number| control.standing().source_of(number);
        assert_eq!([from(8007), from(9810), from(910_002)], [Some(910_002), Some(9810), None]);
        assert!(control.standing().is_taken(8007) && !control.standing().is_taken(8008));
    }

    #[test]
    fn nonsense_is_wrong_with_its_line() {
        for (list, expected) in [
            ("\"9810\"", "p.toml:2:13: MG0203: '9810' is not a program or a run of programs"),
            ("\"O9810\", \"OABC\"", "p.toml:2:22: MG0203: 'OABC' is not a program"),
            ("\"O9999-O9700\"", "'O9999-O9700' holds no program"),
            ("\"O0\"", "no program has the number 0"),
            ("\"O0 as O8006\"", "no program has the number 0"),
            ("\"O910002\"", "'O910002': the program numbers of this control end at O99999"),
            ("\"O9000-O100000\"", "end at O99999"),
            ("\"O9810 as O8006\", \"O9811 as O8006\"", "contradicts"),
            ("\"O9810 as O8006\", \"O9810 as O8007\"", "contradicts"),
            ("\"O9810 as O8006\", \"O9810\"", "named by itself too"),
            ("\"O8006\", \"O9810 as O8006\"", "named by itself too"),
            ("\"O99999999999999999999\"", "is not a program"),
            ("\"\"", "is not a program"),
        ] {
            let text = standing(list).map(|_| ()).unwrap_err();
            assert!(text.contains(expected), "{list}: {text}");
        }
        for dialect in ["fadal", "cc100"] {
            let text = format!("dialect = \"{dialect}\"\nprograms = [\"O9810\"]\n");
            let faults = Control::from_profile(&text).map(|_| ()).unwrap_err();
            let text = faults_as_text("p.toml", &text, &faults);
            assert!(text.contains("p.toml:2:12: MG0203: calls give no arguments on this control"), "{text}");
        }
    }
}
