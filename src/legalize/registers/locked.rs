//! Choices of earlier runs, and those that no longer hold.
//!
//! Law: a lock keeps every variable in its register. Side conditions: the register is not kept for the shop by now,
//! the target still has it, no computed number of the library reaches it, and no other variable is in it, as after an
//! edit by hand. A choice that breaks one of them is an error: a register that something else writes is no register of
//! the program's. Where the library itself now has a variable of that number, or needs its variables in a row, the choice
//! is given up if every program that relies on it is converted anew in this run; else it stays, and what needs the
//! register is refused. Counter-example: a macro that was converted alone, and a caller with a variable of the number that
//! the macro computes in.

use crate::diag::{Code, Diagnostic};
use crate::ir::analysis::Numbers;
use crate::ir::{Bank, Module, Var};
use crate::legalize::Context;
use crate::legalize::registers::map::Registers;
use crate::legalize::registers::names::{members, name_of, pool_name, run_name};
use std::collections::{BTreeMap, BTreeSet};

/// No names.
static NONE: BTreeMap<String, u32> = BTreeMap::new();

/// The choices of earlier runs.
#[derive(Clone, Debug)]
pub struct Locked<'l> {
    /// Registers by the variable's name on the source.
    pub variables: &'l BTreeMap<String, u32>,
    /// Numbers of programs by what names the program on the source.
    pub programs: &'l BTreeMap<String, u32>,
    /// Registers of temporaries.
    pub scratch: &'l [u32],
    /// Those of them whose values outlive calls, perhaps of programs of this run.
    pub over_calls: &'l [u32],
    /// Numbers that programs of earlier runs use themselves.
    pub own: &'l [u32],
    /// Numbers that programs of earlier runs reach by computing them.
    pub reached: Numbers,
    /// Files of earlier runs that this run does not convert anew.
    pub others: &'l [String],
}

impl Default for Locked<'_> {
    fn default() -> Self {
        let reached = Numbers::default();
        Self {
            variables: &NONE,
            programs: &NONE,
            scratch: &[],
            over_calls: &[],
            own: &[],
            reached,
            others: &[],
        }
    }
}

/// The choices that hold in this run.
#[derive(Debug, Default)]
pub(in crate::legalize) struct Effective {
    /// Registers by the variable's name on the source.
    pub variables: BTreeMap<String, u32>,
    /// Registers of temporaries.
    pub scratch: BTreeSet<u32>,
    /// Names of variables that lose their register.
    pub freed: BTreeSet<String>,
}

/// A choice that stands in the way of this run.
struct Conflict {
    /// The variable that has the register; none for a temporary.
    name: Option<String>,
    number: u32,
    /// What needs the register.
    wants: Wants,
}

enum Wants {
    /// This variable, which has the same number on both controls.
    Own(Var),
    /// This space, whose variables stand in a row.
    Row(Bank),
}

/// Finds the choices that this library cannot keep, where `kept` are the variables whose number the target has too and
/// `banks` the spaces with computed numbers; gives them up or refuses what needs their registers.
pub(in crate::legalize) fn settle(
    module: &Module,
    locked: &Locked<'_>,
    kept: &BTreeSet<Var>,
    banks: &[Bank],
    context: &mut Context<'_>,
) -> Effective {
    let mut effective = Effective {
        variables: locked.variables.clone(),
        scratch: locked.scratch.iter().copied().collect(),
        ..Effective::default()
    };
    let conflicts = conflicts(module, locked, kept, banks, context);
    for conflict in conflicts {
        if locked.others.is_empty() {
            give_up(module, &conflict, &mut effective, context);
        } else {
            refuse(module, &conflict, locked.others, context);
        }
    }
    effective
}

fn conflicts(
    module: &Module,
    locked: &Locked<'_>,
    kept: &BTreeSet<Var>,
    banks: &[Bank],
    context: &Context<'_>,
) -> Vec<Conflict> {
    let mut found = Vec::new();
    let shared = || kept.iter().filter(|var| var.class != crate::ir::Class::Local);
    for var in shared() {
        let holders = locked.variables.iter().filter(|(_, number)| **number == var.number);
        let holders = holders.map(|(name, _)| Some(name.clone()));
        let scratch = locked.scratch.contains(&var.number).then_some(None);
        let conflict = |name| Conflict { name, number: var.number, wants: Wants::Own(*var) };
        found.extend(holders.chain(scratch).map(conflict));
    }
    for bank in banks {
        let base = locked.variables.get(&run_name(*bank, context.source));
        for (number, name) in members(*bank, module, context) {
            let Some(&register) = locked.variables.get(&name) else { continue };
            if base.is_none_or(|base| base + number != register) {
                found.push(Conflict { name: Some(name), number: register, wants: Wants::Row(*bank) });
            }
        }
    }
    found
}

