//! Waits at the bottom of bores, for a target whose cycle has no word for one.
//!
//! Law: while it waits at the bottom of a bore the tool stands: no axis moves, and what comes after is the same. So the wait is left
//! out and a person is told, who looks at the floor of the bore. Side conditions: a cycle that bores with one edge and then leaves
//! the wall or stops the spindle, and no code of the target's cycle takes the word. The word lasts for the cycles after it all the
//! same. Counter-example: `G82 P500`, which is for the floor, and for which the target has a word.

use crate::assume::Predicate;
use crate::canon::{Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Control;
use crate::ir::Expr;
use crate::legalize::Context;
use crate::text::Span;
use std::collections::BTreeMap;

const LOOK: &str = "look at the floor of the bore on the first part. If it needs the wait, write the bore as moves (G0 and G1) with a \
     dwell (G4) in the source";

/// True for a cycle that bores, where the target's code for it takes no wait.
pub(super) fn is_bore(op: Op, target: &Control) -> bool {
    let bores = matches!(op, Op::CycleFineBore | Op::CycleBackBore | Op::CycleBoreStop);
    bores && target.code_for(op, &BTreeMap::new()).is_some_and(|row| !row.takes(Role::CycleDwell))
}

/// Tells that a wait is left out. Without a dwell it depends on the way whether one of an earlier cycle is still in force.
pub(super) fn left_out(
    index: usize,
    span: Span,
    (op, dwell): (Op, Option<&Expr>),
    context: &mut Context<'_>,
) {
    let Some(row) = context.target.code_for(op, &BTreeMap::new()) else { return };
    let wait = match dwell.map(Expr::constant) {
        Some(Some(milliseconds)) => {
            format!("the wait of {} s at the bottom of the hole is", milliseconds / 1000.0)
        }
        Some(None) => "the wait at the bottom of the hole is".to_owned(),
        None => {
            "a wait of an earlier cycle may still be in force at the bottom of this hole, and is".to_owned()
        }
    };
    let what = format!(
        "{wait} left out: the target's {} has none. A turn of the spindle at the bottom is lost",
        row.code
    );
    let told = Diagnostic::new(Code::Conditional, span, what.clone());
    context.add_once(index, &what, told.with_help(LOOK).assuming(Predicate::Substitute(op)));
}
