//! Settings that refusals of a survey wait for, or that the target must have while programs run.

use super::filled::{counted, plain};
use super::shape::{NAMED, Places};
use crate::assume::Predicate;
use crate::diag::Diagnostic;
use crate::dialect::{CODE_SYSTEM, Control, Question, Setting, Settled, Side};
use crate::library::ProgramReport;
use crate::report::Fact;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// A setting that a machine profile would have to state.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AskedSetting {
    /// The machine.
    #[serde(skip)]
    pub side: Side,
    /// The section of its profile: `settings`.
    pub section: &'static str,
    /// Its name there: `73`.
    pub name: String,
    /// The values that it may have; empty for any.
    pub values: Vec<String>,
    /// Where programs need more than one value: each of them, and the first place that needs it.
    #[serde(skip)]
    pub wanted: Vec<(String, String)>,
    /// What the machine has if nobody changed it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub default: Option<String>,
    /// What it is if the programs are right, where the machine may have any value: never written as an answer.
    #[serde(skip)]
    pub likely: Option<String>,
    /// True for one that is confirmed with other facts, as its value is known but for a person's word.
    #[serde(skip)]
    pub as_fact: bool,
    /// What it is.
    pub meaning: String,
    /// How many programs wait for it.
    pub programs: usize,
    /// The first places, as `file:line`.
    pub places: Vec<String>,
}

impl AskedSetting {
    /// The fact that a profile confirms, `parameter.6050=100`; none if it is a line of its own.
    pub(super) fn fact(&self) -> Option<String> {
        let stem = if self.section == "parameters" { "parameter." } else { "setting." };
        self.as_fact.then(|| format!("{stem}{}={}", self.name, self.usual()))
    }

    /// An answer that a machine might give: what programs show, what it has if nobody changed it, or the first value.
    pub fn usual(&self) -> String {
        let first = self.likely.as_ref().or(self.default.as_ref()).or_else(|| self.values.first());
        first.cloned().unwrap_or_else(|| "1".into())
    }
}

/// What is found of one setting.
#[derive(Default)]
struct Found {
    programs: BTreeSet<usize>,
    /// The values that it must have, as their bits, and the first place of each.
    needed: BTreeMap<u64, String>,
    likely: Option<String>,
    places: Vec<String>,
}

