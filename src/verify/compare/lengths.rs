//! Tool lengths, where the target's tool word brings them: earlier than the source takes them up.
//!
//! Which length is in force shows in the machine coordinates of the moves along it, every length having a value of its
//! own; so the block that takes it up counts only where a program returns, for its caller.

use super::kinds::{returns, setting};
use super::observe::Act;
use crate::control::trace::EventKind;
use crate::dialect::{Control, Question};

/// True if only one of two controls brings a length with the tool.
pub fn brought(source: &Control, target: &Control) -> bool {
    target.is(Question::ToolWordSelectsLength) && !source.is(Question::ToolWordSelectsLength)
}

/// True if it is settled what the word of the tool that is in the spindle does.
pub fn is_told_of_same_tool(control: &Control) -> bool {
    control.behaviour(Question::ToolWordAgain).is_some_and(|row| row.origin.is_settled())
}

/// Leaves the lengths that a program returns with.
pub fn shown_by_moves(acts: Vec<Act<'_>>) -> Vec<Act<'_>> {
    let is_length = |act: &Act<'_>| matches!(*act.what, EventKind::ToolLength { .. });
    let mut kept: Vec<bool> = Vec::with_capacity(acts.len());
    for (at, act) in acts.iter().enumerate() {
        let next = acts[at + 1..].iter().find(|next| setting(&next.what).is_none());
        kept.push(!is_length(act) || next.is_some_and(|next| returns(&next.what)));
    }
    let mut kept = kept.into_iter();
    acts.into_iter().filter(|_| kept.next().unwrap_or(true)).collect()
}
