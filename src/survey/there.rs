//! Codes that the source's profile names and no code of the target does: which of its codes does the same, the target's profile says.

use super::Survey;
use super::filled::{ASKS, TELLS, plain};
use super::shape::{NAMED, Places};
use super::site_rows::{in_braces, key, said};
use crate::diag::Asks;
use crate::dialect::{Control, SiteCode};
use crate::library::ProgramReport;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

/// A name for which the target's profile has no code.
#[derive(Clone, Debug, PartialEq)]
pub struct AskedThere {
    /// The name: `chuck.clamp`.
    pub name: String,
    /// The code of the source.
    pub code: String,
    /// How many programs wait for it.
    pub programs: usize,
    /// The first places, as `file:line`.
    pub places: Vec<String>,
}

/// The names that programs wait for, those of most programs first.
pub(super) fn asked(places: &Places<'_>, source: &Control, programs: &[ProgramReport]) -> Vec<AskedThere> {
    let mut found: BTreeMap<String, (BTreeSet<usize>, Vec<String>)> = BTreeMap::new();
    for (at, program) in programs.iter().enumerate() {
        for finding in &program.diagnostics {
            let Some(Asks::There { name }) = finding.asks.as_deref() else { continue };
            let (waiting, named) = found.entry(name.to_string()).or_default();
            waiting.insert(at);
            let place = places.at(program.file, finding.span);
            if named.len() < NAMED && !named.contains(&place) {
                named.push(place);
            }
        }
    }
    let asked = found.into_iter().map(|(name, (programs, places))| {
        let code = site(source, &name).map(|site| site.code.clone()).unwrap_or_default();
        AskedThere { name, code, programs: programs.len(), places }
    });
    let mut asked: Vec<AskedThere> = asked.collect();
    asked.sort_by_key(|asked| std::cmp::Reverse(asked.programs));
    asked
}

/// The row of the source's profile that has a name.
fn site<'c>(source: &'c Control, name: &str) -> Option<&'c SiteCode> {
    source.profile().site.iter().find(|site| site.name.as_deref() == Some(name))
}

/// A line of the target's profile to fill in for each name.
pub(super) fn lines(survey: &Survey<'_>) -> String {
    let mut text = String::new();
    if survey.there.is_empty() {
        return text;
    }
    for told in [
        "Which codes of this machine do what these of the source do: its page of M codes says it. Write each between the quotes that",
        "stand first. Where it has none, leave the line out, and write do = \"omit\", \"stop\" or \"alarm\" at the source's code:",
        "docs/builders-codes.md.",
    ] {
        let _ = writeln!(text, "{TELLS} {told}");
    }
    for asked in &survey.there {
        let Some(site) = site(survey.controls[0], &asked.name) else { continue };
        let words: Vec<String> =
            site.words.iter().map(|(letter, name)| format!("{letter} = \"{name}\"")).collect();
        let by = if words.is_empty() { "" } else { "; its words by the letters of its code here" };
        let keys = [Some(format!("name = \"{}\"", asked.name)), said(&site.text), in_braces(&words)];
        let keys: Vec<String> = keys.into_iter().flatten().collect();
        let programs =
            if asked.programs == 1 { String::new() } else { format!("{} programs: ", asked.programs) };
        let about = format!("{} of the source; {programs}{}{by}", asked.code, asked.places.join(", "));
        let _ = writeln!(text, "{ASKS} {} = {{ {} }} # {}", key(""), keys.join(", "), plain(&about));
    }
    text
}

#[cfg(test)]
mod tests {
    use crate::dialect::{Control, Side};
    use crate::library::Input;
    use crate::survey::{filled, survey};

    const SOURCE: &str = "dialect = \"fanuc\"\nmachine = \"lathe\"\n[[site]]\ncode = \"M68\"\nname = \"chuck.clamp\"\ntext = \"clamps \
                          the chuck\"\n[[site]]\ncode = \"M50\"\nname = \"bar.feed\"\ntext = \"feeds the bar\"\nwords = { P = \"pieces\" }\n";

    fn target_of(target: &str) -> String {
        let source = Control::from_profile(SOURCE).unwrap();
        let there = Control::from_profile(target).unwrap();
        let text = "O1\nG21\nM68\nM50 P3\nM68\nM30\n";
        let inputs = [Input { path: "a.nc".into(), name: "a.nc".into(), bytes: text.into() }];
        let made = survey(&inputs, &source, Some(&there));
        assert!(made.answered.is_some_and(|outcomes| outcomes.refused == 0), "{:?}", made.stays);
        filled(&made, Side::Target, Some(target)).unwrap()
    }

    #[test]
    fn names_that_the_target_lacks_are_rows_of_its_profile() {
        let text = target_of("dialect = \"haas\"\nmachine = \"lathe\"\n");
        for line in [
            "#? \"\" = { name = \"chuck.clamp\", text = \"clamps the chuck\" } # M68 of the source; a.nc:3, a.nc:5",
            "#? \"\" = { name = \"bar.feed\", text = \"feeds the bar\", words = { P = \"pieces\" } } # M50 of the source; a.nc:4; its words by the letters of its code here",
        ] {
            assert_eq!(text.lines().filter(|found| *found == line).count(), 1, "{line} in {text}");
        }
    }

    #[test]
    fn names_that_it_has_are_not_asked() {
        let has = "dialect = \"haas\"\nmachine = \"lathe\"\n[[site]]\ncode = \"M10\"\nname = \"chuck.clamp\"\ntext = \"clamps\"\n";
        let text = target_of(has);
        assert!(
            !text.contains("name = \"chuck.clamp\", ") && text.contains("name = \"bar.feed\", "),
            "{text}"
        );
    }
}
