//! Work offsets beyond the standard six, where programs read which of them is in force.
//!
//! Law: if no program of the library selects one, none is in force but by other programs or by hand. What is read of its number,
//! where the target does not tell that, is then an alarm in the place of the block that reads it, so that no run goes on with
//! another number. Side conditions: the block only sets a variable, and a run can pass it by. Counter-example: a program that
//! selects one itself, as each run would come to the alarm.

use super::findings::Finding;
use super::{held, own};
use crate::canon::{Op, Role, Sys};
use crate::dialect::{CodeHead, Control};
use crate::ir::analysis::{Assigned, LAST_P};
use crate::ir::{Expr, Module, Nc, NcItem, Place, Program, StmtKind, TermKind};
use crate::legalize::Context;
use crate::legalize::codes::by_number::numbers;
use crate::text::Span;
use std::cell::LazyCell;
use std::collections::BTreeSet;

/// G54 to G59.
const STANDARD_OFFSETS: f64 = 6.0;

/// The number of the alarm that stands for a block.
const ALARM: f64 = 99.0;

/// True if a program may select a work offset other than the standard six, which are G54 to G59.
pub(in crate::legalize) fn may_select(module: &Module, context: &Context<'_>) -> bool {
    let more = |nc: &Nc| {
        let number = nc.word(Role::WorkOffset).map(Expr::constant);
        number.is_some_and(|number| number.is_none_or(|number| number > STANDARD_OFFSETS))
    };
    let stmts = module.programs.iter().flat_map(|program| &program.blocks).flat_map(|block| &block.stmts);
    stmts.filter_map(|stmt| stmt.kind.nc()).any(more)
        || module.programs.iter().any(|program| computes_one(program, module, context))
}

/// True if a computed code of a program may select one: a word beside it says which. A code that was read is put back, and
/// selects nothing else.
fn computes_one(program: &Program, module: &Module, context: &Context<'_>) -> bool {
    let source = context.source;
    let summaries = LazyCell::new(|| context.summaries(module));
    let assigned = LazyCell::new(|| Assigned::new(program, &summaries));
    let selects = |number: f64| {
        let Some(head) = CodeHead::new('G', number) else { return true };
        let mut rows = source.rows_of(head).filter(|row| row.op == Op::SelectWork);
        rows.any(|row| {
            let after = row.head().map_or(0.0, |first| number - first.number());
            row.fixed.get(&Role::WorkOffset).is_none_or(|first| first + after > STANDARD_OFFSETS)
        })
    };
    for (id, block) in program.ids().zip(&program.blocks) {
        for (at, stmt) in block.stmts.iter().enumerate() {
            let Some(nc) = stmt.kind.nc() else { continue };
            if !nc.items.iter().any(|item| matches!(item, NcItem::Word(..))) {
                continue;
            }
            for item in &nc.items {
                let NcItem::Code('G', value) = item else { continue };
                match numbers(value, &assigned, id, at, source) {
                    Some(all) if !all.iter().any(|number| !number.is_read() && selects(number.number)) => {}
                    _ => return true,
                }
            }
        }
    }
    false
}

/// The blocks that each run begins with, before its first branch.
fn of_each_run(program: &Program) -> BTreeSet<usize> {
    let (mut passed, mut at) = (BTreeSet::new(), 0);
    while let Some(block) = program.blocks.get(at) {
        if !passed.insert(at) {
            break;
        }
        match &block.term.kind {
            TermKind::Jump(next) | TermKind::Call { next, .. } => at = next.index(),
            _ => break,
        }
    }
    passed
}

/// Puts an alarm in the place of each assignment that reads the number of an additional work offset, if the target does not
/// tell it.
pub(super) fn stop_reads(
    program: &mut Program,
    (source, target): (&Control, &Control),
    found: &mut Vec<(Span, Finding)>,
) {
    let number = [Expr::Number(LAST_P)];
    let Some(Finding::Own(variable, note)) = own(Sys::Address, &number, source) else { return };
    if held(Sys::Address, &number, target).is_some() {
        return;
    }
    let always = of_each_run(program);
    let blocks = program.blocks.iter_mut().enumerate().filter(|(at, _)| !always.contains(at));
    for stmt in blocks.flat_map(|(_, block)| &mut block.stmts) {
        let StmtKind::Assign { target: Place::Var(_), value } = &stmt.kind else { continue };
        let mut reads = false;
        value.walk(&mut |e| {
            reads |= matches!(e, Expr::System(Sys::Address, subscripts) if subscripts[..] == number);
        });
        if reads {
            found.push((stmt.site.span, Finding::NotTold(variable.clone(), note.clone())));
            let text = format!("{variable} IS NOT KNOWN HERE").into();
            stmt.kind = StmtKind::Alarm { number: Expr::Number(ALARM).into(), text };
        }
    }
}
