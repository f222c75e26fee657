//! Compensation of the nose radius that begins or ends between the blocks of a contour, for a target that may stop there.
//!
//! Law: none, it only reports. Some controls stop with an alarm where they rough a contour with such a code in it: that is refused where it
//! is known of the target, and told plainly, once for the library, where nobody says it.
//! Counter-example: `N10 G0 G42 X20.` to `N20 G1 G40 X50.` as the contour of a roughing.

use super::contours::contour;
use crate::canon::{Group, Op};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question};
use crate::ir::Module;
use crate::legalize::Context;
use crate::legalize::features::Features;

/// True where contours are roughed beside such codes, and the target is not known to read them.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let answer = |control: &Control| control.behaviour(Question::ContourNose).map(|row| row.value.clone());
    let (ours, theirs) = (answer(context.source), answer(context.target));
    // Two machines with one control, of which nobody says it, are taken to be alike.
    let alike = ours == theirs && context.source.dialect().name == context.target.dialect().name;
    let reads = theirs.as_deref() == Some("read") || alike;
    let codes = [Op::RadiusLeft, Op::RadiusRight].iter().any(|op| features.op(*op));
    codes && !reads && !context.source.is_same_machine(context.target)
}

/// Looks at the contour of each roughing.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let alarms = context.target.behaviour(Question::ContourNose).is_some_and(|row| row.value == "alarm");
    let setting = context.target.setting_of(Question::ContourNose).map(|row| row.name.clone());
    for (index, program) in module.programs.iter().enumerate() {
        for stmt in program.blocks.iter().flat_map(|block| &block.stmts) {
            let Some(nc) = stmt.kind.nc() else { continue };
            let roughs = nc.ops().any(|op| op.reads_contour() && op != Op::Finish);
            let inside = |op: Op| op.group() == Group::RadiusComp;
            if !roughs || !contour(program, nc).any(|nc| nc.ops().any(inside)) {
                continue;
            }
            let span = stmt.site.span;
            if alarms {
                let told = Diagnostic::new(Code::NoEquivalent, span, ALARM).with_help(HELP);
                context.add_once(index, &format!("{ALARM} {span:?}"), told);
                continue;
            }
            let mut told = Diagnostic::new(Code::Conditional, span, OPEN).with_help(HELP).asked_once();
            if let Some(name) = &setting {
                told = told.lacking_there(name.clone());
            }
            context.rests_on_target(index, span, Question::ContourNose);
            context.add_once(index, OPEN, told);
        }
    }
}

const ALARM: &str =
    "G40, G41 or G42 stands in the contour that this cycle roughs: the target stops there with an alarm";
const OPEN: &str = "G40, G41 or G42 stands in the contour that this cycle roughs: some controls of the target stop there with an alarm (PS0325)";
const HELP: &str = "take these codes out of the contour, and write G41 or G42 in a block before the finishing (G70) and G40 after it";
