//! Inputs and outputs that programs read or switch, and no profile says by which wire the target knows them.

use super::Survey;
use super::filled::{ASKS, TELLS, plain};
use super::shape::{NAMED, Places};
use crate::canon::Sys;
use crate::diag::Asks;
use crate::dialect::{Control, Profile, Signal};
use crate::library::ProgramReport;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

/// A signal of which the target's profile must say the wire.
#[derive(Clone, Debug, PartialEq)]
pub struct AskedSignal {
    /// True for an input.
    pub input: bool,
    /// The number by which programs know it.
    pub number: u32,
    /// How many programs wait for it.
    pub programs: usize,
    /// The first places, as `file:line`.
    pub places: Vec<String>,
}

impl AskedSignal {
    /// True for the same signal.
    pub(super) fn is(&self, other: &Self) -> bool {
        (self.input, self.number) == (other.input, other.number)
    }
}

/// The signals that programs wait for, in the order of their numbers.
pub(super) fn asked(places: &Places<'_>, programs: &[ProgramReport]) -> Vec<AskedSignal> {
    let mut found: BTreeMap<(bool, u32), (BTreeSet<usize>, Vec<String>)> = BTreeMap::new();
    for (at, program) in programs.iter().enumerate() {
        for finding in &program.diagnostics {
            let Some(Asks::Signal { input, number }) = finding.asks.as_deref() else { continue };
            let (waiting, named) = found.entry((*input, *number)).or_default();
            waiting.insert(at);
            let place = places.at(program.file, finding.span);
            if named.len() < NAMED && !named.contains(&place) {
                named.push(place);
            }
        }
    }
    let asked = found.into_iter().map(|((input, number), (programs, places))| AskedSignal {
        input,
        number,
        programs: programs.len(),
        places,
    });
    asked.collect()
}

/// The profile with a table to fill in for each signal, after all that stands there.
pub(super) fn asked_in(text: &str, survey: &Survey<'_>) -> String {
    let mut text = text.to_owned();
    if survey.signals.is_empty() {
        return text;
    }
    for told in [
        "Which input or output of this machine has the wire that programs of the other one know by a number: the electrical drawing",
        "says it. Write its own number here in place of the first; on = 0 or on = 1 says what it shows when the signal is on, where that is not as the manual has it.",
    ] {
        let _ = writeln!(text, "{TELLS} {told}");
    }
    let control = survey.controls[1];
    for (asked, wire) in wires(control, &survey.signals, control.profile()) {
        let kind = if asked.input { "input" } else { "output" };
        let programs =
            if asked.programs == 1 { String::new() } else { format!("{} programs: ", asked.programs) };
        let _ = writeln!(text, "{ASKS} [[signal]]");
        let _ = writeln!(text, "{ASKS} {kind} = {wire} # or another one");
        let about = plain(&format!("{programs}{}", asked.places.join(", ")));
        let _ = writeln!(text, "{ASKS} number = {} # {about}", asked.number);
    }
    text
}

/// Gives each signal a wire that no other one has.
pub(super) fn answer(control: &Control, signals: &[AskedSignal], profile: &mut Profile) {
    for (asked, wire) in wires(control, signals, &profile.clone()) {
        let (input, output) = if asked.input { (Some(wire), None) } else { (None, Some(wire)) };
        profile.signal.push(Signal { input, output, number: asked.number, on: None, text: None });
    }
}

/// A wire for each signal that nothing in the profile has, as far as there are any: the last ones, as programs name the
/// first ones most.
fn wires<'s>(
    control: &Control,
    signals: &'s [AskedSignal],
    profile: &Profile,
) -> Vec<(&'s AskedSignal, u32)> {
    let mut bare = profile.clone();
    bare.signal.clear();
    let Ok(bare) = Control::new(control.entry(), bare) else { return Vec::new() };
    let taken = |own: fn(&Signal) -> Option<u32>| profile.signal.iter().filter_map(own).collect::<Vec<u32>>();
    let mut free = [(true, taken(|signal| signal.input)), (false, taken(|signal| signal.output))]
        .map(|(input, taken)| numbers(&bare, input).filter(move |number| !taken.contains(number)));
    let wired = signals.iter().filter_map(|asked| {
        let [inputs, outputs] = &mut free;
        let wire = if asked.input { inputs.next() } else { outputs.next() };
        Some((asked, wire?))
    });
    wired.collect()
}

/// The numbers that a control has for its inputs, or its outputs, the last one first.
fn numbers(control: &Control, input: bool) -> impl Iterator<Item = u32> + use<> {
    let states = match input {
        true => [Sys::Input, Sys::InputInverted],
        false => [Sys::Output, Sys::OutputInverted],
    };
    let rows = states.into_iter().flat_map(|state| control.system_runs(state));
    let counted = rows.filter_map(|row| row.subscripts.first().map(|run| run.from..run.from + run.count));
    let mut numbers: Vec<u32> = counted.flatten().collect();
    numbers.sort_unstable();
    numbers.into_iter().rev()
}

#[cfg(test)]
mod tests {
    use crate::dialect::{Control, Side};
    use crate::library::Input;
    use crate::survey::{filled, survey};

    #[test]
    fn wires_that_nobody_names_are_tables_to_fill_in() {
        let source =
            Control::from_profile("dialect = \"fanuc\"\nmachine = \"mill\"\nunits = \"metric\"\n").unwrap();
        let profile = "dialect = \"fadal\"\nmachine = \"mill\"\nunits = \"metric\"\n[[signal]]\ninput = 1\nnumber = 1\n";
        let target = Control::from_profile(profile).unwrap();
        let text = "O1\nG21\nIF[#1000EQ1]GOTO5\nIF[#1001EQ1]GOTO5\nIF[#1030EQ1]GOTO5\nN5\nM30\n";
        let inputs = [Input { path: "a.nc".into(), name: "a.nc".into(), bytes: text.into() }];
        let made = survey(&inputs, &source, Some(&target));
        assert!(made.answered.is_some_and(|outcomes| outcomes.refused == 0), "{:?}", made.stays);
        let text = filled(&made, Side::Target, Some(profile)).unwrap();
        for (number, wire) in [(0, 29), (30, 28)] {
            let lines =
                format!("#? [[signal]]\n#? input = {wire} # or another one\n#? number = {number} # a.nc:");
            assert!(text.contains(&lines), "{text}");
        }
        assert!(!text.contains("#? number = 1 "), "{text}");
        // The same again says the same.
        let again = survey(&inputs, &source, Some(&target));
        assert_eq!(filled(&again, Side::Target, Some(&text)).unwrap(), text);
    }
}
