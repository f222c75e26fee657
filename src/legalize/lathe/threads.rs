//! Threads of many passes that the target's cycle does not cut.
//!
//! Law: none. It says what the target's cycle has no words for: a start of the spindle, an angle, a thread without a finishing
//! pass. Counter-example: an angle of 45 degrees, which one control takes and another has an alarm for.

use super::cycle_values::{Values, constant};
use super::settings::{setting, takes};
use crate::assume::Predicate;
use crate::canon::{Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question};
use crate::ir::Nc;
use crate::legalize::Context;
use crate::text::Span;

/// What of a thread's block, and of what else its cycle takes, the target's cycle cannot be told, and what to do.
pub(super) fn beyond(nc: &Nc, values: &Values, target: &Control) -> Option<(&'static str, &'static str)> {
    let angle = constant(values, Role::ThreadAngle).unwrap_or(0.0);
    let counts_finishes = takes(target, Op::ThreadingSetup, Role::ThreadForm)
        || setting(target, Op::Threading, Role::ThreadFinishes).is_some();
    if nc.word(Role::ThreadStart).is_some() && !takes(target, Op::Threading, Role::ThreadStart) {
        Some((START, "begin the thread at another Z instead: a lead is a turn"))
    } else if !has_angle(target, angle) {
        Some((ANGLE, "give the thread an angle that the target has"))
    } else if counts_finishes && constant(values, Role::ThreadFinishes).unwrap_or(0.0) < 1.0 {
        Some((UNFINISHED, "give the source an allowance for a finishing pass"))
    } else {
        None
    }
}

/// Says that the order of the flanks was taken from a row that no page confirms.
pub(super) fn flanks_are_open(index: usize, span: Span, context: &mut Context<'_>) {
    context.rests_on_source(index, span, Question::ThreadFlanks);
    let row = context.source.behaviour(Question::ThreadFlanks);
    if row.is_some_and(|row| row.origin.is_confirmed()) {
        return;
    }
    let told = Diagnostic::new(Code::Conditional, span, FLANKS)
        .with_help(FLANKS_HELP)
        .assuming(Predicate::Substitute(Op::Threading));
    context.add_once(index, FLANKS, told);
}

/// True where the cycle of a control takes this angle between the flanks.
pub(super) fn has_angle(control: &Control, angle: f64) -> bool {
    match control.behaviour(Question::ThreadAngles).map(|row| row.value.as_str()) {
        None | Some("any" | "unknown") => true,
        Some(list) => list.split('.').filter_map(|one| one.parse::<f64>().ok()).any(|one| one == angle),
    }
}

const START: &str = "the target's cycle has no word for the angle of the spindle at which a thread begins";
const ANGLE: &str = "the target's cycle does not take this angle of a thread";
const UNFINISHED: &str = "the target's cycle makes a finishing pass at least, and this thread has none";
const FLANKS: &str = "the passes of a thread that is cut on both flanks are written out, and no source says in which order the flanks come, or from where \
                      along Z";
const FLANKS_HELP: &str = "run the cycle in the air on the source's machine, compare Z of its first two passes with those written, and confirm \
                           behaviour:thread.flanks in its profile; or cut the thread on one flank";
