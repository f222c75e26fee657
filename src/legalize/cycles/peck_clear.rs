//! How far over the last depth each peck begins, told by a word that the target's code does not take.
//!
//! Law: where the target's machine begins each peck as far over the last depth by itself, the word may go. Side condition: the word is
//! a number, its unit is known, and the target's profile says the same. Counter-example: `G83 Z-20. Q5. P0.5` for a machine whose own
//! clearance is 1 mm.

use crate::canon::{Group, Op, Role};
use crate::dialect::{Question, Units};
use crate::ir::{Nc, NcItem};
use crate::legalize::{Context, Modal};

/// The clearance that a block tells, in millimetres; none if it tells none, or a computed one.
fn told(nc: &Nc, state: &Modal, context: &Context<'_>) -> Option<f64> {
    let clear = nc.word(Role::PeckClear)?.constant()?.abs();
    let inch = match state.op(Group::Units) {
        Some(op) => op == Op::Inch,
        None => context.source.units().or(context.target.units())? == Units::Inch,
    };
    Some(if inch { clear * 25.4 } else { clear })
}

/// Takes the word out where the target's machine has the same clearance; else the clearance that it would have to have, in millimetres.
pub(super) fn fit(nc: &mut Nc, state: &Modal, context: &Context<'_>) -> Option<f64> {
    let needed = told(nc, state, context)?;
    if context.target.peck_clearance().is_some_and(|own| (own - needed).abs() < 1e-4) {
        nc.items.retain(|item| !matches!(item, NcItem::Word(Role::PeckClear, _)));
    }
    Some((needed * 1e6).round() / 1e6)
}

/// What to do about it.
pub(super) fn help(needed: f64) -> String {
    format!(
        "if the target begins each peck {needed} mm over the last depth (a setting of the machine), write \
         \"{}\" = {needed} under [behaviours] in its profile; or take the word out",
        Question::CyclePeckClearance
    )
}
