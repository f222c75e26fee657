//! Variables that one control keeps over power-off and the other clears.
//!
//! Law: a variable that every run writes before it reads it does not show what it held at power-on. For the others the
//! difference can be seen, and is a review diagnostic: a counter kept in `#100` starts anew on a control that clears it,
//! and a test for vacancy after power-on never comes true on one that keeps it.

use super::Context;
use super::exposed::{Exposed, roots};
use super::registers::{Register, Registers};
use crate::diag::{Code, Diagnostic};
use crate::ir::{Class, Module, Var};
use std::sync::Arc;

/// Reports variables whose life differs.
pub fn check(module: &Module, registers: &Registers, context: &mut Context<'_>) {
    let differing = |var: &Var, register: &Register| {
        let there =
            context.target.variable_class(&register.name, register.number).and_then(|row| row.retained);
        let here = match var.class {
            Class::Common => Some(false),
            Class::Retained => Some(true),
            _ => None,
        };
        (here.is_some() && here != there).then_some(here == Some(true))
    };
    let told = |var: &Var, register: &Register| {
        let name = format!("{}{}", register.name, register.number);
        Some(match differing(var, register)? {
            true => format!(
                "{name} keeps its value over power-off on the source, not on the target, and the program reads what an earlier run left in it"
            ),
            false => format!(
                "{name} is vacant after power-on on the source and keeps its value on the target, and the program reads what an earlier run left in it"
            ),
        })
    };
    let lives: Vec<(Var, Arc<str>)> =
        registers.of.iter().filter_map(|(var, register)| Some((*var, told(var, register)?.into()))).collect();
    if lives.is_empty() {
        return;
    }
    let exposed = Exposed::of(module);
    for index in roots(module) {
        let span = module.programs[index].site.span;
        let shown = lives.iter().filter(|(var, _)| exposed.is_at_entry(index, *var));
        let found = shown.map(|(_, what)| Diagnostic::new(Code::OtherRetention, span, what.clone()));
        context.add_all(index, found.collect());
    }
}
