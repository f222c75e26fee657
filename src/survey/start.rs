//! What programs take from the machine when they begin, because they do not say it themselves.

use super::shape::{NAMED, Places};
use crate::canon::{Group, Op, Role};
use crate::dialect::{Control, StartMode};
use crate::ir::Module;
use crate::legalize::rests_on;
use serde::Serialize;
use std::collections::BTreeMap;

/// A mode that programs of the library begin in without naming it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AskedStart {
    /// Its group.
    #[serde(skip)]
    pub group: Group,
    /// Its group, in words: `the unit`.
    pub what: &'static str,
    /// The codes of which one is in force: `G20`, `G21`.
    pub codes: Vec<String>,
    /// How many programs rest on it.
    pub programs: usize,
    /// The first of them, as `file:line`.
    pub places: Vec<String>,
}

/// The modes that the profile does not say; those that most programs rest on are first.
pub(super) fn asked(places: &Places<'_>, source: &Control, module: &Module) -> Vec<AskedStart> {
    let rests = rests_on(module);
    let is_said = |group: Group| {
        let unit = group == Group::Units && source.units().is_some();
        unit || source.start().iter().any(|mode| mode.op.group() == group)
    };
    let of_group = |group: Group| {
        let programs = module.programs.iter().zip(&rests).filter(|(_, rests)| rests.contains(&group));
        let programs: Vec<_> = programs.map(|(program, _)| program).collect();
        let codes = codes(source, group);
        // Of a single one there is nothing to ask: the machine is always in it.
        let asks = !programs.is_empty() && codes.len() > 1 && !is_said(group);
        asks.then(|| AskedStart {
            group,
            what: words(group),
            codes,
            programs: programs.len(),
            places: programs.iter().take(NAMED).map(|one| places.at(one.file, one.site.span)).collect(),
        })
    };
    let mut all: Vec<AskedStart> = StartMode::GROUPS.into_iter().filter_map(of_group).collect();
    all.sort_by_key(|asked| std::cmp::Reverse(asked.programs));
    all
}

fn words(group: Group) -> &'static str {
    match group {
        Group::Units => "the unit",
        Group::Distance => "absolute or incremental",
        Group::Plane => "the plane",
        Group::FeedMode => "feed a minute or a turn",
        Group::Motion => "rapid or feed",
        Group::WorkOffset => "the work offset",
        _ => group.meaning(),
    }
}

/// The codes of a group that a profile may name under `[start]`.
fn codes(control: &Control, group: Group) -> Vec<String> {
    let ops: &[Op] = match group {
        Group::Units => &[Op::Inch, Op::Metric],
        Group::Distance => &[Op::Absolute, Op::Incremental],
        Group::Plane => &[Op::PlaneXy, Op::PlaneZx, Op::PlaneYz],
        Group::FeedMode => &[Op::FeedPerMinute, Op::FeedPerTurn],
        Group::Motion => &[Op::Rapid, Op::Linear],
        Group::WorkOffset => return work_offsets(control),
        _ => &[],
    };
    ops.iter().filter_map(|op| Some(control.code_for(*op, &BTreeMap::new())?.code.clone())).collect()
}

/// The codes of the first work offsets, as every machine has them.
fn work_offsets(control: &Control) -> Vec<String> {
    let code = |number: u32| {
        let fixed = BTreeMap::from([(Role::WorkOffset, f64::from(number))]);
        let row = control.code_for(Op::SelectWork, &fixed)?;
        // One that is written with a word of its own is no single code.
        row.fixed.contains_key(&Role::WorkOffset).then(|| row.code.clone())
    };
    (1..=6).filter_map(code).collect()
}
