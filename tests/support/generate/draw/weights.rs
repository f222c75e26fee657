//! How often each kind of step is drawn.

use crate::generate::{Policy, Source};

/// The number of a kind of step.
pub(super) fn drawn(policy: Policy, source: &mut Source<'_>) -> usize {
    let weights = of(policy);
    let mut drawn = source.below(weights.iter().sum());
    let mut which = 0;
    while drawn >= weights[which] {
        drawn -= weights[which];
        which += 1;
    }
    which
}

/// How often: set, cell, mode, move, arc, dwell, if, repeat, leave, switch, call, cycle, offset, machine, own,
/// figure, frame, modal call, talk, words, beside, cells, jump, far, unit.
fn of(policy: Policy) -> &'static [usize] {
    match policy {
        Policy::Goto => &[5, 1, 1, 5, 1, 0, 8, 1, 2, 3, 1, 0, 0, 0, 1],
        Policy::DeepDo => &[4, 2, 1, 4, 1, 0, 2, 9, 3, 0, 1, 0, 0, 0, 1],
        Policy::Arguments => &[4, 0, 1, 4, 0, 0, 2, 1, 1, 1, 8, 0, 0, 0, 1],
        Policy::NearRounding => &[9, 1, 1, 6, 1, 1, 4, 1, 1, 1, 1, 0, 1, 0, 1],
        Policy::Vacancy => &[6, 1, 1, 6, 1, 0, 5, 1, 1, 1, 3, 1, 1, 0, 1],
        Policy::Cycles => &[3, 0, 2, 3, 0, 0, 1, 2, 0, 0, 2, 8, 1, 1, 1, 0, 1],
        Policy::Offsets => &[3, 0, 2, 5, 1, 0, 1, 1, 0, 0, 1, 1, 9, 2, 1, 0, 1],
        Policy::Figures => &[2, 0, 1, 2, 2, 0, 1, 1, 0, 0, 1, 1, 1, 1, 0, 8, 6, 0, 0, 1],
        Policy::Calls => &[3, 0, 1, 3, 0, 0, 2, 1, 1, 1, 7, 0, 0, 0, 0, 1, 1, 5, 0, 1],
        Policy::Operator => &[3, 0, 0, 3, 0, 2, 3, 1, 0, 0, 1, 0, 1, 2, 1, 0, 0, 0, 9, 1],
        Policy::Words => &[2, 0, 1, 2, 1, 1, 2, 1, 0, 1, 1, 1, 1, 2, 1, 1, 0, 0, 0, 9],
        Policy::Beside => &[2, 0, 1, 3, 1, 1, 2, 1, 0, 0, 2, 1, 1, 2, 0, 1, 1, 1, 1, 0, 10],
        Policy::Reach => &[4, 2, 0, 3, 0, 0, 3, 2, 1, 1, 2, 0, 0, 0, 1, 0, 0, 1, 0, 2, 0, 5, 3, 3],
        Policy::Missing => &[3, 0, 1, 3, 0, 0, 2, 1, 0, 0, 8, 0, 0, 1, 1, 0, 0, 2, 0, 0, 0, 0, 0, 1],
        Policy::Units => &[3, 0, 2, 5, 1, 1, 2, 1, 0, 0, 3, 2, 3, 1, 1, 2, 2, 1, 0, 2, 0, 0, 0, 0, 3],
    }
}
