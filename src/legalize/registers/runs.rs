//! Registers in a row, for variables that are reached by computed numbers.

use super::map::{Register, Registers};
use super::names::{class_of, run_name};
use super::pool::Pool;
use crate::diag::{Code, Diagnostic};
use crate::ir::{Bank, BinOp, Expr, Module, Place, StmtKind, Var};
use crate::legalize::{Context, Position, Rewriter, rewrite_program};
use crate::text::Span;
use std::collections::BTreeMap;

/// Which spaces of computed numbers the library uses, and where first.
pub(super) fn banks(module: &Module) -> BTreeMap<Bank, (usize, Span)> {
    let mut banks = BTreeMap::new();
    for (index, program) in module.programs.iter().enumerate() {
        for block in &program.blocks {
            let mut note = |e: &Expr, span: Span| {
                e.walk(&mut |e| {
                    if let Expr::Indirect(bank @ (Bank::Global | Bank::Parametric), _) = e {
                        banks.entry(*bank).or_insert((index, span));
                    }
                });
            };
            for stmt in &block.stmts {
                stmt.kind.exprs(&mut |e| note(e, stmt.site.span));
                if let Some(place @ Place::Indirect(..)) = stmt.kind.target() {
                    note(&place.read(), stmt.site.span);
                }
            }
            block.term.kind.exprs(&mut |e| note(e, block.term.site.span));
        }
    }
    banks
}

/// A run of registers for variables that are reached by computed numbers: what is added to the number.
pub(super) fn run_of(
    bank: Bank,
    pool: &mut Pool<'_>,
    users: &BTreeMap<Var, (usize, Span)>,
    registers: &mut Registers,
    context: &mut Context<'_>,
) -> Option<(Bank, u32)> {
    if bank == Bank::Numbered {
        return None;
    }
    let (class, name) = (class_of(bank), run_name(bank, context.source));
    let numbers: Vec<u32> =
        users.keys().filter(|var| var.class == class).map(|var| var.number).filter(|n| *n <= 100).collect();
    let (first, last) = (*numbers.first()?, *numbers.last()?);
    match pool.run(first, last, &name) {
        Some(base) => {
            registers.chosen.insert(name, base);
            for number in numbers {
                let register = Register { name: pool.name.clone(), number: base + number };
                registers.of.insert(Var { class, number }, register);
            }
            Some((bank, base))
        }
        None => {
            let (index, span) = users.values().next().copied()?;
            let what = format!(
                "the target has no {} registers in a row for variables with computed numbers",
                last - first + 1
            );
            context.add(index, Diagnostic::new(Code::OutOfRegisters, span, what));
            None
        }
    }
}

/// Turns computed numbers into those of the target.
pub(super) fn point(module: &mut Module, runs: &[(Bank, u32)]) {
    if runs.is_empty() {
        return;
    }
    let base_of = |bank: Bank| runs.iter().find(|(b, _)| *b == bank).map(|(_, base)| f64::from(*base));
    let shifted = |index: Expr, base: f64| match index {
        Expr::Number(n) => Expr::Number(n + base),
        index => Expr::binary(BinOp::Add, Expr::Number(base), index),
    };
    for program in &mut module.programs {
        rewrite_program(
            program,
            |e| matches!(e, Expr::Indirect(..)),
            &mut |e, _: Position, _: &mut Rewriter<'_>| match e {
                Expr::Indirect(bank, index) => match base_of(bank) {
                    // Adding 0 makes a number of what nobody has set, as it is on the source.
                    Some(base) => Expr::binary(
                        BinOp::Add,
                        Expr::Indirect(Bank::Numbered, Box::new(shifted(*index, base))),
                        Expr::Number(0.0),
                    ),
                    None => Expr::Indirect(bank, index),
                },
                other => other,
            },
        );
        for stmt in program.blocks.iter_mut().flat_map(|block| &mut block.stmts) {
            if let StmtKind::Assign { target: Place::Indirect(bank, index), .. } = &mut stmt.kind
                && let Some(base) = base_of(*bank)
            {
                let old = std::mem::replace(index.as_mut(), Expr::Vacant);
                (*bank, **index) = (Bank::Numbered, shifted(old, base));
            }
        }
    }
}
