//! What the settings of a machine profile change in a table.

use super::control::numbered;
use super::overlay::{Overlay, conditions};
use super::profile::{Axis, Plain};
use super::reader::closest;
use super::{BareLength, Dialect, Mark, OneTable, Origin, Question, Setting, TABLE_ROWS};
use crate::canon::{Op, Role};
use std::collections::BTreeMap;

impl Overlay {
    /// Puts settings that the profile confirms, `parameter.6050=100`, where it states the others.
    pub(super) fn confirmed_settings(&mut self) {
        let all = std::mem::take(&mut self.profile.confirm);
        for fact in all {
            let tables =
                [("parameter.", &mut self.profile.parameters), ("setting.", &mut self.profile.settings)];
            let of = |stem: &str| Some(fact.strip_prefix(stem)?.split_once('='));
            let found = tables.into_iter().find_map(|(stem, table)| Some((of(stem)??, table)));
            let Some(((key, value), table)) = found else {
                self.profile.confirm.push(fact);
                continue;
            };
            let stated =
                table.entry(key.to_owned()).or_insert_with(|| Plain::Word(value.to_owned())).to_string();
            if stated != value {
                let message = format!("'{fact}' is confirmed, and '{key}' is '{stated}' below");
                self.fault(&format!("confirm:{fact}"), message, "keep one of the two".into());
            }
        }
    }

    /// The values of all settings: the table's, then the profile's. `axis.A` is `no` where the profile lists the axes without A, and
    /// else `open`.
    pub(super) fn settings(&mut self, dialect: &Dialect) -> BTreeMap<String, String> {
        let mut values: BTreeMap<String, String> = (dialect.settings.iter())
            .filter_map(|row| Some((row.name.clone(), row.default.clone()?)))
            .collect();
        if let Some(machine) = self.profile.machine {
            values.insert("machine".into(), machine.name().into());
            self.stated.insert("machine".into());
        }
        for axis in Axis::ALL {
            let none = self.profile.axes.as_ref().is_some_and(|axes| !axes.contains(&axis));
            values.insert(format!("axis.{axis:?}"), if none { "no" } else { "open" }.into());
        }
        let given: Vec<(String, String, String)> = [("parameters", "parameter."), ("settings", "setting.")]
            .into_iter()
            .zip([&self.profile.parameters, &self.profile.settings])
            .flat_map(|((section, stem), table)| {
                table.iter().map(move |(key, value)| {
                    (format!("{section}:{key}"), format!("{stem}{key}"), value.to_string())
                })
            })
            .collect();
        let mut stated_at = BTreeMap::new();
        for (place, name, value) in given {
            let known =
                dialect.settings.iter().find(|row| row.covers(&name) || row.also.as_ref() == Some(&name));
            // Its number on a newer control says the same.
            let name =
                known.filter(|row| row.also.as_ref() == Some(&name)).map_or(name, |row| row.name.clone());
            match known {
                Some(Setting { also: Some(both), .. })
                    if self.stated.contains(&name) && values.get(&name) != Some(&value) =>
                {
                    let help = format!("it is {both} on a newer control: keep one of the two");
                    self.fault(&place, format!("{name} is there twice, with two values"), help);
                }
                Some(row) if !row.values.is_empty() && !row.values.contains(&value) => {
                    let help = format!("{}: one of {}", row.meaning, row.values.join(", "));
                    self.fault(&place, format!("'{value}' is not a value of {name}"), help);
                }
                Some(_) => {
                    stated_at.insert(name.clone(), place);
                    self.stated.insert(name.clone());
                    values.insert(name, value);
                }
                None => {
                    let help = match closest(&name, dialect.settings.iter().map(|row| row.name.as_str())) {
                        Some(near) => format!("did you mean '{near}'?"),
                        None => format!("'macroglot dialects {}' lists what can be set", dialect.name),
                    };
                    self.fault(&place, format!("{} has no setting '{name}'", dialect.title), help);
                }
            }
        }
        let rows = TABLE_ROWS.map(|name| values.get(name).map(String::as_str));
        if let Err((at, help)) = OneTable::read(rows)
            && let Some(place) = stated_at.get(TABLE_ROWS[at])
        {
            let what = format!("these are no rows of a table of offsets for {}", TABLE_ROWS[at]);
            self.fault(place, what, help.to_owned());
        }
        values
    }

    /// Does what the values of the settings say, then what the profile says itself.
    pub(super) fn apply(&mut self, dialect: &mut Dialect, values: &BTreeMap<String, String>) {
        for setting in dialect.settings.clone() {
            let stated = self.stated.contains(&setting.name);
            let effects = values.get(&setting.name).and_then(|value| setting.sets.get(value));
            for (target, value) in effects.into_iter().flatten() {
                dialect.numbers.feed_stated |= stated && target == "numbers:bare_feed" && value != "unknown";
                if let Some(origin) = change(dialect, target, value)
                    && stated
                    && setting.origin.is_settled()
                {
                    origin.mark = Mark::Confirmed;
                }
            }
            if setting.assumed && !stated {
                for target in setting.sets.values().flat_map(BTreeMap::keys) {
                    // Whatever value it might have changes this, so it is not sure.
                    if let Some(origin) = touched(dialect, target) {
                        assume(origin, &setting.name);
                    }
                }
            }
        }
        if let Some(point) = self.profile.decimal_point {
            dialect.numbers.bare_length = point.into();
            dialect.numbers.bare_argument = point.into();
            dialect.numbers.origin.mark = Mark::Confirmed;
            if dialect.numbers.bare_length == BareLength::Units
                && dialect.numbers.calculator_letters.contains('F')
            {
                dialect.numbers.bare_feed = BareLength::Units;
                dialect.numbers.feed_parts = 1.0;
                dialect.numbers.feed_stated = true;
            }
        }
    }

