//! Variables by which programs that stand in a machine give their results, where those of another machine have other numbers.
//!
//! A profile says it as `standing_results = ["#135-#149 as #185-#199"]`: the numbers on the machine that programs come from, and those here.

use super::Control;
use super::overlay::Overlay;
use std::collections::BTreeSet;

/// What stands between the numbers of the source and those here.
const AS: &str = " as ";

/// Runs of such variables.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct StandingResults(Vec<Run>);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Run {
    /// The first and the last on the source.
    there: (u32, u32),
    /// The first here.
    here: u32,
}

impl Run {
    fn of(self, number: u32) -> Option<u32> {
        let (first, last) = self.there;
        (first..=last).contains(&number).then(|| self.here + (number - first))
    }

    fn last_here(self) -> u32 {
        self.here + (self.there.1 - self.there.0)
    }
}

impl StandingResults {
    /// The number here of a variable of the source; none if it is not said.
    pub fn of(&self, number: u32) -> Option<u32> {
        self.0.iter().find_map(|run| run.of(number))
    }

    /// True for a number that one of them has here, or has on the source.
    pub fn names(&self, number: u32) -> bool {
        self.of(number).is_some() || self.0.iter().any(|run| (run.here..=run.last_here()).contains(&number))
    }

    /// True where the cell `there` of the source and the cell `here` are no one variable, as one of them is such a result.
    pub fn parts(&self, there: u32, here: u32) -> bool {
        let goes = self.of(there);
        goes != Some(here)
            && (goes.is_some() || self.0.iter().any(|run| (run.here..=run.last_here()).contains(&here)))
    }

    /// The numbers that they have here.
    pub fn here(&self) -> impl Iterator<Item = u32> + '_ {
        self.0.iter().flat_map(|run| run.here..=run.last_here())
    }

    /// True if nothing is said.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Adds a variable of the source and its number here; false where that contradicts what is said.
    fn add(&mut self, there: u32, here: u32) -> bool {
        if let Some(known) = self.of(there) {
            return known == here;
        }
        match self.0.last_mut() {
            Some(run) if run.there.1.checked_add(1) == Some(there) && run.last_here() + 1 == here => {
                run.there.1 = there;
            }
            _ => self.0.push(Run { there: (there, there), here }),
        }
        true
    }
}

/// True for the number of a common variable.
fn is_common(control: &Control, number: u32) -> bool {
    control.numbered_class(number).is_some_and(|row| !matches!(row.class.as_str(), "local" | "letter"))
}

/// What the target's profile says of results, by the numbers of the cells that the source has: a control may number a variable twice.
///
/// # Errors
/// A line that names no common variable of the source, or one that another line gives another number: the line, and why.
pub(super) fn met(source: &Control, target: &Control) -> Result<StandingResults, (String, String)> {
    let (name, title) = (target.numbered().unwrap_or_default(), &source.dialect().title);
    let mut all = StandingResults::default();
    for text in &target.profile.standing_results {
        let Some(run) = read(text, name) else { continue };
        for number in run.there.0..=run.there.1 {
            let cell = source.numbered().map_or(number, |space| source.cell(space, number));
            if !is_common(source, cell) {
                let why = format!("'{text}': the source, {title}, has no common variable {name}{number}");
                return Err((text.clone(), why));
            }
            let here = run.here + (number - run.there.0);
            if !all.add(cell, target.cell(name, here)) {
                let what = match cell == number {
                    true => format!("another line gives {name}{number} another number"),
                    false => {
                        format!("{name}{number} is {name}{cell}, to which another line gives another number")
                    }
                };
                return Err((text.clone(), format!("'{text}': {what}")));
            }
        }
    }
    Ok(all)
}

/// The most variables of a run: no maker's macros have more.
const LONGEST: u32 = 200;

/// `#135-#149 as #185-#199`, or `#135 as #185`.
fn read(text: &str, name: &str) -> Option<Run> {
    let (there, here) = text.split_once(AS)?;
    let ((first, last), (here, last_here)) = (run(there, name)?, run(here, name)?);
    let same = last.checked_sub(first)? == last_here.checked_sub(here)? && last - first < LONGEST;
    (same && first > 0 && here > 0).then_some(Run { there: (first, last), here })
}

