//! Cuts a table down to the number of offsets that a machine has.

use super::{Dialect, Profile, Shift};
use crate::canon::{Role, Sys};

/// The first common number of the additional work offsets.
const ADDITIONAL: u32 = 101;

/// Drops the tool offsets and the additional work offsets past those of the profile.
pub(super) fn clamp(dialect: &mut Dialect, profile: &Profile) {
    if let Some(offsets) = profile.offsets {
        for row in dialect.system.iter_mut().filter(|row| row.state.is_tool_offset()) {
            if let Some(subscript) = row.subscripts.first_mut() {
                subscript.count = subscript.count.min(offsets);
            }
        }
        dialect.system.retain(|row| row.subscripts.iter().all(|subscript| subscript.count > 0));
    }
    if let Some(count) = profile.work_offsets {
        for row in dialect.system.iter_mut().filter(|row| row.state == Sys::WorkOffset) {
            if let Some(subscript) = row.subscripts.first_mut().filter(|s| s.from >= ADDITIONAL) {
                let left = (ADDITIONAL + count).saturating_sub(subscript.from);
                subscript.count = subscript.count.min(left);
            }
        }
        dialect.system.retain(|row| row.subscripts.iter().all(|subscript| subscript.count > 0));
        let last = f64::from(ADDITIONAL) + f64::from(count) - 1.0;
        dialect.codes.retain(|row| row.fixed.get(&Role::WorkOffset).is_none_or(|number| *number <= last));
        let codes = dialect.codes.iter_mut().map(|row| &mut row.shift);
        let words = dialect.words.iter_mut().map(|row| &mut row.shift);
        for shifts in codes.chain(words) {
            for role in [Role::WorkOffset, Role::OffsetRow] {
                if let Some(shifts) = shifts.get_mut(&role) {
                    shifts.retain_mut(|shift| shorten(shift, count));
                }
            }
        }
        // A code whose every number is past the end writes nothing.
        dialect.codes.retain(|row| row.shift.values().all(|shifts| !shifts.is_empty()));
    }
}

/// Shortens a run that ends past the last additional offset; false where nothing is left.
fn shorten(shift: &mut Shift, count: u32) -> bool {
    let last = i64::from(ADDITIONAL) + i64::from(count) - 1 - shift.add;
    if i64::from(shift.first) + shift.add < i64::from(ADDITIONAL) {
        return true;
    }
    shift.last = shift.last.min(u32::try_from(last).unwrap_or(0));
    shift.first <= shift.last
}
