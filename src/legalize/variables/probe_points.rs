//! Touch points that the control keeps by number.
//!
//! Law: a probe move that keeps its touch point as number n copies the place where the probe touched into registers of
//! that point, one for each axis that the library reads; a point is read there. Which of the points is read by a
//! computed number is asked one by one: there are few. Side conditions: which point is kept is known, and no point is
//! read before it is kept; and, for a reviewer, the source keeps points in the coordinates of the program (a printed
//! example reads so), and the probe touches.

use crate::canon::{Op, Role, Sys};
use crate::diag::{Code, Diagnostic};
use crate::ir::analysis::upward_exposed::{UpwardExposed, roots};
use crate::ir::analysis::{Constant, Summaries, values_at};
use crate::ir::{
    BlockId, Class, Cond, Expr, Module, Nc, NcItem, Place, Program, Relation, SourceInfo, Stmt, StmtKind,
    Stmts, Var,
};
use crate::legalize::rewrite::{PreStatement, rewrite_program};
use crate::legalize::{Context, Rewriter};
use crate::text::Span;
use std::collections::BTreeSet;
use thin_vec::ThinVec;

/// An axis and the number of a point.
type Cell = (u32, u32);

/// Keeps touch points in registers.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let Some(row) = context.source.system_run(Sys::ProbePoint) else { return };
    let first = row.subscripts.first().map_or(1, |run| run.from);
    let points: Vec<u32> = (first..first + row.subscripts.first().map_or(0, |run| run.count)).collect();
    let any_kept = |program: &Program| {
        let mut stmts = program.blocks.iter().flat_map(|block| &block.stmts);
        stmts.any(|stmt| matches!(&stmt.kind, StmtKind::Nc(nc) if keeps(nc)))
    };
    let there = |axis: u32| context.target.system_address(Sys::SkipPosition, &[axis]).is_some();
    if context.target.system_run(Sys::ProbePoint).is_some() || !module.programs.iter().any(any_kept) {
        return;
    }
    let cells = read(module, &points);
    if cells.iter().any(|(axis, point)| !there(*axis) || *axis > 9 || *point > 9) {
        return;
    }
    let summaries = context.summaries(module);
    let mut sure = true;
    for (index, program) in module.programs.iter_mut().enumerate() {
        let mut any = any_kept(program);
        for span in keep(program, &cells, &summaries) {
            let what = "the number of the touch point that the probe move keeps is computed: write a \
                        constant";
            context.add(index, Diagnostic::new(Code::NoEquivalent, span, what));
            sure = false;
        }
        rewrite_program(program, |e| matches!(e, Expr::System(Sys::ProbePoint, _)), &mut |e, _, rewriter| {
            let Expr::System(Sys::ProbePoint, subscripts) = e else { return e };
            any = true;
            look_up(subscripts, &points, rewriter)
        });
        if any {
            let what = "touch points are kept in registers, in program coordinates: check that the source \
                        keeps them so, and that each probe move touches";
            let finding = Diagnostic::new(Code::Conditional, program.site.span, what);
            context.add_once(index, "probe points", finding);
        }
    }
    // What is not known to be kept is not known to be missing.
    let upward_exposed = UpwardExposed::of(module);
    for index in roots(module).into_iter().filter(|_| sure) {
        let unset =
            upward_exposed.at_entry(index).into_iter().find(|var| cells.iter().any(|of| cell(*of) == *var));
        if unset.is_some() {
            let what = "this touch point may be read before any program of the library has probed it";
            let span = module.programs[index].site.span;
            context.add_once(index, what, Diagnostic::new(Code::NoEquivalent, span, what));
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

fn look_up(subscripts: ThinVec<Expr>, points: &[u32], rewriter: &mut Rewriter<'_>) -> Expr {
    let [axis, point] = subscripts.as_slice() else { return Expr::System(Sys::ProbePoint, subscripts) };
    match (whole(axis), whole(point)) {
        (Some(axis), Some(point)) => Expr::Var(cell((axis, point))),
        (Some(axis), None) if point.constant().is_none() => {
            let point = rewriter.held(point.clone());
            let value = rewriter.materialize(Expr::Number(0.0));
            for &number in points {
                let cond = Cond::Compare(Relation::Equal, point.clone(), Expr::Number(f64::from(number)));
                rewriter.first(PreStatement::When(cond, value, Expr::Var(cell((axis, number)))));
            }
            Expr::Var(value)
        }
        _ => Expr::System(Sys::ProbePoint, subscripts),
    }
}

/// The number of the point that a probe move keeps, where it is known.
fn kept(nc: &Nc, at: (&Program, &Summaries, BlockId, usize)) -> Option<u32> {
    let value = nc.word(Role::ProbePoint)?;
    let (program, summaries, id, stmt) = at;
    match value {
        Expr::Var(var) => match values_at(program, summaries, *var, id, stmt)?.as_slice() {
            [Constant::Number(number)] => whole(&Expr::Number(*number)),
            _ => None,
        },
        value => whole(value),
    }
}

/// Copies the place of the touch after each probe move that keeps it; where the number of the point is not known,
/// the places of those moves.
fn keep(program: &mut Program, cells: &BTreeSet<Cell>, summaries: &Summaries) -> Vec<Span> {
    let mut open = Vec::new();
    let mut points: Vec<Vec<Option<u32>>> = Vec::new();
    for (id, block) in program.ids().zip(&program.blocks) {
        let point = |(at, stmt): (usize, &Stmt)| match &stmt.kind {
            StmtKind::Nc(nc) if keeps(nc) => kept(nc, (program, summaries, id, at)),
            _ => None,
        };
        points.push(block.stmts.iter().enumerate().map(point).collect());
    }
    for (block, points) in program.blocks.iter_mut().zip(points) {
        let mut out = Stmts::with_capacity(block.stmts.len());
        for (mut stmt, point) in std::mem::take(&mut block.stmts).into_iter().zip(points) {
            let site = SourceInfo { skip: stmt.site.skip, ..SourceInfo::default() };
            let span = stmt.site.span;
            let StmtKind::Nc(nc) = &mut stmt.kind else {
                out.push(stmt);
                continue;
            };
            let any = keeps(nc);
            nc.items.retain(|item| !(any && matches!(item, NcItem::Word(Role::ProbePoint, _))));
            out.push(stmt);
            if any && point.is_none() {
                open.push(span);
            }
            let own: Vec<Cell> = cells.iter().copied().filter(|(_, of)| point == Some(*of)).collect();
            if !own.is_empty() {
                // A control that reads ahead must not read the place before the move.
                out.push(Stmt { kind: StmtKind::Sync, site: SourceInfo { span, ..site.clone() } });
            }
            for (axis, of) in own {
                let value = Expr::System(Sys::SkipPosition, [Expr::Number(f64::from(axis))].into());
                let kind = StmtKind::Assign { target: Place::Var(cell((axis, of))), value };
                out.push(Stmt { kind, site: site.clone() });
            }
        }
        block.stmts = out;
    }
    open
}

fn keeps(nc: &Nc) -> bool {
    nc.has(Op::Probe) && nc.word(Role::ProbePoint).is_some()
}

/// The register of a cell: its axis and its point are its digits.
fn cell((axis, point): Cell) -> Var {
    Var { class: Class::Register, number: axis * 10 + point }
}

fn whole(e: &Expr) -> Option<u32> {
    let value = e.constant()?;
    ((0.0..=99.0).contains(&value) && value.fract() == 0.0).then_some(value as u32)
}
