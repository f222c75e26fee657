//! Spindles that a drilling cycle of the source turns, for a target whose cycles turn none.
//!
//! Law: a cycle that finds the spindle standing after a tool change turns it as it was last commanded. The target gets that code
//! in a block before the cycle, with the S in force. Where the spindle turns on some way, the code says no more than what is in force. Side conditions: the last command is the same
//! turning on every way, and no program of the library calls this one; after M5 such a cycle turns nothing, and a tap is left to `runtime`. Where they do not hold, `runtime` refuses
//! or asks. Counter-example: a program that is called with another tool's spindle turning.

use crate::canon::{Group, Op};
use crate::dialect::{Machine, Question};
use crate::ir::analysis::calls_of;
use crate::ir::analysis::over_calls::OverCalls;
use crate::ir::{Callee, Module, Nc, NcItem, SourceInfo, Stmt, StmtKind};
use crate::legalize::assumptions::standing::{Standing, turned_by_cycle};
use crate::legalize::features::Features;
use crate::legalize::{Context, Modal};
use crate::syntax::ProgramName;
use std::collections::BTreeSet;

/// True if cycles of the source alone turn the spindle.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    features.any_op(|op| op.is_cycle() && !op.is_tap())
        && context.source.machine() == Machine::Mill
        && context.source.is(Question::CycleStartsSpindle)
        && !context.target.is(Question::CycleStartsSpindle)
}

/// Turns it before the cycle.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let facts = context.modal_facts(module);
    let standing = Standing::of(context.source, context.target);
    let stood = OverCalls::of(module, &standing);
    // A program that is called has its callers' spindle, whoever they are.
    let blocks = module.programs.iter().flat_map(|program| &program.blocks);
    let called: BTreeSet<ProgramName> = blocks
        .flat_map(calls_of)
        .filter_map(|call| match &call.callee {
            Callee::Program(name) => Some(name.clone()),
            _ => None,
        })
        .collect();
    let mut changed = false;
    for (index, program) in module.programs.iter_mut().enumerate() {
        if program.name.as_ref().is_some_and(|name| called.contains(name)) {
            continue;
        }
        for (id, block) in program.ids().zip(&mut program.blocks) {
            let Some(mut spindle) = stood.at(index, id).copied() else { continue };
            let mut state = facts.at(index, id);
            let mut at = 0;
            while let Some(stmt) = block.stmts.get(at) {
                spindle = standing.after(&stmt.kind, spindle);
                let turning = stmt.kind.nc().filter(|_| spindle.stands && !spindle.lost);
                let turning = turning.and_then(|nc| turned_here(nc, &state));
                state.step(stmt);
                if let Some(op) = turning {
                    let nc = Nc { items: [NcItem::Op(op)].into_iter().collect() };
                    let site =
                        SourceInfo { span: stmt.site.span, skip: stmt.site.skip, ..SourceInfo::default() };
                    let start = Stmt { kind: StmtKind::Nc(nc), site };
                    spindle = standing.after(&start.kind, spindle);
                    block.stmts.insert(at, start);
                    (changed, at) = (true, at + 1);
                }
                at += 1;
            }
        }
    }
    changed
}

/// How the spindle was last commanded, where a block begins to drill and turns it so.
fn turned_here(nc: &Nc, before: &Modal) -> Option<Op> {
    let begins = nc.ops().any(|op| op.is_cycle() && !op.is_tap());
    let turns = |op: &Op| matches!(op, Op::SpindleCw | Op::SpindleCcw);
    before.op(Group::Spindle).filter(|op| turns(op) && begins && turned_by_cycle(nc, true, before))
}
