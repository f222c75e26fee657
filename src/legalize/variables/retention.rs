//! Variables that one control keeps over power-off and the other clears.
//!
//! Law: a variable that every run writes before it reads it does not show what it held at power-on. For the others the
//! difference can be seen: a counter kept in `#100` starts anew on a control that clears it, and a test for vacancy after
//! power-on never comes true on one that keeps it. Whether the shop needs such values is asked once, and the profile of the
//! source says it. If it does, each program is for review. Where no source says whether the source keeps them, and the target is
//! known to, that is asked: a count that began at 0 each morning would go on.
//!
//! What is read after a call of a program that is not in the library, and not before one, is taken for what that program leaves,
//! where no program of the library writes it by its number, and none that runs with it by a computed one: a note says so, and
//! nobody is asked. Counter-example: a counter of parts, `#100=#100+1`, after a probe was switched on by such a program.

use crate::diag::{Code, Diagnostic};
use crate::dialect::{Question, Side};
use crate::ir::analysis::upward_exposed::{UpwardExposed, roots};
use crate::ir::analysis::{Universe, Vars};
use crate::ir::{Callee, Class, Module, Place, TermKind, Var};
use crate::legalize::Context;
use crate::legalize::calls::standing;
use crate::legalize::registers::map::{Register, Registers};
use crate::syntax::ProgramName;
use crate::text::Span;
use foldhash::{HashMap, HashMapExt};
use std::collections::BTreeSet;
use std::sync::Arc;

const QUESTION: Question = Question::PowerOffValues;
/// Whether the source keeps a variable, and whether it comes after a program that is not in the library.
const WAYS: [(bool, bool); 4] = [(true, false), (false, false), (true, true), (false, true)];
const KEEPS: Question = Question::CommonAtPowerOn;

/// Reports variables whose life differs.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let registers = std::mem::take(&mut context.registers);
    check(module, &registers, context);
    context.registers = registers;
}

fn check(module: &Module, registers: &Registers, context: &mut Context<'_>) {
    // A control with two kinds of them says by its classes which it keeps.
    let two_kinds = context.source.classes().iter().any(|row| row.class == "retained");
    let said = context.source.behaviour(KEEPS).filter(|_| !two_kinds).map(|row| row.value.clone());
    let keeps = match said.as_deref() {
        Some("kept") => Some(true),
        Some("vacant") => Some(false),
        _ => None,
    };
    let differing = |var: &Var, register: &Register| {
        let there =
            context.target.variable_class(&register.name, register.number).and_then(|row| row.retained);
        let here = match var.class {
            Class::Common => Some(false),
            Class::Retained => Some(true),
            Class::Global | Class::Parametric => keeps,
            _ => None,
        };
        (here.is_some() && here != there).then_some(here == Some(true))
    };
    let of = |(var, register): (&Var, &Register)| {
        // As the program has it, whatever register it is in.
        let name = registers.names.get(var).and_then(|name| {
            let digits = name.find(|c: char| c.is_ascii_digit())?;
            Some((name[..digits].to_owned(), name[digits..].parse().ok()?))
        });
        let named = || name.unwrap_or_else(|| (register.name.clone(), register.number));
        differing(var, register).map(|kept| (*var, kept, named()))
    };
    let mut lives: Vec<_> = registers.of.iter().filter_map(of).collect();
    let answer = context.source.behaviour(QUESTION).map(|row| row.value.as_str());
    if answer == Some("unused") {
        return;
    }
    if said.as_deref() == Some("unknown") {
        ask_of_globals(module, registers, context);
    }
    let is_needed = answer == Some("used");
    if lives.is_empty() {
        return;
    }
    lives.sort_by(|(.., a), (.., b)| a.cmp(b));
    let universe = Universe::new(lives.iter().map(|(var, ..)| *var).collect());
    let upward_exposed = UpwardExposed::among(module, universe.clone());
    let before = cut(module).map(|cut| UpwardExposed::among(&cut, universe));
    let roots = roots(module);
    // Where nothing outside is called, nothing comes after it.
    let ours = if before.is_some() { written(module, &roots, context) } else { HashMap::new() };
    let asked = Diagnostic::new(Code::OtherRetention, Span::default(), "")
        .with_help(context.source.to_settle(QUESTION.fact(), Side::Source))
        .with_fact(QUESTION.fact())
        .asked_once();
    // Of a program, what is shown in each of the ways.
    let of = |index: usize| -> [Vec<usize>; 4] {
        let is_at_entry = upward_exposed.at_entry_of(index);
        let is_before = before.as_ref().map(|before| before.at_entry_of(index));
        let is_ours = |var: Var| ours.get(&index).is_some_and(|ours| ours.contains(var));
        let is_after = |var: Var| {
            is_before.as_ref().is_some_and(|is_before| !is_before(var)) && (is_needed || !is_ours(var))
        };
        let mut shown: [Vec<usize>; 4] = Default::default();
        for (at, (var, kept, _)) in lives.iter().enumerate().filter(|(_, (var, ..))| is_at_entry(*var)) {
            let way = WAYS.iter().position(|way| *way == (*kept, is_after(*var)));
            way.into_iter().for_each(|way| shown[way].push(at));
        }
        shown
    };
    // One question of the library names all of its variables.
    let mut all: [BTreeSet<usize>; 4] = Default::default();
    for root in &roots {
        all.iter_mut().zip(of(*root)).for_each(|(all, shown)| all.extend(shown));
    }
    let mut said: HashMap<Vec<usize>, Arc<str>> = HashMap::new();
    for index in roots {
        let span = module.programs[index].site.span;
        for (((kept, after), shown), all) in WAYS.into_iter().zip(of(index)).zip(&all) {
            if shown.is_empty() {
                continue;
            }
            let shown = if is_needed { shown } else { all.iter().copied().collect() };
            // Programs of a library that share their variables share the sentence.
            let what = said.entry(shown).or_insert_with_key(|shown| {
                told(&shown.iter().map(|at| &lives[*at].2).collect::<Vec<_>>(), kept).into()
            });
            if after && !is_needed {
                let what = format!(
                    "{what}: it is taken for what the programs leave there that are not in the library"
                );
                context.add(index, Diagnostic::new(Code::LeftByOthers, span, what));
                continue;
            }
            let finding = || Diagnostic::new(Code::OtherRetention, span, what.clone());
            let finding = match is_needed {
                // After a program that stands in the machine it mostly is what that one left.
                true if after => finding().asked_once(),
                true => finding(),
                // Programs of a library share what there is to do about it.
                false => Diagnostic { span, message: what.clone(), ..asked.clone() },
            };
            context.add(index, finding);
        }
    }
}

