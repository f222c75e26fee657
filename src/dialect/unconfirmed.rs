//! The words for facts that no manual confirms.

use super::overlay::conditions;
use super::{Control, Mark, Origin, Question, Row, Setting, matters};
use crate::diag::{Code, Diagnostic};
use crate::text::Span;
use std::collections::BTreeMap;
use std::fmt;

/// Which control of a conversion a fact is about; a program that is only read has the source's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Side {
    /// The control that the programs were written for.
    Source,
    /// The control that they are to run on.
    Target,
}

impl fmt::Display for Side {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Source => "source",
            Self::Target => "target",
        })
    }
}

impl Control {
    /// How a program that rests on a fact of this control is told: for review, or, where the fact is common, with a note.
    pub fn told_as(&self, fact: &str) -> Code {
        match self.mark(fact) {
            Mark::Common => Code::CommonFact,
            Mark::Confirmed | Mark::Unconfirmed => Code::UnconfirmedFact,
        }
    }

    /// True where a source or the machine's profile says that a matter is as the emulated controls have it:
    /// [`matters::ALL`].
    pub fn has_tried(&self, matter: &str) -> bool {
        self.profile().confirm.iter().any(|fact| fact == matter)
            || self.dialect().matters.iter().any(|row| row.origin.is_settled() && row.fact() == matter)
    }

    /// All such matters, and the facts that the profile confirms.
    pub fn tried(&self) -> Vec<String> {
        let rows = self.dialect().matters.iter().filter(|row| row.origin.is_settled());
        self.profile().confirm.iter().cloned().chain(rows.map(Row::fact)).collect()
    }

    /// The construct at `span` rests on a fact of this control, named as a machine profile confirms it:
    /// `behaviour:load.sets.condition`.
    pub fn unconfirmed(&self, side: Side, fact: &str, note: Option<&str>, span: Span) -> Diagnostic {
        // One answer settles all that rests on it, unless the row itself is less sure.
        let rests = self.rests(fact).filter(|on| self.mark(on) == self.mark(fact));
        let (fact, note) = match rests {
            Some(on) => (on, Question::of_fact(on).and_then(|on| self.behaviour(on)?.origin.note.as_deref())),
            None => (fact, note),
        };
        let title = &self.dialect().title;
        let asked = Question::of_fact(fact).map(|question| self.taken(question));
        let note = note.filter(|note| Question::of_fact(fact).is_none_or(|asked| asked.meaning() != *note));
        // Of a matter that no table asks about it is what the emulated control does.
        let note = note.or_else(|| matters::meaning(fact));
        let said: Vec<&str> = asked.as_deref().into_iter().chain(note).collect();
        let code = self.told_as(fact);
        let said = match said.as_slice() {
            [] if code == Code::CommonFact => "sources of the trade agree on it".into(),
            [] => "no source says so".into(),
            said => said.join("; "),
        };
        let what = match code {
            Code::CommonFact => {
                format!(
                    "'{fact}' is common knowledge for the {side}, {title}, and no manual was reached: {said}"
                )
            }
            _ => format!("no manual confirms '{fact}' for the {side}, {title}: {said}"),
        };
        Diagnostic::new(code, span, what).with_help(self.to_settle(fact, side)).with_fact(fact)
    }

    /// A question, and what this control is taken to answer.
    fn taken(&self, question: Question) -> String {
        let meaning = question.meaning();
        match self.behaviour(question) {
            Some(row) if !row.one_of.is_empty() => format!("{meaning}: {}", row.one_of.join(" or ")),
            Some(row) if !matches!(row.value.as_str(), "unknown" | "setting") => {
                format!("{meaning}: taken as '{}'", row.value)
            }
            _ => meaning.to_owned(),
        }
    }

    /// What a machine profile says to settle a fact of this control: the setting that it hangs on where there is one and
    /// nobody stated it, an answer, or that it is so.
    pub fn settled_by(&self, fact: &str) -> Settled {
        if fact == "numbers" {
            return Settled::POINT;
        }
        let row = Question::of_fact(fact).and_then(|question| self.behaviour(question));
        let open = row.is_some_and(|row| row.value == "setting");
        // A setting answers it where each of its values does, or where nothing else does.
        let sets = |row: &&Setting| {
            let mut answers = row.values.iter().map(|value| row.sets.get(value));
            let says = |sets: Option<&BTreeMap<String, String>>| sets.is_some_and(|s| s.contains_key(fact));
            if open { answers.any(says) } else { row.origin.is_settled() && answers.all(says) }
        };
        // A relative of another maker has no parameters of these numbers.
        let own = self.setting("setting.own_parameters") != Some("no");
        let has = |row: &&Setting| own || !row.name.starts_with("parameter.");
        let mut settings = self.dialect().settings.iter().filter(|row| !row.values.is_empty()).filter(has);
        match self.open_setting(fact).filter(has).or_else(|| settings.find(sets)) {
            Some(row) => {
                let (section, name) = match row.name.strip_prefix("parameter.") {
                    Some(number) => ("parameters", number),
                    None => ("settings", row.name.trim_start_matches("setting.")),
                };
                Settled::Setting { section, name: name.to_owned(), values: row.values.clone() }
            }
            None if !own || row.is_none_or(|row| row.value == "unknown" || !row.one_of.is_empty()) => {
                match Question::of_fact(fact) {
                    Some(question) if !question.answers().written(&[]).is_empty() => Settled::Answer {
                        question: question.to_string(),
                        answers: question.answers().written(row.map_or(&[], |row| &row.one_of)),
                    },
                    _ => Settled::Confirmed(fact.to_owned()),
                }
            }
            None => Settled::Confirmed(fact.to_owned()),
        }
    }

