//! States of the machine that a program may start in: what an earlier program, or a person, left in force.
//!
//! A program that leaves something out runs in what it finds. So both sides are run from states in which that shows:
//! each row here is one thing that may be otherwise than after power-on.

use crate::canon::{Group, Op};
use crate::control::entry::{Drilling, Entry};
use crate::control::{ProgramRef, Scenario};
use crate::dialect::{CodeHead, Control, StartMode};
use crate::syntax::{ExprKind, Item, ItemKind, Word, for_each_item};
use crate::verify::sides::{Job, Side, of_target};
use std::collections::BTreeSet;

/// Something that a program may find otherwise than after power-on.
#[derive(Debug)]
pub struct Start {
    /// Its name in certificates.
    pub name: &'static str,
    /// What it is, in words.
    pub noun: &'static str,
    /// How a program is started then, in words.
    pub words: &'static str,
    /// The mode that is in force then; none for what is no mode.
    mode: Option<Op>,
    /// What is no mode: the operation that both controls must have a code of.
    code: Option<Op>,
    /// Puts what is no mode.
    put: fn(&mut Entry),
    /// Tried where a program names a code of this group, or one of these; always where there are none.
    named: (Option<Group>, &'static [Op]),
    /// True for what turns coordinates about, so that other things may not show beside it.
    pub turns: bool,
    /// True for what controls go back to when they are switched on or reset: a program may rest on that.
    pub resets: bool,
    /// True for what a reset and power-on switch off: a program that does not return may rest on that, whose caller may leave it on.
    pub ends: bool,
}

/// A state that every program is tried in.
const fn always(name: &'static str, noun: &'static str, words: &'static str) -> Start {
    Start {
        name,
        noun,
        words,
        mode: None,
        code: None,
        put: |_| {},
        named: (None, &[]),
        turns: false,
        resets: false,
        ends: false,
    }
}

/// A state that a reset ends.
const fn reset(name: &'static str, noun: &'static str, words: &'static str) -> Start {
    Start { resets: true, ..always(name, noun, words) }
}

/// The other unit; which one that is, is each side's own matter.
pub const UNIT: Start = always("unit", "the unit in force", "in the other unit");

const WORK_OFFSET: &str = "work.offset";

/// The name of a drilling cycle in force.
pub const CYCLE: &str = "cycle";

/// All others, those that turn coordinates about last.
const STARTS: &[Start] = &[
    Start {
        put: |entry| entry.work = Some(3),
        ..always(WORK_OFFSET, "the work offset that is selected", "in the third work offset")
    },
    Start {
        put: |entry| entry.feed = Some(777.0),
        ..always("feed", "the feed in force", "with a feed in force")
    },
    Start {
        mode: Some(Op::FeedPerTurn),
        ..reset("feed.mode", "the unit of the feed", "with feed per turn in force")
    },
    Start {
        put: |entry| entry.length = Some(17),
        named: (Some(Group::LengthComp), &[]),
        ..always("length", "the tool length in force", "with a tool length in force")
    },
    Start {
        code: Some(Op::RadiusLeft),
        put: |entry| entry.cutter = Some(18),
        named: (Some(Group::RadiusComp), &[]),
        ..reset("radius", "the cutter compensation in force", "with cutter compensation in force")
    },
    Start {
        mode: Some(Op::ReturnR),
        named: (Some(Group::Cycle), &[Op::ReturnInitial, Op::ReturnR]),
        ..reset("return.plane", "the plane that cycles return to", "with cycles that return to the plane R")
    },
    Start {
        mode: Some(Op::ExactStop),
        named: (Some(Group::PathMode), &[]),
        ..reset("path.mode", "the mode of exact stops", "in the mode of exact stops")
    },
    Start {
        put: |entry| entry.spindle = Some(77.0),
        named: (Some(Group::Spindle), &[]),
        ends: true,
        ..always("spindle", "whether the spindle runs", "with the spindle running")
    },
    Start {
        put: |entry| entry.coolant = true,
        named: (Some(Group::Coolant), &[]),
        ends: true,
        ..always("coolant", "whether the coolant is on", "with the coolant on")
    },
    Start {
        code: Some(Op::LocalShift),
        put: |entry| entry.local = Some(shifted(12.7)),
        named: (None, &[Op::LocalShift]),
        ..reset("local.shift", "the local shift in force", "with a local shift in force")
    },
    Start {
        mode: Some(Op::Incremental),
        turns: true,
        ..reset("distance", "absolute or incremental mode", "in incremental mode")
    },
    Start { mode: Some(Op::PlaneZx), turns: true, ..reset("plane", "the plane in force", "in the ZX plane") },
    Start {
        mode: Some(Op::Linear),
        turns: true,
        ..reset("motion", "the motion mode", "with moves at feed in force")
    },
    Start {
        code: Some(Op::CycleDrill),
        put: |entry| entry.cycle = Some(Drilling { retract: 2.54, bottom: -25.4 }),
        named: (Some(Group::Cycle), &[]),
        turns: true,
        ..reset(CYCLE, "the drilling cycle in force", "with a drilling cycle in force")
    },
    Start {
        code: Some(Op::RotateOn),
        put: |entry| entry.rotation = Some(30.0),
        named: (Some(Group::Rotation), &[]),
        turns: true,
        ..reset("rotation", "the rotation in force", "with coordinates rotated")
    },
    Start {
        code: Some(Op::ScaleOn),
        put: |entry| entry.scale = Some(2.0),
        named: (Some(Group::Scaling), &[]),
        turns: true,
        ..reset("scale", "the scale in force", "with coordinates scaled")
    },
    Start {
        code: Some(Op::MirrorOn),
        put: |entry| entry.mirror = true,
        named: (Some(Group::Mirror), &[]),
        turns: true,
        ..reset("mirror", "the mirror image in force", "with X mirrored")
    },
];

/// X, Y and Z shifted by so many millimetres.
fn shifted(by: f64) -> crate::control::scenario::Axes {
    std::array::from_fn(|axis| if axis < 3 { by } else { 0.0 })
}

impl Start {
    /// Lets a scenario start so.
    pub fn put(&self, scenario: &mut Scenario) {
        scenario.modes.extend(self.mode);
        (self.put)(&mut scenario.entry);
    }