/// Lets a variable have another register: every program that relies on the old one is converted anew.
fn give_up(module: &Module, conflict: &Conflict, effective: &mut Effective, context: &mut Context<'_>) {
    let Conflict { name, number, wants } = conflict;
    let Some(name) = name else {
        effective.scratch.remove(number);
        return;
    };
    effective.variables.remove(name);
    effective.freed.insert(name.clone());
    let register = format!("{}{number}", pool_name(context.target));
    let why = match wants {
        Wants::Own(_) => format!("a program uses {register} itself"),
        Wants::Row(bank) => format!("{} needs its variables in a row", run_name(*bank, context.source)),
    };
    let what = format!("{name} moves out of {register}, where an earlier run put it: {why}");
    let help = "move the old register's value by hand if it matters; macroglot.lock names the new register";
    let place = module.programs.first().map(|program| program.site.span).unwrap_or_default();
    context.add_once(0, &what, Diagnostic::new(Code::LockChanged, place, what.clone()).with_help(help));
}

/// Refuses the programs that need a register which programs of earlier runs rely on.
fn refuse(module: &Module, conflict: &Conflict, others: &[String], context: &mut Context<'_>) {
    let Conflict { name, number, wants } = conflict;
    let holder = match name {
        Some(name) => format!("for {name}"),
        None => "for intermediate values".into(),
    };
    let others = others.join(", ");
    let register = format!("{}{number}", pool_name(context.target));
    let why = match wants {
        Wants::Own(_) => format!("this program uses {register} itself"),
        Wants::Row(bank) => format!("{} needs its variables in a row", run_name(*bank, context.source)),
    };
    let what = format!("macroglot.lock keeps {register} {holder}, and {others} relies on it, but {why}");
    let help = "delete macroglot.lock in the output folder, and convert all of these files in one run";
    for (index, program) in module.programs.iter().enumerate() {
        let mut concerned = matches!(wants, Wants::Row(_));
        if let Wants::Own(var) = wants {
            program.variables(&mut |other| concerned |= other == *var);
        }
        if concerned {
            let told = Diagnostic::new(Code::LockConflict, program.site.span, what.clone());
            context.add_once(index, &what, told.with_help(help));
        }
    }
}

/// Reports locked choices that cannot be honoured, in every program that names the variable.
pub fn check(
    module: &Module,
    locked: &BTreeMap<String, u32>,
    registers: &Registers,
    context: &mut Context<'_>,
) {
    let mut holders: BTreeMap<u32, Vec<&str>> = BTreeMap::new();
    for (name, number) in &registers.chosen {
        holders.entry(*number).or_default().push(name);
    }
    for (name, number) in &registers.chosen {
        if locked.get(name) != Some(number) {
            continue;
        }
        let held = registers.of.iter().find(|(var, register)| {
            register.number == *number && name_of(**var, module, context.source).as_deref() == Some(name)
        });
        let Some((&var, register)) = held else { continue };
        let target = context.target;
        let others = holders.get(number).into_iter().flatten().filter(|other| **other != name.as_str());
        let why = if target.is_reserved(&register.name, *number) {
            "the machine profile reserves".to_owned()
        } else if target.variable_class(&register.name, *number).is_none() {
            "the target does not have".to_owned()
        } else if context.reached.sure.contains(*number) {
            "a computed number of the library reaches".to_owned()
        } else if let Some(other) = others.into_iter().next() {
            format!("holds {other} as well")
        } else {
            continue;
        };
        let what = format!(
            "macroglot.lock keeps {name} in {}{number}, which {why}; remove the line from macroglot.lock \
             to get another register",
            register.name
        );
        for (index, program) in module.programs.iter().enumerate() {
            let mut named = false;
            program.variables(&mut |other| named |= other == var);
            if named {
                context.add(index, Diagnostic::new(Code::OutOfRegisters, program.site.span, what.clone()));
            }
        }
    }
}
