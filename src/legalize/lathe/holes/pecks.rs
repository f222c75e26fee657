//! How long the peck of a hole lasts, on a target with one code for holes with pecks and without (docs/lathe.md Q7).

use super::walk::{Hole, Refused};
use crate::dialect::{Control, Question};

/// How long it lasts on the target.
#[derive(Clone, Copy, Debug)]
pub(super) struct Peck {
    /// Until the cycle ends; else in its block alone.
    lasts: bool,
    /// True if some hole of the library has one.
    any: bool,
}

impl Peck {
    pub fn of(target: &Control, any: bool) -> Self {
        let lasts = target.behaviour(Question::HolePeckLasts).is_some_and(|row| row.value == "lasts");
        Self { lasts, any }
    }
}

/// A hole in one go for a control with the one code: where an earlier hole of its cycle had a peck, it rests on that one being over.
pub(super) fn end(hole: &mut Hole<'_>) -> Result<(), Refused> {
    let known = hole.cycle.pecked;
    let none = known == Some(false) || known.is_none() && !hole.peck.0.any;
    hole.peck.1 |= !none;
    if none || !hole.peck.0.lasts { Ok(()) } else { Err((KEPT, KEPT_HELP)) }
}

const KEPT: &str =
    "a hole in one go after one with pecks: on the target Q of the first lasts until the cycle ends";
const KEPT_HELP: &str = "write G80 before this block, and all words of the hole";
