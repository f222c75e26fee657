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
use crate::ir::{Bank, Module, Program, Var};
use crate::legalize::Context;
use crate::legalize::registers::map::{Register, Registers};
use crate::legalize::registers::names::{listed, members, name_of, pool_name, run_name};
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
    /// What other libraries have on the same machine.
    pub elsewhere: &'l Elsewhere,
}

/// What other libraries that go to the same machine have there. Their program numbers are given to no other program; their registers
/// are taken only where no other is free.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Elsewhere {
    /// Numbers of their programs.
    pub programs: BTreeSet<u32>,
    /// Registers that keep something of theirs.
    pub registers: BTreeSet<u32>,
}

static NOWHERE: Elsewhere = Elsewhere { programs: BTreeSet::new(), registers: BTreeSet::new() };

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
            elsewhere: &NOWHERE,
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
    /// Why they do.
    moves: Vec<Conflict>,
}

/// A choice that stands in the way of this run.
#[derive(Debug)]
struct Conflict {
    /// The variable that has the register; none for a temporary.
    name: Option<String>,
    number: u32,
    /// What needs the register.
    wants: Wants,
}

#[derive(Debug)]
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
    if !locked.others.is_empty() {
        refuse(module, &conflicts, locked.others, context);
        return effective;
    }
    for conflict in conflicts {
        let Some(name) = &conflict.name else {
            effective.scratch.remove(&conflict.number);
            continue;
        };
        effective.variables.remove(name);
        // Two programs may want one register: its variable moves once.
        if effective.freed.insert(name.clone()) {
            effective.moves.push(conflict);
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

/// Says which variables have another register than before. Every program that relies on the old one is converted anew.
pub(in crate::legalize) fn tell_moves(
    module: &Module,
    effective: &Effective,
    registers: &Registers,
    context: &mut Context<'_>,
) {
    let pool = pool_name(context.target);
    let mut now: BTreeMap<String, &Register> = BTreeMap::new();
    if !effective.moves.is_empty() {
        let named = registers.of.iter();
        now.extend(
            named.filter_map(|(var, register)| Some((name_of(*var, module, context.source)?, register))),
        );
    }
    for Conflict { name, number, wants } in &effective.moves {
        let Some(name) = name else { continue };
        let register = format!("{pool}{number}");
        let (index, why) = match wants {
            Wants::Own(var) => {
                let index = module.programs.iter().position(|program| uses(program, *var));
                (index, format!("this program uses {register} itself"))
            }
            Wants::Row(bank) => {
                let row = run_name(*bank, context.source);
                (None, format!("{row} needs its variables in a row"))
            }
        };
        let index = index.unwrap_or_default();
        let what = match now.get(name) {
            Some(now) => format!("{name} moves from {register} to {}{}: {why}", now.name, now.number),
            None => format!("{name}, which no program uses any more, gives up {register}: {why}"),
        };
        let help = format!(
            "load every program that uses {name} into the machine again; move the value in {register} by hand if \
             it matters"
        );
        let place = module.programs.get(index).map(|program| program.site.span).unwrap_or_default();
        context.add_once(
            index,
            &what,
            Diagnostic::new(Code::LockChanged, place, what.clone()).with_help(help),
        );
    }
}

fn uses(program: &Program, var: Var) -> bool {
    let mut found = false;
    program.variables(&mut |other| found |= other == var);
    found
}

/// Refuses the programs that need registers which programs of earlier runs rely on: each is told once of them all.
fn refuse(module: &Module, conflicts: &[Conflict], others: &[String], context: &mut Context<'_>) {
    if conflicts.is_empty() {
        return;
    }
    let rely = if others.len() == 1 { "relies" } else { "rely" };
    let files = listed(others.to_vec());
    let pool = pool_name(context.target);
    let in_rows = conflicts.iter().filter_map(|conflict| match conflict.wants {
        Wants::Row(bank) => Some((bank, conflict)),
        Wants::Own(_) => None,
    });
    let mut rows: BTreeMap<Bank, Vec<&Conflict>> = BTreeMap::new();
    in_rows.for_each(|(bank, conflict)| rows.entry(bank).or_default().push(conflict));
    let mut told: Vec<(usize, String)> = Vec::new();
    for (index, program) in module.programs.iter().enumerate() {
        let mut names = BTreeSet::new();
        program.variables(&mut |var| _ = names.insert(var));
        let own = |conflict: &&Conflict| matches!(conflict.wants, Wants::Own(var) if names.contains(&var));
        let own: Vec<&Conflict> = conflicts.iter().filter(own).collect();
        if !own.is_empty() {
            let numbers: BTreeSet<u32> = own.iter().map(|conflict| conflict.number).collect();
            let numbers = listed(numbers.into_iter().map(|number| format!("{pool}{number}")).collect());
            told.push((
                index,
                held(&own, &pool, &files, rely, &format!("this program uses {numbers} itself")),
            ));
        }
        for (bank, conflicts) in &rows {
            let why = format!("{} needs its variables in a row", run_name(*bank, context.source));
            told.push((index, held(conflicts, &pool, &files, rely, &why)));
        }
    }
    let help = "convert all of these files in one run, into the same folder: then the variables get other registers. \
                Where that cannot be, give these programs another --out";
    for (index, what) in told {
        let place = module.programs.get(index).map(|program| program.site.span).unwrap_or_default();
        context.add(index, Diagnostic::new(Code::LockConflict, place, what).with_help(help));
    }
}

/// What the lock keeps, and why that stands in the way.
fn held(conflicts: &[&Conflict], pool: &str, files: &str, rely: &str, why: &str) -> String {
    let of = |conflict: &&Conflict| match &conflict.name {
        Some(name) => format!("{pool}{} for {name}", conflict.number),
        None => format!("{pool}{} for intermediate values", conflict.number),
    };
    let kept = listed(conflicts.iter().map(of).collect());
    let them = if conflicts.len() == 1 { "it" } else { "them" };
    format!("macroglot.lock keeps {kept}, and {files} {rely} on {them}, but {why}")
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
        let is_result = target.standing_results().of(var.number) == Some(*number);
        let why = if is_result {
            continue;
        } else if target.is_reserved(&register.name, *number) {
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