/// The settings that findings name; those that most programs wait for are first.
pub(super) fn asked(
    places: &Places<'_>,
    controls: [&Control; 2],
    programs: &[ProgramReport],
) -> Vec<AskedSetting> {
    let mut found: BTreeMap<(Side, Arc<str>), Found> = BTreeMap::new();
    for (at, program) in programs.iter().enumerate() {
        for finding in &program.diagnostics {
            let Some((side, name, value)) = named(finding) else { continue };
            let found = found.entry((side, name)).or_default();
            found.programs.insert(at);
            let there = finding.setting_there.as_deref().filter(|_| value.is_none());
            let named = finding.setting.as_deref().or(there);
            let shown = named.and_then(|name| Some(name.split_once('=')?.1.to_owned()));
            found.likely = found.likely.take().or(shown);
            let place = places.at(program.file, finding.span);
            if let Some(value) = value {
                found.needed.entry(value.to_bits()).or_insert_with(|| place.clone());
            }
            if found.places.len() < NAMED && !found.places.contains(&place) {
                found.places.push(place);
            }
        }
    }
    let asked = found.into_iter().map(|((side, name), found)| {
        let control = match side {
            Side::Source => controls[0],
            Side::Target => controls[1],
        };
        let row = control.setting_row(&name);
        // By the number that this machine has.
        let newer = row
            .filter(|row| row.also_with.as_ref().is_some_and(|with| control.has_option(with) == Some(true)));
        let name = newer.and_then(|row| row.also.as_deref()).unwrap_or(&name);
        let (section, short) = match (name.strip_prefix("parameter."), name.strip_prefix("behaviour.")) {
            (Some(number), _) => ("parameters", number),
            (None, Some(question)) => ("behaviours", question),
            (None, None) => ("settings", name.trim_start_matches("setting.")),
        };
        let question = Question::find(short).filter(|_| section == "behaviours");
        let whole = row.map_or(1.0, Setting::whole);
        let as_set = |bits: u64| ((f64::from_bits(bits) * whole * 1e6).round() / 1e6).to_string();
        let wanted: Vec<(String, String)> =
            found.needed.into_iter().map(|(bits, place)| (as_set(bits), place)).collect();
        let needed: Vec<String> = wanted.iter().map(|(value, _)| value.clone()).collect();
        let answers = question.map_or_else(String::new, |question| question.answers().written(&[]));
        let mut values = if needed.is_empty() { values(row, short) } else { needed };
        if values.is_empty() && question.is_some_and(Question::is_choice) {
            values = answers.split(" or ").map(|answer| answer.trim_matches('"').to_owned()).collect();
        }
        // A length that a setting gives is small beside those of a part. Parameters are whole numbers.
        let gives = row.and_then(|row| row.gives).filter(|role| section == "settings" && role.is_length());
        let is_open = values.is_empty() && row.is_none_or(|row| row.default.is_none());
        let small = gives.filter(|_| is_open).map(|_| "0.01".to_owned());
        AskedSetting {
            side,
            section,
            name: short.to_owned(),
            values,
            wanted,
            as_fact: false,
            likely: found.likely.or(small),
            default: row
                .and_then(|row| row.default.clone())
                .filter(|_| side == Side::Source && short != CODE_SYSTEM),
            meaning: match (row, question) {
                (Some(row), _) => row.meaning.clone(),
                (None, Some(question)) => question.meaning().to_owned(),
                (None, None) => String::new(),
            },
            programs: found.programs.len(),
            places: found.places,
        }
    });
    let mut asked: Vec<AskedSetting> = asked.collect();
    asked.sort_by_key(|setting| std::cmp::Reverse(setting.programs));
    asked
}

/// How many programs need a setting, and where; each of several values with its first place.
pub(super) fn needed_by(setting: &AskedSetting) -> String {
    let each = setting.wanted.iter().map(|(value, place)| format!("{value} in {}", plain(place)));
    match setting.wanted.len() {
        0 | 1 => counted(setting.programs, &setting.places),
        _ => {
            let each: Vec<String> = each.collect();
            format!("{} programs, one value at a time: {}", setting.programs, each.join(", "))
        }
    }
}

/// The values that a setting may have. A G code system is asked where codes show another one than the usual.
fn values(row: Option<&Setting>, name: &str) -> Vec<String> {
    let Some(row) = row else { return Vec::new() };
    let usual = row.default.as_ref().filter(|_| name == CODE_SYSTEM);
    row.values.iter().filter(|value| usual != Some(*value)).chain(usual).cloned().collect()
}

/// The setting that a finding waits for: of which machine, and the value that it must have, if it must have one.
fn named(finding: &Diagnostic) -> Option<(Side, Arc<str>, Option<f64>)> {
    if let Some(name) = &finding.setting {
        return Some((Side::Source, name.split('=').next()?.into(), None));
    }
    if let Some(name) = &finding.setting_there {
        let (name, value) =
            name.split_once('=').map_or((&**name, None), |(name, value)| (name, value.parse().ok()));
        return Some((Side::Target, name.into(), value));
    }
    match finding.assumes.as_deref()? {
        Predicate::Setting(name, value) => Some((Side::Target, name.clone(), Some(*value))),
        _ => None,
    }
}

/// The row of the setting that a fact hangs on.
pub(super) fn setting_of<'c>(fact: &Fact<'_>, control: &'c Control) -> Option<&'c Setting> {
    let Settled::Setting { section, name, .. } = &fact.settled_by else { return None };
    let prefix = if *section == "parameters" { "parameter." } else { "setting." };
    control.setting_row(&format!("{prefix}{name}"))
}
