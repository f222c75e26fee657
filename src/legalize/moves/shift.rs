//! Cancelling every zero shift for good, where the target can leave them for one block only.
//!
//! Law: while shifts are cancelled, coordinates are machine coordinates; a rapid move in absolute
//! coordinates under that state is the same move marked as one in machine coordinates. Side conditions: the
//! state, the motion and the distance mode are known from the text; the move is rapid, because the target's
//! machine-coordinate block is. Counter-example: a cut at feed with shifts cancelled, which is refused.

use crate::canon::{Group, Op, Role, Sys};
use crate::diag::{Code, Diagnostic};
use crate::ir::analysis::reachable;
use crate::ir::{BlockId, Expr, Module, Nc, NcItem, Stmt, StmtKind, TermKind};
use crate::legalize::layout::emptied::drop_emptied;
use crate::legalize::{Context, Modal};
use crate::text::Span;
use std::collections::BTreeMap;

/// A move whose work offset no block before it selects.
const INHERITED: &str = "the work offset in force here depends on what ran before: the target keeps the one that it has. If \
                         programs of the old machine begin in one, name it in its profile, under [start]: codes = \"G54\"";

/// Marks the moves under cancelled shifts.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let lacks = context.target.code_for(Op::ShiftCancel, &BTreeMap::new()).is_none()
        && context.target.word_for(Op::ShiftCancel).is_none();
    if !lacks {
        return;
    }
    let facts = context.modal_facts(module);
    let stmts = || module.programs.iter().flat_map(|p| &p.blocks).flat_map(|b| &b.stmts);
    let has = |op: Op| stmts().any(|stmt| matches!(&stmt.kind, StmtKind::Nc(nc) if nc.has(op)));
    let (incremental, sets_position) = (has(Op::Incremental), has(Op::SetPosition));
    for (index, program) in module.programs.iter_mut().enumerate() {
        let main = reachable(program, BlockId(0));
        for (at, block) in program.blocks.iter_mut().enumerate() {
            let mut state = facts.at(index, BlockId(at as u32));
            for stmt in &mut block.stmts {
                state.step(stmt);
                let mut reads = false;
                stmt.kind.exprs(&mut |e| reads |= reads_position(e));
                if reads {
                    refuse_read(index, stmt.site.span, &state, context);
                }
                if sets_position && matches!(&stmt.kind, StmtKind::Nc(nc) if nc.has(Op::ShiftCancel)) {
                    let what = "all zero shifts are cancelled: no source says whether that also ends a \
                                position that a program set; on the target that position stays";
                    context.add_once(index, what, Diagnostic::new(Code::NoEquivalent, stmt.site.span, what));
                }
                if let Some((code, what)) = mark(stmt, &state, incremental) {
                    let finding = Diagnostic::new(code, stmt.site.span, what);
                    // What programs begin in is asked of the machine.
                    let finding = if what == INHERITED { finding.asked_once() } else { finding };
                    context.add_once(index, what, finding);
                }
            }
            let mut reads = false;
            block.term.kind.exprs(&mut |e| reads |= reads_position(e));
            if reads {
                refuse_read(index, block.term.site.span, &state, context);
            }
            if matches!(block.term.kind, TermKind::Return { .. })
                && state.may_be_cancelled
                && main.contains(&BlockId(at as u32))
            {
                let what = "the program returns with all zero shifts cancelled, but the target always has \
                            a work offset: convert its callers together with it";
                context.add_once(index, what, Diagnostic::new(Code::Conditional, block.term.site.span, what));
            }
            drop_emptied(block);
        }
    }
}

/// True where an expression reads a position that is counted from the work offset.
fn reads_position(e: &Expr) -> bool {
    let mut found = false;
    e.walk(&mut |e| {
        use Sys::{AxisPosition, EndPosition, SkipPosition, WorkPosition};
        found |= matches!(e, Expr::System(AxisPosition | EndPosition | SkipPosition | WorkPosition, _));
    });
    found
}

