//! Variables that a drilling cycle takes its planes, the depth of its pecks or its dwell from, and that change while it is in force.
//!
//! Law: no source says whether the next holes take the new value or that of the cycle's own block. So such a program is refused.
//! Side condition: the next block with words is not a cycle's own, which says its planes again, or the end of the cycle.
//! Counter-example: `V2=-15` between two holes of `G81 V1=5 V2=-10`.

use crate::canon::{Group, Op};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question};
use crate::ir::{Class, Module, Place, Stmt, StmtKind, Var};
use crate::legalize::Context;
use crate::legalize::features::Features;

/// True if the library drills, and cycles of the source take their planes from variables.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    features.any_op(Op::is_cycle) && !variables(context.source).is_empty()
}

/// The numbers of the variables that cycles take their planes and more from.
fn variables(control: &Control) -> Vec<u32> {
    use Question::{CycleVariableDepth, CycleVariableDwell, CycleVariablePeck, CycleVariableRetract};
    let questions = [CycleVariableRetract, CycleVariableDepth, CycleVariablePeck, CycleVariableDwell];
    let rows = questions.into_iter().filter_map(|question| control.behaviour(question));
    rows.filter_map(|row| row.value.parse().ok()).collect()
}

/// Refuses changes of such variables under a cycle.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let numbers = variables(context.source);
    let facts = context.modal_facts(module);
    let changes = |stmt: &Stmt| match &stmt.kind {
        StmtKind::Assign { target: Place::Var(Var { class: Class::Global, number }), .. } => {
            numbers.contains(number)
        }
        _ => false,
    };
    for (index, program) in module.programs.iter().enumerate() {
        for (id, block) in program.ids().zip(&program.blocks) {
            let mut state = facts.at(index, id);
            for (at, stmt) in block.stmts.iter().enumerate() {
                let under = state.op(Group::Cycle).is_some_and(Op::is_cycle);
                if under && changes(stmt) && !told_again(&block.stmts[at..]) {
                    let found = Diagnostic::new(Code::NoEquivalent, stmt.site.span, CHANGED);
                    context.add(index, found.with_help(HELP));
                }
                state.step(stmt);
            }
        }
    }
}

/// True if the next words are those of a cycle's own block, or end it.
fn told_again(stmts: &[Stmt]) -> bool {
    let next = stmts.iter().find_map(|stmt| stmt.kind.nc());
    next.is_some_and(|nc| nc.ops().any(|op| op.is_cycle() || op == Op::CycleOff))
}

const CHANGED: &str = "this variable holds a plane, the pecks or the dwell of the drilling cycle in force, and no source says whether the next holes take its new \
     value";

const HELP: &str = "write the cycle again with its new values, or end it before the change";
