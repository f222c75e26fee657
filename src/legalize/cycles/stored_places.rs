//! Places beside a repeat count of 0, in the block that begins a drilling cycle.
//!
//! Law: on a control that goes to such a place and drills nothing, a rapid to the place, then the cycle without it, does the same;
//! the cycle is only stored. So nothing rests on what another control does with the place. Side conditions: rapid is in force and no
//! cycle is, the plane is known, no macro runs after moves, and the block has no codes but those of the cycle and of how its words
//! count. Counter-example: `X45. L0` while a cycle is in force, which would have to end and begin again.

use crate::canon::{Group, Op, Role};
use crate::dialect::{Control, Question};
use crate::ir::{BlockId, Expr, Module, Nc, NcItem, SourceInfo, Stmt, StmtKind, Stmts};
use crate::legalize::features::Features;
use crate::legalize::{Context, Modal};

/// True where the source is known to go there, the target is not, and there are repeats.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let goes = |control: &Control| control.is(Question::CycleL0Moves);
    features.role(Role::Repeat) && goes(context.source) && !goes(context.target)
}

/// Goes to the places before the cycles; true where there was one.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let facts = context.modal_facts(module);
    let mut changed = false;
    for (index, program) in module.programs.iter_mut().enumerate() {
        for (at, block) in program.blocks.iter_mut().enumerate() {
            if !block.stmts.iter().any(|stmt| stmt.kind.nc().is_some_and(stores)) {
                continue;
            }
            let mut state = facts.at(index, BlockId(at as u32));
            let mut out = Stmts::with_capacity(block.stmts.len() + 1);
            for mut stmt in std::mem::take(&mut block.stmts) {
                if let Some(to) = place(&mut stmt, &state) {
                    // The number of the block is that of its first part.
                    let sequence = std::mem::take(&mut stmt.site.sequence);
                    let site = SourceInfo { span: stmt.site.span, sequence, ..SourceInfo::default() };
                    out.push(Stmt { kind: StmtKind::Nc(to), site });
                    changed = true;
                }
                state.step(&stmt);
                out.push(stmt);
            }
            block.stmts = out;
        }
    }
    changed
}

/// True for a block that begins a cycle and drills nothing.
fn stores(nc: &Nc) -> bool {
    nc.ops().any(Op::is_cycle) && nc.word(Role::Repeat).and_then(Expr::constant) == Some(0.0)
}

/// Takes the place out of such a block; the move to it, where the side conditions hold.
fn place(stmt: &mut Stmt, before: &Modal) -> Option<Nc> {
    let known = before.op(Group::Motion) == Some(Op::Rapid)
        && before.op(Group::Cycle) == Some(Op::CycleOff)
        && before.op(Group::Plane) == Some(Op::PlaneXy)
        && !before.may_call();
    let StmtKind::Nc(nc) = &mut stmt.kind else { return None };
    let counts = |op: Op| op.group() == Group::Distance;
    let plain = nc.ops().all(|op| op.is_cycle() || counts(op) || op.group() == Group::ReturnPlane)
        && !nc.items.iter().any(|item| matches!(item, NcItem::Code(..)));
    if !known || !plain || stmt.site.skip.is_some() || !stores(nc) {
        return None;
    }
    let goes = |item: &NcItem| match item {
        NcItem::Op(op) => counts(*op),
        NcItem::Word(role, _) => role.is_axis() && *role != Role::Z,
        NcItem::Code(..) => false,
    };
    if !nc.items.iter().any(|item| matches!(item, NcItem::Word(..)) && goes(item)) {
        return None;
    }
    let (to, rest) = std::mem::take(&mut nc.items).into_iter().partition::<Vec<_>, _>(goes);
    nc.items = rest;
    Some(Nc { items: std::iter::once(NcItem::Op(Op::Rapid)).chain(to).collect() })
}
