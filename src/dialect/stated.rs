//! What a machine profile says of the facts themselves: answers to questions, and facts that were checked.

use super::answers::{Answers, SETTING};
use super::check::{LIMITS, STATEMENTS};
use super::overlay::Overlay;
use super::profile::Plain;
use super::reader::closest;
use super::rows::Limit;
use super::{
    Behaviour, CodeHead, Control, Dialect, HALTS, Mark, Origin, Question, QuestionGroup, Row, matters,
    registry,
};
use crate::canon::Func;
use std::collections::BTreeMap;

/// Answers that leave a question open.
pub(super) const OPEN: [&str; 2] = ["unknown", SETTING];

/// Limits that may be 0: a control need not have such a thing at all.
const MAY_BE_NONE: [&str; 1] = ["brackets"];

/// The limit that says how many characters a line may have.
const LINE: &str = "line.length";

/// How many turns a minute the spindle makes at the most, and how many tools the magazine holds: no table has them.
const SPEED: &str = "spindle.speed";
const TOOLS: &str = "tools";

/// No machine takes shorter lines.
const LEAST_LINE: u32 = 40;

impl Overlay {
    /// Puts the answers that the profile states in place of the table's.
    pub(super) fn behaviours(&mut self, dialect: &mut Dialect) {
        let word = |value| match value {
            Plain::Truth(truth) => truth.to_string(),
            other => other.to_string(),
        };
        let all = self.profile.behaviours.clone().into_iter().map(|(name, value)| (name, word(value)));
        let (groups, single): (Vec<_>, Vec<_>) =
            all.partition(|(name, _)| QuestionGroup::find(name).is_some());
        for (name, value) in groups {
            self.group(dialect, &name, &value);
        }
        let (halts, single): (Vec<_>, Vec<_>) = single.into_iter().partition(|(name, _)| name == HALTS);
        halts.iter().for_each(|(_, value)| self.halts(dialect, value));
        for (name, value) in single {
            match stated(dialect, &name, &value) {
                Ok(question) => match self.contradicted(dialect, question, &value) {
                    Some(setting) => {
                        let message = format!("'{setting}' contradicts this about {name}");
                        self.fault(&format!("behaviours:{name}"), message, "keep one of the two".into());
                    }
                    None => answer(dialect, question, value),
                },
                Err((message, help)) => self.fault(&format!("behaviours:{name}"), message, help),
            }
        }
    }

    /// True where a setting that the profile states answers a question.
    pub(super) fn is_set(&self, dialect: &Dialect, question: Question) -> bool {
        let mut rows = dialect.settings.iter().filter(|row| self.stated.contains(&row.name));
        rows.any(|row| row.sets.values().any(|sets| sets.contains_key(question.fact())))
    }

    /// Puts the limits that the profile states in place of the table's.
    pub(super) fn limits(&mut self, dialect: &mut Dialect) {
        for (name, most) in self.profile.limits.clone() {
            if name == LINE && dialect.text.line.is_some() {
                match most {
                    LEAST_LINE.. => dialect.text.line = Some(most),
                    _ => {
                        let message = format!("{name} = {most} leaves no room for a block");
                        let help = format!("write how many characters a line may have, {LEAST_LINE} or more");
                        self.fault(&format!("limits:{name}"), message, help);
                    }
                }
                continue;
            }
            if (name == SPEED || name == TOOLS) && most > 0 {
                let origin = Origin { mark: Mark::Confirmed, ..Origin::of_profile(None) };
                dialect.limits.push(Limit { name, max: Some(most), alarm: None, origin });
                continue;
            }
            match dialect.limits.iter_mut().find(|row| row.name == name) {
                Some(row) if most == 0 && row.max != Some(0) && !MAY_BE_NONE.contains(&name.as_str()) => {
                    let message = format!("{name} = 0 leaves nothing that a program may have");
                    let help = "write how many there may be, or remove the line".to_owned();
                    self.fault(&format!("limits:{name}"), message, help);
                }
                Some(row) => {
                    row.max = Some(most);
                    row.origin.mark = Mark::Confirmed;
                    row.origin.source = "machine profile".into();
                }
                None => {
                    let needed = match name.as_str() {
                        SPEED => Some(("how many turns a minute it makes", "the spindle would not turn")),
                        TOOLS => {
                            Some(("how many tools its magazine holds", "the machine would have no tool"))
                        }
                        _ => None,
                    };
                    if let Some((what, why)) = needed {
                        let help = format!("write {what}, or remove the line");
                        self.fault(&format!("limits:{name}"), format!("{name} = 0: {why}"), help);
                        continue;
                    }
                    let mut names: Vec<&str> = dialect.limits.iter().map(|row| row.name.as_str()).collect();
                    names.extend([SPEED, TOOLS]);
                    let help = format!("its limits are {}", names.join(", "));
                    self.fault(&format!("limits:{name}"), format!("the table has no limit '{name}'"), help);
                }
            }
        }
    }

