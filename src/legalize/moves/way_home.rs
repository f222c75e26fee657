//! Z0 without a tool length, which is the way home on machines whose lengths are measured from there.
//!
//! Law: where the profile of the source says so (`length.off.zero`), a rapid move to Z0 with no length in force becomes a move to
//! Z0 in machine coordinates. Z of each work offset is 0 there. Where nobody says what it is, it is asked. Codes that only set what
//! is in force go into a block before it. Side conditions: no other axis in the block, absolute coordinates, no shift of Z beside its
//! offset, no cutter radius that ends here; else a person has to look.
//! Counter-example: `G0 G49 Z0` on a machine whose lengths are gauge lengths, which takes the nose of the spindle to the part.

use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Question, Side};
use crate::ir::analysis::behind::behind;
use crate::ir::analysis::modal_facts::replace_statements;
use crate::ir::{Expr, Module, Nc, NcItem, SourceInfo, Stmt, StmtKind, TermKind};
use crate::legalize::assumptions::shop::are_mills;
use crate::legalize::features::Features;
use crate::legalize::moves::mains::{facts_from_reset, facts_of_mains, mains, returns};
use crate::legalize::{Context, Modal};
use crate::text::Span;
use std::collections::BTreeSet;

const QUESTION: Question = Question::LengthOffZero;

/// True for mills whose programs use tool lengths and cancel them.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let lengths = features.op(Op::LengthPlus) || features.op(Op::LengthMinus);
    let answer = context.source.behaviour(QUESTION).map(|row| row.value.clone());
    are_mills(context)
        && lengths
        && features.op(Op::LengthOff)
        && answer.as_deref() != Some("offset")
        && !context.source.is_same_machine(context.target)
}

const BESIDE: &str = "Z0 without a tool length is home on the old machine, and something else stands in the block: write G53 Z0 into a \
                      block of its own before it";
const SHIFTED: &str = "Z0 without a tool length is home on the old machine, and Z may be shifted, scaled or mirrored here: write G53 Z0 in \
                       its place, or end the shift before it";

/// Writes the moves, or asks.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let mut changed = false;
    let facts = context.modal_facts(module);
    let home = context.source.behaviour(QUESTION).is_some_and(|row| row.value == "home");
    let (anywhere, shaped) = shifts(module);
    let uncompensated = uncompensated(module, context);
    replace_statements(module, &facts, |index, state, mut stmt, out| {
        state.step(&stmt);
        let place = (index, stmt.site.span);
        if let StmtKind::Nc(nc) = &mut stmt.kind
            && goes_home(nc, state)
        {
            let span = stmt.site.span;
            let ends_none = uncompensated.contains(&place);
            if !home {
                context.unconfirmed(index, Side::Source, span, QUESTION.fact(), QUESTION.meaning());
            } else if anywhere || shaped.contains(&place) {
                context.add(index, Diagnostic::new(Code::Conditional, span, SHIFTED));
            } else if is_plain(nc) {
                let at = nc.items.iter().position(|item| matches!(item, NcItem::Word(..))).unwrap_or(0);
                nc.items.insert(at, NcItem::Op(Op::MachineOnce));
                changed = true;
            } else if let Some(codes) = ends_none.then(|| split(nc)).flatten() {
                let site = SourceInfo { span, skip: stmt.site.skip, ..SourceInfo::default() };
                let before = std::mem::replace(&mut stmt.site, site);
                out.push(Stmt { kind: StmtKind::Nc(codes), site: before });
                changed = true;
            } else {
                context.add(index, Diagnostic::new(Code::Conditional, span, BESIDE));
            }
        }
        out.push(stmt);
    });
    changed
}

/// True where some program shifts Z beside its offset, or leaves it scaled or mirrored at its end; and the places that may come while
/// it is scaled or mirrored.
fn shifts(module: &Module) -> (bool, BTreeSet<(usize, Span)>) {
    let along_z = |nc: &Nc| {
        let axes = || nc.items.iter().filter(|item| matches!(item, NcItem::Word(role, _) if role.is_axis()));
        nc.word(Role::Z).is_some() || axes().next().is_none()
    };
    let sets = |stmt: &Stmt| {
        stmt.kind.nc().is_some_and(|nc| nc.has(Op::ScaleOn) || nc.has(Op::MirrorOn) && along_z(nc))
    };
    // One that names an axis may leave the others.
    let ends = |stmt: &Stmt| {
        let bare = |nc: &Nc| !nc.items.iter().any(|item| matches!(item, NcItem::Word(..)));
        let all = |nc: &Nc| nc.has(Op::MirrorOff) && bare(nc);
        stmt.site.skip.is_none() && stmt.kind.nc().is_some_and(all)
    };
    let mut shaped = BTreeSet::new();
    behind(module, sets, ends, |index, stmt| {
        shaped.insert((index, stmt.site.span));
    });
    let mut anywhere = false;
    for (index, program) in module.programs.iter().enumerate() {
        let mut stmts = program.blocks.iter().flat_map(|block| &block.stmts);
        anywhere |= stmts.any(|stmt| {
            let shifts = |nc: &Nc| (nc.has(Op::SetPosition) || nc.has(Op::LocalShift)) && along_z(nc);
            stmt.kind.nc().is_some_and(shifts)
        });
        let sets_any = program.blocks.iter().flat_map(|block| &block.stmts).any(sets);
        anywhere |= program.blocks.iter().any(|block| {
            let ends_so = matches!(block.term.kind, TermKind::End { .. } | TermKind::Stray);
            ends_so
                && block.stmts.last().map_or(sets_any, |last| {
                    sets(last) || shaped.contains(&(index, last.site.span)) && !ends(last)
                })
        });
    }
    (anywhere, shaped)
}

