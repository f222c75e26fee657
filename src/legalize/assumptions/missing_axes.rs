//! Words of axes that the target does not have.
//!
//! Nothing is changed. The profile of the target lists its axes (`axes`); a word of another one is an alarm there, or moves something else. So it is
//! refused, once for each axis of a program. Side conditions: a profile without the list says nothing; increments of an axis are
//! words of that axis, whatever their letter; Y on the face of a lathe (polar interpolation) is no axis. Counter-example: `W-5.` of a lathe, which moves its Z.

use crate::canon::{Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Axis, Control};
use crate::ir::{Module, NcItem, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::Features;

/// True if the target's profile lists its axes, and programs name another.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let lists = context.target.profile().axes.is_some();
    lists
        && Axis::ALL
            .iter()
            .any(|axis| lacks(context.target, *axis) && of(*axis).any(|role| features.role(role)))
}

/// Tells of the first word of each such axis in each program.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let missing: Vec<Axis> = Axis::ALL.iter().copied().filter(|axis| lacks(context.target, *axis)).collect();
    let list: Vec<String> =
        context.target.profile().axes.iter().flatten().map(|axis| format!("{axis:?}")).collect();
    for (index, program) in module.programs.iter().enumerate() {
        let mut on_face = false;
        for stmt in program.blocks.iter().flat_map(|block| &block.stmts) {
            let StmtKind::Nc(nc) = &stmt.kind else { continue };
            on_face = nc.has(Op::PolarPlane) || on_face && !nc.has(Op::PolarPlaneOff);
            for item in &nc.items {
                let NcItem::Word(role, _) = item else { continue };
                if on_face && *role == Role::Y {
                    continue;
                }
                let Some(axis) = missing.iter().find(|axis| of(**axis).any(|its| its == *role)) else {
                    continue;
                };
                let what = format!(
                    "this moves the axis {axis:?}, or says where it is, and the target has the axes {} by its profile",
                    list.join(", ")
                );
                let help = format!(
                    "if the machine has the axis, put \"{axis:?}\" into 'axes' of its profile; if not, leave its words out of the programs, or write \
                     what another axis does in their place"
                );
                let finding = Diagnostic::new(Code::NoEquivalent, stmt.site.span, what).with_help(help);
                context.add_once(index, &format!("axis {axis:?}"), finding);
            }
        }
    }
}

/// True if the profile lists the axes, and this is none of them.
fn lacks(control: &Control, axis: Axis) -> bool {
    control.profile().axes.as_ref().is_some_and(|axes| !axes.contains(&axis))
}

/// The words of an axis.
fn of(axis: Axis) -> impl Iterator<Item = Role> {
    let number = Some(axis.number());
    let all = [Role::X, Role::Y, Role::Z, Role::A, Role::B, Role::C, Role::U, Role::V, Role::W];
    let steps = Role::STEPS.into_iter().map(|(_, step)| step);
    all.into_iter().chain(steps).filter(move |role| role.axis_number() == number)
}