    /// The setting that a row of a code, a word or a system variable holds under, where the table takes a value that nobody stated.
    fn open_setting(&self, fact: &str) -> Option<&Setting> {
        let dialect = self.dialect();
        let is_open = |origin: &Origin, when: &Option<String>| when.is_some() && !origin.is_settled();
        let (codes, words, system) = (dialect.codes.iter(), dialect.words.iter(), dialect.system.iter());
        let codes =
            codes.filter(|row| is_open(&row.origin, &row.when) && row.fact() == fact).map(|row| &row.when);
        let words =
            words.filter(|row| is_open(&row.origin, &row.when) && row.fact() == fact).map(|row| &row.when);
        let system =
            system.filter(|row| is_open(&row.origin, &row.when) && row.fact() == fact).map(|row| &row.when);
        let names = codes
            .chain(words)
            .chain(system)
            .flatten()
            .flat_map(|when| conditions(when))
            .map(|(name, _)| name);
        let mut settings = names.filter_map(|name| self.setting_row(name));
        settings.find(|row| row.assumed && !row.values.is_empty() && !self.states(&row.name))
    }

    /// True if the machine's profile says the value of a setting itself.
    fn states(&self, name: &str) -> bool {
        let profile = self.profile();
        match name.strip_prefix("parameter.") {
            Some(number) => profile.parameters.contains_key(number),
            None => profile.settings.contains_key(name.trim_start_matches("setting.")),
        }
    }

    /// The same in words.
    pub fn to_settle(&self, fact: &str, side: Side) -> String {
        self.settled_by(fact).in_words(side)
    }
}

/// What a machine profile says to settle a fact.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Settled {
    /// A setting of the control that the fact hangs on.
    Setting {
        /// The profile's section.
        section: &'static str,
        /// The setting's name there.
        name: String,
        /// The values that it may have.
        values: Vec<String>,
    },
    /// An answer to a question of behaviour.
    Answer {
        /// The question.
        question: String,
        /// The answers that it may have, in words.
        answers: String,
    },
    /// A key of the profile itself.
    Key {
        /// The key.
        name: &'static str,
        /// The values that it may have.
        values: &'static [&'static str],
    },
    /// That it is as the tables have it.
    Confirmed(String),
}

impl Settled {
    /// What a profile says of the unit that its machine starts in.
    pub const UNITS: Self = Self::Key { name: "units", values: &["inch", "metric"] };

    /// What a profile says of numbers without a decimal point.
    pub const POINT: Self = Self::Key { name: "decimal_point", values: &["calculator", "increments"] };

    /// A key or a setting with the values that it may have, as a line of a profile.
    pub fn choice<S: AsRef<str>>(name: &str, values: &[S]) -> String {
        let values: Vec<&str> = values.iter().map(AsRef::as_ref).collect();
        format!("{name} = \"{}\"", values.join("\" or \""))
    }

    /// What to do on the machine and in its profile.
    pub fn in_words(&self, side: Side) -> String {
        let then = match self {
            Self::Setting { section, name, .. } => {
                format!("put '{name}' under [{section}] in the machine profile of the {side}")
            }
            Self::Answer { question, answers } => {
                format!(
                    "write '{question} = {answers}' under [behaviours] in the machine profile of the {side}"
                )
            }
            Self::Key { name, values } => {
                format!("write '{}' in the machine profile of the {side}", Self::choice(name, values))
            }
            Self::Confirmed(fact) => {
                format!("add \"{fact}\" to 'confirm' in the machine profile of the {side}")
            }
        };
        format!("check it on the machine, then {then}")
    }
}

/// What to do about a fact that nothing confirms.
pub fn to_confirm(fact: &str, side: Side) -> String {
    Settled::Confirmed(fact.to_owned()).in_words(side)
}
