//! Words beside codes of the machine's builder that a machine profile names without them.

use super::shape::{NAMED, Places};
use crate::diag::Asks;
use crate::dialect::Side;
use crate::library::ProgramReport;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

/// A word that the profile of a machine would have to name at a code.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AskedWord {
    /// The machine.
    #[serde(skip)]
    pub side: Side,
    /// The code: `M213`.
    pub code: String,
    /// The letter.
    pub letter: char,
    /// What the shop calls it.
    pub name: String,
    /// How many programs wait for it.
    pub programs: usize,
    /// The first places, as `file:line`.
    pub places: Vec<String>,
}

/// Whether it is the target's, its code, its letter, and the name of its meaning.
type Key = (bool, String, char, String);

impl AskedWord {
    /// True for the same word of the same code.
    pub(super) fn is(&self, other: &Self) -> bool {
        (self.side, &self.code, self.letter) == (other.side, &other.code, other.letter)
    }
}

/// The words that programs wait for.
pub(super) fn asked(places: &Places<'_>, programs: &[ProgramReport]) -> Vec<AskedWord> {
    let mut found: BTreeMap<Key, (BTreeSet<usize>, Vec<String>)> = BTreeMap::new();
    for (at, program) in programs.iter().enumerate() {
        for finding in &program.diagnostics {
            let Some(Asks::Word { target, code, letter, name }) = finding.asks.as_deref() else { continue };
            let key = (*target, code.to_string(), *letter, name.to_string());
            let (waiting, named) = found.entry(key).or_default();
            waiting.insert(at);
            let place = places.at(program.file, finding.span);
            if named.len() < NAMED && !named.contains(&place) {
                named.push(place);
            }
        }
    }
    let asked = found.into_iter().map(|((target, code, letter, name), (programs, places))| AskedWord {
        side: if target { Side::Target } else { Side::Source },
        code,
        letter,
        name,
        programs: programs.len(),
        places,
    });
    asked.collect()
}

/// The text of a profile with a line for each such word at its code: an answer, or what to add to the words that it has.
pub(super) fn with_words(text: &str, asked: &[&AskedWord], (asks, tells): (&str, &str)) -> String {
    let lines: Vec<&str> = text.split_inclusive('\n').collect();
    let mut out = String::with_capacity(text.len());
    for (at, line) in lines.iter().enumerate() {
        out.push_str(line);
        let Some((code, row)) = code_of(line, &lines[..at]) else { continue };
        let wanted: Vec<&&AskedWord> = asked.iter().filter(|word| word.code == code).collect();
        if wanted.is_empty() {
            continue;
        }
        if !line.ends_with('\n') {
            out.push('\n');
        }
        let head = lines[..at].iter().rposition(|line| line.trim_start().starts_with('[')).unwrap_or(0);
        let end = lines[at..].iter().position(|line| line.trim_start().starts_with('['));
        let own = lines.get(head..end.map_or(lines.len(), |end| at + end)).unwrap_or_default();
        let has =
            row || own.iter().any(|line| line.split('=').next().is_some_and(|key| key.trim() == "words"));
        let words: Vec<String> =
            wanted.iter().map(|word| format!("{} = \"{}\"", word.letter, word.name)).collect();
        let words = words.join(", ");
        let places: Vec<&str> =
            wanted.iter().flat_map(|word| &word.places).map(String::as_str).take(NAMED).collect();
        let places = super::filled::plain(&places.join(", "));
        let _ = match has {
            true if row => {
                writeln!(out, "{tells} add to the words of {code}: words = {{ {words} }} # {places}")
            }
            true => writeln!(out, "{tells} add to its words: {words} # {places}"),
            false => writeln!(out, "{asks} words = {{ {words} }} # its words: each with a name ({places})"),
        };
    }
    out
}

/// The code of a line that says it, as `code = "M14"`, or `M14 = { ... }` under `[codes]`; true for the latter.
fn code_of<'l>(line: &'l str, before: &[&str]) -> Option<(&'l str, bool)> {
    let code = value_of(line, "code").map(|code| (code, false));
    code.or_else(|| {
        let (key, _) = line.split_once('=').filter(|(_, value)| value.trim_start().starts_with('{'))?;
        let head = before.iter().rev().map(|line| line.trim()).find(|line| line.starts_with('['))?;
        let section = head.strip_prefix('[')?.split(']').next()?.trim();
        (section == super::site_rows::SECTION).then(|| (key.trim().trim_matches('"'), true))
    })
}

/// The text that a line gives a key, if it is one of it.
fn value_of<'l>(line: &'l str, key: &str) -> Option<&'l str> {
    let (found, value) = line.split_once('=')?;
    (found.trim() == key).then(|| value.split('"').nth(1))?
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A code's own line has all that is said of it, so what it lacks is told below.
    #[test]
    fn words_of_a_code_on_one_line_are_told_below_it() {
        let word = AskedWord {
            side: Side::Source,
            code: "M3 P11".into(),
            letter: 'Q',
            name: "Q".into(),
            programs: 1,
            places: vec!["a.nc:3".into()],
        };
        let text = "[settings]\n\"M3 P11\" = { }\n[codes] # ours\n\"M3 P11\" = { do = \"omit\" }\nM4 = { do = \"omit\" }\n";
        let told = with_words(text, &[&word], ("#?", "#:"));
        let line = "#: add to the words of M3 P11: words = { Q = \"Q\" } # a.nc:3\n";
        assert_eq!(told, text.replace("M4 =", &format!("{line}M4 =")));
    }
}
