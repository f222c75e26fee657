//! Units that the target cannot select.
//!
//! Law: where the operator sets the unit and a code, or a test before a stop, can only check it, a program that selects one unit does what one does
//! that checks it: on a machine that is set so both go on, and on another one the check stops before anything moves. Side
//! condition: the program selects no other unit; one that uses both keeps its codes and is refused. Where programs of the
//! library differ, the machine must be set anew between them, which they say.
//! Counter-example: `G20` .. `G21` in one program.

use crate::canon::Op;
use crate::diag::{Code, Diagnostic};
use crate::ir::{Module, NcItem, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::Features;
use std::collections::BTreeMap;

/// True if the target checks units and does not select them, and the library selects one.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let has = |op| context.target.code_for(op, &BTreeMap::new()).is_some();
    let tests = context.target.statement("test.unit").is_some();
    let checked = |(unit, check)| features.op(unit) && !has(unit) && (tests || has(check));
    checked(INCH) || checked(METRIC)
}

/// A unit, and what checks it.
const INCH: (Op, Op) = (Op::Inch, Op::CheckInch);
const METRIC: (Op, Op) = (Op::Metric, Op::CheckMetric);

/// Checks the unit wherever it was selected.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let all = Features::of(&module.programs);
    let both = all.op(Op::Inch) && all.op(Op::Metric);
    for (index, program) in module.programs.iter_mut().enumerate() {
        let features = Features::of(std::slice::from_ref(program));
        let (unit, check) = match (features.op(Op::Inch), features.op(Op::Metric)) {
            (true, false) => INCH,
            (false, true) => METRIC,
            _ => continue,
        };
        if both {
            let set = if unit == Op::Inch { "inches" } else { "millimetres" };
            let what = format!(
                "other programs of the library use the other unit: set the control to {set} for this one"
            );
            let finding = Diagnostic::new(Code::Conditional, program.site.span, what);
            context.add_once(index, "unit to be set", finding);
        }
        for stmt in program.blocks.iter_mut().flat_map(|block| &mut block.stmts) {
            let StmtKind::Nc(nc) = &mut stmt.kind else { continue };
            nc.items
                .iter_mut()
                .filter(|item| **item == NcItem::Op(unit))
                .for_each(|item| *item = NcItem::Op(check));
        }
    }
}
