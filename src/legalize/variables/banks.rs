//! Variables of a space of their own whose number is computed: `V(..)`.
//!
//! Law: the target keeps such a space in a run of registers, so a number of the space means the same on both. Side
//! condition, for a reviewer: the number is one of the space; where every value that it may have is known, it
//! is looked up. Counter-example: `V(101)`, which the source does not have, and which is on the target what stands after the run.

use crate::diag::{Code, Diagnostic};
use crate::dialect::Control;
use crate::ir::analysis::{Constant, Numbers, Ranges, values_at};
use crate::ir::eval::whole;
use crate::ir::{Bank, BlockId, Expr, Module, Place, Program};
use crate::legalize::Context;
use crate::text::Span;
use std::cell::LazyCell;

/// Reports computed numbers that may lie outside of their space.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let spaces = [Bank::Global, Bank::Parametric].map(|bank| (bank, Space::of(bank, context.source)));
    if spaces.iter().all(|(_, space)| space.is_none()) {
        return;
    }
    let summaries = context.summaries(module);
    for (index, program) in module.programs.iter().enumerate() {
        let mut found: Vec<(Span, &Space)> = Vec::new();
        let ranges = LazyCell::new(|| Ranges::of(program, &summaries));
        each_index(program, &mut |bank, number, span, id, at| {
            let Some((_, Some(space))) = spaces.iter().find(|(own, _)| *own == bank) else { return };
            let told = found.iter().any(|(_, other)| other.name == space.name);
            let inside = || {
                let own = Numbers::of([(space.first, space.last)]);
                let known = match number {
                    Expr::Var(var) => values_at(program, &summaries, *var, id, at).and_then(all_numbers),
                    _ => None,
                };
                own.holds(&known.unwrap_or_else(|| ranges.at(id, at, number).numbers()))
            };
            if !told && !inside() {
                found.push((span, space));
            }
        });
        for (span, space) in found {
            let Space { name, first, last } = space;
            let what = format!(
                "the number of the {name} variable is computed: it must be one of {name}{first} to \
                 {name}{last}, or the target uses another variable"
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
}

/// The whole numbers that constants are; none if one is something else.
pub(in crate::legalize) fn all_numbers(constants: Vec<Constant>) -> Option<Numbers> {
    let number = |constant| match constant {
        Constant::Number(value) if value.fract() == 0.0 => whole(value),
        _ => None,
    };
    let all = constants.into_iter().map(number).collect::<Option<Vec<u32>>>()?;
    Some(Numbers::of(all.into_iter().map(|number| (number, number))))
}

/// Calls `f` on each computed number, with its space, its place and the statement that it stands in.
pub(in crate::legalize) fn each_index(
    program: &Program,
    f: &mut dyn FnMut(Bank, &Expr, Span, BlockId, usize),
) {
    for (id, block) in program.ids().zip(&program.blocks) {
        for (at, stmt) in block.stmts.iter().enumerate() {
            let mut found = |bank, number: &Expr| f(bank, number, stmt.site.span, id, at);
            stmt.kind.exprs(&mut |e| each_within(e, &mut found));
            match stmt.kind.target() {
                Some(Place::Indirect(bank, number)) => {
                    found(*bank, number);
                    each_within(number, &mut found);
                }
                Some(Place::System(_, subscripts)) => {
                    subscripts.iter().for_each(|e| each_within(e, &mut found));
                }
                _ => {}
            }
        }
        let mut found = |bank, number: &Expr| f(bank, number, block.term.site.span, id, block.stmts.len());
        block.term.kind.exprs(&mut |e| each_within(e, &mut found));
    }
}

fn each_within(e: &Expr, found: &mut dyn FnMut(Bank, &Expr)) {
    e.walk(&mut |e| {
        if let Expr::Indirect(bank, number) = e {
            found(*bank, number);
        }
    });
}