    /// Rows that hold only under a setting are as sure as the setting is stated.
    pub(super) fn doubt(&self, dialect: &mut Dialect) {
        let open: Vec<String> = (dialect.settings.iter())
            .filter(|setting| setting.assumed && !self.stated.contains(&setting.name))
            .map(|setting| setting.name.clone())
            .collect();
        let rests_on = |when: &Option<String>| {
            let mut names = conditions(when.as_ref()?).map(|(name, _)| name);
            names.find_map(|name| open.iter().find(|open| *open == name).cloned())
        };
        let codes = dialect.codes.iter_mut().map(|row| (&row.when, &mut row.origin));
        let words = dialect.words.iter_mut().map(|row| (&row.when, &mut row.origin));
        let system = dialect.system.iter_mut().map(|row| (&row.when, &mut row.origin));
        for (when, origin) in codes.chain(words).chain(system) {
            if let Some(setting) = rests_on(when) {
                assume(origin, &setting);
            }
        }
    }
}

/// Notes that a row rests on a setting that nobody stated.
fn assume(origin: &mut Origin, setting: &str) {
    origin.mark = Mark::Unconfirmed;
    let reason = format!("the machine profile does not give {setting}");
    origin.note = Some(match origin.note.take() {
        Some(note) if note.contains(&reason) => note,
        Some(note) => format!("{note}; {reason}"),
        None => reason,
    });
}

/// Sets what a setting changes, and gives its origin.
fn change<'d>(dialect: &'d mut Dialect, target: &str, value: &str) -> Option<&'d mut Origin> {
    match target.split_once(':')? {
        ("behaviour", name) => {
            let row = dialect.behaviours.iter_mut().find(|row| row.question.name() == name)?;
            row.value = value.into();
            Some(&mut row.origin)
        }
        ("limit", name) => {
            let row = dialect.limits.iter_mut().find(|row| row.name == name)?;
            row.max = value.parse().ok();
            Some(&mut row.origin)
        }
        ("text", "program_max") => {
            dialect.text.program_max = value.parse().unwrap_or(dialect.text.program_max);
            None
        }
        ("numbers", column) => {
            let numbers = &mut dialect.numbers;
            let bare = match value {
                "units" => BareLength::Units,
                "increments" => BareLength::Increments,
                _ => BareLength::Unknown,
            };
            match column {
                "bare_length" => numbers.bare_length = bare,
                "bare_argument" => numbers.bare_argument = bare,
                "bare_feed" => numbers.bare_feed = bare,
                "feed_parts" => numbers.feed_parts = value.parse().unwrap_or(1.0),
                _ => numbers.arithmetic = value.into(),
            }
            // One origin stands for all columns, so one setting does not confirm it.
            None
        }
        _ => None,
    }
}

/// The origin of what a setting could change.
fn touched<'d>(dialect: &'d mut Dialect, target: &str) -> Option<&'d mut Origin> {
    match target.split_once(':')? {
        ("behaviour", name) => {
            dialect.behaviours.iter_mut().find(|row| row.question.name() == name).map(|row| &mut row.origin)
        }
        ("limit", name) => dialect.limits.iter_mut().find(|row| row.name == name).map(|row| &mut row.origin),
        // What the row's facts are told by is numbers without a point.
        ("numbers", column) if column != "arithmetic" => Some(&mut dialect.numbers.origin),
        _ => None,
    }
}

impl Setting {
    /// True where the row is for this setting: its own name, or one of its run.
    pub fn covers(&self, name: &str) -> bool {
        if self.name == name {
            return true;
        }
        match (numbered(&self.name), numbered(name), self.through) {
            (Some((stem, first)), Some((other, number)), Some(last)) => {
                stem == other && (first..=last).contains(&number)
            }
            _ => false,
        }
    }
}

/// Makes tool words do what the answer says: where a code changes the tool the word only names it, whatever the table says of
/// words that change tools by themselves, and where the word does it is the change.
pub(super) fn settle_tool_words(dialect: &mut Dialect) {
    let row = dialect.behaviours.iter().find(|row| row.question == Question::ToolChangeWord);
    match row.map(|row| row.value.as_str()) {
        Some("m6") => {
            dialect.behaviours.retain(|row| row.question != Question::ToolWordAgain);
            let changes = dialect.words.iter_mut().filter(|row| row.op == Some(Op::ToolChange));
            changes.for_each(|row| row.op = None);
        }
        Some("t") => {
            let names = dialect.words.iter_mut().filter(|row| row.role == Role::Tool && row.op.is_none());
            names.for_each(|row| row.op = Some(Op::ToolChange));
        }
        _ => {}
    }
}
