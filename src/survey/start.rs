//! What programs take from the machine when they begin, because they do not say it themselves.

use super::filled::{ASKS, TELLS, plain};
use super::shape::{NAMED, Places};
use crate::canon::{Group, Op, Role};
use crate::dialect::{CODE_SYSTEM, Control, Machine, Question, Settled, StartMode};
use crate::ir::Module;
use crate::legalize::{cancels_length, rests_on, rests_unwritten};
use crate::library::{Input, by_other_systems, understood};
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

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
    /// These by G code system, where the library shows another one than is taken, and none is said.
    #[serde(skip)]
    pub systems: Vec<(String, Vec<String>)>,
    /// How many programs rest on it.
    pub programs: usize,
    /// The first of them, as `file:line`.
    pub places: Vec<String>,
}

impl AskedStart {
    /// True for the unit, which a profile says by a key of its own, and not under `[start]`.
    pub(super) fn is_unit(&self) -> bool {
        self.group == Group::Units
    }

    /// The codes in words: `G20, G21`, or `G20, G21 in B; G70, G71 in C`. The unit has a key of its own.
    pub fn told(&self) -> String {
        if self.is_unit() {
            return Settled::choice("units", &["inch", "metric"]);
        }
        let mut lists: Vec<(&[String], Vec<&str>)> = Vec::new();
        for (system, codes) in &self.systems {
            match lists.iter_mut().find(|(known, _)| known == codes) {
                Some((_, systems)) => systems.push(system),
                None => lists.push((codes, vec![system])),
            }
        }
        if lists.is_empty() {
            return self.codes.join(", ");
        }
        let told =
            lists.iter().map(|(codes, systems)| format!("{} in {}", codes.join(", "), systems.join(" and ")));
        told.collect::<Vec<_>>().join("; ")
    }
}

/// What programs begin in without saying it, as one line to fill in with a line for each mode before it; a line for each G code system,
/// where that is open. What is `said` stays, and gets more codes.
pub(super) fn lines(asked: &[AskedStart], said: Option<&str>) -> String {
    let mut lines = String::new();
    let _ =
        writeln!(lines, "{TELLS} What is in force after a reset, as the machine's page of codes shows it.");
    if asked.iter().any(|asked| !asked.systems.is_empty()) {
        let _ = writeln!(lines, "{TELLS} Answer {CODE_SYSTEM} first, and take the codes of that system.");
    }
    for begun @ AskedStart { what, programs, places, .. } in asked {
        let programs = if *programs == 1 { "1 program".to_owned() } else { format!("{programs} programs") };
        let (codes, places) = (begun.told(), plain(&places.join(", ")));
        let one_of = if begun.codes.len() > 1 { "one of " } else { "" };
        let _ = writeln!(lines, "{TELLS} {what}: {one_of}{codes} ({programs}: {places})");
    }
    for (choice, of) in choices(asked) {
        let _ = match said {
            Some(_) => writeln!(lines, "{TELLS} Write these into codes too, one of each: {choice}{of}"),
            None => writeln!(lines, "{ASKS} codes = \"{choice}\"{of}"),
        };
    }
    lines
}

/// What is to be chosen from, each with whose it is, if that hangs on the G code system.
fn choices(asked: &[AskedStart]) -> Vec<(String, String)> {
    let systems: BTreeSet<&String> =
        asked.iter().flat_map(|asked| &asked.systems).map(|(system, _)| system).collect();
    if systems.is_empty() {
        let choice = asked.iter().map(|asked| asked.codes.join("|")).collect::<Vec<_>>();
        return vec![(choice.join(" "), String::new())];
    }
    let of = |system: &String| {
        let own = |asked: &AskedStart| {
            asked.systems.iter().find(|(of, _)| of == system).map(|(_, codes)| codes.join("|"))
        };
        asked.iter().filter_map(own).collect::<Vec<_>>().join(" ")
    };
    let mut lines: Vec<(String, Vec<&str>)> = Vec::new();
    for system in systems {
        let choice = of(system);
        match lines.iter_mut().find(|(known, _)| *known == choice) {
            Some((_, systems)) => systems.push(system),
            None => lines.push((choice, vec![system])),
        }
    }
    let told = |(choice, systems): (String, Vec<&str>)| {
        (choice, format!(" # in G code system {}", systems.join(" and ")))
    };
    lines.into_iter().map(told).collect()
}