fn run(text: &str, name: &str) -> Option<(u32, u32)> {
    match text.trim().split_once('-') {
        Some((first, last)) => Some((number(first, name)?, number(last, name)?)),
        None => number(text, name).map(|number| (number, number)),
    }
}

fn number(text: &str, name: &str) -> Option<u32> {
    let digits = text.trim().strip_prefix(name)?;
    digits.bytes().all(|digit| digit.is_ascii_digit()).then(|| digits.parse().ok()).flatten()
}

impl Overlay {
    /// The results of programs that stand in the machine. `name` stands before a variable's number, and `cell` gives the cell that
    /// a number of a common variable names.
    pub(super) fn standing_results(
        &mut self,
        name: Option<&str>,
        cell: &dyn Fn(u32) -> Option<u32>,
    ) -> StandingResults {
        let (mut all, mut cells) = (StandingResults::default(), BTreeSet::new());
        for text in self.profile.standing_results.clone() {
            let name = name.unwrap_or_default();
            let form = format!(
                "write '{name}135-{name}149 as {name}185-{name}199': those of the old machine, and those of this one"
            );
            let fault = match read(&text, name).filter(|_| !name.is_empty()) {
                None => Some((format!("'{text}' is no run of variables and its numbers here"), form)),
                Some(run) => {
                    let missing = (run.here..=run.last_here()).find(|number| cell(*number).is_none());
                    let twice = (run.there.0..=run.there.1).any(|number| all.of(number).is_some())
                        || (run.here..=run.last_here()).filter_map(cell).any(|cell| cells.contains(&cell));
                    match (missing, twice) {
                        (Some(number), _) => Some((
                            format!("'{text}': this control has no common variable {name}{number}"),
                            "name those in which the machine's programs put their results".into(),
                        )),
                        (None, true) => Some((
                            format!("'{text}' contradicts what stands before it"),
                            "name each variable once".into(),
                        )),
                        (None, false) => {
                            cells.extend((run.here..=run.last_here()).filter_map(cell));
                            for number in run.there.0..=run.there.1 {
                                let here = run.here + (number - run.there.0);
                                all.add(number, cell(here).unwrap_or(here));
                            }
                            None
                        }
                    }
                }
            };
            if let Some((message, help)) = fault {
                self.fault(&format!("standing_results:{text}"), message, help);
            }
        }
        all
    }
}

impl Control {
    /// The results of programs that stand in this machine, by their numbers on the machine that programs come from.
    pub fn standing_results(&self) -> &StandingResults {
        &self.standing_results
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn made(entries: &str) -> Result<Control, String> {
        let text = format!("dialect = \"haas\"\nstanding_results = [{entries}]\n");
        let fault = |faults: Vec<_>| super::super::faults_as_text("p.toml", &text, &faults);
        Control::from_profile(&text).map_err(fault)
    }

    #[test]
    fn runs_have_their_numbers_one_by_one() {
        let control = made("\"#135-#149 as #185-#199\", \"#131 as #180\"").expect("a profile");
        let results = control.standing_results();
        assert_eq!([135, 140, 149, 131].map(|number| results.of(number)), [185, 190, 199, 180].map(Some));
        assert_eq!([134, 150, 185, 180].map(|number| results.of(number)), [None; 4]);
        assert!(results.names(185) && results.names(135) && !results.names(184));
        assert_eq!(results.here().count(), 16);
        // One that moves, one that is moved to, others, and one with its own place.
        let parts = [(138, 138), (188, 188), (130, 130), (184, 184), (138, 188)];
        assert_eq!(parts.map(|(there, here)| results.parts(there, here)), [true, true, false, false, false]);
    }

    #[test]
    fn what_is_no_such_run_is_a_fault() {
        let bad = [
            "#135",
            "#135-#149 as #185",
            "135 as 185",
            "#149-#135 as #199-#185",
            "#1 as #0",
            "#135 as V5",
            "#1-#900 as #100-#999",
        ];
        for entry in bad {
            let fault = made(&format!("\"{entry}\"")).expect_err("a fault");
            assert!(fault.contains(&format!("'{entry}' is no run of variables")), "{fault}");
        }
        assert!(made("\"#135 as #5\"").expect_err("a local").contains("no common variable #5"));
        assert!(made("\"#135 as #185\", \"#135 as #186\"").expect_err("twice").contains("contradicts"));
        assert!(made("\"#135 as #185\", \"#136 as #185\"").expect_err("twice").contains("contradicts"));
    }
}