    /// The setting that the profile states and that answers the question in another way.
    fn contradicted(&self, dialect: &Dialect, question: Question, value: &str) -> Option<String> {
        let says = |name: &String| {
            let row = dialect.settings.iter().find(|row| row.name == *name)?;
            let place = ["parameters", "settings"].into_iter().zip(["parameter.", "setting."]);
            let chosen = place
                .filter_map(|(section, stem)| Some((section, name.strip_prefix(stem)?)))
                .find_map(|(section, key)| match section {
                    "parameters" => self.profile.parameters.get(key),
                    _ => self.profile.settings.get(key),
                })?;
            row.sets.get(&chosen.to_string())?.get(question.fact()).filter(|other| *other != value)
        };
        self.stated.iter().find(|name| says(name).is_some()).cloned()
    }

    /// Marks the facts that the shop has checked.
    pub(super) fn confirm(&mut self, dialect: &mut Dialect) {
        for fact in self.profile.confirm.clone() {
            let mut found = 0;
            each_row(dialect, &mut |name, origin| {
                if name == fact {
                    (origin.mark, origin.rests) = (Mark::Confirmed, None);
                    found += 1;
                }
            });
            if found == 0 && self.names_no_code(&fact) {
                let code = fact.trim_start_matches("code:");
                let help = format!("leave it out, or say under [[site]] what {code} does on this machine");
                self.fault(&format!("confirm:{fact}"), format!("{} has no code {code}", dialect.title), help);
            } else if found == 0
                && matters::meaning(&fact).is_none()
                && !is_without_row(&fact)
                && !self.holds_elsewhere(&fact)
            {
                let mut names = Vec::new();
                each_row(dialect, &mut |name, _| names.push(name.to_string()));
                names.extend(matters::ALL.iter().map(|(name, _)| (*name).to_owned()));
                let help = match closest(&fact, names.iter().map(String::as_str)) {
                    Some(near) => format!("did you mean '{near}'?"),
                    None => "diagnostics name the fact: 'behaviour:NAME', 'code:G50', 'system:#5041'".into(),
                };
                self.fault(&format!("confirm:{fact}"), format!("no fact is named '{fact}'"), help);
            }
        }
    }
}

impl Overlay {
    /// What rests on a question is no surer than its answer.
    pub(super) fn rest(dialect: &mut Dialect) {
        let answers = dialect.behaviours.iter().map(|row| (row.question.fact(), row.origin.mark));
        let answers: BTreeMap<&str, Mark> = answers.collect();
        each_row(dialect, &mut |_, origin| {
            if let Some(mark) = origin.rests.as_deref().and_then(|fact| answers.get(fact)) {
                origin.mark = origin.mark.min(*mark);
            }
        });
    }

    /// True for a G code that no row of the control's table has, of no setting and no option. M codes may be of the
    /// machine's builder.
    fn names_no_code(&self, fact: &str) -> bool {
        let Some(code) = fact.strip_prefix("code:").filter(|code| code.starts_with('G') && is_code(code))
        else {
            return false;
        };
        let table = registry::find(&self.profile.dialect).and_then(|entry| entry.dialect().ok());
        table.is_some_and(|table| !table.codes.iter().any(|row| row.code.split(' ').next() == Some(code)))
    }

