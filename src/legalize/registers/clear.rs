//! One statement that clears a whole class of variables, where the target has none.
//!
//! Law: variables that no program of the library names cannot be told from cleared
//! ones by it, so setting to 0 each that is named does what the statement does. Registers in a row are set by a loop
//! over their numbers, as a programmer would write it.
//! Counter-example: a program outside the library that reads a variable which no program inside it names.

use crate::dialect::Question;
use crate::ir::{
    Bank, BinOp, Builder, Class, Cond, Expr, Module, Place, Relation, SourceInfo, Stmt, StmtKind, TermKind,
    Var,
};
use crate::legalize::Context;
use crate::legalize::features::{Feature, Features};
use crate::legalize::registers::map::{Register, Registers};
use crate::legalize::rewrite::{Part, rebuild};

/// Counts through the registers of a run.
pub const COUNTER: Var = Var { class: Class::Register, number: 9 };

/// Registers in a row that are worth a loop.
const ROW: usize = 6;

/// True where a library clears classes that the target cannot.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    features.has(Feature::Clear) && !context.target.is(Question::ClearAll)
}

/// Expands the clearing of a class; needs the registers, so it runs after their allocation.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let registers = &context.registers;
    // A loop counts through numbers, which must find registers.
    let row = if context.target.numbered().is_some() { ROW } else { usize::MAX };
    for program in &mut module.programs {
        rebuild(program, &mut |builder, part| match part {
            Part::Stmt(Stmt { kind: StmtKind::ClearAll(class), site }) => {
                clear(class, registers, row, site, builder);
            }
            other => other.keep(builder),
        });
    }
}

fn clear(class: Class, registers: &Registers, row: usize, site: SourceInfo, builder: &mut Builder) {
    let mut all: Vec<(&Register, Var)> =
        registers.of.iter().filter(|(var, _)| var.class == class).map(|(var, r)| (r, *var)).collect();
    all.sort();
    let span = site.span;
    let mut site = Some(site);
    // The block's number and comments stay with the first of what it becomes.
    let mut next_site = move || site.take().unwrap_or_else(|| SourceInfo { span, ..SourceInfo::default() });
    let zero = |var| StmtKind::Assign { target: Place::Var(var), value: Expr::Number(0.0) };
    let follows =
        |a: &(&Register, Var), b: &(&Register, Var)| a.0.name == b.0.name && a.0.number + 1 == b.0.number;
    if all.is_empty() {
        builder.push(StmtKind::Comment, next_site());
    }
    for run in all.chunk_by(follows) {
        match run {
            [(first, _), .., (last, _)] if run.len() >= row => {
                sweep(first.number, last.number, &mut next_site, builder);
            }
            _ => run.iter().for_each(|(_, var)| builder.push(zero(*var), next_site())),
        }
    }
}

/// A loop that sets the registers from `first` to `last` to 0.
fn sweep(first: u32, last: u32, site: &mut dyn FnMut() -> SourceInfo, builder: &mut Builder) {
    let counter = || Expr::Var(COUNTER);
    let set = |target, value| StmtKind::Assign { target, value };
    builder.push(set(Place::Var(COUNTER), Expr::Number(f64::from(first))), site());
    let (head, body, behind) = (builder.fresh(), builder.fresh(), builder.fresh());
    builder.start(head);
    let more = Cond::Compare(Relation::LessEqual, counter(), Expr::Number(f64::from(last)));
    builder.end(TermKind::Branch { cond: Box::new(more), then: body, otherwise: behind }, site());
    builder.start(body);
    let cell = Place::Indirect(Bank::Numbered, Box::new(counter()));
    builder.push(set(cell, Expr::Number(0.0)), site());
    let next = Expr::binary(BinOp::Add, counter(), Expr::Number(1.0));
    builder.push(set(Place::Var(COUNTER), next), site());
    builder.end(TermKind::Jump(head), SourceInfo::default());
    builder.start(behind);
}
