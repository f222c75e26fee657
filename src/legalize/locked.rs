//! Choices of earlier runs that no longer hold.
//!
//! Law: a lock keeps every variable in its register. Side conditions: the register is not kept for the shop by now,
//! the target still has it, and no other variable of the library is in it, as after an edit by hand. A choice that
//! breaks one of them is an error: a register that something else writes is no register of the program's.

use super::Context;
use super::registers::{Registers, name_of};
use crate::diag::{Code, Diagnostic};
use crate::ir::Module;
use std::collections::BTreeMap;

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
        } else if let Some(other) = others.into_iter().next() {
            format!("holds {other} as well")
        } else {
            continue;
        };
        let what = format!(
            "the lock keeps {name} in {}{number}, which {why}; take the line out of macroglot.lock to choose anew",
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