/// Positions are machine coordinates while shifts are cancelled, and on the target never.
fn refuse_read(index: usize, span: Span, state: &Modal, context: &mut Context<'_>) {
    if state.may_be_cancelled || state.op(Group::WorkOffset) == Some(Op::ShiftCancel) {
        let what = "a position is read while all zero shifts may be cancelled: on the target it counts \
                    from the work offset";
        context.add_once(index, what, Diagnostic::new(Code::NoEquivalent, span, what));
    }
}

fn names_axes(nc: &Nc) -> bool {
    nc.items.iter().any(|item| matches!(item, NcItem::Word(role, _) if role.is_axis()))
}

/// `incremental` if a program of the library sets incremental coordinates.
fn mark(stmt: &mut Stmt, state: &Modal, incremental: bool) -> Option<(Code, &'static str)> {
    let StmtKind::Nc(nc) = &mut stmt.kind else { return None };
    let moves = nc.moves() && !nc.has(Op::ReferenceReturn) && !nc.has(Op::MachineOnce);
    let at = nc.items.iter().position(|item| *item == NcItem::Op(Op::ShiftCancel));
    // A modal call after the move may leave another shift, but not before it.
    let cancelled = at.map(|_| Op::ShiftCancel).or(state.op(Group::WorkOffset));
    if let Some(at) = at {
        nc.items.remove(at);
    }
    let returns = nc.has(Op::ReferenceReturn) || nc.has(Op::Reference2);
    let absolute = state.op(Group::Distance) != Some(Op::Incremental);
    if returns && absolute && names_axes(nc) && (state.may_be_cancelled || cancelled == Some(Op::ShiftCancel))
    {
        return Some((
            Code::NoEquivalent,
            "a return to the reference position through a point, while all zero shifts may be cancelled: \
             on the target the point counts from the work offset. Give the point in G91",
        ));
    }
    if !moves {
        return None;
    }
    match cancelled {
        Some(Op::ShiftCancel) => {
            let first_word = nc.items.iter().position(|item| matches!(item, NcItem::Word(..)));
            // Before the words that it is about, as each target writes it on the next way too.
            let place = first_word.into_iter().chain(at).min();
            nc.items.insert(place.unwrap_or(0), NcItem::Op(Op::MachineOnce));
            if state.op(Group::Cycle).is_some_and(|op| op != Op::CycleOff) {
                return Some((
                    Code::NoEquivalent,
                    "a drilling cycle with all zero shifts cancelled: the target has machine coordinates \
                     for moves only",
                ));
            }
            match (state.op(Group::Motion), state.op(Group::Distance)) {
                (Some(Op::Rapid), Some(Op::Absolute)) => match state.op(Group::LengthComp) {
                    _ if nc.word(Role::Z).is_none() => None,
                    Some(Op::LengthOff) => None,
                    Some(_) => Some((
                        Code::NoEquivalent,
                        "a move with all zero shifts cancelled and a tool length in force: the target \
                         ignores the length in machine coordinates",
                    )),
                    None if state.names_length() => Some((
                        Code::NoEquivalent,
                        "a move with all zero shifts cancelled, and a tool length may be in force, on \
                         some paths to this block or from a caller: the target ignores the length in \
                         machine coordinates. Cancel the length before the move",
                    )),
                    _ => Some((
                        Code::Conditional,
                        "the move becomes one in machine coordinates: the target also ignores tool length \
                         compensation in this block",
                    )),
                },
                (Some(Op::Rapid), None) if !incremental => Some((
                    Code::Conditional,
                    "this move in machine coordinates is taken as absolute: the program does not say so",
                )),
                _ => Some((
                    Code::NoEquivalent,
                    "a move with all zero shifts cancelled: the target has machine coordinates for rapid \
                     absolute moves only, and this one may be another",
                )),
            }
        }
        Some(_) => None,
        None if state.may_be_cancelled => Some((
            Code::NoEquivalent,
            "all zero shifts are cancelled on some paths to this move and not on others: the target needs \
             the same on all of them",
        )),
        None => Some((Code::Conditional, INHERITED)),
    }
}
