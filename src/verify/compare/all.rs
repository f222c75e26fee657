//! All that differs between two runs, not the first difference alone.
//!
//! Two runs are walked through as far as they go together, by the same rules as where one difference is enough. At a
//! difference the walk goes on at the next pair of an alignment of both runs: what stands before that on one side was
//! added or taken out, and what is paired there was changed.

use super::aligned::{Blocks, aligned};
use super::exit_state::left_differs;
use super::kinds::is_cut;
use super::loose::{Found, farthest};
use super::observe::{Act, What};
use super::pairs::{Pairs, acts};
use super::paths::{apart, ends};
use super::shown::end_differs;
use super::tolerance::Tolerance;
use super::variables::all_variables;
use crate::control::Run;
use crate::control::trace::{Event, EventKind, Spindle, Told};
use crate::verify::sides::{Side, SymbolMap};
use std::borrow::Cow;
use std::collections::BTreeSet;

/// What one side does and the other does not, or does otherwise.
#[derive(Clone, Debug)]
pub struct Apart<'r> {
    /// The block and what is seen of it on the source; none for what the target alone does.
    pub source: Option<(&'r Event, Cow<'r, EventKind>)>,
    /// The same on the target.
    pub target: Option<(&'r Event, Cow<'r, EventKind>)>,
    /// What differs, in words.
    pub what: String,
    /// True for what was found in force at the start, and counts only where something else needs it.
    found: bool,
}

/// The differences of two runs, at the most so many, and what differs at their ends. With `strict`, what lies apart by
/// less than a least increment differs too.
pub fn differences<'r>(
    source: (&Side<'_>, &'r Run),
    target: (&Side<'_>, &'r Run),
    names: &SymbolMap,
    (tolerance, strict): (Tolerance, bool),
    most: usize,
) -> (Vec<Apart<'r>>, Vec<String>) {
    let cut = is_cut(source.1) || is_cut(target.1);
    let [ours, theirs] = farthest([source.1, target.1], |orders| {
        let sides = acts(source, target, orders);
        let mut pairs = Pairs::new((source.0, target.0), names, tolerance);
        pairs.strict = strict;
        let (i, j) = pairs.walk(&sides[0], &sides[1], cut);
        let blocks = pairs.found.difference.as_ref().map(|found| [found.source, found.target]);
        let is_one = blocks.is_some();
        let blocks = blocks.unwrap_or_default().map(|event| event.map(|event| event.at));
        Found { what: sides, pairs: is_one.then_some(i + j), blocks }
    });
    let told = |(side, run): (&Side<'_>, &Run), acts: &[Act<'_>]| {
        acts.iter().map(|act| block(side, run, act.event)).collect::<Vec<_>>()
    };
    let met = aligned(
        &Blocks { acts: &ours, blocks: told(source, &ours) },
        &Blocks { acts: &theirs, blocks: told(target, &theirs) },
        tolerance.rounded,
    );
    let mut pairs = Pairs::new((source.0, target.0), names, tolerance);
    pairs.strict = strict;
    // Where no message came to the target, one that follows a stop is no other way of that stop.
    let messages =
        |acts: &[Act<'_>]| acts.iter().filter(|act| matches!(*act.what, EventKind::Message { .. })).count();
    pairs.shows_more = messages(&theirs) > messages(&ours);
    let (mut i, mut j, mut out) = (0, 0, Vec::new());
    while out.len() < most {
        let (here, there) = (ours.get(i..).unwrap_or_default(), theirs.get(j..).unwrap_or_default());
        let (di, dj) = pairs.walk(here, there, cut);
        (i, j) = (i + di, j + dj);
        let Some(difference) = pairs.found.difference.take() else { break };
        let next = met.partition_point(|(p, q)| *p < i || *q < j);
        let (p, q) = met.get(next).copied().unwrap_or((ours.len(), theirs.len()));
        if let (true, Some(a), Some(b)) = ((p, q) == (i, j), ours.get(i), theirs.get(j)) {
            if out.is_empty() || !(starts_elsewhere(a, b, tolerance.rounded) || both_stand(a, b)) {
                out.push(Apart { source: seen(a), target: seen(b), what: difference.what, found: false });
            }
            pairs.moved(0, a);
            pairs.moved(1, b);
            (i, j) = (i + 1, j + 1);
            continue;
        }
        for act in ours.get(i..p).unwrap_or_default() {
            out.push(Apart {
                source: seen(act),
                target: None,
                what: "taken out".into(),
                found: was_found(act),
            });
            pairs.moved(0, act);
        }
        for act in theirs.get(j..q).unwrap_or_default() {
            out.push(Apart { source: None, target: seen(act), what: "added".into(), found: was_found(act) });
            pairs.moved(1, act);
        }
        // A side that has nothing left goes no farther.
        if (p, q) == (i, j) {
            break;
        }
        (i, j) = (p, q);
    }
    if out.iter().any(|apart| !apart.found) {
        out.retain(|apart| !apart.found);
    }
    if cut {
        return (out, Vec::new());
    }
    let end = end_differs(&source.1.end, &target.1.end);
    let variables = all_variables(source, target, names).into_iter().map(|found| found.what);
    let left = left_differs(source, target, tolerance, &mut BTreeSet::new(), &mut BTreeSet::new());
    // All of it is said of the end.
    let all = end.into_iter().chain(variables).chain(left);
    let at_end = all.map(|what| match what.split_once(" at the end, ") {
        Some((old, new)) => format!("{old} in the old program, {new} in the new one"),
        None => what.trim_end_matches(" at the end").to_owned(),
    });
    let at_end = at_end.collect();
    (out, at_end)
}

fn was_found(act: &Act<'_>) -> bool {
    act.told == Told::Found
}

fn seen<'r>(act: &Act<'r>) -> Option<(&'r Event, Cow<'r, EventKind>)> {
    let what = match &act.what {
        What::Own(what) => Cow::Borrowed(*what),
        What::Other(what) => Cow::Owned((**what).clone()),
    };
    Some((act.event, what))
}

/// The text of an event's block, without its sequence number and blanks.
fn block(side: &Side<'_>, run: &Run, event: &Event) -> String {
    let file = run.programs.get(event.at.program as usize).map(|program| program.file);
    let source = file.and_then(|file| side.source(file)).unwrap_or_default();
    let text = String::from_utf8_lossy(event.at.span.of(source));
    let text: String = text.chars().filter(|sign| !sign.is_whitespace()).collect();
    let rest =
        text.strip_prefix(['N', 'n']).map(|rest| rest.trim_start_matches(|c: char| c.is_ascii_digit()));
    rest.map_or(text.clone(), str::to_owned)
}

/// True for two spindles that stand: what they turned by before was told where they turned.
fn both_stand(a: &Act<'_>, b: &Act<'_>) -> bool {
    [a, b].iter().all(|act| matches!(*act.what, EventKind::Spindle { direction: Spindle::Stopped, .. }))
}

/// True for two rapid moves to one place, of which only the starts differ: what was told before put the tool there.
fn starts_elsewhere(a: &Act<'_>, b: &Act<'_>, allowed: f64) -> bool {
    let both = matches!((&*a.what, &*b.what), (EventKind::Rapid { .. }, EventKind::Rapid { .. }));
    both && ends(&a.what).zip(ends(&b.what)).is_some_and(|((_, a), (_, b))| apart(&a, &b) <= allowed)
}
