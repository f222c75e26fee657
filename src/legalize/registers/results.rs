//! Variables by which programs that stand in both machines give their results, where they have other numbers on the target.
//!
//! Law: what such a program sets is read by the number that it has there, as the target's profile says. Side conditions: nothing else is
//! kept in one of those numbers, no computed number reaches the variable, and no lock has it elsewhere for programs that are not
//! converted anew. Counter-example: `#[130+#1]`, which reaches `#135` by its number.

use super::locked::Locked;
use super::map::{Register, Registers};
use super::names::name_of;
use super::pool::Pool;
use crate::diag::{Code, Diagnostic};
use crate::ir::{Class, Module, Var};
use crate::legalize::Context;
use crate::text::Span;
use std::collections::BTreeMap;

/// Gives them those numbers, and nothing else any of these.
pub(super) fn pin(
    users: &BTreeMap<Var, (usize, Span)>,
    locked: &Locked<'_>,
    pool: &mut Pool<'_>,
    registers: &mut Registers,
    module: &Module,
    context: &mut Context<'_>,
) {
    let results = context.target.standing_results();
    pool.used.extend(results.here());
    for (var, (index, span)) in users {
        let Some(number) = results.of(var.number).filter(|_| is_result(*var)) else { continue };
        let Some(name) = name_of(*var, module, context.source) else { continue };
        let reached = [var.number, number].into_iter().any(|number| context.reached.sure.contains(number));
        let elsewhere =
            locked.variables.get(&name).filter(|kept| **kept != number && !locked.others.is_empty());
        if reached {
            let what = format!(
                "{name} has another number in the target's machine, as 'standing_results' of its profile says, and a computed number of the \
                 library reaches it"
            );
            let help = "name these variables by their numbers, or take them out of 'standing_results'";
            context.add(*index, Diagnostic::new(Code::OutOfRegisters, *span, what).with_help(help));
        } else if let Some(kept) = elsewhere {
            let what = format!(
                "macroglot.lock keeps {}{kept} for {name}, and 'standing_results' of the target's profile says {}{number}",
                pool.name, pool.name
            );
            let help = "convert all files of the library in one run";
            context.add(*index, Diagnostic::new(Code::LockConflict, *span, what).with_help(help));
        }
        registers.of.insert(*var, Register { name: pool.name.clone(), number });
        registers.chosen.insert(name, number);
        registers.results.insert(number);
    }
}

/// True for a variable that outlives a program.
pub(super) fn is_result(var: Var) -> bool {
    var.class.nullable() && var.class != Class::Local
}
