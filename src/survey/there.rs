//! Codes that the source's profile names and no code of the target does, and what the target's table has no code for: which of its
//! codes does the same, the target's profile says.

use super::Survey;
use super::filled::{ASKS, TELLS, plain};
use super::shape::{NAMED, Places};
use super::site_rows::{in_braces, key, said};
use crate::canon::Op;
use crate::diag::Asks;
use crate::dialect::{Control, SiteCode};
use crate::library::ProgramReport;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

/// A name, or an operation, for which the target has no code.
#[derive(Clone, Debug, PartialEq)]
pub struct AskedThere {
    /// The name: `chuck.clamp`.
    pub name: String,
    /// What it does, if the tables have a name for it and no profile.
    pub op: Option<Op>,
    /// The code of the source.
    pub code: String,
    /// How many programs wait for it.
    pub programs: usize,
    /// The first places, as `file:line`.
    pub places: Vec<String>,
}

/// The programs that wait for a code, and the first places.
type Waiting = (BTreeSet<usize>, Vec<String>);

/// The names that programs wait for, those of most programs first.
pub(super) fn asked(places: &Places<'_>, source: &Control, programs: &[ProgramReport]) -> Vec<AskedThere> {
    let mut found: BTreeMap<(String, Option<Op>), Waiting> = BTreeMap::new();
    for (at, program) in programs.iter().enumerate() {
        for finding in &program.diagnostics {
            let asked = match finding.asks.as_deref() {
                Some(Asks::There { name }) => (name.to_string(), None),
                Some(Asks::OpThere { op }) => (op.to_string(), Some(*op)),
                _ => continue,
            };
            let (waiting, named) = found.entry(asked).or_default();
            waiting.insert(at);
            let place = places.at(program.file, finding.span);
            if named.len() < NAMED && !named.contains(&place) {
                named.push(place);
            }
        }
    }
    let asked = found.into_iter().map(|((name, op), (programs, places))| {
        let of_table = || source.code_for(op?, &BTreeMap::new()).map(|row| row.code.clone());
        let code = site(source, &name).map(|site| site.code.clone()).or_else(of_table).unwrap_or_default();
        AskedThere { name, op, code, programs: programs.len(), places }
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
        "stand first, two in their order. Where it has none, leave the line out, and write do = \"omit\", \"stop\" or \"alarm\" at the source's code:",
        "docs/builders-codes.md.",
    ] {
        let _ = writeln!(text, "{TELLS} {told}");
    }
    let rows: Vec<Row> = survey.there.iter().filter_map(|asked| row(survey, asked)).collect();
    let mut paired = vec![false; rows.len()];
    for (at, one) in rows.iter().enumerate() {
        if paired[at] {
            continue;
        }
        let two = (at + 1..rows.len()).find(|other| !paired[*other] && is_pair(one, &rows[*other]));
        let line = match two.map(|other| (other, &rows[other])) {
            Some((other, two)) => {
                paired[other] = true;
                let does = format!("{} = \"{}, {}\"", one.key, one.name, two.name);
                format!("{} = {{ {does} }} # {}; {}", key(", "), plain(&one.about), plain(&two.about))
            }
            None => {
                let does = format!("{} = \"{}\"", one.key, one.name);
                let keys = [Some(does), said(&one.meaning), in_braces(&one.words)];
                let keys: Vec<String> = keys.into_iter().flatten().collect();
                format!("{} = {{ {} }} # {}", key(""), keys.join(", "), plain(&one.about))
            }
        };
        let _ = writeln!(text, "{ASKS} {line}");
    }
    text
}

/// A line of the target's profile, before it is written.
struct Row {
    key: &'static str,
    name: String,
    meaning: String,
    words: Vec<String>,
    about: String,
}

fn row(survey: &Survey<'_>, asked: &AskedThere) -> Option<Row> {
    let (key, meaning, words) = match (asked.op, site(survey.controls[0], &asked.name)) {
        (Some(op), _) => ("op", op.meaning().trim().trim_end_matches('.').to_owned(), Vec::new()),
        (None, Some(site)) => {
            let words = site.words.iter().map(|(letter, name)| format!("{letter} = \"{name}\""));
            ("name", site.text.clone(), words.collect())
        }
        (None, None) => return None,
    };
    let by = if words.is_empty() { "" } else { "; its words by the letters of its code here" };
    let programs = if asked.programs == 1 { String::new() } else { format!("{} programs: ", asked.programs) };
    let about = format!("{} of the source; {programs}{}{by}", asked.code, asked.places.join(", "));
    Some(Row { key, name: asked.name.clone(), meaning, words, about })
}

/// True for two of one thing, as on and off: their names differ in the last part alone.
fn is_pair(one: &Row, two: &Row) -> bool {
    let thing = |row: &Row| row.name.rsplit_once('.').map(|(thing, _)| thing.to_owned());
    let plain = one.words.is_empty() && two.words.is_empty();
    plain && one.key == two.key && thing(one).is_some() && thing(one) == thing(two)
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

    /// The table of the other control has no code for it, and its builder may have given it one.
    #[test]
    fn what_only_a_builder_has_a_code_for_is_a_row_of_the_targets_profile() {
        let source = Control::from_profile("dialect = \"haas\"\nmachine = \"mill\"\n").unwrap();
        let target = |text: &str| Control::from_profile(text).unwrap();
        let inputs =
            [Input { path: "a.nc".into(), name: "a.nc".into(), bytes: "O1\nG21\nM88\nM89\nM30\n".into() }];
        let plain = "dialect = \"fanuc\"\nmachine = \"mill\"\n";
        let there = target(plain);
        let made = survey(&inputs, &source, Some(&there));
        assert!(
            made.now.refused == 1 && made.answered.is_some_and(|then| then.refused == 0),
            "{:?}",
            made.stays
        );
        let text = filled(&made, Side::Target, Some(plain)).unwrap();
        let line = "#? \", \" = { op = \"coolant.through.off, coolant.through.on\" } # M89 of the source; a.nc:4; M88 of the source; a.nc:3";
        assert!(text.lines().any(|found| found == line), "{text}");
        let answered = text.replace("#? \", \" = {", "\"M59, M51\" = {");
        let there = target(&answered);
        assert_eq!(survey(&inputs, &source, Some(&there)).now.refused, 0);
    }
}