    /// The modal group of what is in force; none of the unit, and of what is no mode.
    pub fn group(&self) -> Option<Group> {
        self.mode.or(self.code).map(|op| op.group()).or(self.named.0)
    }

    /// True for what a machine profile may say under `[start]`.
    pub fn is_stated(&self) -> bool {
        let group = self.mode.map(|mode| mode.group()).filter(|group| *group != Group::ReturnPlane);
        group.is_some_and(|group| StartMode::GROUPS.contains(&group)) || self.name == WORK_OFFSET
    }

    /// True where both machines may start so, and either program has something to do with it.
    fn concerns(&self, controls: [&Control; 2], named: Option<&BTreeSet<Op>>) -> bool {
        let has = |op: Op| controls.iter().all(|control| control.code_for(op, &Default::default()).is_some());
        let (group, single) = self.named;
        let is_named = |op: &Op| Some(op.group()) == group || single.contains(op);
        let always = group.is_none() && single.is_empty();
        self.mode.or(self.code).is_none_or(has)
            && (always || named.is_none_or(|named| named.iter().any(is_named)))
    }
}

/// The states that a program and its conversion are to be started in; the unit is left out.
pub fn starts(job: &Job<'_>, program: ProgramRef) -> Vec<&'static Start> {
    let (ours, computed) = named(job.source, &job.source.links().called_from(program, |_| true));
    // A code that only the target computes is one that the source names: what it does shows from any start.
    let (theirs, _) = named(job.target, &of_target(job, program));
    let all: Option<BTreeSet<Op>> = (!computed).then(|| ours.union(&theirs).copied().collect());
    let controls = [job.source.control, job.target.control];
    STARTS.iter().filter(|start| start.concerns(controls, all.as_ref())).collect()
}

/// The operations that the codes of programs name, and whether one is computed, which may be any.
fn named(side: &Side<'_>, programs: &[ProgramRef]) -> (BTreeSet<Op>, bool) {
    let (mut found, mut computed) = (BTreeSet::new(), false);
    for block in programs.iter().flat_map(|program| side.text(*program)) {
        for_each_item(&block.items, &mut |item| {
            let ItemKind::Word(word) = &item.kind else { return };
            match ops(side.control, word) {
                Some(ops) => found.extend(ops),
                None => computed = true,
            }
        });
    }
    (found, computed)
}

/// True where a program may end with a drilling cycle in force: in the order of its text one begins, and the text ends, or goes
/// elsewhere, before a code ends it.
pub fn leaves_cycle(side: &Side<'_>) -> bool {
    let of_cycle = |items: &[Item]| {
        let mut any = false;
        for_each_item(items, &mut |item| {
            let ItemKind::Word(word) = &item.kind else { return };
            any |= ops(side.control, word).is_none_or(|ops| ops.iter().any(|op| op.group() == Group::Cycle));
        });
        any
    };
    side.links().programs().iter().any(|program| {
        let (mut drills, mut leaves) = (false, false);
        for block in side.text(*program) {
            for_each_item(&block.items, &mut |item| match &item.kind {
                ItemKind::Word(word) => match ops(side.control, word) {
                    None => leaves = true,
                    Some(ops) if ops.contains(&Op::CycleOff) => drills = false,
                    Some(ops) if ops.iter().any(|op| op.is_cycle()) => drills = true,
                    Some(ops) => leaves |= drills && ops.iter().any(|op| op.is_flow()),
                },
                ItemKind::Skip(_) => leaves |= drills || of_cycle(&block.items),
                ItemKind::EndOfBlock
                | ItemKind::Tape
                | ItemKind::Program(_)
                | ItemKind::Sequence { .. }
                | ItemKind::Label(_)
                | ItemKind::MacroMark
                | ItemKind::Comment(_)
                | ItemKind::Assign { .. } => {}
                _ => leaves |= drills,
            });
        }
        drills || leaves
    })
}

/// The operations that a word may say; none if it is a code that is computed.
fn ops(control: &Control, word: &Word) -> Option<Vec<Op>> {
    if !matches!(word.letter, 'G' | 'M') {
        return Some(control.word(word.letter, false).and_then(|row| row.op).into_iter().collect());
    }
    let Some(ExprKind::Number(number)) = word.value.as_ref().map(|value| &value.kind) else { return None };
    let head = CodeHead::new(word.letter, number.value);
    Some(head.into_iter().flat_map(|head| control.rows_of(head)).map(|row| row.op).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_turns_coordinates_comes_last_and_names_are_their_own() {
        let names: BTreeSet<&str> = STARTS.iter().map(|start| start.name).collect();
        assert_eq!(names.len(), STARTS.len());
        assert!(STARTS.is_sorted_by_key(|start| start.turns));
    }

    #[test]
    fn each_state_is_another_than_that_of_power_on() {
        for start in STARTS {
            let mut scenario = Scenario::default();
            start.put(&mut scenario);
            assert_ne!(scenario, Scenario::default(), "{}", start.name);
        }
    }
}
