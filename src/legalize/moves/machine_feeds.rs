//! Moves in machine coordinates that feed, for a target that goes there by rapid traverse alone.
//!
//! Law: under the code of the rapid both go there by rapid. Under another code the source may feed, and the target's code never does: no
//! other code of the target moves in machine coordinates, so the program is refused. Where it is not known which code is in force a
//! reviewer has to look. Counter-example: `G53 G1 Z-5. F20.`, a crash where it is rapid.

use crate::canon::{Group, Op};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Machine, Question};
use crate::ir::Module;
use crate::legalize::Context;
use crate::legalize::features::Features;

const FEEDS: &str = "a move in machine coordinates under a code that feeds: the target makes every such move by rapid traverse";

const MAY_FEED: &str = "a move in machine coordinates, and it is not known whether G0 is in force: the target makes every such move by rapid \
     traverse";

const HELP: &str = "write G0 into its block if it may be rapid, else move in coordinates of the part; if the source's moves are rapid too, say so in its \
     machine profile, as machine.move.rapid";

/// True for two mills, where the target alone is known to go there by rapid whatever is in force.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let rapid = Question::MachineMoveRapid;
    features.op(Op::MachineOnce)
        && [context.source, context.target].iter().all(|control| control.machine() == Machine::Mill)
        && context.target.is(rapid)
        && !context.source.is(rapid)
}

/// Refuses them.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let facts = context.modal_facts(module);
    facts.each(module, &mut |index, stmt, _, after| {
        if !stmt.kind.nc().is_some_and(|nc| nc.has(Op::MachineOnce) && nc.names_axis()) {
            return;
        }
        let (code, what) = match after.op(Group::Motion) {
            Some(Op::Rapid) => return,
            Some(_) => (Code::NoEquivalent, FEEDS),
            None => (Code::Conditional, MAY_FEED),
        };
        context.add_once(index, what, Diagnostic::new(code, stmt.site.span, what).with_help(HELP));
    });
}
