//! By which numbers of variables two controls mean the same, in runs: memory does not grow with the largest number.

use super::meaning::{Meaning, State, last_number, meaning_by};
use crate::canon::{Pause, Running, Sys};
use crate::dialect::Control;
use crate::legalize::variables::state::tables_differ;

/// Numbers up to here are looked at one by one; most system variables are there.
const DENSE: u32 = 99_999;

/// Numbers one after the other that compare alike.
#[derive(Debug)]
pub(super) struct Run {
    pub(super) first: u32,
    pub(super) last: u32,
    /// True where both controls mean the same, none where neither means anything.
    pub(super) alike: Option<bool>,
    /// True where the source means something.
    pub(super) here: bool,
}

/// The runs of all numbers up to the source's last, in order and without gaps.
pub(super) fn compared(source: &Control, target: &Control) -> Vec<Run> {
    let last = last_number(source);
    let mut runs = Vec::new();
    let dense = last.min(DENSE);
    let states = |control| all_states(control, dense);
    let (ours, theirs) = (states(source), states(target));
    let mut bounds = [source.numbered_bounds(), target.numbered_bounds()].concat();
    bounds.retain(|bound| *bound <= last);
    bounds.extend([0, dense + 1, last.saturating_add(1)]);
    bounds.sort_unstable();
    bounds.dedup();
    for (first, end) in bounds.iter().zip(bounds.iter().skip(1)) {
        // Only variables of the system differ within bounds, and results of programs that stand in the target's machine.
        let moved = !target.standing_results().is_empty() && *first <= dense;
        let each = moved || source.holds_states(*first) || target.holds_states(*first);
        let step = if each { 1 } else { end - first };
        let mut number = *first;
        while number < *end {
            let found = if number > dense {
                let [our, their] = [source, target].map(|control| control.numbered_state(number));
                same(source, target, number, our.as_ref(), their.as_ref())
            } else {
                let [our, their] =
                    [&ours, &theirs].map(|of| of.get(number as usize).and_then(Option::as_ref));
                same(source, target, number, our, their)
            };
            add(&mut runs, number, number + step - 1, found);
            number += step;
        }
    }
    runs
}

fn all_states(control: &Control, last: u32) -> Vec<Option<State<'_>>> {
    control.numbered().map(|name| control.read_all_system(name, last)).unwrap_or_default()
}

fn add(runs: &mut Vec<Run>, first: u32, last: u32, (alike, here): (Option<bool>, bool)) {
    match runs.last_mut() {
        Some(run) if run.alike == alike && run.here == here => run.last = last,
        _ => runs.push(Run { first, last, alike, here }),
    }
}

/// How the controls compare in a number, and whether the source means something by it.
fn same(
    source: &Control,
    target: &Control,
    number: u32,
    our: Option<&State<'_>>,
    their: Option<&State<'_>>,
) -> (Option<bool>, bool) {
    let (here, there) = (meaning_by(source, number, our), meaning_by(target, number, their));
    let alike = match &here {
        None if there.is_none() => None,
        Some(Meaning::State(Sys::Other, _)) if source.name() != target.name() => Some(false),
        Some(Meaning::State(Sys::StopMessage, _)) if !stops_alike(source, target) => Some(false),
        Some(Meaning::State(state, _)) if tables_differ(*state, source, target) => Some(false),
        // A number that is written there may be one that the target does not take.
        Some(Meaning::State(state, _)) if takes_less(source, target, *state) => Some(false),
        Some(Meaning::State(..)) => {
            let accessible = |c| access(their).contains(c);
            Some(here == there && access(our).chars().all(accessible))
        }
        _ => Some(here == there && !target.is_numbered_reserved(number) && !is_moved(source, target, number)),
    };
    (alike, here.is_some())
}

/// True for a variable whose number is another one on the target, or that of another variable there: results of programs that
/// stand in its machine.
pub(super) fn is_moved(source: &Control, target: &Control, number: u32) -> bool {
    let cell = |control: &Control| control.numbered().map_or(number, |name| control.cell(name, number));
    let is_common =
        source.numbered_class(cell(source)).is_some_and(|row| row.class != "local" && row.class != "letter");
    is_common && target.standing_results().parts(cell(source), cell(target))
}

/// True for state that the source may set to a larger number than the target takes.
fn takes_less(source: &Control, target: &Control, state: Sys) -> bool {
    let most = |control: &Control| control.system_run(state).and_then(|row| row.most);
    most(target).is_some_and(|most_there| most(source).is_none_or(|most_here| most_here > most_there))
}

fn access<'s>(state: Option<&'s State<'_>>) -> &'s str {
    state.map_or("", |(.., row)| row.access.as_str())
}

/// True if a message of the target ends whatever one of the source is known to end. Where the number is computed, nothing
/// can be written before it.
fn stops_alike(source: &Control, target: &Control) -> bool {
    Running::ALL.into_iter().all(|running| {
        let [here, there] = [source, target].map(|control| control.ends(Pause::Message, running).answer);
        here.is_none() || here == there
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_says_of_each_number_what_it_says_of_its_first() {
        let control = |name: &str| Control::plain(name).unwrap();
        for (source, target) in [("fanuc", "haas"), ("haas", "fanuc"), ("fanuc", "fadal")] {
            let (source, target) = (control(source), control(target));
            let runs = compared(&source, &target);
            assert_eq!(runs.first().map(|run| run.first), Some(0));
            assert!(runs.windows(2).all(|two| two[0].last + 1 == two[1].first), "no gaps");
            for run in runs.iter().filter(|run| run.first < 20_000) {
                for number in run.first..=run.last.min(20_000) {
                    let [our, their] = [&source, &target].map(|control| control.numbered_state(number));
                    let own = same(&source, &target, number, our.as_ref(), their.as_ref());
                    assert_eq!(own, (run.alike, run.here), "#{number}");
                }
            }
        }
    }
}
