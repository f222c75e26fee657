//! What the condition of a branch hangs on, by the text: the variables in it first, then those that they are set from.
//!
//! It orders a search and decides nothing. What sets a variable anywhere in the program counts, whatever way leads there.

use super::steer::Input;
use crate::canon::Sys;
use crate::control::Scenario;
use crate::dialect::Control;
use crate::syntax::{Block, Expr, ExprKind, Index, Item, ItemKind, VarRef, for_each_expr, for_each_item};
use crate::text::Span;
use std::collections::BTreeSet;

/// Variables that are followed, at the most.
const MOST: usize = 200;

/// A variable with a number.
type Named = (String, u32);

/// The variables that the block at a place hangs on, the nearest first.
pub fn hangs_on(blocks: &[Block], place: Span) -> Vec<Named> {
    let here = |block: &&Block| block.span.start < place.end && place.start < block.span.end;
    let mut found: Vec<Named> = Vec::new();
    let mut known: BTreeSet<Named> = BTreeSet::new();
    let mut take = |named: Named, found: &mut Vec<Named>| {
        if found.len() < MOST && known.insert(named.clone()) {
            found.push(named);
        }
    };
    for block in blocks.iter().filter(here) {
        variables(&block.items).into_iter().for_each(|named| take(named, &mut found));
    }
    let mut sets: Vec<(Named, Vec<Named>)> = Vec::new();
    for item in blocks.iter().flat_map(|block| &block.items) {
        for_each_item(std::slice::from_ref(item), &mut |item| {
            if let ItemKind::Assign { target, .. } = &item.kind
                && let Some(target) = named(target)
            {
                sets.push((target, variables(std::slice::from_ref(item))));
            }
        });
    }
    let mut at = 0;
    while let Some(next) = found.get(at).cloned() {
        at += 1;
        let of = sets.iter().filter(|(target, _)| *target == next).flat_map(|(_, from)| from.clone());
        of.for_each(|named| take(named, &mut found));
    }
    found
}

fn variables(items: &[Item]) -> Vec<Named> {
    let mut all = Vec::new();
    for_each_expr(items, &mut |e: &Expr| {
        if let ExprKind::Variable(variable) = &e.kind {
            all.extend(named(variable));
        }
    });
    all
}

fn named(variable: &VarRef) -> Option<Named> {
    match &variable.index {
        Index::Number(number) => Some((variable.name.to_string(), *number)),
        _ => None,
    }
}

/// The inputs that stand in `hangs_on`, in its order, and the others.
pub fn in_order(
    all: Vec<Input>,
    hangs_on: &[Named],
    control: &Control,
    scenario: &Scenario,
) -> [Vec<Input>; 2] {
    let rank = |input: &Input| {
        let is_it = |(name, number): &Named| match input {
            Input::Variable(own, _) => *own == format!("{name}{number}"),
            _ => control
                .read_system(name, Some(*number))
                .is_some_and(|(state, subscripts, _)| is_state(input, state, &subscripts, scenario)),
        };
        hangs_on.iter().position(is_it).unwrap_or(usize::MAX)
    };
    let mut ranked: Vec<(usize, Input)> = all.into_iter().map(|input| (rank(&input), input)).collect();
    // Where a probe move begins tells more than how far it gets.
    ranked.sort_by_key(|(rank, input)| (*rank, matches!(input, Input::Probe(_))));
    let (near, others): (Vec<_>, Vec<_>) = ranked.into_iter().partition(|(rank, _)| *rank < usize::MAX);
    [near, others].map(|inputs| inputs.into_iter().map(|(_, input)| input).collect())
}

/// True for the input that a state of the machine is.
fn is_state(input: &Input, state: Sys, subscripts: &[u32], scenario: &Scenario) -> bool {
    match input {
        Input::State(at) => {
            scenario.state.get(*at).is_some_and(|own| own.state == state && own.subscripts == subscripts)
        }
        Input::Start(axis) => {
            let place = matches!(state, Sys::EndPosition | Sys::MachinePosition | Sys::WorkPosition);
            place && subscripts.last().is_some_and(|own| *own as usize == axis + 1)
        }
        // Where a probe move ends is where the next one begins.
        Input::Probe(_) => matches!(state, Sys::SkipPosition | Sys::EndPosition | Sys::WorkPosition),
        Input::Tool => state == Sys::ActiveTool,
        Input::Selected => Input::is_selected(state, subscripts),
        own => Input::of_cell(state, subscripts).as_ref() == Some(own),
    }
}

#[cfg(test)]
mod tests {
    use super::hangs_on;
    use crate::dialect::Control;
    use crate::syntax::parse_file;
    use crate::text::Span;

    #[test]
    fn the_nearest_come_first() {
        let text = "O1\n#3=#4+#5003\n#2=#3\n#9=#8\nIF[#1GT#2]GOTO5\nN5\nM99\n";
        let control = Control::from_profile("dialect = \"fanuc\"\n").unwrap();
        let parsed = parse_file(text.as_bytes(), control.entry().parse);
        let at = u32::try_from(text.find("IF").unwrap()).unwrap();
        let found = hangs_on(&parsed.blocks, Span { start: at, end: at + 1 });
        let numbers: Vec<u32> = found.iter().map(|(_, number)| *number).collect();
        assert_eq!(numbers, [1, 2, 3, 4, 5003]);
    }
}
