//! Tries on runs what a conversion supposes.
//!
//! A conversion is right for the runs of the source that keep its assumptions. So what comes after the place where the
//! source breaks one is not held against it; what the target alone does otherwise is. Nothing else of a conversion is
//! known here.

use super::computed::{beside, computed, judged, never, numbers};
use super::standing::stands;
use crate::assume::{Assumption, Predicate};
use crate::canon::Op;
use crate::control::trace::{Event, EventKind, LONE_LENGTH, ODD_SPEED};
use crate::control::{End, ProgramRef, Run};
use crate::text::Span;
use crate::verify::compare::{Difference, is_move, is_pause, setting};
use crate::verify::sides::{Assumptions, Job, Side, SymbolMap};
use std::collections::BTreeSet;
use std::sync::Arc;

/// What a run shows of an assumption.
#[derive(Clone, Debug, PartialEq)]
pub enum Held {
    /// It did not come to it.
    Untried,
    /// It kept it.
    Kept,
    /// It broke it.
    Broken {
        /// How many events came before.
        before: usize,
        /// What the run did, in words.
        what: String,
    },
}

/// What two runs show of an assumption.
#[derive(Clone, Debug)]
pub struct Tried<'a> {
    /// The program whose assumption it is.
    pub program: ProgramRef,
    /// Its place among those of the program.
    pub at: usize,
    /// The assumption.
    pub assumption: &'a Assumption,
    /// The source's run.
    pub source: Held,
    /// The target's.
    pub target: Held,
    /// How many events came before the target did first what it is about; none if it does nothing of the kind.
    since: Option<usize>,
}

impl Tried<'_> {
    /// True where one of the runs broke it.
    pub fn is_broken(&self) -> bool {
        [&self.source, &self.target].into_iter().any(|held| matches!(held, Held::Broken { .. }))
    }

    /// True where the source kept it, and the target did not break it.
    pub fn is_kept(&self) -> bool {
        self.source == Held::Kept && !self.is_broken()
    }
}

/// Tries what the programs suppose that a run of the source came through.
pub fn tried<'j>(job: &Job<'j>, run: &Run, other: &Run) -> Vec<Tried<'j>> {
    let entered: BTreeSet<ProgramRef> = job.source.links().entered(run).collect();
    let all = entered.into_iter().filter_map(|program| Some((program, job.assumptions.get(&program)?)));
    let tried = all.flat_map(|(program, all)| {
        let there = job.names.program(job.source, program, job.target);
        all.iter().enumerate().map(move |(at, assumption)| Tried {
            program,
            at,
            assumption,
            source: match &assumption.predicate {
                Predicate::Subscripts(own) => numbers(own, &beside(all, at), (job.source, program), run),
                predicate => on_source(predicate, (job.source, program), run),
            },
            target: on_target(&assumption.predicate, there.map(|there| (job.target, there)), other),
            since: there.and_then(|there| since(&assumption.predicate, (job.target, there), other)),
        })
    });
    tried.collect()
}

/// The facts that programs take to be as the tables have them, of those that a run came through.
pub fn facts(job: &Job<'_>, run: &Run) -> BTreeSet<Arc<str>> {
    let all = job.source.links().entered(run).filter_map(|program| job.assumptions.get(&program)).flatten();
    all.filter_map(|assumption| assumption.predicate.fact()).collect()
}

/// The operations of which it is told that the target has none, in the programs that a run came through.
pub fn told_substitutes(job: &Job<'_>, run: &Run) -> BTreeSet<Op> {
    let all = job.source.links().entered(run).filter_map(|program| job.assumptions.get(&program)).flatten();
    let told = all.filter_map(|assumption| match assumption.predicate {
        Predicate::Substitute(op) => Some(op),
        _ => None,
    });
    told.collect()
}