/// The blocks before which no cutter radius is in force: none is after a reset.
fn uncompensated(module: &Module, context: &Context<'_>) -> BTreeSet<(usize, Span)> {
    let called = context.called(module);
    let mains: BTreeSet<usize> = mains(module, &called).into_iter().collect();
    let (from_reset, of_mains) = (facts_from_reset(module, context), facts_of_mains(module, context));
    let mut found = BTreeSet::new();
    for (index, program) in module.programs.iter().enumerate() {
        // What comes back from a call in a main program it gave itself, whoever else calls that.
        let is_main = mains.contains(&index) && !called.is_known(index) && !returns(program);
        let facts = if is_main { &of_mains } else { &from_reset };
        for (id, block) in program.ids().zip(&program.blocks) {
            let mut state = facts.at(index, id);
            for stmt in &block.stmts {
                if state.op(Group::RadiusComp) == Some(Op::RadiusOff) {
                    found.insert((index, stmt.site.span));
                }
                state.step(stmt);
            }
        }
    }
    found
}

/// Leaves the move, as one in machine coordinates, with what acts beside it; gives the codes that only set what is in force. None if
/// something else stands there.
fn split(nc: &mut Nc) -> Option<Nc> {
    use Group::{FeedMode, Plane, RadiusComp, ReturnPlane, Spindle, WorkOffset};
    let sets = |item: &NcItem| match item {
        NcItem::Op(op) => {
            let modal = [RadiusComp, Plane, FeedMode, WorkOffset, ReturnPlane].contains(&op.group());
            modal && *op != Op::RadiusLeft && *op != Op::RadiusRight
                || matches!(op, Op::Rapid | Op::LengthOff | Op::Absolute | Op::CycleOff)
        }
        NcItem::Word(role, _) => {
            matches!(role, Role::LengthOffset | Role::RadiusOffset | Role::WorkOffset)
        }
        NcItem::Code(..) => false,
    };
    let stays = |item: &NcItem| match item {
        NcItem::Op(op) => matches!(op.group(), Spindle | Group::Coolant),
        NcItem::Word(role, _) => matches!(role, Role::Z | Role::Speed),
        NcItem::Code(..) => false,
    };
    if !nc.items.iter().all(|item| sets(item) || stays(item)) {
        return None;
    }
    let (codes, mut left): (Vec<NcItem>, Vec<NcItem>) = nc.items.drain(..).partition(sets);
    left.insert(0, NcItem::Op(Op::MachineOnce));
    nc.items.extend(left);
    Some(Nc { items: codes.into_iter().collect() })
}

/// True for a rapid move to Z0 in a work offset, with no length in force.
fn goes_home(nc: &Nc, state: &Modal) -> bool {
    nc.word(Role::Z).and_then(Expr::constant) == Some(0.0)
        && state.op(Group::LengthComp) == Some(Op::LengthOff)
        && state.op(Group::Motion) == Some(Op::Rapid)
        && state.op(Group::Distance) != Some(Op::Incremental)
        && state.op(Group::WorkOffset) != Some(Op::ShiftCancel)
        && !nc.has(Op::MachineOnce)
        && !nc.ops().any(|op| op.takes_axes() || op.is_return() || op.is_cycle())
}

/// True for a block that may become one in machine coordinates.
fn is_plain(nc: &Nc) -> bool {
    nc.items.iter().all(|item| match item {
        NcItem::Op(op) => {
            matches!(op, Op::Rapid | Op::LengthOff | Op::Absolute | Op::CycleOff)
                || matches!(op.group(), Group::Spindle | Group::Coolant)
        }
        NcItem::Word(role, _) => {
            matches!(role, Role::Z | Role::LengthOffset | Role::RadiusOffset | Role::Speed)
        }
        NcItem::Code(..) => false,
    })
}
