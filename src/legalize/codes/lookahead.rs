//! Waiting for the moves, and how far a control reads ahead.
//!
//! Law: a statement that waits until all moves are done is needed only where the target runs macro
//! statements early; there, reading ahead is limited to the least and empty blocks hold it back. Where the
//! target has no such limit, none is set. Both change when a value is read or an output is switched,
//! never what is computed; hence review diagnostics. Side condition: no cutter compensation is in force, under which the
//! target takes no limit; where the library compensates, the limit is taken off again after the empty blocks.

use crate::assume::Predicate;
use crate::canon::{Group, Op};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Question, Side};
use crate::ir::analysis::modal_facts::replace_statements;
use crate::ir::{Expr, Module, Nc, NcItem, SourceInfo, Stmt, StmtKind, Stmts};
use crate::legalize::layout::emptied::drop_emptied;
use crate::legalize::{Context, Modal, ModalFacts};
use crate::text::Span;
use std::collections::BTreeMap;

/// Empty blocks after a limit of one: the control reads two blocks more than it is told.
const HOLD_BACK: usize = 3;

/// Replaces waits and limits that the target has not.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let waits = context.target.statement("wait").is_some();
    let limits = context.target.code_for(Op::LimitLookahead, &BTreeMap::new()).is_some();
    let early = context.target.is(Question::LookaheadRunsEarly);
    let compensates = module.programs.iter().flat_map(|p| &p.blocks).flat_map(|b| &b.stmts).any(compensates);
    let mut entry = context.entry.clone();
    // Programs start without compensation: only what one begins may be in force.
    entry.start_in(Op::RadiusOff);
    let facts = if compensates { ModalFacts::of(module, &entry) } else { ModalFacts::unknown() };
    replace_statements(module, &facts, |index, state, stmt, out| {
        if compensates {
            state.step(&stmt);
        }
        let span = stmt.site.span;
        match stmt.kind {
            StmtKind::Sync if !waits && limits && early => {
                say_limit(index, compensates.then_some(&*state), span, context);
                limit(stmt.site, compensates, out);
            }
            StmtKind::Sync if !waits => {
                say_unlimited(index, early, span, context);
                out.push(Stmt { kind: StmtKind::Nc(Nc::default()), site: stmt.site });
            }
            StmtKind::LimitLookahead(_) if !limits => {
                let what = "the limit on reading ahead is dropped: the target has none, so the blocks after it \
                     may read inputs and switch outputs early";
                let told = Diagnostic::new(Code::Conditional, span, what);
                context.add_once(
                    index,
                    "lookahead",
                    told.assuming(Predicate::Substitute(Op::LimitLookahead)),
                );
                out.push(Stmt { kind: StmtKind::Nc(Nc::default()), site: stmt.site });
            }
            kind => out.push(Stmt { kind, site: stmt.site }),
        }
    });
    module.programs.iter_mut().flat_map(|p| &mut p.blocks).for_each(|block| _ = drop_emptied(block));
}

fn compensates(stmt: &Stmt) -> bool {
    let StmtKind::Nc(nc) = &stmt.kind else { return false };
    let begins =
        |item: &NcItem| matches!(item, NcItem::Op(Op::RadiusLeft | Op::RadiusRight) | NcItem::Code('G', _));
    nc.items.iter().any(begins)
}

/// A limit of one block and the empty ones; taken off again where it must not stay.
fn limit(site: SourceInfo, taken_off: bool, out: &mut Stmts) {
    let span = site.span;
    let empty = || Stmt { kind: StmtKind::Comment, site: SourceInfo { span, ..SourceInfo::default() } };
    let to = |count: f64| StmtKind::LimitLookahead(Expr::Number(count));
    out.push(Stmt { kind: to(1.0), site });
    out.extend(std::iter::repeat_with(empty).take(HOLD_BACK));
    if taken_off {
        out.push(Stmt { kind: to(0.0), ..empty() });
    }
}

/// Says what the limit rests on; `state` where the library has cutter compensation.
fn say_limit(index: usize, state: Option<&Modal>, span: Span, context: &mut Context<'_>) {
    let what = match state.map(|state| state.op(Group::RadiusComp)) {
        Some(Some(Op::RadiusLeft | Op::RadiusRight)) => {
            let what = "a wait under cutter compensation: the target does not take a limit on reading \
                        ahead there";
            let help = "put the wait before the compensation begins, or after it ends";
            return context.add(index, Diagnostic::new(Code::NoEquivalent, span, what).with_help(help));
        }
        Some(None) => {
            "the wait becomes a limit on reading ahead and three empty blocks: make sure that no cutter \
             compensation is in force here, because the target does not take the limit then"
        }
        Some(Some(_)) => {
            "the wait becomes a limit on reading ahead and three empty blocks; the limit ends after them"
        }
        None => {
            "the wait becomes a limit on reading ahead and three empty blocks; the limit stays in force \
             after them"
        }
    };
    context.add_once(index, what, Diagnostic::new(Code::Conditional, span, what));
}

/// Says what becomes of a wait where the target has neither a wait nor a limit.
fn say_unlimited(index: usize, early: bool, span: Span, context: &mut Context<'_>) {
    let waits = context.target.behaviour(Question::SystemReadWaits);
    if early || !waits.is_some_and(|b| b.value == "true" && b.origin.is_confirmed()) {
        let what = "the source waits here until all moves are done; no manual confirms that the target \
                    waits before it reads a position";
        context.unconfirmed(index, Side::Target, span, Question::SystemReadWaits.fact(), what);
    }
}
