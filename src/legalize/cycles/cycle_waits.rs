//! Waits inside a drilling cycle, where their time is the cycle's too.
//!
//! Law: on a control where P of a wait is P of the cycle in force, the holes after the wait wait as long as it did; elsewhere they
//! wait as long as the cycle was told. So such a program is refused, unless both controls are alike. Side conditions: the cycle takes
//! a dwell, or a later one may that is not told its own; a program that does not return begins without a cycle. Counter-example: `G4 P500`
//! after `G80`.

use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question};
use crate::ir::{Module, Nc};
use crate::legalize::Context;
use crate::legalize::features::Features;
use crate::legalize::moves::mains::{facts_of_mains, returns};
use std::collections::BTreeMap;

/// True if the library waits and drills, and the time may be shared on one of the controls alone.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    shares(context.source) != shares(context.target)
        && features.op(Op::Dwell)
        && features.any_op(Op::is_cycle)
}

/// True where the time of a wait may be that of the cycle too: a table that is silent says that it is not.
fn shares(control: &Control) -> bool {
    let row = control.behaviour(Question::CycleDwellShared);
    row.is_some_and(|row| row.value != "false" || !row.origin.is_settled())
}

/// Reports waits inside cycles.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let (called, mains) = (context.modal_facts(module), facts_of_mains(module, context));
    let control = if shares(context.source) { context.source } else { context.target };
    let takes =
        |op: Op| control.code_for(op, &BTreeMap::new()).is_some_and(|row| row.takes(Role::CycleDwell));
    let stmts = module.programs.iter().flat_map(|program| &program.blocks).flat_map(|block| &block.stmts);
    let untold =
        |nc: &Nc| nc.ops().any(|op| op.is_cycle() && takes(op)) && nc.word(Role::CycleDwell).is_none();
    // A wait under a cycle without a dwell is kept for one of them.
    let later = stmts.filter_map(|stmt| stmt.kind.nc()).any(untold);
    for (facts, of_mains) in [(called, false), (mains, true)] {
        facts.each(module, &mut |index, stmt, before, _| {
            if returns(&module.programs[index]) == of_mains || !stmt.kind.nc().is_some_and(waits) {
                return;
            }
            let span = stmt.site.span;
            match before.op(Group::Cycle) {
                Some(op) if op.is_cycle() && (later || takes(op)) => {
                    context.add(index, Diagnostic::new(Code::NoEquivalent, span, SHARED));
                }
                Some(_) => {}
                None => context.add_once(index, MAY_BE, Diagnostic::new(Code::Conditional, span, MAY_BE)),
            }
        });
    }
}

/// True for a wait that does not stand beside the end of the cycle.
fn waits(nc: &Nc) -> bool {
    nc.has(Op::Dwell) && !nc.has(Op::CycleOff)
}

const SHARED: &str = "a G4 while a drilling cycle is in force: on one of the two controls its time is the wait of the next holes too. \
     End the cycle before the wait, and write it again after it, or say cycle.dwell.shared in that control's machine profile";

const MAY_BE: &str = "a drilling cycle may be in force at this G4, and on one of the two controls its time is then the wait of the next \
     holes too: make sure that none is";
