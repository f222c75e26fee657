//! What the programs of a file leave set where they return.

use super::others::Others;
use super::shape::Shape;
use super::state::{Motion, Sets};
use super::ways::Flow;
use crate::canon::Role;
use crate::dialect::Control;
use crate::ir::analysis::CallGraph;
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

/// The programs that others of the file call, each after those that it calls itself; none if there are no calls. Not
/// those that come back to themselves, nor what calls them.
fn callees_first(texts: &[ProgramText<'_>], control: &Control) -> Option<Vec<usize>> {
    if texts.len() < 2 {
        return None;
    }
    let mut places: BTreeMap<u32, Option<usize>> = BTreeMap::new();
    for (at, text) in texts.iter().enumerate() {
        if let Some(number) = number_of(text) {
            places.entry(number).and_modify(|place| *place = None).or_insert(Some(at));
        }
    }
    let place = |number: u32| places.get(&number).copied().flatten();
    let callees: Vec<BTreeSet<(usize, bool)>> = texts
        .iter()
        .map(|text| {
            called(text.blocks, control).into_iter().filter_map(place).map(|at| (at, false)).collect()
        })
        .collect();
    let wanted: BTreeSet<usize> = callees.iter().flatten().map(|(callee, _)| *callee).collect();
    if wanted.is_empty() {
        return None;
    }
    let graph = CallGraph::new(callees);
    let mut order = graph.callees_first();
    let mut known = vec![false; texts.len()];
    for at in &order {
        known[*at] = graph.callees(*at).all(|callee| known[callee]);
    }
    order.retain(|at| known[*at] && wanted.contains(at));
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