/// Asks whether the source keeps variables that a program may read before it writes them.
fn ask_of_globals(module: &Module, registers: &Registers, context: &mut Context<'_>) {
    let keeps = |register: &Register| {
        context.target.variable_class(&register.name, register.number).and_then(|row| row.retained)
    };
    let shown = registers.of.iter().filter(|(var, register)| {
        matches!(var.class, Class::Global | Class::Parametric) && keeps(register) != Some(false)
    });
    let shown: Vec<Var> = shown.map(|(var, _)| *var).collect();
    if shown.is_empty() {
        return;
    }
    let upward_exposed = UpwardExposed::among(module, Universe::new(shown.clone()));
    for index in roots(module) {
        let is_at_entry = upward_exposed.at_entry_of(index);
        if shown.iter().any(|var| is_at_entry(*var)) {
            context.rests_on_source(index, module.programs[index].site.span, KEEPS);
        }
    }
}

/// The library as it is before programs are called that are no part of it; none if no such program is called.
fn cut(module: &Module) -> Option<Module> {
    let known = standing::known(module);
    let is_outside = |kind: &TermKind| match kind {
        TermKind::Call { call, .. } => {
            matches!(&call.callee, Callee::Program(name @ ProgramName::Number(_)) if !known.contains(name))
        }
        _ => false,
    };
    let any =
        module.programs.iter().flat_map(|program| &program.blocks).any(|block| is_outside(&block.term.kind));
    let mut cut = any.then(|| module.clone())?;
    for block in cut.programs.iter_mut().flat_map(|program| &mut program.blocks) {
        if is_outside(&block.term.kind) {
            block.term.kind = TermKind::Stray;
        }
    }
    Some(cut)
}

/// By root: what the library writes by its number, and what is written by a computed one where that root runs.
fn written(module: &Module, roots: &[usize], context: &Context<'_>) -> HashMap<usize, Vars> {
    let places = |index: usize| {
        let blocks = module.programs.get(index).into_iter().flat_map(|program| &program.blocks);
        blocks.flat_map(|block| &block.stmts).filter_map(|stmt| stmt.kind.target())
    };
    let mut everywhere = Vars::default();
    let numbered = (0..module.programs.len()).flat_map(places).filter(|place| matches!(place, Place::Var(_)));
    numbered.for_each(|place| everywhere.write(place));
    let mut callees: HashMap<usize, Vec<usize>> = HashMap::new();
    for (caller, callee) in context.called(module).pairs(module) {
        callees.entry(caller).or_default().push(callee);
    }
    let of = |root: &usize| {
        let (mut open, mut found, mut ours) = (vec![*root], BTreeSet::from([*root]), everywhere.clone());
        while let Some(at) = open.pop() {
            places(at).for_each(|place| ours.write(place));
            open.extend(
                callees.get(&at).into_iter().flatten().copied().filter(|callee| found.insert(*callee)),
            );
        }
        (*root, ours)
    };
    roots.iter().map(of).collect()
}

/// The sentence about registers, in order of their numbers; true for those that the source keeps.
fn told(registers: &[&(String, u32)], kept: bool) -> String {
    let one = registers.len() == 1;
    let names = list(registers);
    let (keeps, is, them) =
        if one { ("keeps its value", "is", "it") } else { ("keep their values", "are", "them") };
    match kept {
        true => format!(
            "{names} {keeps} over power-off on the source, not on the target, and the program may read what an earlier run left in {them}"
        ),
        false => format!(
            "{names} {is} vacant after power-on on the source and {keeps} on the target, and the program may read what an earlier run left in {them}"
        ),
    }
}

/// Registers as people write them: `#100, #103 to #105`.
fn list(registers: &[&(String, u32)]) -> String {
    let runs = registers.chunk_by(|a, b| a.0 == b.0 && a.1 + 1 == b.1);
    let written = |run: &[&(String, u32)]| match run {
        [(name, number)] => format!("{name}{number}"),
        [(name, first), (_, second)] => format!("{name}{first}, {name}{second}"),
        [(name, first), .., (_, last)] => format!("{name}{first} to {name}{last}"),
        [] => String::new(),
    };
    runs.map(written).collect::<Vec<_>>().join(", ")
}
