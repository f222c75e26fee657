//! What holds of a program, of those that it calls, and of those that call it.

use super::starts_in;
use crate::canon::Running;
use crate::ir::Module;
use crate::ir::analysis::CallGraph;
use crate::ir::analysis::dataflow::Lattice;
use crate::legalize::Context;
use crate::legalize::features::Features;
use std::collections::BTreeSet;

/// By program, true where it, one that it calls, or one that calls it, may have something.
pub(in crate::legalize) fn related(
    module: &Module,
    context: &Context<'_>,
    has: impl Fn(&Features) -> bool,
) -> Vec<bool> {
    let own = |index| [context.may_concern(index, &has), false];
    let mut found: Vec<[bool; 2]> = (0..module.programs.len()).map(own).collect();
    spread(&mut found, module, context);
    found.into_iter().map(|[has, _]| has).collect()
}

/// Gives each program what holds of those that it calls, and of those that call it.
pub(super) fn spread(found: &mut [[bool; 2]], module: &Module, context: &Context<'_>) {
    let mut callees = vec![BTreeSet::new(); found.len()];
    for (caller, callee) in context.called(module).pairs(module) {
        callees[caller].insert((callee, false));
    }
    let graph = CallGraph::new(callees);
    let either = |mine: &mut [bool; 2], theirs: &[bool; 2], _| {
        mine.iter_mut().zip(theirs).fold(false, |changed, (mine, theirs)| mine.join(theirs) || changed)
    };
    graph.bottom_up(found, either);
    graph.top_down(found, either);
}

/// For each program, what it, those that it calls, or those that call it start.
pub(super) fn started(module: &Module, context: &Context<'_>) -> Vec<[bool; 2]> {
    let starts = |index| {
        Running::ALL.map(|running| context.may_concern(index, |features| starts_in(features, running)))
    };
    let mut found: Vec<[bool; 2]> = (0..module.programs.len()).map(starts).collect();
    spread(&mut found, module, context);
    found
}
