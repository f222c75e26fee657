//! What the programs of a file leave set where they return.

use super::others::Others;
use super::shape::Shape;
use super::state::{Motion, Sets};
use super::ways::Flow;
use crate::canon::Role;
use crate::dialect::Control;
use crate::lower::common::ProgramText;
use crate::lower::fadal::codes::{Codes, Step, operand, program_number, steps};
use crate::syntax::{Block, ProgramName};
use std::collections::{BTreeMap, BTreeSet};

impl Others {
    /// Looks through the programs.
    pub fn of(texts: &[ProgramText<'_>], control: &Control) -> Self {
        let mut others = Self::that_set(sets_of_others(texts));
        let Some(order) = callees_first(texts, control) else { return others };
        for at in order {
            let Some((text, number)) = texts.get(at).and_then(|text| Some((text, number_of(text)?))) else {
                continue;
            };
            let shape = Shape::new(text.blocks, control);
            let flow = Flow::new(text.blocks, control, &shape, (&others, at));
            if let Some(state) = flow.left() {
                others.leaves(number, Motion::of(state));
            }
        }
        others
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
