//! Probe moves in increments, for a target that takes them for a fault.
//!
//! Law: a move by an increment ends at the present place and the increment. So each axis of the block goes to a place that is
//! worked out before it, under G90, and G91 comes back after it. Side conditions: G91 is in force for certain; the block has
//! the probe move, words of linear axes and its feed alone; no block skip, no modal call, no cutter compensation; nothing turns, mirrors or shifts the
//! coordinates of the library, for then the place that the target shows may be another one. Along the axis of the tool
//! the target must show the place of the tip.
//! Counter-example: `G68 R45.` before it, under which X alone moves both axes.

use crate::canon::{Group, Op, Role, Sys};
use crate::dialect::Control;
use crate::ir::analysis::modal_facts::replace_statements;
use crate::ir::{BinOp, Class, Expr, Module, Nc, NcItem, Place, SourceInfo, Stmt, StmtKind, Var};
use crate::legalize::assumptions::shop::are_mills;
use crate::legalize::features::{Feature, Features};
use crate::legalize::offsets::position_length::FACT;
use crate::legalize::rewrite::highest_temp;
use crate::legalize::{Context, Modal};

/// True if the library probes in increments, and the target does not.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let turned = |op| {
        matches!(
            op,
            Op::RotateOn | Op::ScaleOn | Op::MirrorOn | Op::LocalShift | Op::SetPosition | Op::PolarOn
        )
    };
    are_mills(context)
        && features.op(Op::Probe)
        && features.op(Op::Incremental)
        && !features.has(Feature::Modal)
        && !features.any_op(turned)
        && context.target.forbids(Op::Probe, |op| op == Op::Incremental).is_some()
}

/// Gives them places.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let facts = context.modal_facts(module);
    let mut temps: Vec<u32> = module.programs.iter().map(highest_temp).collect();
    let tip = shows_tip(context.target);
    replace_statements(module, &facts, |index, state, stmt, out| {
        state.step(&stmt);
        let probes = stmt.kind.nc().is_some_and(|nc| stmt.site.skip.is_none() && is_probed(nc, state, tip));
        let (StmtKind::Nc(nc), true) = (&stmt.kind, probes) else { return out.push(stmt) };
        let span = stmt.site.span;
        let aside = || SourceInfo { span, ..SourceInfo::default() };
        let mut items = vec![NcItem::Op(Op::Absolute)];
        for item in &nc.items {
            items.push(match item {
                NcItem::Op(Op::Incremental) => continue,
                NcItem::Word(role, value) if let Some(axis) = axis_of(*role) => {
                    if *role == Role::Z {
                        context.rests_on_target(index, span, FACT);
                    }
                    temps[index] += 1;
                    let temp = Var { class: Class::Temp, number: temps[index] };
                    let here = Expr::System(Sys::WorkPosition, [Expr::Number(axis)].into());
                    let value = Expr::binary(BinOp::Add, here, value.clone());
                    let kind = StmtKind::Assign { target: Place::Var(temp), value };
                    out.push(Stmt { kind, site: aside() });
                    NcItem::Word(*role, Expr::Var(temp))
                }
                other => other.clone(),
            });
        }
        out.push(Stmt { kind: StmtKind::Nc(Nc { items }), site: stmt.site });
        let after = Nc { items: vec![NcItem::Op(Op::Incremental)] };
        out.push(Stmt { kind: StmtKind::Nc(after), site: aside() });
    });
}

/// True where the place along the tool's axis that a control shows is that of the tip.
fn shows_tip(control: &Control) -> bool {
    control.behaviour(FACT).is_some_and(|row| row.value == "left.out")
}

fn axis_of(role: Role) -> Option<f64> {
    let linear = matches!(role, Role::X | Role::Y | Role::Z);
    role.axis_number().filter(|_| linear).map(f64::from)
}

/// True for a probe move under G91 that keeps the side conditions.
fn is_probed(nc: &Nc, state: &Modal, tip: bool) -> bool {
    let own = |item: &NcItem| match item {
        NcItem::Op(op) => matches!(op, Op::Probe | Op::Incremental | Op::Linear),
        NcItem::Word(Role::Feed | Role::ProbePoint, _) => true,
        NcItem::Word(role, value) => {
            axis_of(*role).is_some() && !value.may_be_vacant() && (*role != Role::Z || tip)
        }
        NcItem::Code(..) => false,
    };
    let once =
        |role| nc.items.iter().filter(|item| matches!(item, NcItem::Word(r, _) if *r == role)).count() <= 1;
    let beside = matches!(state.op(Group::RadiusComp), Some(Op::RadiusLeft | Op::RadiusRight));
    nc.has(Op::Probe)
        && !beside
        && state.op(Group::Distance) == Some(Op::Incremental)
        && nc.items.iter().all(own)
        && [Role::X, Role::Y, Role::Z].into_iter().all(once)
}
