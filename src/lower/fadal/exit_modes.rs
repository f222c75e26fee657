//! What the programs of a file leave set where they return.

use super::flow::Flow;
use super::shape::Shape;
use super::state::{Sets, State, Values};
use super::statement::program_number;
use super::steps::{Step, operand, steps};
use super::words::Codes;
use crate::canon::Role;
use crate::dialect::Control;
use crate::lower::common::ProgramText;
use crate::syntax::{Block, Item, ProgramName};
use std::collections::{BTreeMap, BTreeSet};

/// The motion modes that a program leaves to its caller.
#[derive(Clone, Debug, Default)]
pub struct Motion {
    /// The interpolation.
    codes: Values<u32>,
    /// True where the caller's may still be in force.
    callers: bool,
    /// True where another program may have set it, of which nothing is known.
    unknown: bool,
    cycle: Values<u32>,
    after_cycle: bool,
    resumed: bool,
}

impl Motion {
    fn of(state: State) -> Self {
        Self {
            codes: state.motion,
            callers: state.motion_entry,
            unknown: state.motion_called,
            cycle: state.cycle,
            after_cycle: state.after_cycle,
            resumed: state.resumed,
        }
    }

    /// Lets the caller go on in it.
    pub fn give(&self, state: &mut State) {
        if self.callers {
            state.motion.join(&self.codes);
            // A cycle goes on if the program touches neither it nor the motion mode, which would end it.
            let sets_motion = self.codes.is_any() || !self.codes.list().is_empty();
            if sets_motion || self.after_cycle || self.cycle.is_any() || self.cycle.list() != [0] {
                state.cycle.join(&self.cycle);
            }
            state.motion_called |= self.unknown;
            state.after_cycle |= self.after_cycle;
            state.resumed |= self.resumed;
        } else {
            state.motion = self.codes.clone();
            state.cycle = self.cycle.clone();
            state.motion_entry = false;
            (state.motion_called, state.after_cycle, state.resumed) =
                (self.unknown, self.after_cycle, self.resumed);
        }
    }
}

/// What is known of the programs of a file.
#[derive(Debug, Default)]
pub struct Others {
    /// By number, the motion modes that a program leaves. Not of one that calls itself in the end, that returns
    /// to another place than that of its call, or whose number stands twice.
    motion: BTreeMap<u32, Motion>,
    /// What the programs before each set, and those after it.
    sets: Vec<Sets>,
}

impl Others {
    /// Looks through the programs.
    pub fn of(texts: &[ProgramText<'_>], control: &Control) -> Self {
        let mut others = Self { motion: BTreeMap::new(), sets: sets_of_others(texts) };
        let Some(order) = callees_first(texts, control) else { return others };
        for at in order {
            let Some((text, number)) = texts.get(at).and_then(|text| Some((text, number_of(text)?))) else {
                continue;
            };
            let shape = Shape::new(text.blocks, control);
            let flow = Flow::new(text.blocks, control, &shape, (&others, at));
            if let Some(state) = flow.left() {
                others.motion.insert(number, Motion::of(state));
            }
        }
        others
    }

    /// What the programs but this one set.
    pub fn sets(&self, own: usize) -> &Sets {
        const NONE: &Sets = &Sets::NONE;
        self.sets.get(own).unwrap_or(NONE)
    }

    /// The motion modes that the program of a call leaves, where they are known.
    pub fn motion(&self, items: &[Item], codes: &Codes<'_, '_>) -> Option<&Motion> {
        self.motion.get(&operand(items, codes, Role::Program).and_then(program_number)?)
    }
}

/// By program, what all but it set.
fn sets_of_others(texts: &[ProgramText<'_>]) -> Vec<Sets> {
    let mut all: Vec<Sets> = Vec::with_capacity(texts.len());
    let mut before = Sets::default();
    for text in texts {
        all.push(before.clone());
        before.add(text.blocks);
    }
    let mut after = Sets::default();
    for (sets, text) in all.iter_mut().zip(texts).rev() {
        sets.join(&after);
        after.add(text.blocks);
    }
    all
}

fn number_of(text: &ProgramText<'_>) -> Option<u32> {
    match text.name {
        Some(ProgramName::Number(number)) => Some(*number),
        _ => None,
    }
}

/// The programs that others of the file call, each after those that it calls itself; none if there are no calls.
fn callees_first(texts: &[ProgramText<'_>], control: &Control) -> Option<Vec<usize>> {
    let mut places: BTreeMap<u32, Option<usize>> = BTreeMap::new();
    for (at, text) in texts.iter().enumerate() {
        if let Some(number) = number_of(text) {
            places.entry(number).and_modify(|place| *place = None).or_insert(Some(at));
        }
    }
    let place = |number: u32| places.get(&number).copied().flatten();
    let callees: Vec<BTreeSet<usize>> = texts
        .iter()
        .map(|text| called(text.blocks, control).into_iter().filter_map(place).collect())
        .collect();
    let mut waits: Vec<usize> = callees.iter().map(BTreeSet::len).collect();
    let mut callers: Vec<Vec<usize>> = vec![Vec::new(); texts.len()];
    for (from, callees) in callees.iter().enumerate() {
        callees.iter().for_each(|to| callers.get_mut(*to).into_iter().for_each(|list| list.push(from)));
    }
    if callers.iter().all(Vec::is_empty) {
        return None;
    }
    let mut work: Vec<usize> = (0..texts.len()).filter(|at| waits.get(*at) == Some(&0)).collect();
    let mut order = Vec::new();
    // Programs that call each other in a circle are never ready.
    while let Some(at) = work.pop() {
        let Some(callers) = callers.get(at).filter(|callers| !callers.is_empty()) else { continue };
        if texts.get(at).and_then(number_of).and_then(place) == Some(at) {
            order.push(at);
        }
        for caller in callers {
            if let Some(left) = waits.get_mut(*caller) {
                *left -= 1;
                if *left == 0 {
                    work.push(*caller);
                }
            }
        }
    }
    Some(order)
}

/// The numbers of the programs that blocks call.
fn called(blocks: &[Block], control: &Control) -> BTreeSet<u32> {
    let mut found = BTreeSet::new();
    for block in blocks {
        let codes = Codes::new(&block.items, control);
        if steps(&block.items, &codes).contains(&Step::Program) {
            found.extend(operand(&block.items, &codes, Role::Program).and_then(program_number));
        }
    }
    found
}
