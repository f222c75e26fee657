//! The code that makes taps rigid, for a target whose taps always are.

use crate::canon::{Group, Op, Role};
use crate::dialect::Control;
use crate::ir::{Block, NcItem, Stmt, StmtKind};
use crate::text::Span;
use std::collections::{BTreeMap, BTreeSet};

/// Takes away what makes taps rigid, for a target whose taps always are; the speed beside it stays, unless it is said `again`.
pub(super) fn drop_rigid(stmt: &mut Stmt, target: &Control, again: Option<f64>) {
    if !stmt.kind.has_op(Op::RigidTaps) || target.code_for(Op::RigidTaps, &BTreeMap::new()).is_some() {
        return;
    }
    let StmtKind::Nc(nc) = &mut stmt.kind else { return };
    nc.items.retain(|item| match item {
        NcItem::Word(Role::Speed, speed) => again.is_none() || speed.constant() != again,
        item => *item != NcItem::Op(Op::RigidTaps),
    });
    if nc.items.is_empty() {
        stmt.kind = StmtKind::Comment;
    }
}

/// Whether taps are rigid after a statement, by a code that gives their speed: until the cycle ends. Moves beside a hole, in the
/// blocks that are `drilling`, end none.
pub(super) fn rigid_after(before: bool, stmt: &Stmt, drilling: &BTreeSet<Span>) -> bool {
    let Some(nc) = stmt.kind.nc() else { return before && !matches!(stmt.kind, StmtKind::ModalCall(_)) };
    if nc.has(Op::RigidTaps) {
        return stmt.site.skip.is_none() && nc.word(Role::Speed).is_some();
    }
    let beside = drilling.contains(&stmt.site.span);
    let ends =
        |op: Op| op == Op::CycleOff || !beside && op.group() == Group::Motion || op.is_hole() && !op.is_tap();
    before && !nc.ops().any(ends)
}

/// The blocks of the source that a hole comes from.
pub(super) fn drilling(block: &Block) -> BTreeSet<Span> {
    let drills = |stmt: &&Stmt| stmt.kind.nc().is_some_and(|nc| nc.ops().any(Op::is_hole));
    block.stmts.iter().filter(drills).map(|stmt| stmt.site.span).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ir::text::parse;

    #[test]
    fn taps_stay_rigid_until_their_cycle_ends() {
        let after = |text: &str| {
            let program = format!("program O1 file 0 {{\nblock0:\n{text}    end\n}}\n");
            let module = parse(&program).unwrap();
            let block = &module.programs[0].blocks[0];
            let drilling = drilling(block);
            block.stmts.iter().fold(false, |rigid, stmt| rigid_after(rigid, stmt, &drilling))
        };
        let begun = "    nc tap.rigid speed=500 @1..2\n";
        let tap = "    nc motion.rapid axis.c=60 @3..4\n    nc hole.face.tap axis.z=-5 @3..4\n";
        assert!(after(begun));
        assert!(after(&format!("{begun}{tap}{tap}")), "moves beside a hole are the hole's");
        assert!(!after(&format!("{begun}{tap}    nc cycle.off @5..6\n")));
        assert!(!after(&format!("{begun}{tap}    nc motion.rapid axis.x=1 @5..6\n")));
        assert!(!after(&format!("{begun}    nc hole.face axis.z=-5 @3..4\n")));
        assert!(!after("    nc tap.rigid @1..2\n"), "the speed is not said");
        assert!(!after(tap));
    }
}
