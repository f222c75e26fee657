//! Names on the target: numbers of programs, registers of variables.

use super::{Input, Lock};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Control;
use crate::emit::{Naming, Register, last_sequence};
use crate::ir::analysis::{Numbers, Ranges, Summaries};
use crate::ir::{Block, Call, Callee, Module, Program, StmtKind, TermKind};
use crate::legalize::{Context, Registers, calls_of};
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
    // A computed call must not find a program that has its number by this conversion.
    let looked_for = computed_calls(module);
    let max = target.text().program_max;
    let bounded = looked_for.last().is_none_or(|last| last < max);
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
                free[usize::from(sub)].find(|n| !(taken.contains(n) || bounded && looked_for.contains(*n)))
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
    report_looked_for(module, &looked_for, &out, context);
    out
}

fn computed(call: &Call) -> bool {
    matches!(call.callee, Callee::Computed(_))
}

/// The numbers of programs that computed calls look for.
fn computed_calls(module: &Module) -> Numbers {
    let callee = |block: &Block| match &block.term.kind {
        TermKind::Call { call, .. } => match &call.callee {
            Callee::Computed(number) => Some(number.clone()),
            _ => None,
        },
        _ => None,
    };
    let mut all = Numbers::default();
    if !module.programs.iter().flat_map(|program| &program.blocks).any(|block| calls_of(block).any(computed))
    {
        return all;
    }
    let summaries = Summaries::of(module);
    for program in &module.programs {
        let ranges = Ranges::of_any_inputs(program, &summaries);
        for (id, block) in program.ids().zip(&program.blocks) {
            // A modal one is called from wherever an axis moves.
            if block
                .stmts
                .iter()
                .any(|stmt| matches!(&stmt.kind, StmtKind::ModalCall(call) if computed(call)))
            {
                return Numbers::of([(0, u32::MAX)]);
            }
            if let Some(number) = callee(block) {
                all.join(&ranges.at(id, block.stmts.len(), &number).numbers());
            }
        }
    }
    all
}

/// Says where a computed call may look for a number that the conversion gave to a program.
fn report_looked_for(
    module: &Module,
    looked_for: &Numbers,
    given: &[(ProgramName, u32)],
    context: &mut Context<'_>,
) {
    let made = given.iter().filter(|(name, n)| *name != ProgramName::Number(*n) && looked_for.contains(*n));
    let made: BTreeSet<String> = made.map(|(_, number)| ProgramName::Number(*number).to_string()).collect();
    if made.is_empty() {
        return;
    }
    let what = format!(
        "which program is called is computed: it must be none of {}, which this conversion numbered",
        made.into_iter().collect::<Vec<_>>().join(", ")
    );
    for (index, program) in module.programs.iter().enumerate() {
        for block in &program.blocks {
            if calls_of(block).any(computed) {
                let told = Diagnostic::new(Code::Conditional, block.term.site.span, what.clone());
                context.add_once(index, &what, told);
            }
        }
    }
}

/// What everything is called on the target.
pub fn naming(module: &Module, registers: &Registers, names: &[(ProgramName, u32)]) -> Naming {
    let mut naming = Naming::new();
    for (var, register) in &registers.of {
        let label = registers.names.get(var).cloned();
        naming.set_variable(*var, Register { label, ..Register::number(&register.name, register.number) });
    }
    for (name, number) in names {
        naming.set_program(name.clone(), *number);
    }
    let looks = |program: &Program| {
        let looks =
            |kind: &TermKind| matches!(kind, TermKind::Computed { .. } | TermKind::Return { to: Some(_) });
        program.blocks.iter().any(|block| looks(&block.term.kind))
    };
    if !module.programs.iter().any(looks) {
        return naming;
    }
    let summaries = Summaries::of(module);
    for program in module.programs.iter().filter(|program| looks(program)) {
        let ranges = Ranges::of_any_inputs(program, &summaries);
        for (id, block) in program.ids().zip(&program.blocks) {
            if let TermKind::Return { to: Some(to) } = &block.term.kind {
                naming.keep_sequences(&ranges.at(id, block.stmts.len(), to).numbers());
            }
        }
    }
    let last = module.programs.iter().map(last_sequence).max().unwrap_or(0);
    naming.set_summaries(summaries, last);
    naming
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
