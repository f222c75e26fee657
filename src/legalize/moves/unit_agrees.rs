//! Units of programs for a control that takes another one than it is set to for a fault.
//!
//! Law: a code for a unit does nothing there but to agree with the setting. Side condition: the target's profile says the unit. A
//! program that names the other one stops at an alarm. A mill is set for the job, so there it is asked once for the library; a program
//! for a lathe is refused, since its cycles take lengths from settings in that unit. Counter-example: a program in inches with `units = "metric"`.

use crate::canon::Op;
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Machine, Question, Units};
use crate::ir::Module;
use crate::legalize::Context;
use crate::legalize::features::Features;

/// True if the library names a unit that the target's profile does not.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    context.target.is(Question::UnitsAgree) && other(context).is_some_and(|(op, _, _)| features.op(op))
}

/// The unit that the target is not set to, its name, and that of the other one.
fn other(context: &Context<'_>) -> Option<(Op, &'static str, &'static str)> {
    Some(match context.target.units()? {
        Units::Metric => (Op::Inch, "inches", "millimetres"),
        Units::Inch => (Op::Metric, "millimetres", "inches"),
    })
}

/// Tells of the programs that name the other unit, at the first block that does.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let Some((op, named, set)) = other(context) else { return };
    let code = match context.target.machine() {
        Machine::Lathe => Code::NoEquivalent,
        Machine::Mill => Code::Conditional,
    };
    let title = &context.target.dialect().title;
    let what = format!("the program names {named}, and the {title} is set to {set}: that is an alarm there");
    let help = format!(
        "set the machine to {named} before such a program. If all programs are in {named}, say so in its profile (units); if the setting is \
         turned with each job, leave units out of it"
    );
    for (index, program) in module.programs.iter().enumerate() {
        let mut stmts = program.blocks.iter().flat_map(|block| &block.stmts);
        if let Some(stmt) = stmts.find(|stmt| stmt.kind.has_op(op)) {
            let finding = Diagnostic::new(code, stmt.site.span, what.clone()).with_help(help.clone());
            let finding = if code == Code::Conditional { finding.asked_once() } else { finding };
            context.add_once(index, &what, finding);
        }
    }
}
