//! Drilling cycles that their own block only stores, which begin at their first hole instead.
//!
//! Law: a cycle that its block stores and that drills first in the next block is one that this block begins. Side conditions: the
//! next block names X or Y and nothing but places in that plane, neither block may be skipped, and nothing but numbers and
//! variables that the cycle does not read is set between them. It is done where the target has no way to store a cycle.
//! Counter-example: `G81 R5. Z-10.` and then `G0 X20.`, which drills nothing.

use crate::canon::{Op, Role};
use crate::dialect::{Control, Question};
use crate::ir::{Module, Nc, NcItem, Place, Stmt, StmtKind, Stmts};
use crate::legalize::Context;
use crate::legalize::features::Features;

/// True if there are cycles whose block may store them, and the target is not known to store any.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let answer = |control: &Control, value: &str| {
        control.behaviour(Question::CycleRunsWithoutAxes).is_some_and(|row| row.value == value)
    };
    features.any_op(Op::is_cycle)
        && !answer(context.source, "true")
        && !answer(context.target, "false")
        && !context.target.is(Question::CycleL0Stores)
}

/// Begins such cycles at their first holes; true where there was one.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let vacant = context.source.is(Question::Vacancy);
    let mut changed = false;
    for (index, program) in module.programs.iter_mut().enumerate() {
        for block in &mut program.blocks {
            let mut out = Stmts::with_capacity(block.stmts.len());
            let mut rest = std::mem::take(&mut block.stmts).into_iter();
            while let Some(mut stmt) = rest.next() {
                let hole = stmt.kind.nc().filter(|nc| stores(nc) && stmt.site.skip.is_none());
                let Some(at) = hole.and_then(|nc| first_hole(nc, rest.as_slice(), vacant)) else {
                    out.push(stmt);
                    continue;
                };
                context.rests_on_source(index, stmt.site.span, Question::CycleRunsWithoutAxes);
                let kind = std::mem::replace(&mut stmt.kind, StmtKind::Comment);
                if !stmt.site.comments.is_empty() {
                    out.push(stmt);
                }
                out.extend(rest.by_ref().take(at));
                if let (Some(mut hole), StmtKind::Nc(cycle)) = (rest.next(), kind) {
                    if let StmtKind::Nc(nc) = &mut hole.kind {
                        nc.items.splice(0..0, cycle.items);
                    }
                    out.push(hole);
                }
                changed = true;
            }
            block.stmts = out;
        }
    }
    changed
}

/// True for a block that begins a cycle, and names neither a position nor a repeat.
fn stores(nc: &Nc) -> bool {
    let other = |item: &NcItem| match item {
        NcItem::Op(op) => *op == Op::CycleHere,
        NcItem::Word(role, _) => *role == Role::Repeat || role.is_axis() && *role != Role::Z,
        NcItem::Code(..) => true,
    };
    nc.ops().any(Op::is_cycle) && !nc.items.iter().any(other)
}

/// How many statements stand before the first hole; `vacant` where variables may be, so that a word may not be there.
fn first_hole(cycle: &Nc, rest: &[Stmt], vacant: bool) -> Option<usize> {
    let constant = cycle.items.iter().all(|item| match item {
        NcItem::Word(_, value) => value.constant().is_some(),
        NcItem::Op(_) | NcItem::Code(..) => true,
    });
    let passes = |stmt: &Stmt| match &stmt.kind {
        StmtKind::Comment => true,
        StmtKind::Assign { target: Place::Var(_), .. } => constant,
        _ => false,
    };
    let at = rest.iter().position(|stmt| !passes(stmt))?;
    let hole = rest.get(at)?;
    let nc = hole.kind.nc().filter(|_| hole.site.skip.is_none())?;
    let places = nc.items.iter().all(|item| match item {
        NcItem::Word(role, value) => matches!(role, Role::X | Role::Y) && !(vacant && value.may_be_vacant()),
        NcItem::Op(_) | NcItem::Code(..) => false,
    });
    (places && !nc.items.is_empty()).then_some(at)
}
