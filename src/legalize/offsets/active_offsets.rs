//! Work offsets that a program writes while they may be selected.
//!
//! Law: a table row that is written before it is selected counts the same on every control. One that is selected
//! already may count at once, from the next block, or when it is selected again: where a program goes to a place of the part before it
//! selects one, each control that is not known is asked, and a program is refused where the two are known to differ.
//! Side conditions: what is selected is known from the text; an increment goes the same way under every offset. Counter-example:
//! `G54`, `#5221=#5221+5.`, `G90 G0 X0.`.

use crate::canon::{Group, Op, Role, Sys};
use crate::dialect::Question;
use crate::ir::{Expr, Module, Nc, Place, Stmt, StmtKind};
use crate::legalize::each_step::each_step;
use crate::legalize::features::{Feature, Features};
use crate::legalize::{Context, Modal, Setting};

const FACT: Question = Question::OffsetActiveImmediately;

/// True if the library writes work offsets.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    (features.has(Feature::System) || features.op(Op::WriteWork))
        && !context.source.is_same_machine(context.target)
}

/// Says what rests on the controls.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let stmts = || module.programs.iter().flat_map(|p| &p.blocks).flat_map(|b| &b.stmts);
    if !stmts().any(|stmt| row(&stmt.kind).is_some()) {
        return;
    }
    let facts = context.modal_facts(module);
    each_step(module, &facts, step, |index, stmt, (_, rests)| {
        if rests {
            context.rests_on_source(index, stmt.site.span, FACT);
            context.rests_on_target(index, stmt.site.span, FACT);
            context.must_agree(index, stmt.site.span, FACT);
        }
    });
}

/// Takes a statement; true where it rests on when the offset counts. `stale` is true where the offset in force was written since it
/// was selected, on some way.
fn step(stmt: &Stmt, state: &mut Modal, stale: &mut bool) -> bool {
    let before = *stale;
    if let Some(written) = row(&stmt.kind) {
        *stale |= match state.of(Group::WorkOffset) {
            Setting::Known(Op::ShiftCancel, _) => false,
            Setting::Known(Op::SelectWork, Some(selected)) => {
                written.is_none_or(|row| row == f64::from(selected))
            }
            _ => true,
        };
    }
    state.step(stmt);
    let reads = before && reads_position(&stmt.kind);
    let Some(nc) = stmt.kind.nc() else { return reads };
    *stale &= !nc.ops().any(|op| op.group() == Group::WorkOffset);
    let rests = *stale && goes(nc, state);
    // A block that may be skipped leaves what was.
    if stmt.site.skip.is_some() {
        *stale |= before;
    }
    rests || reads
}

/// True for a place of the part.
fn goes(nc: &Nc, after: &Modal) -> bool {
    let elsewhere = [Op::MachineOnce, Op::WriteWork, Op::LocalShift];
    nc.names_axis()
        && !nc.ops().any(|op| elsewhere.contains(&op))
        && after.op(Group::Distance) != Some(Op::Incremental)
}

/// True for a statement that reads where the tool is on the part.
fn reads_position(kind: &StmtKind) -> bool {
    let mut reads = false;
    kind.exprs(&mut |expr| {
        expr.walk(&mut |inner| {
            reads |=
                matches!(inner, Expr::System(Sys::WorkPosition | Sys::EndPosition | Sys::AxisPosition, _));
        });
    });
    reads
}

/// The row of the work offset that a statement writes, the number where it is constant. Row 0 of a code is the shift of all of
/// them.
fn row(kind: &StmtKind) -> Option<Option<f64>> {
    match kind {
        StmtKind::Assign { target: Place::System(Sys::WorkOffset, subscripts), .. } => {
            Some(subscripts.first().and_then(Expr::constant))
        }
        StmtKind::Nc(nc) if nc.has(Op::WriteWork) => {
            Some(nc.word(Role::OffsetRow).and_then(Expr::constant).filter(|row| *row != 0.0))
        }
        _ => None,
    }
}
