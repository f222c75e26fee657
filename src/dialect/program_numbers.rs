//! The numbers that a profile leaves to programs of other machines: `program_numbers = ["O1000-O1999", "O9723"]`.

use super::Control;
use super::overlay::Overlay;
use super::standing::run_of;

impl Overlay {
    /// The runs of numbers, in the order of the profile.
    pub(super) fn program_numbers(&mut self, program_max: u32) -> Vec<(u32, u32)> {
        let mut runs = Vec::new();
        for text in self.profile.program_numbers.clone() {
            let fault = match run_of(&text) {
                None => Some(format!("'{text}' is not a number of a program or a run of them")),
                Some((first, last)) if first == 0 || first > last => {
                    Some(format!("'{text}' holds no number that a program may have"))
                }
                Some((_, last)) if last > program_max => {
                    Some(format!("'{text}': the program numbers of this control end at O{program_max}"))
                }
                Some(run) => {
                    runs.push(run);
                    None
                }
            };
            if let Some(message) = fault {
                let help = "write 'O1000-O1999', or 'O9723'".to_owned();
                self.fault(&format!("program_numbers:{text}"), message, help);
            }
        }
        runs
    }
}

impl Control {
    /// First and last number of each run that programs get here which have no number, or another one, on their own machine; empty if
    /// they may have any. A number by itself only says that it is free.
    pub fn program_numbers(&self) -> impl Iterator<Item = (u32, u32)> + '_ {
        self.program_numbers.iter().copied().filter(|(first, last)| first < last)
    }

    /// True if the profile leaves this number to programs of other machines by name.
    pub fn leaves_number(&self, number: u32) -> bool {
        self.program_numbers.iter().any(|(first, last)| (*first..=*last).contains(&number))
    }
}

#[cfg(test)]
mod tests {
    use crate::dialect::{Control, faults_as_text};

    fn made(list: &str) -> Result<Control, String> {
        let text = format!("dialect = \"haas\"\nprogram_numbers = [{list}]\n");
        Control::from_profile(&text).map_err(|faults| faults_as_text("p.toml", &text, &faults))
    }

    #[test]
    fn runs_and_single_numbers_are_left_to_programs() {
        let control = made("\"O1000-O1999\", \"O9723\"").expect("a profile");
        assert_eq!(control.program_numbers().collect::<Vec<_>>(), [(1000, 1999)]);
        let left = [999, 1000, 1999, 2000, 9723].map(|number| control.leaves_number(number));
        assert_eq!(left, [false, true, true, false, true]);
    }

    #[test]
    fn what_is_no_run_is_a_fault() {
        for (entry, what) in [
            ("\"1000\"", "is not a number of a program"),
            ("\"O2000-O1000\"", "holds no number"),
            ("\"O0\"", "holds no number"),
            ("\"O1000-O100000\"", "end at O99999"),
        ] {
            let fault = made(entry).expect_err("a fault");
            assert!(fault.contains(what), "{fault}");
        }
    }
}