    /// True for a fact of the control's table that holds under another setting or option than this machine has.
    fn holds_elsewhere(&self, fact: &str) -> bool {
        let Some(table) = registry::find(&self.profile.dialect).and_then(|entry| entry.dialect().ok()) else {
            return false;
        };
        let mut found = false;
        each_row(&mut table.clone(), &mut |name, _| found |= name == fact);
        found
    }
}

/// The question that a profile answers; else what is wrong, and what to do.
pub(super) fn stated(dialect: &Dialect, name: &str, value: &str) -> Result<Question, (String, String)> {
    let Some(question) = Question::find(name) else {
        let groups = QuestionGroup::all().iter().map(|group| group.name);
        let help = match closest(name, Question::ALL.iter().map(|known| known.name()).chain(groups)) {
            Some(near) => format!("did you mean '{near}'?"),
            None => "'macroglot dialects' lists the questions under BEHAVIOURS".into(),
        };
        return Err((format!("no behaviour is named '{name}'"), help));
    };
    if !question.answers().admits(value) {
        return Err((format!("'{value}' is not a value of {name}"), format!("it is {}", question.answers())));
    }
    let row = dialect.behaviours.iter().find(|row| row.question == question);
    match row {
        None if question.needs() != Some("said") => {
            let message = format!("{} is not asked '{name}'", dialect.title);
            Err((message, "it has nothing that the question is about: remove the line".into()))
        }
        Some(row) if !row.one_of.is_empty() && !row.one_of.iter().any(|one| one == value) => {
            let message =
                format!("{name} is one of {} on this control, not '{value}'", row.one_of.join(", "));
            Err((message, "the table's source says so: check it again".into()))
        }
        row if !acts_by(dialect, question, row, value) => {
            let known =
                row.map_or("as on most controls".into(), |row| format!("'{}' in the table", row.value));
            let message = format!("{name} is {known}, and '{value}' is not converted");
            Err((message, "leave out the programs that depend on it".into()))
        }
        _ => Ok(question),
    }
}

/// True where conversions go by the answer: the table's own, one that settles what is open there, or one that a control
/// of the family gives, or a setting or an option of one.
fn acts_by(dialect: &Dialect, question: Question, row: Option<&Behaviour>, value: &str) -> bool {
    let gives = |other: &Dialect| {
        let sets = other.settings.iter().flat_map(|setting| setting.sets.values());
        other.behaviours.iter().any(|its| its.question == question && its.value == value)
            || sets.flatten().any(|(fact, to)| fact == question.fact() && to == value)
    };
    let settles = |row: &Behaviour| {
        row.value == value
            || OPEN.contains(&row.value.as_str())
            || row.one_of.iter().any(|one| one == value)
            || row.option.is_some() && value != "unknown"
    };
    // A number that no table has is one that only the machine has.
    let of_machine = row.is_none() && question.answers() == Answers::Number;
    of_machine
        || question.is_choice()
        || question.is_set_up()
        || row.is_some_and(settles)
        || registry::all()
            .iter()
            .filter_map(|entry| entry.dialect().ok())
            .any(|other| other.family == dialect.family && gives(other))
}

pub(super) fn answer(dialect: &mut Dialect, question: Question, value: String) {
    let open = OPEN.contains(&value.as_str());
    let note = open.then(|| "the machine profile leaves it open".into());
    let mark = if open { Mark::Unconfirmed } else { Mark::Confirmed };
    let origin = Origin { mark, ..Origin::of_profile(note) };
    let row = Behaviour { question, value, one_of: Vec::new(), option: None, machine: None, origin };
    match dialect.behaviours.iter_mut().find(|row| row.question == question) {
        Some(old) => *old = row,
        None => dialect.behaviours.push(row),
    }
}

