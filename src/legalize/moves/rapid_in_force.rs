//! Moves in machine coordinates on a machine that goes there by the interpolation in force.
//!
//! Law: such a move is a rapid on the source whatever interpolation is in force, and leaves that alone. So where another one is in
//! force, or it is not known which, the target's block has the code of the rapid too, in the place of one that it has, and the
//! interpolation that was in force is said again, unless the next block that moves says its own. Side condition: it is known, and is
//! the straight feed; or nothing can tell that the target has the rapid in force ([`motion_left`]). Where no source says how the source's control moves, the block stays, and the question is told: one answer
//! for both is enough. Counter-example: the move between two blocks of a modal pass.

use super::motion_left;
use crate::canon::{Group, Op};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Machine, Question};
use crate::ir::{BlockId, Module, Nc, NcItem, SourceInfo, Stmt, StmtKind, TermKind};
use crate::legalize::Context;
use crate::legalize::features::Features;

/// True where the target is such a machine, and the library moves so. A mill is, where only the source's moves are rapid.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let rapid = context.target.behaviour(Question::MachineMoveRapid);
    (context.target.machine() == Machine::Lathe || answer(context.source) != Some("false"))
        && features.op(Op::MachineOnce)
        && rapid.is_some_and(|row| row.value != "true")
}

/// What is known of a control's moves in machine coordinates.
fn answer(control: &Control) -> Option<&str> {
    control.behaviour(Question::MachineMoveRapid).map(|row| row.value.as_str())
}

/// Writes the code of the rapid; true where it was missing.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let facts = context.modal_facts(module);
    let is_mill = context.target.machine() == Machine::Mill;
    let (mut changed, mut found) = (false, Vec::new());
    for (index, program) in module.programs.iter_mut().enumerate() {
        let mut open = Vec::new();
        for (at, block) in program.blocks.iter_mut().enumerate() {
            if !block.stmts.iter().any(|stmt| stmt.kind.has_op(Op::MachineOnce)) {
                continue;
            }
            let mut state = facts.at(index, BlockId(at as u32));
            let ends = matches!(block.term.kind, TermKind::End { .. });
            let old = std::mem::take(&mut block.stmts);
            for (place, stmt) in old.iter().enumerate() {
                let before = state.op(Group::Motion);
                state.step(stmt);
                let mut stmt = stmt.clone();
                let own = |nc: &Nc| nc.ops().any(|op| op.group() == Group::Motion);
                let moves =
                    matches!(&stmt.kind, StmtKind::Nc(nc) if nc.has(Op::MachineOnce) && nc.names_axis());
                let own = stmt.kind.nc().is_some_and(own);
                let lacks = if own {
                    is_mill && state.op(Group::Motion) != Some(Op::Rapid)
                } else {
                    before != Some(Op::Rapid)
                };
                if !moves || !lacks {
                    block.stmts.push(stmt);
                    continue;
                }
                if is_mill && !context.source.is(Question::MachineMoveRapid) {
                    context.rests_on_source(index, stmt.site.span, Question::MachineMoveRapid);
                    context.rests_on_target(index, stmt.site.span, Question::MachineMoveRapid);
                    block.stmts.push(stmt);
                    continue;
                }
                changed = true;
                let before = if own { state.op(Group::Motion) } else { before };
                let span = stmt.site.span;
                if is_mill {
                    context.rests_on_source(index, span, Question::MachineMoveRapid);
                }
                let site = SourceInfo { span, skip: stmt.site.skip, ..SourceInfo::default() };
                if let StmtKind::Nc(nc) = &mut stmt.kind {
                    nc.items.retain(|item| !matches!(item, NcItem::Op(op) if op.group() == Group::Motion));
                    let once = nc.items.iter().position(|item| *item == NcItem::Op(Op::MachineOnce));
                    nc.items.insert(once.map_or(0, |once| once + 1), NcItem::Op(Op::Rapid));
                }
                block.stmts.push(stmt);
                match before {
                    _ if old.get(place + 1..).is_some_and(|rest| says_its_own(rest, false)) => {}
                    Some(Op::Linear) => {
                        let again = StmtKind::Nc(Nc { items: vec![NcItem::Op(Op::Linear)] });
                        block.stmts.push(Stmt { kind: again, site });
                    }
                    // What the program may be found in is what it leaves.
                    _ if old.get(place + 1..).is_some_and(|rest| says_its_own(rest, ends)) => {}
                    _ => open.push(((BlockId(at as u32), block.stmts.len() - 1), span)),
                }
            }
        }
        let moves: Vec<motion_left::Move> = open.iter().map(|(place, _)| *place).collect();
        if !moves.is_empty() {
            let told = motion_left::told(program, &moves);
            found.extend(
                open.iter().filter(|(place, _)| told.contains(place)).map(|(_, span)| (index, *span)),
            );
        }
    }
    for (index, span) in found {
        let what = "a move in machine coordinates, for which the target must be in G0: the code to go back to is not known, or is no straight \
                    move";
        let help =
            "write G0 in a block before the move, and the code that goes on after it in the block after it";
        context.add(index, Diagnostic::new(Code::NoEquivalent, span, what).with_help(help));
    }
    changed
}

/// True where the next block that names an axis has a code of its own for how it moves, or the program ends before one.
fn says_its_own(rest: &[Stmt], ends: bool) -> bool {
    for nc in rest.iter().filter_map(|stmt| stmt.kind.nc()) {
        if nc.ops().any(|op| op.group() == Group::Motion) {
            return true;
        }
        if nc.names_axis() {
            return false;
        }
    }
    ends
}
