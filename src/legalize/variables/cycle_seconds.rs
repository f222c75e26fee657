//! The seconds since cycle start, where the target has a timer that programs set.
//!
//! Law: a timer that a main program sets to 0 where it starts counts from there. Side condition, for a reviewer: nothing else
//! uses the timer. Counter-example: a shop's macro that measures with it across programs.

use crate::canon::Sys;
use crate::diag::{Code, Diagnostic};
use crate::ir::analysis::computed_calls::CalledPrograms;
use crate::ir::analysis::dataflow::reached;
use crate::ir::{Expr, Module, Place, SourceInfo, Stmt, StmtKind};
use crate::legalize::Context;
use std::collections::{BTreeMap, BTreeSet};
use thin_vec::ThinVec;

/// The programs, and all that call them, directly or not.
fn callers_of(module: &Module, programs: BTreeSet<usize>) -> BTreeSet<usize> {
    let mut callers: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (caller, callee) in CalledPrograms::of(module).pairs(module) {
        callers.entry(callee).or_default().push(caller);
    }
    reached(programs, |index, go| callers.get(&index).into_iter().flatten().for_each(|caller| go(*caller)))
}

/// Sets the timer to 0 where each main program starts that reads it, itself or in what it calls; gives all that do.
pub(super) fn start(
    module: &mut Module,
    timed: BTreeSet<usize>,
    context: &mut Context<'_>,
) -> BTreeSet<usize> {
    let callers = callers_of(module, timed);
    for &index in &callers {
        let program = &mut module.programs[index];
        if program.ends()
            && let Some(block) = program.blocks.first_mut()
        {
            let kind = StmtKind::Assign {
                target: Place::System(Sys::TimerMs, ThinVec::new()),
                value: Expr::Number(0.0),
            };
            block.stmts.insert(0, Stmt { kind, site: SourceInfo::default() });
            let what = "the millisecond timer counts the seconds since cycle start; the program sets it \
                        to 0 at its start";
            let finding = Diagnostic::new(Code::Conditional, program.site.span, what);
            context.add_once(index, "cycle seconds", finding);
        }
    }
    callers
}
