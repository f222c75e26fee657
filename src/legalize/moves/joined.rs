//! Codes that an earlier conversion wrote into a block before their move.
//!
//! Law: a control that has no code and no number beside a variable gets `G2 F30`, then `X=V67 Y=V66 R=V69`. The first
//! block moves nothing, and what it says is in force where the second one moves: one block says the same.
//!
//! Side conditions: an earlier conversion wrote the library for such a control. The first block has motion codes, G90
//! or G91 and a feed alone, and the second, right after it, words of axes and centres alone, one of them by a
//! variable. No block of them may be skipped, and nothing drills, as a motion code would end that. Counter-example:
//! `M3` before such a move, which then starts with it.

use crate::canon::{Group, Op, Role};
use crate::dialect::{Control, OperandPlace};
use crate::ir::{Module, Nc, NcItem, Stmt, StmtKind, Stmts};
use crate::legalize::Context;
use crate::legalize::features::Features;

/// True in a library that an earlier conversion wrote for a control with such blocks, and that does not drill.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    context.earlier.is_written() && parts(context.source) && !features.any_op(Op::is_cycle)
}

fn parts(control: &Control) -> bool {
    control.form(OperandPlace::Word).is_some_and(|form| !form.mixed)
}

/// Puts them together; true if there were any.
pub fn run(module: &mut Module, _: &mut Context<'_>) -> bool {
    let mut changed = false;
    for block in module.programs.iter_mut().flat_map(|program| &mut program.blocks) {
        let found = block.stmts.windows(2).any(|two| fits(&two[0], &two[1]));
        if !found {
            continue;
        }
        changed = true;
        let mut out = Stmts::with_capacity(block.stmts.len());
        for stmt in std::mem::take(&mut block.stmts) {
            match out.last_mut() {
                Some(last) if fits(last, &stmt) => join(last, stmt),
                _ => out.push(stmt),
            }
        }
        block.stmts = out;
    }
    changed
}

/// True for codes, and their move after them.
fn fits(codes: &Stmt, words: &Stmt) -> bool {
    let (Some(first), Some(second)) = (codes.kind.nc(), words.kind.nc()) else { return false };
    let always = codes.site.skip.is_none() && words.site.skip.is_none();
    always && !first.items.is_empty() && first.items.iter().all(is_setting) && is_place(second)
}

fn is_setting(item: &NcItem) -> bool {
    match item {
        NcItem::Op(op) => {
            matches!(op, Op::Rapid | Op::Linear | Op::ArcCw | Op::ArcCcw) || op.group() == Group::Distance
        }
        NcItem::Word(Role::Feed, value) => value.constant().is_some(),
        _ => false,
    }
}

fn is_place(nc: &Nc) -> bool {
    let words = |item: &NcItem| {
        let centre = [Role::ArcI, Role::ArcJ, Role::ArcK, Role::ArcRadius];
        matches!(item, NcItem::Word(role, _) if role.is_axis() || centre.contains(role))
    };
    let by_variable = |item: &NcItem| matches!(item, NcItem::Word(_, value) if value.constant().is_none());
    nc.moves() && nc.items.iter().all(words) && nc.items.iter().any(by_variable)
}

/// Puts the words of a move after its codes.
fn join(codes: &mut Stmt, words: Stmt) {
    let (StmtKind::Nc(first), StmtKind::Nc(second)) = (&mut codes.kind, words.kind) else { return };
    first.items.extend(second.items);
    codes.site.comments.extend(words.site.comments);
}
