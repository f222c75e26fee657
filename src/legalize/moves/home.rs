//! The return to the reference position, where the target has no code for it.
//!
//! Law: a return is a rapid move to its point, if that is not where the tool stands, and one to the reference position in
//! machine coordinates. Side conditions: the reference position is the zero of the machine's coordinates, which a person
//! must confirm; absolute or incremental is known, and restored, as the interpolation is. Rotary axes are left alone, and
//! refused. An axis whose word may be vacant is refused too: the return leaves it where it is. Counter-example: a machine whose reference position was set elsewhere.

use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Control;
use crate::ir::analysis::{Summaries, Vacancy};
use crate::ir::{BlockId, Expr, Module, Nc, NcItem, SourceInfo, Stmt, StmtKind};
use crate::legalize::features::Features;
use crate::legalize::{Context, Modal, replace_statements};
use crate::text::Span;
use std::collections::{BTreeMap, BTreeSet};

/// True if the target has machine coordinates and no return.
pub fn concerns(target: &Control) -> bool {
    let has = |op| target.code_for(op, &BTreeMap::new()).is_some();
    !has(Op::ReferenceReturn) && (has(Op::ShiftCancel) || has(Op::MachineOnce))
}

const ZERO: &str =
    "the reference position is taken to be the zero of the machine's coordinates: check it on both machines";
const UNKNOWN: &str = "a return to the reference position where it is not known whether G90 or G91 is in force: write one before it";
const MOTION: &str = "which interpolation is in force before this return is not known: the target is in rapid traverse after it";

pub(super) const VACANT: &str = "this return leaves out an axis whose value is vacant, and the target's move would take it along: write a return for \
                      each case, after an IF";

/// Writes returns as moves.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let facts = context.modal_facts(module);
    let unsure = unsure(module, context, Op::ReferenceReturn);
    replace_statements(module, &facts, |index, state, stmt, out| {
        let before = state.clone();
        state.step(&stmt);
        let moves = match &stmt.kind {
            StmtKind::Nc(nc) if nc.has(Op::ReferenceReturn) && nc.names_axis() => moves(nc, &before, state),
            _ => return out.push(stmt),
        };
        let span = stmt.site.span;
        if unsure.contains(&(index, span)) {
            context.add(index, Diagnostic::new(Code::NoEquivalent, span, VACANT));
            return out.push(stmt);
        }
        let Some(moves) = moves else {
            context.add_once(index, UNKNOWN, Diagnostic::new(Code::NoEquivalent, span, UNKNOWN));
            return out.push(stmt);
        };
        context.add_once(index, ZERO, Diagnostic::new(Code::Conditional, span, ZERO).asked_once());
        if before.op(Group::Motion).is_none() && state.op(Group::Motion).is_none() {
            context.add_once(index, MOTION, Diagnostic::new(Code::Conditional, span, MOTION));
        }
        let skip = stmt.site.skip;
        let mut site = Some(stmt.site);
        for items in moves {
            let site = site.take().unwrap_or_else(|| SourceInfo { span, skip, ..SourceInfo::default() });
            out.push(Stmt { kind: StmtKind::Nc(Nc { items }), site });
        }
    });
}

/// The returns by this code with a word of an axis that may not be there, by program.
pub(super) fn unsure(module: &Module, context: &mut Context<'_>, code: Op) -> BTreeSet<(usize, Span)> {
    absent(module, &context.summaries(module), code)
}

/// The same by what calls of the library assign.
pub(super) fn absent(module: &Module, summaries: &Summaries, code: Op) -> BTreeSet<(usize, Span)> {
    let mut found = BTreeSet::new();
    for (index, program) in module.programs.iter().enumerate() {
        if !Features::of_program(program).op(code) {
            continue;
        }
        let vacancy = Vacancy::of(program, summaries, &BTreeSet::new());
        let absent = vacancy.absent(&|nc, role| nc.has(code) && role.is_axis());
        let stmt = |(id, at): (BlockId, usize)| program.block(id)?.stmts.get(at);
        found.extend(absent.into_iter().filter_map(stmt).map(|stmt| (index, stmt.site.span)));
    }
    found
}

/// The blocks that stand for a return; none where the distance mode is not known.
fn moves(nc: &Nc, before: &Modal, after: &Modal) -> Option<Vec<Vec<NcItem>>> {
    let distance = after.op(Group::Distance)?;
    let axis = |item: &NcItem| matches!(item, NcItem::Word(role, _) if role.is_axis());
    let (axes, rest): (Vec<NcItem>, Vec<NcItem>) =
        nc.items.iter().filter(|item| **item != NcItem::Op(Op::ReferenceReturn)).cloned().partition(axis);
    let here = |item: &NcItem| matches!(item, NcItem::Word(_, value) if value.constant() == Some(0.0));
    let stays = distance == Op::Incremental && axes.iter().all(here);
    let mut out = Vec::new();
    let mode = |item: &NcItem| matches!(item, NcItem::Op(Op::Absolute | Op::Incremental));
    if stays {
        let rest: Vec<NcItem> = rest.into_iter().filter(|item| !mode(item)).collect();
        out.extend(Some(rest).filter(|rest| !rest.is_empty()));
    } else {
        let mut first = rest;
        first.retain(|item| !matches!(item, NcItem::Op(op) if op.group() == Group::Motion));
        first.push(NcItem::Op(Op::Rapid));
        first.extend(axes.iter().cloned());
        out.push(first);
    }
    let roles = axes.iter().filter_map(|item| match item {
        NcItem::Word(role, _) => Some(*role),
        _ => None,
    });
    let zero = |role: Role| NcItem::Word(role, Expr::Number(0.0));
    let home = [Op::Absolute, Op::Rapid, Op::MachineOnce].map(NcItem::Op);
    out.push(home.into_iter().chain(roles.map(zero)).collect());
    let motion = after.op(Group::Motion).or(before.op(Group::Motion));
    let mut again = Vec::new();
    again.extend((distance == Op::Incremental).then_some(NcItem::Op(distance)));
    again.extend(motion.filter(|op| *op != Op::Rapid).map(NcItem::Op));
    out.extend(Some(again).filter(|again| !again.is_empty()));
    Some(out)
}
