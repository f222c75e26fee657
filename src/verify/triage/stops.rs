//! Where the source's control stops a program, or an arc is none: the program says nothing of what the target should do.

use crate::control::trace::EventKind;
use crate::control::{End, Run};
use crate::verify::compare::Difference;

/// How far the end of an arc may lie off its circle, millimetres, to be an arc at all.
const MOST_OFF: f64 = 0.05;

/// True where the control stopped the run, not the program.
fn faults(run: &Run) -> bool {
    matches!(&run.end, End::Alarm { stop, .. } if stop.program_number.is_none())
}

/// True where the difference is that the control stopped the run: the program says nothing of what comes then.
pub fn stops_by_itself(run: &Run, difference: &Difference<'_>) -> bool {
    faults(run) && at_the_end(run, difference)
}

/// How far an arc ends off its circle, where that is more than words round.
pub fn off_its_circle(difference: &Difference<'_>) -> Option<f64> {
    match difference.source?.what {
        EventKind::Arc { off, .. } => Some(off.abs()).filter(|off| *off > MOST_OFF),
        _ => None,
    }
}

/// True where the difference lies at the alarm that ended the source, not before it.
fn at_the_end(run: &Run, difference: &Difference<'_>) -> bool {
    match (difference.source, run.events.last()) {
        (Some(event), Some(last)) => std::ptr::eq(event, last),
        (None, _) => true,
        _ => false,
    }
}
