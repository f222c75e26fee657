//! What nobody sees at a difference: settings before an alarm, and what was found running.

use super::kinds::setting;
use super::observe::Act;
use super::substitutes::is_idle;
use crate::control::trace::{Event, EventKind, Told};

/// How many settings stand on each side before an alarm of one of them: it keeps them from doing anything, and the other side
/// goes on, and may set them otherwise first. A limit on reading ahead may stand among them.
pub fn before_alarm(sides: [&[Act<'_>]; 2]) -> [usize; 2] {
    let passes = |act: &&Act<'_>| setting(&act.what).is_some() || is_idle(&act.what);
    let settings = sides.map(|acts| acts.iter().take_while(passes).count());
    let alarm = |side: usize| {
        sides[side].get(settings[side]).is_some_and(|act| matches!(*act.what, EventKind::Alarm(_)))
    };
    if alarm(0) == alarm(1) { [0; 2] } else { settings }
}

/// Where the first of these acts shows: what was found running does at what comes next.
pub fn told_at<'r>(acts: &[Act<'r>]) -> Option<&'r Event> {
    let act = acts.iter().find(|act| act.told != Told::Found).or_else(|| acts.first());
    act.map(|act| act.event)
}
