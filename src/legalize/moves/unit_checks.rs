//! Units that the target cannot select.
//!
//! Law: where the operator sets the unit and a code, or a test before a stop, can only check it, a program that selects one unit does what one does
//! that checks it: on a machine that is set so both go on, and on another one the check stops before anything moves. Side
//! condition: the program selects no other unit, and the machine's profile names no other; such programs are refused. Where
//! programs of the library differ, the machine must be set anew between them, which they say.
//! Counter-example: `G20` .. `G21` in one program.

use crate::canon::Op;
use crate::diag::{Code, Diagnostic};
use crate::dialect::Units;
use crate::ir::{Module, NcItem, Program, Stmt, StmtKind};
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
    let set = context.target.units();
    for (index, program) in module.programs.iter_mut().enumerate() {
        let features = Features::of(std::slice::from_ref(program));
        let unit = match (features.op(Op::Inch), features.op(Op::Metric)) {
            (true, false) => Op::Inch,
            (false, true) => Op::Metric,
            (false, false) => continue,
            (true, true) => {
                refuse(index, program, "this one uses both units".into(), context);
                check_units(program);
                continue;
            }
        };
        let (name, value) = if unit == Op::Inch { ("inches", "inch") } else { ("millimetres", "metric") };
        if set.is_some_and(|set| (set == Units::Inch) != (unit == Op::Inch)) {
            let why = format!(
                "the program is in {name} and the target's profile has the other unit: set the machine to {name} for \
                 this program, and convert it with `units = \"{value}\"` in the profile"
            );
            refuse(index, program, why, context);
        }
        if both {
            let what = format!(
                "other programs of the library use the other unit: set the control to {name} for this one"
            );
            let finding = Diagnostic::new(Code::Conditional, program.site.span, what).asked_once();
            context.add_once(index, "unit to be set", finding);
        }
        check_units(program);
    }
}

/// Checks each unit where it was selected.
fn check_units(program: &mut Program) {
    for stmt in program.blocks.iter_mut().flat_map(|block| &mut block.stmts) {
        let StmtKind::Nc(nc) = &mut stmt.kind else { continue };
        for item in &mut nc.items {
            match item {
                NcItem::Op(op) if *op == INCH.0 => *op = INCH.1,
                NcItem::Op(op) if *op == METRIC.0 => *op = METRIC.1,
                _ => {}
            }
        }
    }
}

/// Refuses a program at the first block that selects a unit.
fn refuse(index: usize, program: &Program, why: String, context: &mut Context<'_>) {
    let selects =
        |stmt: &&Stmt| matches!(&stmt.kind, StmtKind::Nc(nc) if nc.has(Op::Inch) || nc.has(Op::Metric));
    let stmt = program.blocks.iter().flat_map(|block| &block.stmts).find(selects);
    let span = stmt.map_or(program.site.span, |stmt| stmt.site.span);
    let title = &context.target.dialect().title;
    let what = format!("no program changes the unit of a {title}, and {why}");
    context.add(index, Diagnostic::new(Code::NoEquivalent, span, what));
}
