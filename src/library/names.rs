//! What everything is called on the target; programs that share a number.

use super::Input;
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question};
use crate::emit::{Naming, Register, last_sequence};
use crate::ir::analysis::{Ranges, Summaries};
use crate::ir::{Callee, Module, Program, TermKind};
use crate::legalize::{Registers, calls_of};
use crate::syntax::ProgramName;
use std::collections::BTreeMap;

/// True where a program without a number begins after a `%` on both controls, and stays what it is.
pub(super) fn both_nameless(source: &Control, target: &Control) -> bool {
    source.names().nameless && target.names().nameless
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
pub fn report_duplicates(module: &Module, inputs: &[Input], found: &mut [Vec<Diagnostic>]) {
    let mut duplicates: BTreeMap<&ProgramName, Vec<usize>> = BTreeMap::new();
    for (index, program) in module.programs.iter().enumerate() {
        if let Some(name) = &program.name {
            duplicates.entry(name).or_default().push(index);
        }
    }
    duplicates.retain(|_, indexes| indexes.len() > 1);
    let place = |index: &usize| {
        let file = module.programs[*index].file;
        inputs.get(file).map_or("", |input| input.name.as_str())
    };
    for (name, indexes) in &duplicates {
        let mut places: BTreeMap<&str, usize> = BTreeMap::new();
        indexes.iter().for_each(|index| *places.entry(place(index)).or_default() += 1);
        for index in indexes {
            let others = places.iter().filter(|(other, count)| **other != place(index) || **count > 1);
            let others = others.map(|(other, _)| *other).collect::<Vec<_>>().join(", ");
            let what = format!("{name} is also in {others}: a control can hold only one of them");
            let finding = Diagnostic::new(Code::TwinProgram, module.programs[*index].site.span, what);
            found[*index].push(finding.asked_once());
        }
    }
    let all = |indexes: &Vec<usize>| indexes.iter().map(place).collect::<Vec<_>>().join(", ");
    let places: BTreeMap<&ProgramName, String> =
        duplicates.iter().map(|(name, indexes)| (*name, all(indexes))).collect();
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
                        format!("calls {name}, which is in {places}: it is not known which one is meant");
                    found[index].push(Diagnostic::new(Code::AmbiguousCall, block.term.site.span, what));
                }
            }
        }
    }
}

/// Says of a call that leaves the library where a file has the number in its name, and no program in its text.
pub(super) fn tell_files_without_number(inputs: &[Input], found: &mut [Vec<Diagnostic>]) {
    let number = |input: &Input| {
        let name = input.name.rsplit(['/', '\\']).next()?;
        ProgramName::digits(name.split('.').next()?).parse::<u32>().ok()
    };
    let mut files: BTreeMap<u32, &str> = BTreeMap::new();
    files.extend(inputs.iter().filter_map(|input| Some((number(input)?, input.name.as_str()))));
    let outside = |finding: &&mut Diagnostic| finding.code == Code::OutsideLibrary;
    for finding in found.iter_mut().flatten().filter(outside) {
        let Some((name, _)) = finding.message.split_once(" is not in the library") else { continue };
        let Some(file) = ProgramName::digits(name).parse().ok().and_then(|number| files.get(&number)) else {
            continue;
        };
        let help = format!(
            "the file {file} has that number in its name, and no program of that number in its text: write {name} as its first line"
        );
        finding.help = Some(help.into());
    }
}

/// True where programs begin in the same state on both controls, so that nothing is added to their head.
pub(super) fn begin_alike(source: &Control, target: &Control) -> bool {
    let same = |question: Question| {
        let [ours, theirs] =
            [source, target].map(|control| control.behaviour(question).map(|row| &row.value));
        ours.is_some() && ours == theirs
    };
    source.start().is_empty()
        && both_nameless(source, target)
        && same(Question::Vacancy)
        && same(Question::InitialValue)
}
