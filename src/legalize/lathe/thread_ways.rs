//! Threads without the way of their infeed, where P lasts from code to code.
//!
//! Law: none. A thread of many passes without P goes in along one flank, as P1 says; where another P stands before it in the program, no source
//! says whether that one counts, and the program is for review. Counter-example: `G76 ... P2`, and in the next block `G76 ...` without P.

use super::settings::takes;
use crate::canon::{Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question};
use crate::ir::{Module, Nc, StmtKind, TermKind};
use crate::legalize::Context;
use crate::legalize::features::Features;

/// True where threads stand whose infeed P says, on a control whose P may last from code to code.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    features.op(Op::Threading)
        && takes(context.source, Op::Threading, Role::ThreadInfeed)
        && lasts(context.source)
}

/// True where P of one code may be that of a later one: a table that is silent says that it is not.
fn lasts(control: &Control) -> bool {
    let row = control.behaviour(Question::CycleDwellShared);
    row.is_some_and(|row| row.value != "false" || !row.origin.is_settled())
}

/// Reports threads that may take the P of a code before them.
pub fn run(module: &Module, context: &mut Context<'_>) {
    for (index, program) in module.programs.iter().enumerate() {
        let mut last: Option<Before> = None;
        for block in &program.blocks {
            for stmt in &block.stmts {
                let StmtKind::Nc(nc) = &stmt.kind else { continue };
                if nc.has(Op::Threading)
                    && nc.word(Role::ThreadInfeed).is_none()
                    && let Some(before) = last
                {
                    let what = format!(
                        "this thread has no P, and P of {} stands before it: P lasts from code to code on the source, and whether it counts \
                         here no source says; the thread is taken as with P1",
                        before.of
                    );
                    let told = Diagnostic::new(Code::Conditional, stmt.site.span, what.as_str())
                        .with_help("write P1 into the block of the thread, or the P that it is cut by");
                    context.add_once(index, &what, if before.once { told.asked_once() } else { told });
                }
                last = before_of(nc).unwrap_or(last);
            }
            if matches!(block.term.kind, TermKind::Call { .. }) {
                last = Some(Before { of: "a call", once: false });
            }
        }
    }
}

/// The last P before a thread.
#[derive(Clone, Copy)]
struct Before {
    of: &'static str,
    /// True where it is no time and no way of an infeed: it is asked once for the library.
    once: bool,
}

/// What a block leaves: none where it has no P, nothing where its P is that of a thread without one.
fn before_of(nc: &Nc) -> Option<Option<Before>> {
    let has = |roles: &[Role]| roles.iter().any(|role| nc.word(*role).is_some());
    if let Some(way) = nc.word(Role::ThreadInfeed) {
        return Some((way.constant() != Some(1.0)).then_some(Before { of: "another thread", once: false }));
    }
    if has(&[Role::DwellMs, Role::DwellS]) {
        return Some(Some(Before { of: "a wait", once: false }));
    }
    if has(&[Role::CycleDwell]) {
        return Some(Some(Before { of: "a drilling cycle", once: false }));
    }
    has(&[Role::ContourFirst]).then_some(Some(Before { of: "the cycle of a contour", once: true }))
}