/// The modes that the profile does not say, by each G code system of a lathe but for the one that is taken and is not hers.
pub(super) fn asked_by_others(places: &Places<'_>, inputs: &[Input], source: &Control) -> Vec<AskedStart> {
    let mut all: Vec<AskedStart> = Vec::new();
    for (system, control) in by_other_systems(source) {
        let is_said = |asked: &AskedStart| source.start().iter().any(|mode| mode.op.group() == asked.group);
        let of = asked(places, &control, &understood(inputs, &control).module);
        for mut new in of.into_iter().filter(|new| !is_said(new)) {
            let codes = new.codes.clone();
            match all.iter_mut().find(|old| old.group == new.group) {
                Some(old) => {
                    let more: Vec<String> =
                        codes.iter().filter(|code| !old.codes.contains(code)).cloned().collect();
                    old.codes.extend(more);
                    old.systems.push((system.clone(), codes));
                }
                None => {
                    new.systems.push((system.clone(), codes));
                    all.push(new);
                }
            }
        }
    }
    all
}

/// The modes that the profile does not say; those that most programs rest on are first.
pub(super) fn asked(places: &Places<'_>, source: &Control, module: &Module) -> Vec<AskedStart> {
    open(places, source, module, &rests_on(module))
}

/// The modes that the profile of the target does not say, of programs at whose heads no code can be written; and whether such programs
/// rest on its unit.
pub(super) fn asked_of_target(
    places: &Places<'_>,
    (source, target): (&Control, &Control),
    module: &Module,
) -> (Vec<AskedStart>, bool) {
    let mut rests = rests_unwritten(module);
    let unit = rests.iter().any(|rests| rests.contains(&Group::Units));
    // The unit is told where `units` is, and where holes end by each cycle, if the source has no codes for it.
    let told = |group: &Group| {
        *group == Group::Units || *group == Group::ReturnPlane && codes(source, *group).is_empty()
    };
    rests.iter_mut().for_each(|rests| rests.retain(|group| !told(group)));
    (open(places, target, module, &rests), unit)
}

/// That no tool length is in force when programs begin. It is asked of the machine whose code that ends a length moves the
/// axis, where that of the other does not; not if its profile has a `[start]`.
pub(super) fn no_length(
    places: &Places<'_>,
    [of, other]: [&Control; 2],
    module: &Module,
) -> Option<AskedStart> {
    let moves = |control: &Control| control.is(Question::LengthMoves);
    if !moves(of) || moves(other) || of.says_start() {
        return None;
    }
    let code = of.code_for(Op::LengthOff, &BTreeMap::new())?.code.clone();
    let programs = module.programs.iter().zip(cancels_length(module)).filter(|(_, cancels)| *cancels);
    let programs: Vec<_> = programs.map(|(program, _)| program).collect();
    (!programs.is_empty()).then(|| AskedStart {
        group: Group::LengthComp,
        what: "no tool length in force, for this code moves its axis",
        codes: vec![code],
        systems: Vec::new(),
        programs: programs.len(),
        places: programs.iter().take(NAMED).map(|one| places.at(one.file, one.site.span)).collect(),
    })
}

fn open(
    places: &Places<'_>,
    control: &Control,
    module: &Module,
    rests: &[BTreeSet<Group>],
) -> Vec<AskedStart> {
    let is_said = |group: Group| {
        let unit = group == Group::Units && control.units().is_some();
        unit || control.start().iter().any(|mode| mode.op.group() == group)
    };
    let of_group = |group: Group| {
        let programs = module.programs.iter().zip(rests).filter(|(_, rests)| rests.contains(&group));
        let programs: Vec<_> = programs.map(|(program, _)| program).collect();
        let codes = codes(control, group);
        // Of a single one there is nothing to ask: the machine is always in it.
        let asks = !programs.is_empty() && codes.len() > 1 && !is_said(group);
        asks.then(|| AskedStart {
            group,
            what: words(group),
            codes,
            systems: Vec::new(),
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
        Group::ReturnPlane => "where holes end: at the level where the cycle began, or at the retract plane",
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
        // Every mill begins in the first.
        Group::ReturnPlane if control.machine() == Machine::Lathe => &[Op::ReturnInitial, Op::ReturnR],
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
