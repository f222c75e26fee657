//! Variables of a space of their own whose number is computed: `V(..)`.
//!
//! Law: the target keeps such a space in a run of registers, so a number of the space means the same on both. Side
//! condition, for a reviewer: the number is one of the space; where every value that it may have is known, it
//! is looked up. Counter-example: `V(101)`, which the source does not have, and which is on the target what stands behind the run.

use super::Context;
use super::computed_numbers::{all_numbers, each_index};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Control;
use crate::ir::analysis::{Summaries, values_at};
use crate::ir::{Bank, Expr, Module};
use crate::text::Span;

/// Reports computed numbers that may lie outside of their space.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let spaces = [Bank::Global, Bank::Parametric].map(|bank| (bank, Space::of(bank, context.source)));
    if spaces.iter().all(|(_, space)| space.is_none()) {
        return;
    }
    let summaries = Summaries::of(module);
    for (index, program) in module.programs.iter().enumerate() {
        let mut found: Vec<(Span, &Space)> = Vec::new();
        each_index(program, &mut |bank, number, span, id, at| {
            let Some((_, Some(space))) = spaces.iter().find(|(own, _)| *own == bank) else { return };
            let told = found.iter().any(|(_, other)| other.name == space.name);
            let inside = || match number {
                Expr::Var(var) => values_at(program, &summaries, *var, id, at)
                    .and_then(all_numbers)
                    .is_some_and(|all| all.iter().all(|number| space.holds(*number))),
                _ => false,
            };
            if !told && !inside() {
                found.push((span, space));
            }
        });
        for (span, space) in found {
            let Space { name, first, last } = space;
            let what = format!(
                "which {name} variable is meant is known only when the program runs: it must be one of {name}{first} to {name}{last}; the target would go on with another one"
            );
            context.add(index, Diagnostic::new(Code::Conditional, span, what));
        }
    }
}

/// The numbers of a space.
struct Space {
    name: String,
    first: u32,
    last: u32,
}

impl Space {
    fn of(bank: Bank, source: &Control) -> Option<Self> {
        let class = bank.class()?;
        let rows = || source.classes().iter().filter(move |row| row.class == class && !row.nullable);
        let (first, last) = (rows().map(|row| row.first).min()?, rows().map(|row| row.last).max()?);
        Some(Self { name: rows().next()?.name.clone(), first, last })
    }

    fn holds(&self, number: u32) -> bool {
        (self.first..=self.last).contains(&number)
    }
}
