//! The time of a dwell in the unit that the target takes.
//!
//! Law: a second is a thousand milliseconds. A constant is converted here; a computed value goes
//! to the seconds word where the target has one, since its milliseconds word takes whole
//! numbers only. A target may have one time that means something else, a wait for START: two dwells of half the time are
//! written for it.

use crate::canon::{Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Question, Side};
use crate::ir::analysis::{Summaries, Vacancy};
use crate::ir::{BinOp, Expr, Module, Nc, NcItem, Program, SourceInfo, Stmt, StmtKind};
use crate::legalize::Context;
use crate::text::Span;
use std::collections::{BTreeMap, BTreeSet};

/// Converts the times of dwells.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let target = context.target;
    let code = target.code_for(Op::Dwell, &BTreeMap::new());
    let (ms, s) = (target.letter(Role::DwellMs, code).is_some(), target.letter(Role::DwellS, code).is_some());
    let summaries = context.summaries(module);
    for (index, program) in module.programs.iter_mut().enumerate() {
        let mut computed: Vec<(bool, Span)> = Vec::new();
        let waits = target.number(Question::DwellWaits);
        let set = times_that_are_set(program, &summaries);
        for stmt in program.blocks.iter_mut().flat_map(|block| &mut block.stmts) {
            let StmtKind::Nc(nc) = &mut stmt.kind else { continue };
            let vacant = |item: &NcItem| matches!(item, NcItem::Word(_, value) if value.may_be_vacant());
            let dropped = nc.has(Op::Dwell) && nc.items.iter().any(vacant);
            let in_cycle = nc.word(Role::CycleDwell).is_some_and(|value| value.constant().is_none());
            if in_cycle || nc.has(Op::Dwell) && convert(nc, ms, s) {
                computed.push((in_cycle, stmt.site.span));
            }
            if dropped && !nc.items.iter().any(vacant) && !set.contains(&stmt.site.span) {
                let what = "if the time of this dwell is vacant, the source has no time in the block and the \
                     target has 0";
                context.add_once(index, what, Diagnostic::new(Code::Conditional, stmt.site.span, what));
            }
        }
        if let Some(waits) = waits {
            halve(program, waits);
            if let Some((_, span)) = computed.iter().find(|(in_cycle, _)| !in_cycle) {
                let what = format!(
                    "this dwell is computed, and one of {waits} milliseconds waits for START on the target: make sure that it is never that long"
                );
                context.add(index, Diagnostic::new(Code::Conditional, *span, what));
            }
        }
        let row = target.behaviour(Question::DwellExpression);
        let known = row.is_some_and(|row| row.value == "ms" && row.origin.is_confirmed());
        // In seconds a computed value counts as written; a cycle has no such word.
        let asked = computed.iter().find(|(in_cycle, _)| *in_cycle || !s);
        if let Some((_, span)) = asked.filter(|_| row.is_some_and(|row| row.value == "seconds")) {
            let what = "a computed dwell is in milliseconds on the source and in seconds on the target";
            context.add(index, Diagnostic::new(Code::NoEquivalent, *span, what));
        } else if let (Some((_, span)), false) = (asked, known) {
            let what =
                "no manual confirms whether the target counts a computed dwell in seconds or milliseconds";
            context.unconfirmed(index, Side::Target, *span, Question::DwellExpression.fact(), what);
        }
    }
}

