//! Registers of arguments that calls give to programs outside the library, or get from them.
//!
//! Law: a target without locals has no arguments, so both sides of a call must know the registers that stand for them.
//! Within a library they do. Side condition, for a reviewer: what is outside sets and reads the registers that this
//! says. Counter-example: a macro that another program calls, and sets nothing before.

use super::map::Registers;
use super::names::in_a_sentence;
use crate::diag::{Code, Diagnostic};
use crate::dialect::Control;
use crate::ir::{LOCAL_FLAGS, Module, Var, flag_of};
use crate::legalize::Context;
use crate::legalize::registers::names::OF;
use crate::syntax::ProgramName;
use crate::text::Span;
use std::collections::BTreeMap;

/// What the library and the programs outside it give one another.
#[derive(Clone, Debug, Default)]
pub struct Interface {
    /// What programs outside are given.
    pub(super) given: BTreeMap<ProgramName, Given>,
    /// By program of the library that nothing in it calls, what it is given.
    pub(super) taken: BTreeMap<usize, Vec<Shared>>,
    /// The statics of those, what became of them, and its name.
    pub(super) renamed: BTreeMap<Var, (Var, String)>,
}

impl Interface {
    /// True for a variable that stands for an argument which comes from outside.
    pub(super) fn holds(&self, var: Var) -> bool {
        self.renamed.values().any(|(own, _)| *own == var)
    }

    /// How many variables stand for arguments.
    pub(super) fn len(&self) -> usize {
        self.renamed.len() + self.given.values().map(|given| given.shared.len()).sum::<usize>()
    }
}

/// What one program is given.
#[derive(Clone, Debug, Default)]
pub(super) struct Given {
    /// The programs that call it, and where.
    pub calls: Vec<(usize, Span)>,
    /// By local.
    pub shared: BTreeMap<u32, Shared>,
}

/// An argument, or whether one is given.
#[derive(Clone, Debug)]
pub(super) struct Shared {
    /// The variable that stands for it.
    pub var: Var,
    /// The local that it is, without what makes it a flag.
    local: String,
    /// True if it says whether that has a value.
    flag: bool,
}

impl Shared {
    /// Of a local of the source, or its flag.
    pub fn of(var: Var, local: u32, source: &Control) -> Self {
        let flagged = local.checked_sub(LOCAL_FLAGS);
        let before = source.numbered().unwrap_or_default();
        Self { var, local: format!("{before}{}", flagged.unwrap_or(local)), flag: flagged.is_some() }
    }

    /// What the lock calls it in a program.
    pub fn name_in(&self, program: &ProgramName) -> String {
        let name = format!("{}{OF}{}", self.local, program.short());
        if self.flag { flag_of(&name) } else { name }
    }
}

/// Says where arguments stand that come from outside the library, or go there.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let interface = std::mem::take(&mut context.interface);
    for (name, given) in &interface.given {
        let (name, there) = (name.short(), in_words(given.shared.values(), &context.registers));
        let what = format!(
            "{name} is not in the library and gets arguments: put a program of that number that does the same on the \
             target, and finds {there}"
        );
        let help = format!(
            "or convert it together with {name}; 'reserved' in the target's profile keeps variables free for it"
        );
        for (index, span) in &given.calls {
            let finding = Diagnostic::new(Code::OutsideLibrary, *span, what.clone());
            context.add_once(*index, &what, finding.with_help(help.clone()));
        }
    }
    for (index, taken) in &interface.taken {
        let there = in_words(taken.iter(), &context.registers);
        let what = format!(
            "nothing in the library calls this program, and calls give no arguments on the target: it finds {there}"
        );
        let help = "whoever calls it must set all of them before each call, to 0 what has no value; or convert it together \
                    with the programs that call it";
        let span = module.programs[*index].site.span;
        context.add(*index, Diagnostic::new(Code::Conditional, span, what).with_help(help));
    }
    context.interface = interface;
}

/// Where they stand: `#1 in V3, and in V4 whether #1 has a value (1 or 0)`.
fn in_words<'s>(all: impl Iterator<Item = &'s Shared>, registers: &Registers) -> String {
    let said = all.filter_map(|shared| {
        let register = registers.of.get(&shared.var)?;
        let place = format!("{}{}", register.name, register.number);
        Some(match shared.flag {
            true => format!("in {place} whether {} has a value (1 or 0)", shared.local),
            false => format!("{} in {place}", shared.local),
        })
    });
    in_a_sentence(&said.collect::<Vec<_>>())
}
