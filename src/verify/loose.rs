//! Spindle and coolant beside a rapid move or a wait, where no source says which comes first.
//!
//! Nobody could tell in the work: nothing is cut. So such a change may stand before the move of its block or behind it.

use super::observe::{Act, setting};
use crate::control::trace::Told;

/// Puts the change that may stand elsewhere, of the block of the act at `at`, in the other place: before the moves that it
/// stands behind, or behind those that it stands before. False where there is none.
pub fn moves_over(acts: &mut [Act<'_>], at: usize) -> bool {
    let Some(block) = acts.get(at).map(|act| act.event.at) else { return false };
    let rest = acts.get_mut(at..).unwrap_or_default();
    let length = rest.iter().take_while(|act| act.event.at == block).count();
    let rest = rest.get_mut(..length).unwrap_or_default();
    let Some(place) = rest.iter().position(|act| act.told == Told::Loose) else { return false };
    // Once is enough: what does not fit in either place is a difference.
    rest[place].told = Told::Plain;
    let place = if place > 0 {
        rest[..=place].rotate_right(1);
        at
    } else {
        rest.rotate_left(1);
        at + length - 1
    };
    // Among the settings of one place those of another block may come first.
    let settings = acts.get_mut(place..).unwrap_or_default();
    let many = settings.iter().take_while(|act| setting(&act.what).is_some()).count();
    settings.get_mut(..many).unwrap_or_default().sort_by_key(|act| setting(&act.what));
    length > 1
}
