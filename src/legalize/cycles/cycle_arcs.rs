//! Arcs under a drilling cycle, where the source is not known to end it by them.
//!
//! Law: here an arc ends the drilling cycle in force. A source that does not, or of which nobody says it, does something else
//! there, and the program is refused; where only some ways lead there under a cycle, it is for review. Counter-example: `G80`
//! before the arc.

use crate::canon::{Group, Op};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::{Module, Nc};
use crate::legalize::Context;
use crate::legalize::features::Features;

/// True if the library has cycles and arcs, and arcs are not sure to end cycles on the source.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let row = context.source.behaviour(Question::CycleEndsByArc);
    let sure = row.is_none_or(|row| row.value == "true" && row.origin.is_settled());
    !sure && features.any_op(|op| op.is_cycle() || op.is_hole()) && features.any_op(Op::is_arc)
}

/// Reports arcs under cycles.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let facts = context.modal_facts(module);
    facts.each(module, &mut |index, stmt, before, _| {
        if !stmt.kind.nc().is_some_and(arcs) {
            return;
        }
        match before.op(Group::Cycle) {
            Some(Op::CycleOff) => {}
            Some(_) => context.add(index, Diagnostic::new(Code::NoEquivalent, stmt.site.span, UNDER)),
            None => {
                let finding = Diagnostic::new(Code::Conditional, stmt.site.span, MAY_BE);
                context.add_once(index, MAY_BE, finding);
            }
        }
    });
}

/// True for an arc that does not stand beside the end of the cycle.
fn arcs(nc: &Nc) -> bool {
    nc.ops().any(Op::is_arc) && !nc.ops().any(|op| op.group() == Group::Cycle)
}

const UNDER: &str = "an arc while a drilling cycle is in force: the source is not known to end the cycle by it. Write G80 before the \
     arc, or say it of the source in its machine profile, as cycle.ends.by.arc";

const MAY_BE: &str = "a drilling cycle may be in force at this arc, and the source is not known to end it by an arc: make sure that \
     none is, or write G80 before it";