/// True for a fact that a diagnostic may name although the table has no row of it: `word:E`, `code:M77`.
fn is_without_row(fact: &str) -> bool {
    let Some((kind, name)) = fact.split_once(':') else { return false };
    let mut letters = name.chars();
    let letter = letters.next().is_some_and(|letter| letter.is_ascii_uppercase());
    let numbered = |name: &str| {
        let (stem, number) = name.split_at(name.find(|c: char| c.is_ascii_digit()).unwrap_or(name.len()));
        !stem.is_empty() && number.parse::<u32>().is_ok()
    };
    match kind {
        "behaviour" => Question::find(name).is_some_and(|question| question.needs() == Some("said")),
        "statement" => STATEMENTS.contains(&name),
        "limit" => LIMITS.contains(&name),
        "function" => Func::find(name.split_once('/').map_or(name, |(name, _)| name)).is_some(),
        "word" | "argument" => letter && letters.next().is_none(),
        "code" => is_code(name),
        "machine" => name.strip_prefix("code.").is_some_and(is_code),
        "variable" | "system" => numbered(name),
        _ => false,
    }
}

fn is_code(name: &str) -> bool {
    let mut signs = name.chars();
    let head = signs.next().zip(signs.as_str().parse().ok());
    head.is_some_and(|(letter, number)| {
        letter.is_ascii_uppercase() && CodeHead::new(letter, number).is_some()
    })
}

impl Control {
    /// The fact that a fact rests on, where a row of it names one.
    pub(super) fn rests(&self, fact: &str) -> Option<&str> {
        fn of<'d, T: Row>(rows: &'d [T], fact: &str) -> Option<&'d str> {
            let key = fact.strip_prefix(T::KIND)?.strip_prefix(':')?;
            rows.iter().filter(|row| row.key() == key).find_map(|row| row.origin().rests.as_deref())
        }
        let d = self.dialect();
        let of_row = of(&d.system, fact).or_else(|| of(&d.codes, fact));
        of_row.or_else(|| of(&d.operators, fact)).or_else(|| of(&d.words, fact))
    }

    /// How sure a fact is: of several rows of its name, as sure as the least sure; unconfirmed where it has no row.
    pub fn mark(&self, fact: &str) -> Mark {
        fn least<T: Row>(rows: &[T], fact: &str) -> Option<Mark> {
            // The name of a row is put together only where its kind fits.
            let key = match fact.strip_prefix(T::KIND)? {
                "" => "",
                rest => rest.strip_prefix(':').filter(|key| !key.is_empty())?,
            };
            let named = |row: &&T| row.key() == key;
            rows.iter().filter(named).map(|row| row.origin().mark).min()
        }
        let d = self.dialect();
        let marks = [
            least(std::slice::from_ref(&d.numbers), fact),
            least(std::slice::from_ref(&d.text), fact),
            least(&d.forms, fact),
            least(&d.limits, fact),
            least(&d.forbidden, fact),
            least(&d.operators, fact),
            least(&d.functions, fact),
            least(&d.statements, fact),
            least(&d.behaviours, fact),
            least(&d.matters, fact),
            least(&d.variables, fact),
            least(&d.system, fact),
            least(&d.words, fact),
            least(&d.codes, fact),
            least(&d.arguments, fact),
            least(&d.settings, fact),
        ];
        marks.into_iter().flatten().min().unwrap_or_default()
    }
}

/// Visits every row with the name of its fact.
fn each_row(dialect: &mut Dialect, visit: &mut dyn FnMut(&str, &mut super::Origin)) {
    fn section<T: Row>(rows: &mut [T], visit: &mut dyn FnMut(&str, &mut super::Origin)) {
        for row in rows {
            let name = row.fact();
            visit(&name, row.origin_mut());
        }
    }
    section(std::slice::from_mut(&mut dialect.numbers), visit);
    section(std::slice::from_mut(&mut dialect.text), visit);
    section(&mut dialect.limits, visit);
    section(&mut dialect.forbidden, visit);
    section(&mut dialect.operators, visit);
    section(&mut dialect.functions, visit);
    section(&mut dialect.statements, visit);
    section(&mut dialect.behaviours, visit);
    section(&mut dialect.matters, visit);
    section(&mut dialect.variables, visit);
    section(&mut dialect.system, visit);
    section(&mut dialect.words, visit);
    section(&mut dialect.codes, visit);
    section(&mut dialect.arguments, visit);
    section(&mut dialect.settings, visit);
}
