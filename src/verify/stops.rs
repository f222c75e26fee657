//! Where a control stops a program: the source's, so that the program says nothing of what the target should do, or the
//! target's, where a condition of the conversion is broken; and where a run breaks one without an alarm.

use super::compare::Difference;
use super::names::Side;
use crate::canon::Func;
use crate::control::trace::{Event, Happening};
use crate::control::{End, Run};

/// How the facts begin that say which numbers a computed variable must have.
const NUMBERS: &str = "numbers:";

/// How the facts begin that say which arguments a function must have; its name follows.
const ARGUMENTS: &str = "arguments:";

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
        Happening::Arc { off, .. } => Some(off.abs()).filter(|off| *off > MOST_OFF),
        _ => None,
    }
}

/// The limit of the target that calls of the source nest deeper than, and how many levels that allows, where the target's
/// alarm about it is what differs.
pub fn nests_too_deep(run: &Run, other: &Run, difference: &Difference<'_>) -> Option<(&'static str, u32)> {
    let End::Alarm { stop, .. } = &other.end else { return None };
    let (limit, most) = stop.nesting?;
    let is = |event: Option<&Event>, other: &Event| event.is_some_and(|event| std::ptr::eq(event, other));
    if !is(difference.target, other.events.last()?) {
        return None;
    }
    let (mut depth, mut deepest) = (0, 0);
    for event in &run.events {
        match event.what {
            Happening::Enter { .. } => depth += 1,
            Happening::Leave => depth -= 1,
            _ => {}
        }
        deepest = deepest.max(depth);
        if is(difference.source, event) {
            break;
        }
    }
    (deepest > i64::from(most)).then_some((limit, most))
}

/// What the conversion made a condition and the run breaks, without an alarm, before the difference; `reported` has what
/// it said of the files that ran.
pub fn breaks_a_condition<'r>(
    source: (&Side<'_>, &Run),
    target: (&Side<'_>, &Run),
    difference: &Difference<'_>,
    reported: impl Iterator<Item = &'r str>,
) -> Option<String> {
    if let Some(code) = computes_another_code(source, target, difference) {
        let text = "which does not mean the same on the target: it must never do that";
        return Some(format!("a run computes the code {code}, {text}"));
    }
    let reported: Vec<&str> = reported.collect();
    if let Some(call) = leaves_its_domain(source.1, difference, &reported) {
        let text = "for which the conversion does not hold: it must never do that";
        return Some(format!("a run computes {call}, {text}"));
    }
    let number = leaves_its_numbers(source.1, difference, reported.into_iter())?;
    let text = "which is none of those that the conversion takes it to be: it must never do that";
    Some(format!("a run computes the variable #{number}, {text}"))
}

/// How many events come before a difference; none where the source came to its end before.
fn place(run: &Run, difference: &Difference<'_>) -> Option<usize> {
    difference.source.and_then(|event| run.events.iter().position(|e| std::ptr::eq(e, event)))
}

/// The function that the source gave arguments before a difference which are none of those reported.
fn leaves_its_domain(run: &Run, difference: &Difference<'_>, reported: &[&str]) -> Option<String> {
    let at = place(run, difference);
    let before = run.arguments.iter().filter(|(.., before)| at.is_none_or(|at| *before <= at));
    before.into_iter().find_map(|(function, [a, b], _)| {
        let prefix = format!("{ARGUMENTS}{}:", function.name());
        let outside = reported
            .iter()
            .any(|fact| fact.strip_prefix(prefix.as_str()).is_some_and(|kind| !is_inside(kind, [*a, *b])));
        let call = if *function == Func::Pow {
            format!("POW[{a},{b}]")
        } else {
            format!("{}[{a}]", function.name().to_uppercase())
        };
        outside.then_some(call)
    })
}

/// True for arguments of a kind: a range; `digits`, eight of them; a `word` of eight BCD digits; or a range of the base and
/// one of the power times its logarithm.
fn is_inside(kind: &str, [a, b]: [f64; 2]) -> bool {
    let within = |range: &str, value: f64| {
        let (from, to) = range.split_once("..").unwrap_or((range, range));
        let bound = |text: &str| text.parse().unwrap_or(f64::NAN);
        (bound(from)..=bound(to)).contains(&value)
    };
    match kind.split_once(' ') {
        Some((base, power)) => within(base, a) && within(power, b * a.ln()),
        None if kind == "digits" => a.fract() == 0.0 && (0.0..=99_999_999.0).contains(&a),
        None if kind == "word" => {
            let digit = |at: u32| (a as u64 >> (4 * at)) & 15 <= 9;
            a.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&a) && (0..8).all(digit)
        }
        None => within(kind, a),
    }
}

/// The number of a variable that the source computed before a difference and that is none of those reported.
fn leaves_its_numbers<'r>(
    run: &Run,
    difference: &Difference<'_>,
    reported: impl Iterator<Item = &'r str>,
) -> Option<u32> {
    let mut runs: Vec<(u32, u32)> = Vec::new();
    for run in reported.filter_map(|fact| fact.strip_prefix(NUMBERS)).flat_map(|list| list.split(", ")) {
        let (first, last) = run.split_once('-').unwrap_or((run, run));
        let number = |text: &str| text.trim_start_matches('#').parse().ok();
        runs.extend(number(first).zip(number(last)));
    }
    let at = place(run, difference);
    let before = run.computed_numbers.iter().filter(|(_, before)| at.is_none_or(|at| *before <= at));
    let outside = |number: u32| !runs.iter().any(|(first, last)| (*first..=*last).contains(&number));
    before.map(|(number, _)| *number).find(|number| !runs.is_empty() && outside(*number))
}

/// The code that both sides computed before they differ and that does not mean the same on both, where there is one.
fn computes_another_code(
    (source, run): (&Side<'_>, &Run),
    (target, other): (&Side<'_>, &Run),
    difference: &Difference<'_>,
) -> Option<String> {
    let at = place(run, difference);
    let both = run.computed_codes.iter().filter(|(letter, number, before)| {
        let theirs = other.computed_codes.iter().any(|(there, same, _)| (there, same) == (letter, number));
        theirs && at.is_none_or(|at| *before <= at)
    });
    both.copied().find_map(|(letter, number, _)| {
        let here = source.control.code(letter, number, &[])?;
        let there = target.control.code(letter, number, &[]);
        let same = there.is_some_and(|there| {
            (here.op, &here.words, &here.fixed) == (there.op, &there.words, &there.fixed)
        });
        (!same).then(|| format!("{letter}{number}"))
    })
}

/// True where the difference lies at the alarm that ended the source, not before it.
fn at_the_end(run: &Run, difference: &Difference<'_>) -> bool {
    match (difference.source, run.events.last()) {
        (Some(event), Some(last)) => std::ptr::eq(event, last),
        (None, _) => true,
        _ => false,
    }
}
