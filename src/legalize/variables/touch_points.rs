//! The place where the probe touched, on a control that keeps such places by number.
//!
//! Law: where each probe move keeps its place as point 1, point 1 is where the last one touched. The target probes with the
//! feed code in its block or in force, so it is said there, and the rapid code that was in force is said again after it. Side
//! conditions, for a reviewer: the probe touches. Counter-example: `G31 X50.` into the air, after which `PX1` is .1E9 and
//! `#5061` is 50.

use crate::canon::{Group, Op, Role, Sys};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Control;
use crate::ir::{Expr, Module, Nc, NcItem, SourceInfo, Stmt, StmtKind};
use crate::legalize::features::Features;
use crate::legalize::{Context, replace_statements, rewrite_program};

/// The point that probe moves keep their place as.
const POINT: f64 = 1.0;

/// True if there are probe moves, and the target alone keeps their places by number.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    features.op(Op::Probe)
        && !features.role(Role::ProbePoint)
        && by_number(context.target)
        && !by_number(context.source)
}

fn by_number(control: &Control) -> bool {
    control.system_run(Sys::ProbePoint).is_some() && control.system_run(Sys::SkipPosition).is_none()
}

/// Keeps places as point 1, and reads them there.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let facts = context.modal_facts(module);
    let rapid = || StmtKind::Nc(Nc { items: vec![NcItem::Op(Op::Rapid)] });
    let mut said_again = false;
    replace_statements(module, &facts, |index, state, mut stmt, out| {
        let before = state.op(Group::Motion);
        // Who names the motion next needs no code said again.
        let names = stmt.kind.nc().is_some_and(|nc| nc.ops().any(|op| op.group() == Group::Motion));
        let last = out.last().is_some_and(|last| last.kind == rapid());
        if std::mem::take(&mut said_again) && last && names && stmt.site.skip.is_none() {
            out.pop();
        }
        state.step(&stmt);
        let site = SourceInfo { span: stmt.site.span, skip: stmt.site.skip, ..SourceInfo::default() };
        let probes = stmt.kind.nc().is_some_and(|nc| nc.has(Op::Probe));
        if let StmtKind::Nc(nc) = &mut stmt.kind
            && probes
        {
            nc.items.push(NcItem::Word(Role::ProbePoint, Expr::Number(POINT)));
            if before != Some(Op::Linear) && !nc.has(Op::Linear) {
                nc.items.insert(0, NcItem::Op(Op::Linear));
            }
        }
        out.push(stmt);
        match before.filter(|_| probes) {
            Some(Op::Rapid) => {
                out.push(Stmt { kind: rapid(), site });
                said_again = true;
            }
            Some(Op::Linear) => {}
            _ if !probes => {}
            None => {
                let what = "G1 stays in force after this probe move, and what was in force before is not known: write the code \
                            of the next move";
                context.add_once(index, what, Diagnostic::new(Code::Conditional, site.span, what));
            }
            Some(_) => {
                let what = "a probe move under an arc code: write G0 or G1 before it";
                context.add(index, Diagnostic::new(Code::NoEquivalent, site.span, what));
            }
        }
    });
    for (index, program) in module.programs.iter_mut().enumerate() {
        let mut read = None;
        rewrite_program(
            program,
            |e| matches!(e, Expr::System(Sys::SkipPosition, _)),
            &mut |e, _, rewriter| {
                let Expr::System(_, mut subscripts) = e else { return e };
                read.get_or_insert(rewriter.span);
                subscripts.push(Expr::Number(POINT));
                Expr::System(Sys::ProbePoint, subscripts)
            },
        );
        if let Some(span) = read {
            let what = "the place where the probe touched is read: each probe move must touch, for otherwise X is .1E9 on the \
                        target, and the end of the move on the source";
            context.add_once(index, what, Diagnostic::new(Code::Conditional, span, what));
        }
    }
}
