//! A move in machine coordinates, where the target has a code that cancels all zero shifts until one is selected.
//!
//! Law: under cancelled shifts coordinates are machine coordinates, so a block that moves in them for once is the
//! cancelling, the move, and the selection of the work offset that was in force. Where another offset is selected, the
//! program ends, or another such move comes before anything counts from an offset, nothing is selected in between. Ways
//! through other blocks, and into programs that are called, are looked at too.
//! Side conditions: the offset in force is known from the text; the move is rapid and absolute there, as it is on both
//! controls; no tool length counts in it, so one that is in force is ended before, which the text must allow: a length
//! is named, or a tool changed, before the next move along Z.
//! Counter-example: `G53 Z0` in a macro whose callers select G54 and G55.

mod counting;

use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Control;
use crate::ir::{Expr, Module, Nc, NcItem, SourceInfo, Stmt, StmtKind, Stmts, TermKind};
use crate::legalize::{Context, Modal, Setting};
use counting::Counting;
use std::collections::BTreeMap;

/// True if the target cancels shifts for good only.
pub fn concerns(target: &Control) -> bool {
    let has = |op| target.code_for(op, &BTreeMap::new()).is_some();
    has(Op::ShiftCancel) && !has(Op::MachineOnce)
}

/// Cancels the shifts before these moves.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let facts = context.modal_facts(module);
    let counting = counting::of(module);
    for (index, program) in module.programs.iter_mut().enumerate() {
        let ids: Vec<_> = program.ids().collect();
        for (id, block) in ids.into_iter().zip(&mut program.blocks) {
            let moves = |stmt: &Stmt| matches!(&stmt.kind, StmtKind::Nc(nc) if nc.has(Op::MachineOnce));
            if !block.stmts.iter().any(moves) {
                continue;
            }
            let mut state = facts.at(index, id);
            let old = std::mem::take(&mut block.stmts);
            let mut out = Stmts::with_capacity(old.len() + 2);
            for (at, stmt) in old.iter().enumerate() {
                let before = state.clone();
                state.step(stmt);
                if moves(stmt) {
                    let rest = old.get(at + 1..).unwrap_or_default();
                    let rest = Rest { stmts: rest, end: &block.term.kind, counting: &counting, index };
                    match replaced(stmt, &before, &state, &rest) {
                        Ok(stmts) => out.extend(stmts),
                        Err(what) => {
                            let finding = Diagnostic::new(Code::NoEquivalent, stmt.site.span, what);
                            context.add_once(index, what, finding);
                        }
                    }
                } else {
                    out.push(stmt.clone());
                }
            }
            block.stmts = out;
        }
    }
}

/// What comes after a move.
struct Rest<'r> {
    stmts: &'r [Stmt],
    end: &'r TermKind,
    counting: &'r Counting,
    /// The program.
    index: usize,
}

/// What stands for the move.
fn replaced(stmt: &Stmt, before: &Modal, state: &Modal, rest: &Rest<'_>) -> Result<Vec<Stmt>, &'static str> {
    let StmtKind::Nc(nc) = &stmt.kind else { return Ok(vec![stmt.clone()]) };
    if state.op(Group::Motion) != Some(Op::Rapid) || state.op(Group::Distance) != Some(Op::Absolute) {
        return Err(
            "a move in machine coordinates that is not known to be rapid and absolute: write G0 and G90 before it",
        );
    }
    let length = match nc.ops().find(|op| op.group() == Group::LengthComp) {
        // The block says so itself.
        Some(Op::LengthOff) => false,
        Some(_) => {
            return Err(
                "a tool length is taken up in the block of a move in machine coordinates: write it after the move",
            );
        }
        None => length(nc, before, rest.stmts, rest.end)?,
    };
    let mut items: Vec<NcItem> =
        nc.items.iter().filter(|item| **item != NcItem::Op(Op::MachineOnce)).cloned().collect();
    items.extend(length.then_some(NcItem::Op(Op::LengthOff)));
    let site = || SourceInfo { span: stmt.site.span, skip: stmt.site.skip, ..SourceInfo::default() };
    let block = |items, site| Stmt { kind: StmtKind::Nc(Nc { items }), site };
    let mut out = vec![block(vec![NcItem::Op(Op::ShiftCancel)], stmt.site.clone()), block(items, site())];
    if rest.counting.after(rest.index, rest.stmts, rest.end) {
        match before.of(Group::WorkOffset) {
            Setting::Known(Op::SelectWork, Some(number)) => out.push(block(
                vec![
                    NcItem::Op(Op::SelectWork),
                    NcItem::Word(Role::WorkOffset, Expr::Number(f64::from(number))),
                ],
                site(),
            )),
            Setting::Known(Op::ShiftCancel, _) => {}
            _ => {
                return Err(
                    "which work offset is in force after this move in machine coordinates is not known: select one \
                     after it",
                );
            }
        }
    }
    Ok(out)
}

/// True if a tool length has to be ended with the move.
fn length(nc: &Nc, before: &Modal, rest: &[Stmt], end: &TermKind) -> Result<bool, &'static str> {
    if nc.word(Role::Z).is_none() || before.op(Group::LengthComp) == Some(Op::LengthOff) {
        return Ok(false);
    }
    if before.op(Group::LengthComp).is_none() && !before.names_length() {
        return Ok(true);
    }
    for stmt in rest {
        match &stmt.kind {
            StmtKind::Nc(nc)
                if nc.ops().any(|op| op == Op::ToolChange || op.group() == Group::LengthComp) =>
            {
                return Ok(true);
            }
            StmtKind::Nc(nc) if nc.word(Role::Z).is_some() && !nc.has(Op::MachineOnce) => return Err(LENGTH),
            _ => {}
        }
    }
    if matches!(end, TermKind::End { .. }) { Ok(true) } else { Err(LENGTH) }
}

/// Why a length cannot be ended.
const LENGTH: &str = "a move in machine coordinates along Z with a tool length in force: the target counts the length in it, \
                      and where the length counts again is not known. Cancel the length before the move";
