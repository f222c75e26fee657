//! Program numbers on the target.

use super::{Input, Lock};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Control;
use crate::ir::{Callee, Module, TermKind};
use crate::legalize::{Context, calls_of};
use crate::syntax::ProgramName;
use std::collections::{BTreeMap, BTreeSet};

/// First number for main programs that have none on the source, and for subroutines made programs.
const FIRST_MAIN: u32 = 1000;
const FIRST_SUB: u32 = 8000;

/// Gives every program that has a name a number: its own, the lock's, or the next free one.
pub fn number_programs(
    module: &Module,
    lock: &mut Lock,
    target: &Control,
    context: &mut Context<'_>,
) -> Vec<(ProgramName, u32)> {
    let mut taken: BTreeSet<u32> = lock.programs.values().copied().collect();
    let names: BTreeSet<&ProgramName> = module.programs.iter().filter_map(|p| p.name.as_ref()).collect();
    for name in &names {
        if let ProgramName::Number(n) = name {
            taken.insert(*n);
        }
    }
    // Calls that leave the library keep their numbers free, too.
    for call in module.programs.iter().flat_map(|p| &p.blocks).flat_map(calls_of) {
        if let Callee::Program(ProgramName::Number(n)) = &call.callee {
            taken.insert(*n);
        }
    }
    let max = target.text().program_max;
    // Numbers are only ever taken: each search goes on where the last one ended.
    let mut free = [FIRST_MAIN, FIRST_SUB].map(|first| (first..=max).chain(1..first));
    let mut out = Vec::new();
    for (index, program) in module.programs.iter().enumerate() {
        let Some(name) = &program.name else { continue };
        let key = name.to_string();
        let number = match (lock.programs.get(&key), name) {
            (_, ProgramName::Number(n)) if *n >= 1 && *n <= max => Some(*n),
            (Some(n), _) => Some(*n),
            _ => {
                let sub = program.returns() && !program.ends();
                free[usize::from(sub)].find(|n| !taken.contains(n))
            }
        };
        match number {
            Some(number) => {
                if *name != ProgramName::Number(number) {
                    if let ProgramName::Number(_) = name {
                        let what = format!(
                            "{name} becomes {}: the target's numbers end at {max}",
                            ProgramName::Number(number)
                        );
                        let help =
                            "call and select it by its new number; the lock beside the conversion keeps it";
                        context.add(
                            index,
                            Diagnostic::new(Code::Renumbered, program.site.span, what).with_help(help),
                        );
                    }
                    taken.insert(number);
                    lock.programs.insert(key, number);
                }
                out.push((name.clone(), number));
            }
            None => {
                let what = format!("no program number up to {max} is free for '{key}'");
                context.add(index, Diagnostic::new(Code::OutOfNumbers, program.site.span, what));
            }
        }
    }
    out
}

/// Reports programs that share a number: only one of them can be in a control. Where the library calls
/// that number it is not known which one is meant.
pub fn report_twins(module: &Module, inputs: &[Input], found: &mut [Vec<Diagnostic>]) {
    let mut twins: BTreeMap<&ProgramName, Vec<usize>> = BTreeMap::new();
    for (index, program) in module.programs.iter().enumerate() {
        if let Some(name) = &program.name {
            twins.entry(name).or_default().push(index);
        }
    }
    twins.retain(|_, indexes| indexes.len() > 1);
    let place = |index: &usize| {
        let file = module.programs[*index].file;
        inputs.get(file).map_or("", |input| input.name.as_str())
    };
    for (name, indexes) in &twins {
        let mut places: BTreeMap<&str, usize> = BTreeMap::new();
        indexes.iter().for_each(|index| *places.entry(place(index)).or_default() += 1);
        for index in indexes {
            let others = places.iter().filter(|(other, count)| **other != place(index) || **count > 1);
            let others = others.map(|(other, _)| *other).collect::<Vec<_>>().join(", ");
            let what = format!("{name} stands in {others} as well: a control can hold one of them");
            found[*index].push(Diagnostic::new(Code::TwinProgram, module.programs[*index].site.span, what));
        }
    }
    let all = |indexes: &Vec<usize>| indexes.iter().map(place).collect::<Vec<_>>().join(", ");
    let places: BTreeMap<&ProgramName, String> =
        twins.iter().map(|(name, indexes)| (*name, all(indexes))).collect();
    for (index, program) in module.programs.iter().enumerate() {
        for block in &program.blocks {
            let modal = calls_of(block).map(|call| &call.callee);
            let chained = match &block.term.kind {
                TermKind::Chain(name) => Some(Callee::Program(name.clone())),
                _ => None,
            };
            for callee in modal.chain(chained.as_ref()) {
                if let Callee::Program(name) = callee
                    && let Some(places) = places.get(name)
                {
                    let what =
                        format!("calls {name}, which stands in {places}: which one is meant is not known");
                    found[index].push(Diagnostic::new(Code::AmbiguousCall, block.term.site.span, what));
                }
            }
        }
    }
}