/// The dwells whose time is a variable that always has a value there.
fn times_that_are_set(program: &Program, summaries: &Summaries) -> Vec<Span> {
    let by_variable = |stmt: &Stmt| {
        let vacant = |item: &NcItem| matches!(item, NcItem::Word(_, value) if value.may_be_vacant());
        stmt.kind.nc().is_some_and(|nc| nc.has(Op::Dwell) && nc.items.iter().any(vacant))
    };
    let mut found = Vec::new();
    if !program.blocks.iter().flat_map(|block| &block.stmts).any(by_variable) {
        return found;
    }
    let vacancy = Vacancy::of(program, summaries, &BTreeSet::new());
    for (id, block) in program.ids().zip(&program.blocks) {
        for (at, stmt) in block.stmts.iter().enumerate() {
            let Some(nc) = stmt.kind.nc().filter(|nc| nc.has(Op::Dwell)) else { continue };
            let vacant = |item: &NcItem| matches!(item, NcItem::Word(_, value) if value.may_be_vacant() && vacancy.may_yield_vacant(id, at, value));
            found.extend((!nc.items.iter().any(vacant)).then_some(stmt.site.span));
        }
    }
    found
}

/// Writes two dwells of half the time for each of this time. What stands beside a dwell stays in the first block.
fn halve(program: &mut Program, waits: f64) {
    let is_long = |stmt: &Stmt| match &stmt.kind {
        StmtKind::Nc(nc) => {
            nc.has(Op::Dwell) && nc.word(Role::DwellMs).and_then(Expr::constant) == Some(waits)
        }
        _ => false,
    };
    for block in &mut program.blocks {
        if !block.stmts.iter().any(is_long) {
            continue;
        }
        for mut stmt in std::mem::take(&mut block.stmts) {
            let long = is_long(&stmt);
            let mut second = None;
            if let (true, StmtKind::Nc(nc)) = (long, &mut stmt.kind) {
                let half = NcItem::Word(Role::DwellMs, Expr::Number(waits / 2.0));
                for item in &mut nc.items {
                    if matches!(item, NcItem::Word(Role::DwellMs, _)) {
                        *item = half.clone();
                    }
                }
                let kind = StmtKind::Nc(Nc { items: vec![NcItem::Op(Op::Dwell), half] });
                let site = SourceInfo { span: stmt.site.span, skip: stmt.site.skip, ..SourceInfo::default() };
                second = Some(Stmt { kind, site });
            }
            block.stmts.push(stmt);
            block.stmts.extend(second);
        }
    }
}

/// Converts one dwell; true where its value is computed.
fn convert(nc: &mut Nc, ms: bool, s: bool) -> bool {
    let mut computed = false;
    for item in &mut nc.items {
        let NcItem::Word(role @ (Role::DwellMs | Role::DwellS), value) = item else { continue };
        let old = std::mem::replace(value, Expr::Vacant);
        let (to, new) = match (old.constant(), *role) {
            // 0.07 * 1000 is no whole number in binary, and 70 / 1000 is 0.07.
            (Some(t), Role::DwellS) if ms && (t * 1000.0).round() / 1000.0 == t => {
                (Role::DwellMs, Expr::Number((t * 1000.0).round()))
            }
            (Some(t), Role::DwellMs) if s && (!ms || t.fract() != 0.0) => {
                (Role::DwellS, Expr::Number(t / 1000.0))
            }
            (None, Role::DwellMs) if s => (Role::DwellS, scaled(BinOp::Div, old)),
            (None, Role::DwellS) if !s => {
                computed = true;
                (Role::DwellMs, scaled(BinOp::Mul, old))
            }
            (constant, same) => {
                computed |= constant.is_none();
                (same, old)
            }
        };
        (*role, *value) = (to, new);
    }
    computed
}

/// A time in the other unit. One that comes from there, as a conversion wrote it, is what it was: what two roundings take
/// from it is less than the least time that either unit counts. A vacant one would take its word away.
fn scaled(op: BinOp, value: Expr) -> Expr {
    let thousand = |e: &Expr| e.constant() == Some(1000.0);
    if let Expr::Binary(inner, of) = &value
        && matches!((op, inner), (BinOp::Div, BinOp::Mul) | (BinOp::Mul, BinOp::Div))
        && thousand(&of[1])
        && !of[0].may_be_vacant()
    {
        return of[0].clone();
    }
    Expr::binary(op, value, Expr::Number(1000.0))
}
