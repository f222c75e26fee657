//! Roughing of contours by two controls that do not end it alike.
//!
//! Both go as deep each pass, leave the same on the same contour, and come back to where they began; the passes between are
//! each control's own. That is what a conversion tells of, and a person accepts.

use super::observe::Act;
use crate::canon::Op;
use crate::control::trace::{EventKind, Told};
use crate::dialect::{Control, Question};

/// True if two controls do not end the roughing of a contour alike.
pub fn differs(source: &Control, target: &Control) -> bool {
    let ends = |control: &Control| control.behaviour(Question::RoughingEnds).map(|row| row.value.clone());
    let skips = |control: &Control| [false, true].map(|valleys| control.skips_along(valleys).is_some());
    ends(source).zip(ends(target)).is_some_and(|(ours, theirs)| ours != theirs)
        || skips(source) != skips(target)
}

/// Leaves the passes out: what is roughed stands before them.
pub fn without_passes(acts: Vec<Act<'_>>) -> Vec<Act<'_>> {
    acts.into_iter().filter(|act| act.told != Told::Pass).collect()
}

/// What stands for what, where two contours that are roughed were found to be the same.
pub fn stands_for(source: &EventKind) -> Option<(Op, String)> {
    let EventKind::Roughing { cycle, .. } = source else { return None };
    Some((*cycle, "the target ends the roughing of a contour by other passes".to_owned()))
}