/// Why a difference is not held against the conversion: what the source did before it, or in it. None where it kept all
/// that is assumed so far, or the target was not there yet.
pub fn excuse(tried: &[Tried<'_>], run: &Run, other: &Run, difference: &Difference<'_>) -> Option<String> {
    let place_in = |run: &Run, at: Option<&Event>| {
        let at = run.events.iter().position(|e| at.is_some_and(|event| std::ptr::eq(e, event)))?;
        Some(counts_at(run, at))
    };
    let (place, there) = (place_in(run, difference.source), place_in(other, difference.target));
    let too_deep = matches!(&other.end, End::Alarm { stop, .. } if stop.nesting.is_some());
    tried.iter().find_map(|tried| match &tried.source {
        Held::Broken { before, what }
            if place.is_none_or(|place| *before <= place)
                && (there.zip(tried.since).is_none_or(|(there, since)| since <= there)) =>
        {
            // Levels count only where the target ran out of them.
            let counts = too_deep || !matches!(tried.assumption.predicate, Predicate::Nesting { .. });
            counts.then(|| {
                format!("a run {what}, against a condition of the conversion: {}", tried.assumption.text)
            })
        }
        _ => None,
    })
}

/// Where in a run an event counts: a setting does at the next move or stop, which may be what one side alone does.
fn counts_at(run: &Run, at: usize) -> usize {
    if run.events.get(at).is_none_or(|event| setting(&event.what).is_none()) {
        return at;
    }
    let acts = |event: &Event| is_move(&event.what) || is_pause(&event.what);
    let next = run.events.iter().skip(at).position(acts);
    next.map_or(run.events.len().saturating_sub(1), |after| at + after)
}

/// What a run of the source shows.
fn on_source(predicate: &Predicate, of: (&Side<'_>, ProgramRef), run: &Run) -> Held {
    match predicate {
        // The emulated controls go by the tables, and both sides are set to one unit and found with the tool.
        Predicate::Fact(_)
        | Predicate::Unit
        | Predicate::SetTo(_)
        | Predicate::Start(_)
        | Predicate::Main
        | Predicate::Loaded(_)
        | Predicate::Holds(..)
        | Predicate::Setting(..)
        | Predicate::TurnedSetting(..) => Held::Kept,
        // Those of one block are looked at together.
        Predicate::Substitute(_) | Predicate::OfMachine(_) | Predicate::Unseen | Predicate::Subscripts(_) => {
            Held::Untried
        }
        Predicate::Arguments { function, places, domain } => {
            let here = computed(&run.arguments, of, run, Some(places)).filter(|one| one.what.0 == *function);
            judged(here, |(_, arguments)| domain.contains(*arguments), call)
        }
        Predicate::Codes { letter, places, same } => {
            let here =
                computed(&run.computed_codes, of, run, Some(places)).filter(|one| one.what.0 == *letter);
            judged(here, |(_, number)| same.contains(number), |(l, n)| format!("computes the code {l}{n}"))
        }
        Predicate::Nesting { counts, most, .. } => nesting(run, *counts, *most),
        Predicate::Alarms(most) => alarm(run, of, *most),
        Predicate::WholeSpeeds(places) => {
            never(ODD_SPEED, (places, of), run, |speed| format!("turns at {speed}"))
        }
        Predicate::LengthAxis(places) => {
            let what = "names a tool length where the word of its axis is vacant";
            never(LONE_LENGTH, (places, of), run, |_| what.into())
        }
        Predicate::ShortArcs(places) => arcs(run, of, places, |sweep, _| {
            (sweep.abs() > 180.0 + 1e-6).then(|| format!("passes an arc of {:.0} degrees", sweep.abs()))
        }),
        Predicate::ArcEnds(places) => arcs(run, of, places, |_, off| {
            (off.abs() > OFF_ARC).then(|| format!("ends an arc {:.4} mm off it", off.abs()))
        }),
        Predicate::Pecks(places) => pecks(run, of, places),
        Predicate::Levels(places, along) => levels(run, of, places, *along),
        Predicate::Tools(places) => tools(run, of, places),
        Predicate::Stands(places) => stands(run, of, places),
    }
}

/// What a run of the target shows. Where its blocks came from is not known here: whatever its program does counts.
/// Registers that its subscripts reach are compared by what comes of them.
fn on_target(predicate: &Predicate, of: Option<(&Side<'_>, ProgramRef)>, run: &Run) -> Held {
    let Some(of) = of else { return Held::Untried };
    match predicate {
        Predicate::Fact(_)
        | Predicate::Unit
        | Predicate::SetTo(_)
        | Predicate::Start(_)
        | Predicate::Main
        | Predicate::Loaded(_)
        | Predicate::Holds(..)
        | Predicate::Setting(..)
        | Predicate::TurnedSetting(..)
        | Predicate::ShortArcs(_)
        | Predicate::WholeSpeeds(_)
        | Predicate::ArcEnds(_)
        | Predicate::Pecks(_)
        | Predicate::Levels(..)
        | Predicate::Tools(_)
        | Predicate::Stands(_)
        | Predicate::LengthAxis(_)
        | Predicate::Substitute(_)
        | Predicate::OfMachine(_)
        | Predicate::Unseen
        | Predicate::Subscripts(_) => Held::Untried,
        Predicate::Arguments { function, domain, .. } => {
            let here = computed(&run.arguments, of, run, None).filter(|one| one.what.0 == *function);
            judged(here, |(_, arguments)| domain.contains(*arguments), call)
        }
        Predicate::Codes { letter, same, .. } => {
            let here = computed(&run.computed_codes, of, run, None).filter(|one| one.what.0 == *letter);
            judged(here, |(_, number)| same.contains(number), |(l, n)| format!("computes the code {l}{n}"))
        }
        Predicate::Nesting { .. } => match &run.end {
            End::Alarm { stop, .. } if stop.nesting.is_some() => Held::Broken {
                before: run.events.len().saturating_sub(1),
                what: "nests calls too deep".into(),
            },
            _ => Held::Kept,
        },
        Predicate::Alarms(most) => alarm(run, of, *most),
    }
}

/// How many events come before a run does first what an assumption is about.
fn since(predicate: &Predicate, of: (&Side<'_>, ProgramRef), run: &Run) -> Option<usize> {
    match predicate {
        Predicate::Subscripts(_) => {
            computed(&run.computed_numbers, of, run, None).map(|one| one.before).min()
        }
        Predicate::Codes { .. } => computed(&run.computed_codes, of, run, None).map(|one| one.before).min(),
        _ => None,
    }
}

fn call((function, [a, b]): &(crate::canon::Func, [f64; 2])) -> String {
    match function {
        crate::canon::Func::Pow => format!("computes POW[{a},{b}]"),
        _ => format!("computes {}[{a}]", function.name().to_uppercase()),
    }
}

/// How deep calls nest in a run, of the kinds that count.
fn nesting(run: &Run, counts: [bool; 2], most: u32) -> Held {
    let mut open: Vec<bool> = Vec::new();
    for (before, event) in run.events.iter().enumerate() {
        match event.what {
            EventKind::Enter { level, .. } => open.push(counts[usize::from(level)]),
            EventKind::Leave => drop(open.pop()),
            _ => continue,
        }
        let depth = open.iter().filter(|counts| **counts).count();
        if depth > most as usize {
            let what = format!("nests calls {depth} deep, more than the {most} levels of the target");
            return Held::Broken { before, what };
        }
    }
    Held::Kept
}

/// How far from its arc an end may lie that rounding alone puts off it, millimetres.
const OFF_ARC: f64 = 0.002;

/// Whether the arcs of some blocks are as they are assumed to be: `broken` says of a sweep, and of how far the end lies off
/// the arc, what is wrong with it.
fn arcs(
    run: &Run,
    (side, program): (&Side<'_>, ProgramRef),
    places: &[Span],
    broken: impl Fn(f64, f64) -> Option<String>,
) -> Held {
    let mut held = Held::Untried;
    for (before, event) in run.events.iter().enumerate() {
        let EventKind::Arc { sweep, off, .. } = event.what else { continue };
        let block = event.at.span;
        let here = |place: &Span| block.start <= place.start && place.start < block.end.max(block.start + 1);
        if !places.iter().any(here) || side.links().at(run, event.at.program) != Some(program) {
            continue;
        }
        if let Some(what) = broken(sweep, off) {
            return Held::Broken { before, what };
        }
        held = Held::Kept;
    }
    held
}

/// Whether some blocks change to tools that have a number.
fn tools(run: &Run, (side, program): (&Side<'_>, ProgramRef), places: &[Span]) -> Held {
    let mut held = Held::Untried;
    for (before, event) in run.events.iter().enumerate() {
        let EventKind::ToolChange { tool } = event.what else { continue };
        let block = event.at.span;
        let here = |place: &Span| block.start <= place.start && place.start < block.end.max(block.start + 1);
        if !places.iter().any(here) || side.links().at(run, event.at.program) != Some(program) {
            continue;
        }
        if tool < 1.0 || tool.fract() != 0.0 {
            return Held::Broken { before, what: format!("changes to the tool {tool}") };
        }
        held = Held::Kept;
    }
    held
}

/// Whether peck cycles of some blocks have pecks: where they are told none, the hole is one of a cycle without.
fn pecks(run: &Run, (side, program): (&Side<'_>, ProgramRef), places: &[Span]) -> Held {
    let mut held = Held::Untried;
    for (before, event) in run.events.iter().enumerate() {
        let EventKind::Hole { cycle, .. } = event.what else { continue };
        let block = event.at.span;
        let here = |place: &Span| block.start <= place.start && place.start < block.end.max(block.start + 1);
        if !places.iter().any(here) || side.links().at(run, event.at.program) != Some(program) {
            continue;
        }
        if cycle == Op::CycleDrill {
            // The block moves before it drills.
            let other = run.events.iter().take(before).rposition(|event| event.at.span != block);
            let before = other.map_or(0, |last| last + 1);
            return Held::Broken { before, what: "drills pecks without a depth".into() };
        }
        held = Held::Kept;
    }
    held
}

/// Whether drilling cycles of some blocks begin at their plane or beyond it: the tool goes to the plane before it drills.
fn levels(run: &Run, (side, program): (&Side<'_>, ProgramRef), places: &[Span], along: usize) -> Held {
    let mut held = Held::Untried;
    for (at, event) in run.events.iter().enumerate() {
        let EventKind::Hole { at: plane, bottom, .. } = event.what else { continue };
        let block = event.at.span;
        let here = |place: &Span| block.start <= place.start && place.start < block.end.max(block.start + 1);
        if !places.iter().any(here) || side.links().at(run, event.at.program) != Some(program) {
            continue;
        }
        let first = run.events.iter().take(at).rposition(|event| event.at.span != block);
        let before = first.map_or(0, |last| last + 1);
        let goes = run.events.iter().take(at).skip(before).any(|event| {
            let EventKind::Rapid { from, .. } = &event.what else { return false };
            (from.0[along] - plane.0[along]) * (bottom - plane.0[along]) > 0.0
        });
        if goes {
            return Held::Broken { before, what: "begins a drilling cycle below its retract plane".into() };
        }
        held = Held::Kept;
    }
    held
}

/// Whether the number of the alarm that a program ended a run with is small enough.
fn alarm(run: &Run, (side, program): (&Side<'_>, ProgramRef), most: f64) -> Held {
    match &run.end {
        End::Alarm { at, stop } if side.links().at(run, at.program) == Some(program) => {
            match stop.program_number {
                Some(number) if number > most => Held::Broken {
                    before: run.events.len().saturating_sub(1),
                    what: format!("raises the alarm {number}"),
                },
                Some(_) => Held::Kept,
                None => Held::Untried,
            }
        }
        _ => Held::Untried,
    }
}

/// Numbers that scenarios must try for what is assumed of a program, and of those that a person would say it calls.
pub fn telling_numbers(assumptions: &Assumptions, program: ProgramRef, names: &SymbolMap) -> Vec<f64> {
    let held: Vec<u32> = names.variables.values().copied().collect();
    let all = assumptions.get(&program).into_iter().flatten();
    all.flat_map(|assumption| assumption.predicate.telling_numbers(&held)).collect()
}

/// What these programs suppose, where the places of one of them stand elsewhere now.
pub fn moved(
    assumptions: &Assumptions,
    programs: impl Iterator<Item = ProgramRef>,
    edited: ProgramRef,
    now: impl Fn(u32) -> u32,
) -> Assumptions {
    let supposed = |program: ProgramRef| Some((program, assumptions.get(&program)?.clone()));
    let mut moved: Assumptions = programs.filter_map(supposed).collect();
    for assumption in moved.get_mut(&edited).into_iter().flatten() {
        let places = assumption.predicate.places_mut().into_iter().flatten();
        for place in places.chain([&mut assumption.place]) {
            (place.start, place.end) = (now(place.start), now(place.end));
        }
    }
    moved
}
