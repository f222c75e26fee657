//! What cycles that are kept take from settings of the target, whatever those say.
//!
//! Law: the cycle shapes the same part: what is left is how its passes come there. Side conditions: the target's profile says that its settings
//! are right for all its cycles; whether a thread runs out at all is not left, nor a depth, an angle or an allowance of a contour.
//! Counter-example: a thread that ends in a groove, on a machine whose threads run out.

use super::cycle_values::setting_named;
use super::setting_values::{Found, So};
use super::settings::setting;
use crate::assume::Predicate;
use crate::canon::{CycleSetting, Op, Role};
use crate::dialect::{Control, Question};
use std::collections::BTreeMap;
use std::sync::Arc;

/// One of them.
#[derive(Clone)]
pub(super) struct Left {
    /// What it is.
    pub what: CycleSetting,
    /// The setting that says it on the target; none if the cycle itself has it so.
    pub name: Option<Arc<str>>,
    /// What the source has in its place; none if that is computed.
    pub value: Option<f64>,
    /// The unit of that where it is not the one of the target's profile.
    pub unit: Option<&'static str>,
}

/// True where the shop says that the settings of a control are right for its cycles.
pub(super) fn leaves(target: &Control) -> bool {
    target.behaviour(Question::CycleSettings).is_some_and(|row| row.value == "machine")
}

/// True of a setting that is known to be another, and that such an answer would leave.
pub(super) fn may_be_left(predicate: &Predicate, target: &Control) -> bool {
    let Predicate::Setting(name, value) = predicate else { return false };
    let number = |text: &str| text.parse::<f64>().ok();
    let Some(stated) = target.setting(name).and_then(number).filter(|stated| stated != value) else {
        return false;
    };
    let Some(row) = target.setting_row(name) else { return false };
    let of = |role: Role| row.cycles.iter().find_map(|op| CycleSetting::of(*op, role));
    let what = row.gives.or(row.otherwise).and_then(of);
    what.is_some_and(|what| what != CycleSetting::ThreadRunOut || stated > 0.0 && *value > 0.0)
}

/// What such an answer leaves of a cycle whose word for it the target takes from a setting. A thread that runs out is not left to a setting
/// that lets it end straight.
pub(super) fn left_of(
    (cycle, role): (Op, Role),
    value: Option<f64>,
    stated: Option<f64>,
    target: &Control,
) -> Option<CycleSetting> {
    let what = CycleSetting::of(cycle, role).filter(|_| leaves(target))?;
    let runs_out = |leads: Option<f64>| leads.is_some_and(|leads| leads > 0.0);
    (what != CycleSetting::ThreadRunOut || runs_out(value) && runs_out(stated)).then_some(what)
}

/// True where a thread runs out on the source, by more or less than others may, and the target's setting is known to let it end straight: a person
/// sets that, and how long they run out is left.
pub(super) fn runs_out_otherwise((cycle, role): (Op, Role), value: f64, target: &Control) -> bool {
    let what = CycleSetting::of(cycle, role).filter(|_| leaves(target));
    what == Some(CycleSetting::ThreadRunOut) && value > 0.0
}

/// True where the allowance of a thread is left, so that the target's cycle makes one finishing pass of its own.
pub(super) fn leaves_allowance(value: Option<f64>, target: &Control) -> bool {
    let is = (Op::Threading, Role::ThreadAllowance);
    let same = |stated: f64| value.is_some_and(|value| (value - stated).abs() < 1e-9);
    setting(target, is.0, is.1)
        .is_some_and(|(_, stated)| left_of(is, value, stated, target).is_some() && !stated.is_some_and(same))
}

/// What is said of each, once for a library.
pub(super) fn told(found: &[(usize, Found)], target: &Control) -> BTreeMap<CycleSetting, (String, String)> {
    let mut all: BTreeMap<CycleSetting, (Option<Arc<str>>, Vec<String>)> = BTreeMap::new();
    for (.., so) in found.iter().flat_map(|(_, found)| found) {
        let So::Left(left) = so else { continue };
        let value = match (left.value, left.unit) {
            (None, _) => "a computed number".to_owned(),
            (Some(value), None) => value.to_string(),
            (Some(value), Some(unit)) => format!("{value} ({unit})"),
        };
        let (name, values) = all.entry(left.what).or_default();
        *name = name.take().or_else(|| left.name.clone());
        if !values.contains(&value) {
            values.push(value);
        }
    }
    let said = all.into_iter().map(|(what, (name, mut values))| {
        values.sort_by(|one, other| {
            let number = |text: &str| text.parse::<f64>().unwrap_or(f64::MAX);
            number(one).total_cmp(&number(other)).then_with(|| one.cmp(other))
        });
        (what, (sentence(what, name.as_deref(), &values.join(", "), target), help(what).to_owned()))
    });
    said.collect()
}

fn sentence(what: CycleSetting, name: Option<&str>, values: &str, target: &Control) -> String {
    let title = &target.dialect().title;
    let by = match name {
        Some(name) => {
            let (kind, number) = setting_named(name);
            let stated = target.setting(name);
            let now = stated.map_or_else(
                || "which its profile does not give".to_owned(),
                |stated| format!("now {stated}"),
            );
            format!("{kind} {number} of the {title} ({now})")
        }
        None => format!("the cycle of the {title} itself (one)"),
    };
    let meaning = match what {
        CycleSetting::RoughRetract => "how far the passes of a roughed contour go back",
        CycleSetting::PeckRetract => "how far the pecks of a groove or a face go back",
        CycleSetting::ThreadLeast => "the least depth of a pass of a thread",
        CycleSetting::ThreadAllowance => "what is left of a thread for its last pass",
        CycleSetting::ThreadFinishes => "how many finishing passes a thread has",
        CycleSetting::ThreadRunOut => "how long a thread runs out, in leads",
    };
    format!(
        "cycles are kept, and {by} says {meaning}; the source has {values}. Runs are compared as if both had the same"
    )
}

fn help(what: CycleSetting) -> &'static str {
    match what {
        CycleSetting::RoughRetract => "look at the room that the tool has, most of all in a bore",
        CycleSetting::PeckRetract => "make sure that the chips break and come out with it",
        CycleSetting::ThreadLeast | CycleSetting::ThreadAllowance => {
            "the finished thread is the same, its passes are not: look at them where the tool or the part is weak"
        }
        CycleSetting::ThreadFinishes => {
            "write the thread once more where it needs another pass at its full depth"
        }
        CycleSetting::ThreadRunOut => "look at threads that end near a shoulder",
    }
}
