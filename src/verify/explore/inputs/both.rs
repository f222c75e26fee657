//! What a program and its conversion take from outside, by the source's names.

use super::input::{Input, Inputs};
use super::read::{inputs_by, labels, set_for};
use super::reader::Locals;
use crate::control::ProgramRef;
use crate::verify::sides::{Arguments, Side, SymbolMap, class_of};
use std::collections::BTreeSet;

/// The most values of one variable that are tried.
const VALUES: usize = 60;

/// Labels that a computed jump is sent to, at the most.
const LABELS: usize = 40;

/// Reads both sides. What the target alone reads, in registers that no variable of the source has, is tried if nobody
/// calls the program: a main program finds there what the job before left.
pub fn inputs_of_both(
    (source, program): (&Side<'_>, ProgramRef),
    (target, there): (&Side<'_>, ProgramRef),
    names: &SymbolMap,
    (called, arguments): (bool, Option<&Arguments>),
) -> Inputs {
    // Labels that only one side has tell more than those of both.
    let (ours, theirs) = (labels(source, program), labels(target, there));
    let one_sided = theirs.difference(&ours).chain(ours.difference(&theirs));
    let order: Vec<u32> = one_sided.chain(ours.intersection(&theirs)).copied().take(LABELS).collect();
    // A target without locals gets what it is called with in registers: those must be known to give them to a program by itself.
    let locals = match (target.has_locals(), arguments) {
        (true, _) => Locals::All,
        (false, Some(arguments)) => Locals::These(arguments),
        (false, None) => Locals::None,
    };
    let mut found = inputs_by(source, program, locals, &order);
    let other = inputs_by(target, there, Locals::All, &order);
    let mut places = Vec::new();
    for input in other.variables {
        places.push(add(&mut found, input, (source, target), names, called));
    }
    let place = |at: usize| places.get(at).copied().flatten();
    let pairs = other.pairs.iter().filter_map(|(a, b)| Some((place(*a)?, place(*b)?)));
    found.pairs = pairs.chain(found.pairs).collect::<BTreeSet<_>>().into_iter().collect();
    extend(&mut found.numbers, &other.numbers);
    for (cell, values) in other.cells {
        extend(found.cells.entry(cell).or_default(), &values);
    }
    found.skips.extend(other.skips);
    found.asks |= other.asks;
    found.turns_by_sign |= other.turns_by_sign;
    for (own, others) in found.rotary.iter_mut().zip(other.rotary) {
        *own |= others;
    }
    set_for(found, source, target)
}

/// Adds what the target reads: to the source's variable, where it is one. Yields its place.
fn add(
    found: &mut Inputs,
    input: Input,
    (source, target): (&Side<'_>, &Side<'_>),
    names: &SymbolMap,
    called: bool,
) -> Option<usize> {
    let (from, to) = (source.control, target.control);
    let new = match names.of_source(&input.name, from, to) {
        Some(name) => {
            if let Some(at) = found.variables.iter().position(|own| !own.theirs && own.name == name) {
                extend(&mut found.variables[at].values, &input.values);
                return Some(at);
            }
            let nullable = class_of(from, &name).is_some_and(|class| class.nullable);
            Input { name, nullable, ..input }
        }
        None if called || names.is_named(&input.name, to) => return None,
        None => Input { theirs: true, ..input },
    };
    found.variables.push(new);
    Some(found.variables.len() - 1)
}

fn extend(values: &mut Vec<f64>, more: &[f64]) {
    let new: Vec<f64> = more.iter().copied().filter(|value| !values.contains(value)).collect();
    values.extend(new);
    values.truncate(VALUES);
}
