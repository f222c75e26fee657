//! A pass along a contour, so far off it (K9, N4).

use super::profile::Profile;
use super::way::Point;
use crate::control::machine::Machine;
use crate::control::outcome::Stop;
use crate::control::trace::Trace;

/// From where the tool stands to the beginning of the contour as its first block goes, then along it.
pub fn run(machine: &mut Machine, profile: &Profile, off: Point, trace: &mut Trace) -> Result<(), Stop> {
    for piece in &profile.pieces {
        machine.follow(piece, off, trace)?;
        if trace.is_full() {
            break;
        }
    }
    Ok(())
}
