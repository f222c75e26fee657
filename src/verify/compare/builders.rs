//! Codes of a machine's builder and switches of the operator that the target has not, and what the source's profile puts in their place.

use crate::canon::{Act, Op, Sys};
use crate::control::trace::EventKind;
use crate::dialect::Without;
use crate::text::variable_to_set;
use crate::verify::sides::Side;
use std::collections::BTreeSet;

/// The text of a code that is left out.
pub fn is_left_out(source: &Side<'_>, target: &Side<'_>, what: &EventKind) -> Option<String> {
    without_code(source, target, what).filter(|(without, _)| *without == Without::Omit).map(|(_, text)| text)
}

/// True for what the target does without: a code that its profile leaves out, which is noted, and a switch of the operator.
pub fn passes(
    (source, target): (&Side<'_>, &Side<'_>),
    what: &EventKind,
    replaced: &mut BTreeSet<(Op, String)>,
) -> bool {
    let left = is_left_out(source, target, what);
    let passes = left.is_some() || is_switch(target, what);
    replaced.extend(left.map(|text| (Op::Act, text)));
    passes
}

/// True for a write to one of the operator's own switches, of which the target has no variable: no run of the part shows it. No exact
/// stops (bit 2) is no such write.
pub fn is_switch(target: &Side<'_>, what: &EventKind) -> bool {
    let EventKind::Write { state, value, .. } = what else { return false };
    let most = match state {
        Sys::SingleBlock => 1.0,
        Sys::FeedHold => 3.0,
        _ => return false,
    };
    target.control.system_run(*state).is_none() && (0.0..=most).contains(value)
}

/// The text of a stop or an alarm in the place of a code, and true after which the target does nothing more.
pub fn stands_for(
    source: &Side<'_>,
    target: &Side<'_>,
    (here, there): (&EventKind, &EventKind),
) -> Option<(bool, String)> {
    let (without, text) = without_code(source, target, here)?;
    let stands = match without {
        // A stop whose text names a variable asks for it: its text is shown, and the answer comes next on both sides.
        Without::Stop => match there {
            EventKind::Output { .. } => asks(source, here),
            there => matches!(there, EventKind::Message { .. } | EventKind::Stop),
        },
        Without::Alarm => matches!(there, EventKind::Alarm(stop) if stop.program_number.is_some()),
        Without::Omit | Without::Same => false,
    };
    stands.then_some((without == Without::Alarm, text))
}

/// True where the text of the stop that stands for a code names a variable.
fn asks(source: &Side<'_>, what: &EventKind) -> bool {
    let EventKind::Act { name, .. } = what else { return false };
    let site = source.control.site_of(Act::named(name));
    site.is_some_and(|site| variable_to_set(&site.text, &source.control.prefixes()).is_some())
}

fn without_code(source: &Side<'_>, target: &Side<'_>, what: &EventKind) -> Option<(Without, String)> {
    let EventKind::Act { name, .. } = what else { return None };
    let act = Act::named(name);
    let site = source.control.site_of(act)?;
    let without = site.without.filter(|_| target.control.code_of(act).is_none())?;
    let becomes = match without {
        Without::Omit => "is left out",
        Without::Stop => "is a stop",
        Without::Alarm => "is an alarm",
        Without::Same => return None,
    };
    Some((without, format!("{} {becomes} on the target, as the profile says", site.shown())))
}
