//! Programs that stand in the target's machine by its profile, and are no part of the library.
//!
//! What they do nobody knows here; that it is the same as on the source, with the same arguments and variables, the
//! profile says. So a call of one is no question. All that is known before it is lost after it, as after every call
//! that leaves the library.

use crate::ir::analysis::calls_of;
use crate::ir::{Call, Callee, Module};
use crate::legalize::Context;
use crate::legalize::registers::needs::has_locals;
use crate::syntax::ProgramName;
use std::collections::{BTreeMap, BTreeSet};

/// The number on the target of a program that stands there and is not in the library; none if none does. Where calls
/// of one of the two controls give no arguments, none does the same.
pub(in crate::legalize) fn number_of(name: &ProgramName, context: &Context<'_>) -> Option<u32> {
    let ProgramName::Number(number) = name else { return None };
    let both = has_locals(context.source) && has_locals(context.target);
    context.target.standing().number_of(*number).filter(|_| both)
}

/// The names of the library's own programs.
pub(in crate::legalize) fn known(module: &Module) -> BTreeSet<ProgramName> {
    module.programs.iter().filter_map(|program| program.name.clone()).collect()
}

/// The number by which a call runs such a program; none if it runs another one. `known` are the library's own.
pub(in crate::legalize) fn outside(
    call: &Call,
    known: &BTreeSet<ProgramName>,
    context: &Context<'_>,
) -> Option<u32> {
    match &call.callee {
        Callee::Program(name @ ProgramName::Number(number)) if !known.contains(name) => {
            number_of(name, context).map(|_| *number)
        }
        _ => None,
    }
}

/// The programs of the library that call such a one themselves, and which.
pub(in crate::legalize) fn callers(module: &Module, context: &Context<'_>) -> BTreeMap<usize, BTreeSet<u32>> {
    let mut found: BTreeMap<usize, BTreeSet<u32>> = BTreeMap::new();
    if context.target.standing().is_empty() {
        return found;
    }
    let known = known(module);
    let outside = |call: &Call| outside(call, &known, context);
    for (index, program) in module.programs.iter().enumerate() {
        for number in program.blocks.iter().flat_map(calls_of).filter_map(outside) {
            found.entry(index).or_default().insert(number);
        }
    }
    found
}

/// Programs that calls tie to one another with some: those that run with them, however far up and down.
pub(in crate::legalize) fn tied_to(
    some: impl IntoIterator<Item = usize>,
    pairs: &[(usize, usize)],
) -> BTreeSet<usize> {
    let mut ties: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (caller, callee) in pairs {
        ties.entry(*caller).or_default().push(*callee);
        ties.entry(*callee).or_default().push(*caller);
    }
    let mut open: Vec<usize> = some.into_iter().collect();
    let mut found: BTreeSet<usize> = BTreeSet::new();
    while let Some(at) = open.pop() {
        if found.insert(at) {
            open.extend(ties.get(&at).into_iter().flatten());
        }
    }
    found
}
