//! Work offsets by a computed number, where the target keeps them in runs of variables that are apart.
//!
//! Law: the variable of row n is `first + (n - from) * step` of the run that holds n, so a branch on where the next run
//! begins picks it; a run in which the source has no row is never meant. A number with a fraction is rounded, as a
//! subscript is. Side condition: the number is one of a row; another one names no offset on the source.

use crate::canon::{Func, Sys};
use crate::dialect::Control;
use crate::ir::{
    Bank, BinOp, Class, Cond, Expr, Place, Program, Relation, SourceInfo, Stmt, StmtKind, TermKind, Var,
};
use crate::legalize::features::{Feature, Features};
use crate::legalize::rewrite::{Part, PreStatement, highest_temp, rebuild, rewrite_program};
use crate::legalize::{Context, Rewriter};

/// Where a run begins, the number of its first variable, and the distance of two rows.
type Run = (u32, u32, u32);

/// True where state is used, and both controls keep work offsets in several runs.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let several = |control: &Control| control.system_runs(Sys::WorkOffset).count() > 1;
    features.has(Feature::System) && several(context.source) && several(context.target)
}

/// Picks the run that a computed number is in; true if there is one.
pub fn run(program: &mut Program, _: usize, context: &mut Context<'_>) -> bool {
    let (source, target) = (context.source, context.target);
    let written = write(program, source, target);
    rewrite_program(
        program,
        |e| matches!(e, Expr::System(Sys::WorkOffset, _)),
        &mut |e, _, rewriter| match &e {
            Expr::System(Sys::WorkOffset, subscripts) => match computed(subscripts, source, target) {
                Some((row, runs)) => read(row.clone(), &runs, rewriter),
                None => e,
            },
            _ => e,
        },
    ) || written
}

/// The computed number of a row, and the runs of its axis in the order of numbers.
fn computed<'e>(subscripts: &'e [Expr], source: &Control, target: &Control) -> Option<(&'e Expr, Vec<Run>)> {
    let [row, axis] = subscripts else { return None };
    let axis = axis.constant().filter(|axis| row.constant().is_none() && axis.fract() == 0.0)? as u32;
    let mut runs: Vec<Run> = Vec::new();
    for run in target.system_runs(Sys::WorkOffset) {
        let rows = run.subscripts.first()?;
        if let Some(first) = run.number_of(&[rows.from, axis]).flatten()
            && runs.iter().all(|(from, ..)| *from != rows.from)
        {
            runs.push((rows.from, first, rows.step));
        }
    }
    runs.sort_unstable();
    if runs.len() < 2 {
        return None;
    }
    let ends: Vec<u32> = runs.iter().skip(1).map(|(from, ..)| *from).chain([u32::MAX]).collect();
    let mut ends = ends.into_iter();
    runs.retain(|(from, ..)| ends.next().is_some_and(|end| has_row(source, *from, end)));
    (!runs.is_empty()).then_some((row, runs))
}

/// True where a control has a work offset whose row is not before `from`, and before `end`.
fn has_row(control: &Control, from: u32, end: u32) -> bool {
    control.system_runs(Sys::WorkOffset).any(|run| match (run.fixed.first(), run.subscripts.first()) {
        (Some(&row), _) => (from..end).contains(&row),
        (None, Some(rows)) => rows.from < end && from < rows.from + rows.count,
        (None, None) => false,
    })
}

fn read(row: Expr, runs: &[Run], rewriter: &mut Rewriter<'_>) -> Expr {
    let row = whole(row);
    if let [run] = runs {
        return place(&row, *run);
    }
    let row = rewriter.held(row);
    let value = rewriter.materialize(Expr::Number(0.0));
    for (at, run) in runs.iter().enumerate() {
        rewriter.first(PreStatement::When(inside(&row, runs, at), value, place(&row, *run)));
    }
    Expr::Var(value)
}

/// That a row is in one of the runs: not before its beginning, and before the next one's.
fn inside(row: &Expr, runs: &[Run], at: usize) -> Cond {
    let side = |relation, run: Option<&Run>| {
        run.map(|(from, ..)| Cond::Compare(relation, row.clone(), Expr::Number(f64::from(*from))))
    };
    let begun = side(Relation::GreaterEqual, runs.get(at).filter(|_| at > 0));
    let next = side(Relation::Less, runs.get(at + 1));
    match (begun, next) {
        (Some(begun), Some(next)) => Cond::And(vec![begun, next]),
        (begun, next) => begun.or(next).unwrap_or(Cond::And(Vec::new())),
    }
}

/// The row that a computed number means: one with a fraction is rounded before it is counted in steps.
fn whole(row: Expr) -> Expr {
    if row.is_whole() { row } else { Expr::Call(Func::Round, [row].into()) }
}

fn place(row: &Expr, run: Run) -> Expr {
    Expr::Indirect(Bank::Numbered, Box::new(number(row, run)))
}

fn number(row: &Expr, (from, first, step): Run) -> Expr {
    let binary = |op, a, b| Expr::binary(op, a, b);
    let rows = binary(BinOp::Mul, row.clone(), Expr::Number(f64::from(step)));
    let base = f64::from(first) - f64::from(from) * f64::from(step);
    binary(BinOp::Add, rows, Expr::Number(base))
}

/// Writes by a computed number; true where there are any writes of offsets.
fn write(program: &mut Program, source: &Control, target: &Control) -> bool {
    let offset = |stmt: &Stmt| matches!(stmt.kind.target(), Some(Place::System(Sys::WorkOffset, _)));
    if !program.blocks.iter().flat_map(|block| &block.stmts).any(offset) {
        return false;
    }
    let mut highest = highest_temp(program);
    rebuild(program, &mut |builder, part| {
        let Part::Stmt(stmt) = &part else { return part.keep(builder) };
        let StmtKind::Assign { target: Place::System(Sys::WorkOffset, subscripts), value } = &stmt.kind
        else {
            return part.keep(builder);
        };
        let Some((row, runs)) = computed(subscripts, source, target) else { return part.keep(builder) };
        let row = &whole(row.clone());
        if let [run] = runs[..] {
            let there = Place::Indirect(Bank::Numbered, Box::new(number(row, run)));
            let kind = StmtKind::Assign { target: there, value: value.clone() };
            return builder.push(kind, stmt.site.clone());
        }
        let skip = SourceInfo { skip: stmt.site.skip, ..SourceInfo::default() };
        let mut hold = |builder: &mut crate::ir::Builder, value: Expr, site: SourceInfo| {
            highest += 1;
            let temp = Var { class: Class::Temp, number: highest };
            builder.push(StmtKind::Assign { target: Place::Var(temp), value }, site);
            Expr::Var(temp)
        };
        let value = hold(builder, value.clone(), stmt.site.clone());
        let row = hold(builder, row.clone(), skip.clone());
        for (at, run) in runs.iter().enumerate() {
            let (then, otherwise) = (builder.fresh(), builder.fresh());
            let cond = inside(&row, &runs, at);
            builder.end(TermKind::Branch { cond: Box::new(cond), then, otherwise }, SourceInfo::default());
            builder.start(then);
            let there = Place::Indirect(Bank::Numbered, Box::new(number(&row, *run)));
            builder.push(StmtKind::Assign { target: there, value: value.clone() }, skip.clone());
            builder.start(otherwise);
        }
    });
    true
}
