//! Touch points that the control keeps by number.
//!
//! Law: a probe move that keeps its touch point as number n copies the place where the probe touched into registers of
//! that point, one for each axis that the library reads; a point is read there. Which of the points a computed number
//! means is asked one by one: there are few. Side conditions, which a reviewer must accept: the source keeps points in
//! the coordinates of the program (a printed example reads so), the probe touches, and only programs of the library
//! move it. A library that reads points and keeps none has them from elsewhere: there is nothing to read on the target.

use super::rewrite::{Part, Prelude, rebuild, rewrite_program};
use super::{Context, Rewriter};
use crate::canon::{Op, Role, Sys};
use crate::diag::{Code, Diagnostic};
use crate::ir::{
    Builder, Class, Cond, Expr, Module, NcItem, Place, Program, Relation, Site, StmtKind, TermKind, Var,
};
use std::collections::BTreeSet;

/// An axis and the number of a point.
type Cell = (u32, u32);

/// Keeps touch points in registers.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let Some(row) = context.source.system_run(Sys::ProbePoint) else { return };
    let first = row.subscripts.first().map_or(1, |run| run.from);
    let points: Vec<u32> = (first..first + row.subscripts.first().map_or(0, |run| run.count)).collect();
    let keeps = |program: &Program| {
        program.blocks.iter().flat_map(|block| &block.stmts).any(
            |stmt| matches!(&stmt.kind, StmtKind::Nc(nc) if nc.has(Op::Probe) && nc.word(Role::ProbePoint).is_some()),
        )
    };
    let there = |axis: u32| context.target.system_address(Sys::SkipPosition, &[axis]).is_some();
    if context.target.system_run(Sys::ProbePoint).is_some() || !module.programs.iter().any(keeps) {
        return;
    }
    let cells = read(module, &points);
    if cells.iter().any(|(axis, point)| !there(*axis) || *axis > 9 || *point > 9) {
        return;
    }
    for (index, program) in module.programs.iter_mut().enumerate() {
        let mut any = keeps(program);
        rewrite_program(program, &mut |e, _, rewriter| {
            let Expr::System(Sys::ProbePoint, subscripts) = e else { return e };
            any = true;
            look_up(subscripts, &points, rewriter)
        });
        if keeps(program) {
            keep(program, &cells);
        }
        if any {
            let what = "touch points are kept in registers, in the coordinates of the program, when a program of this library has probed: check that the source keeps them so, and that nothing else moves them";
            let finding = Diagnostic::new(Code::Conditional, program.site.span, what);
            context.add_once(index, "probe points", finding);
        }
    }
}

/// The cells that the library reads.
fn read(module: &Module, points: &[u32]) -> BTreeSet<Cell> {
    let mut cells = BTreeSet::new();
    for block in module.programs.iter().flat_map(|program| &program.blocks) {
        let mut note = |e: &Expr| {
            e.walk(&mut |e| {
                if let Expr::System(Sys::ProbePoint, subscripts) = e
                    && let [axis, point] = subscripts.as_slice()
                    && let Some(axis) = whole(axis)
                {
                    match point.constant() {
                        Some(_) => cells.extend(whole(point).map(|point| (axis, point))),
                        None => cells.extend(points.iter().map(|point| (axis, *point))),
                    }
                }
            });
        };
        block.stmts.iter().for_each(|stmt| stmt.kind.exprs(&mut note));
        block.term.kind.exprs(&mut note);
    }
    cells
}

fn look_up(subscripts: Vec<Expr>, points: &[u32], rewriter: &mut Rewriter<'_>) -> Expr {
    let [axis, point] = subscripts.as_slice() else { return Expr::System(Sys::ProbePoint, subscripts) };
    match (whole(axis), whole(point)) {
        (Some(axis), Some(point)) => Expr::Var(cell((axis, point))),
        (Some(axis), None) if point.constant().is_none() => {
            let point = rewriter.held(point.clone());
            let value = rewriter.hold(Expr::Number(0.0));
            for &number in points {
                let cond = Cond::Compare(Relation::Equal, point.clone(), Expr::Number(f64::from(number)));
                rewriter.first(Prelude::When(cond, value, Expr::Var(cell((axis, number)))));
            }
            Expr::Var(value)
        }
        _ => Expr::System(Sys::ProbePoint, subscripts),
    }
}

/// Copies the place of the touch behind each probe move that keeps it.
fn keep(program: &mut Program, cells: &BTreeSet<Cell>) {
    rebuild(program, &mut |builder, mut part| {
        let Part::Stmt(stmt) = &mut part else { return part.keep(builder) };
        let mut number = None;
        let at = stmt.site.span;
        let site = Site { skip: stmt.site.skip, ..Site::default() };
        if let StmtKind::Nc(nc) = &mut stmt.kind
            && nc.has(Op::Probe)
        {
            nc.items.retain_mut(|item| match item {
                NcItem::Word(Role::ProbePoint, value) => {
                    number = Some(std::mem::replace(value, Expr::Vacant));
                    false
                }
                _ => true,
            });
        }
        part.keep(builder);
        let Some(number) = number else { return };
        if cells.is_empty() {
            return;
        }
        // A control that reads ahead must not read the place before the move.
        builder.push(StmtKind::Sync, Site { span: at, ..site.clone() });
        let constant = number.constant();
        for &(axis, point) in cells {
            let of = f64::from(point);
            if constant.is_some_and(|number| number != of) {
                continue;
            }
            let value = Expr::System(Sys::SkipPosition, vec![Expr::Number(f64::from(axis))]);
            let kept = StmtKind::Assign { target: Place::Var(cell((axis, point))), value };
            if constant.is_some() {
                builder.push(kept, site.clone());
                continue;
            }
            when(builder, Cond::Compare(Relation::Equal, number.clone(), Expr::Number(of)), kept, &site);
        }
    });
}

fn when(builder: &mut Builder, cond: Cond, then: StmtKind, site: &Site) {
    let (yes, no) = (builder.fresh(), builder.fresh());
    builder.end(TermKind::Branch { cond, yes, no }, Site::default());
    builder.start(yes);
    builder.push(then, site.clone());
    builder.start(no);
}

/// The register of a cell: its axis and its point are its digits.
fn cell((axis, point): Cell) -> Var {
    Var { class: Class::Register, number: axis * 10 + point }
}

fn whole(e: &Expr) -> Option<u32> {
    let value = e.constant()?;
    ((0.0..=99.0).contains(&value) && value.fract() == 0.0).then_some(value as u32)
}
