//! What runs compute, held against what is assumed of it: numbers of variables, codes, arguments of functions.

use super::assumed::Held;
use crate::assume::{Assumption, Predicate, Subscripts};
use crate::control::trace::Computed;
use crate::control::{ProgramRef, Run};
use crate::text::Span;
use crate::verify::sides::{Job, Side};

/// What a run computed in a program, in these blocks of it or anywhere.
pub(super) fn computed<'r, T: Copy>(
    all: &'r [Computed<T>],
    (side, program): (&'r Side<'_>, ProgramRef),
    run: &'r Run,
    places: Option<&'r [Span]>,
) -> impl Iterator<Item = Computed<T>> + 'r {
    let holds = |block: Span, place: &Span| {
        block.start <= place.start && place.start < block.end.max(block.start.saturating_add(1))
    };
    all.iter().copied().filter(move |one| {
        let here = places.is_none_or(|places| places.iter().any(|place| holds(one.at.span, place)));
        here && side.links().at(run, one.at.program) == Some(program)
    })
}

/// The first that is outside; else that all were inside.
pub(super) fn judged<T>(
    all: impl Iterator<Item = Computed<T>>,
    inside: impl Fn(&T) -> bool,
    words: impl Fn(&T) -> String,
) -> Held {
    let mut held = Held::Untried;
    for one in all {
        if !inside(&one.what) {
            match &held {
                Held::Broken { before, .. } if *before <= one.before => {}
                _ => held = Held::Broken { before: one.before, what: words(&one.what) },
            }
        } else if held == Held::Untried {
            held = Held::Kept;
        }
    }
    held
}

/// Whether a run never notes this letter at some blocks; `words` says what it did there.
pub(super) fn never(
    letter: char,
    (places, of): (&[Span], (&Side<'_>, ProgramRef)),
    run: &Run,
    words: impl Fn(f64) -> String,
) -> Held {
    let noted = computed(&run.computed_codes, of, run, Some(places)).filter(|one| one.what.0 == letter);
    match judged(noted, |_| false, |(_, number)| words(*number)) {
        Held::Untried => Held::Kept,
        held => held,
    }
}

/// The other numbers of variables that the blocks of one compute: a run tells which block computed a number, not for which.
pub(super) fn beside<'a>(all: &'a [Assumption], at: usize) -> Vec<&'a Subscripts> {
    let places = |one: &'a Assumption| match &one.predicate {
        Predicate::Subscripts(subscripts) => Some(subscripts),
        _ => None,
    };
    let Some(own) = all.get(at).and_then(places) else { return Vec::new() };
    let others = all.iter().enumerate().filter(|(other, _)| *other != at).filter_map(|(_, one)| places(one));
    others.filter(|other| other.places.iter().any(|place| own.places.contains(place))).collect()
}

/// Whether the numbers of variables that blocks compute stay in those that are assumed for one of them. A number may be one of
/// another variable of the block, but one at least must be its own.
pub(super) fn numbers(
    own: &Subscripts,
    beside: &[&Subscripts],
    of: (&Side<'_>, ProgramRef),
    run: &Run,
) -> Held {
    let here = || computed(&run.computed_numbers, of, run, Some(&own.places));
    let name = of.0.control.numbered().unwrap_or_default();
    let words = |number: &u32| format!("computes the variable {name}{number}");
    let is_own = |number: &u32| own.safe.contains(*number);
    let inside = |number: &u32| is_own(number) || beside.iter().any(|other| other.safe.contains(*number));
    match judged(here(), inside, words) {
        Held::Kept if !here().any(|one| is_own(&one.what)) => judged(here(), is_own, words),
        held => held,
    }
}

/// How far what a run of the source computes is from what an assumption of a program says, where a change of its inputs may
/// bring it nearer: 0 where it keeps it. None if it does not come there.
pub fn off(job: &Job<'_>, (program, at): (ProgramRef, usize), run: &Run) -> Option<f64> {
    let (all, of) = (job.assumptions.get(&program)?, (job.source, program));
    match &all.get(at)?.predicate {
        Predicate::Subscripts(own) => {
            let here = || computed(&run.computed_numbers, of, run, Some(&own.places)).map(|one| one.what);
            let beside = beside(all, at);
            let safe = |number: u32| {
                std::iter::once(own).chain(beside.iter().copied()).map(move |one| one.safe.distance(number))
            };
            let farthest =
                here().filter_map(|number| safe(number).min_by(f64::total_cmp)).max_by(f64::total_cmp)?;
            let nearest = here().map(|number| own.safe.distance(number)).min_by(f64::total_cmp)?;
            Some(farthest.max(nearest))
        }
        Predicate::Codes { letter, places, same } => {
            let here =
                computed(&run.computed_codes, of, run, Some(places)).filter(|one| one.what.0 == *letter);
            let nearest = |number: f64| same.iter().map(|code| (code - number).abs()).min_by(f64::total_cmp);
            here.filter_map(|one| nearest(one.what.1)).max_by(f64::total_cmp)
        }
        _ => None,
    }
}
