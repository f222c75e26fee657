//! All the places at which two programs differ, in many scenarios.
//!
//! The scenarios are those of the search. Each is run as it is, where every offset and tool has a size of its own, and once
//! more with the part's zero at the machine's and no tool sizes: positions then are those that the program says, which a
//! person can read.

use super::verifier::{Pair, Verifier};
use crate::canon::{Group, Op};
use crate::control::scenario::Scenario;
use crate::control::trace::{Event, EventKind};
use crate::control::{ProgramRef, Run};
use crate::verify::certificate::{Change, Listing, Moment, Seen, Witness};
use crate::verify::compare::{Apart, compare, differences, is_cut};
use crate::verify::explore::{Proposals, inputs_of_both, unit};
use crate::verify::sides::{Job, Side};
use std::collections::{BTreeMap, HashMap};
use std::mem::{Discriminant, discriminant};

/// Scenarios that are looked at, at the most.
const SCENARIOS: usize = 40;

/// Scenarios after the last one that showed a new place.
const BARREN: usize = 16;

/// Differences of one pair of runs that are looked at, for each place that has room.
const OF_A_RUN: usize = 50;

/// Lists the places at which a program of the source and its counterpart differ, at the most so many; the circumstances
/// of a `witness` first.
pub fn listed(job: &Job<'_>, program: ProgramRef, witness: Option<&Witness>, most: usize) -> Listing {
    let verifier = Verifier::new(job, program);
    match job.names.program(job.source, program, job.target) {
        Some(there) => verifier.listed(there, witness, most),
        None => Listing::default(),
    }
}

/// The blocks of both sides, and what they do.
type Place = [Option<(usize, u32, Discriminant<EventKind>)>; 2];

/// The places so far.
pub(super) struct Places {
    pub(super) listing: Listing,
    /// Which change shows a place.
    known: HashMap<Place, usize>,
    /// What differs at the end, by what it is of.
    at_end: BTreeMap<String, String>,
    most: usize,
    /// The number of the run.
    run: usize,
}

impl Verifier<'_, '_> {
    fn listed(mut self, there: ProgramRef, witness: Option<&Witness>, most: usize) -> Listing {
        let Job { source, target, names, effort, .. } = *self.job;
        let found = inputs_of_both(
            (source, self.program),
            (target, there),
            names,
            (self.called, self.arguments.as_ref()),
        );
        let inch = unit(source, target).or(found.inch);
        let mut proposals = Proposals::new(&found, effort);
        let mut places = Places::new(most);
        if let Some(witness) = witness {
            self.theirs = witness.target_variables.clone();
            self.list(&witness.scenario, there, &mut places);
        }
        let (mut barren, mut before) = (0, places.known.len());
        while places.listing.scenarios < SCENARIOS && barren < BARREN && self.steps < effort.all_steps {
            let Some(mut scenario) = proposals.next().filter(|_| !self.clock.is_up()) else { break };
            scenario.milliseconds = scenario.milliseconds.map(|most| most.min(self.clock.left()));
            scenario.inch = inch;
            self.given.start(&mut scenario);
            self.theirs = proposals.theirs().clone();
            self.list(&scenario, there, &mut places);
            barren = if places.known.len() > before { 0 } else { barren + 1 };
            before = places.known.len();
        }
        self.job.spent.add(&self.clock);
        places.end()
    }

    /// Runs both sides in a scenario, and on a machine without sizes.
    fn list(&mut self, scenario: &Scenario, there: ProgramRef, places: &mut Places) {
        places.listing.scenarios += 1;
        let mut differs = false;
        for plain in [true, false] {
            let circumstances = if plain { without_sizes(scenario) } else { scenario.clone() };
            let (apart, cut) = self.list_one(&circumstances, there, places, plain);
            differs |= apart;
            // What comes to no end takes long, and shows the same from another place.
            if apart && cut {
                break;
            }
        }
        places.listing.differing += usize::from(differs);
    }

    /// Whether the two differ, and whether one came to no end.
    fn list_one(
        &mut self,
        scenario: &Scenario,
        there: ProgramRef,
        places: &mut Places,
        plain: bool,
    ) -> (bool, bool) {
        let run = self.run_source(scenario);
        let circumstances = self.circumstances(scenario, &run);
        let other = self.job.target.run(there, &circumstances);
        self.steps += run.steps;
        let pair = Pair { scenario, run: &run, there, circumstances: &circumstances, other: &other };
        let cut = is_cut(&run) || is_cut(&other);
        let Err(Some(first)) = self.fault(&pair) else { return (false, cut) };
        if !self.list_pair(&run, &other, places, plain) {
            places.at_its_end(first.what.clone());
        }
        (true, cut)
    }

    /// Lists all at which two runs differ. False where that is nothing.
    pub(super) fn list_pair(&self, run: &Run, other: &Run, places: &mut Places, plain: bool) -> bool {
        let Job { source, target, names, .. } = *self.job;
        let strict = compare((source, run), (target, other), names, self.tolerance).difference.is_none();
        let most = places.most.saturating_mul(OF_A_RUN);
        let (all, at_end) =
            differences((source, run), (target, other), names, (self.tolerance, strict), most);
        let is_inch = |run: &Run| run.modes.iter().any(|op| op.group() == Group::Units && *op == Op::Inch);
        places.listing.inch |= is_inch(run) && is_inch(other);
        let sides = [(source, run, frames(run)), (target, other, frames(other))];
        places.run += 1;
        let mut last = None;
        for apart in &all {
            last = places.take(apart, &sides, last, plain);
        }
        let any = !all.is_empty() || !at_end.is_empty();
        at_end.into_iter().for_each(|text| places.at_its_end(text));
        any
    }
}

/// A side, its run, and what was in force at each event of it.
type Watched<'w> = (&'w Side<'w>, &'w Run, HashMap<*const Event, (u32, u32)>);

impl Places {
    /// None yet; room for so many.
    pub(super) fn new(most: usize) -> Self {
        Self { listing: Listing::default(), known: HashMap::new(), at_end: BTreeMap::new(), most, run: 0 }
    }

    /// All of them.
    pub(super) fn end(mut self) -> Listing {
        self.listing.at_end = self.at_end.into_values().collect();
        self.listing
    }

    /// Takes in what differs at the end of a run, each once.
    fn at_its_end(&mut self, text: String) {
        let of = text.split(' ').next().unwrap_or_default().to_owned();
        self.at_end.entry(of).or_insert(text);
    }

    /// Takes in a difference. Yields the number of the change that it was taken in by, which the next one may go on with.
    fn take(
        &mut self,
        apart: &Apart<'_>,
        sides: &[Watched<'_>; 2],
        last: Option<usize>,
        plain: bool,
    ) -> Option<usize> {
        let both = [&apart.source, &apart.target];
        let spot = |at: usize| {
            let (event, what) = both[at].as_ref()?;
            let program = sides[at].1.programs.get(event.at.program as usize)?;
            Some((program.file, event.at.span.start, discriminant(&**what)))
        };
        let place = [spot(0), spot(1)];
        if let Some(known) = self.known.get(&place).copied() {
            if let Some(change) = self.listing.changes.get_mut(known) {
                change.times += usize::from(change.run == self.run);
            }
            return Some(known);
        }
        let shift = shift(apart);
        let before = last.and_then(|last| self.listing.changes.get_mut(last));
        if let Some(change) = before
            && change.plain == plain
            && let (Some(shift), Some(old), Some(new)) = (&shift, &change.old, &change.new)
            && self::shift_of(&old.what, &new.what).as_ref() == Some(shift)
        {
            change.alike += 1;
            self.known.insert(place, last.unwrap_or_default());
            return last;
        }
        if self.listing.changes.len() >= self.most {
            self.listing.left_out += 1;
            self.known.insert(place, usize::MAX);
            return None;
        }
        let seen = |at: usize| {
            let (event, what) = both[at].as_ref()?;
            let (side, run, frames) = &sides[at];
            let (work, length) = frames.get(&std::ptr::from_ref(*event)).copied().unwrap_or((1, 0));
            let moment = Moment::of(side, run, event);
            let moment = Moment { event: serde_json::to_value(&**what).unwrap_or_default(), ..moment };
            Some(Seen { moment, what: (**what).clone(), at: event.at, work, length })
        };
        let (old, new, what) = (seen(0), seen(1), apart.what.clone());
        self.listing.changes.push(Change { old, new, what, times: 1, run: self.run, alike: 0, plain });
        let at = self.listing.changes.len() - 1;
        self.known.insert(place, at);
        Some(at)
    }
}

/// By how much the new move ends elsewhere, and its feed; in thousandths of a thousandth.
type Shift = (Vec<i64>, [i64; 2]);

fn shift(apart: &Apart<'_>) -> Option<Shift> {
    let ((_, a), (_, b)) = (apart.source.as_ref()?, apart.target.as_ref()?);
    shift_of(a, b)
}

/// The same of two moves; none for what is none.
fn shift_of(a: &EventKind, b: &EventKind) -> Option<Shift> {
    use EventKind::{Arc, Feed, Rapid};
    let end = |what: &EventKind| match what {
        Rapid { to, .. } => Some((*to, 0.0)),
        Feed { to, feed, .. } | Arc { to, feed, .. } => Some((*to, *feed)),
        _ => None,
    };
    let sweep = |what: &EventKind| match what {
        Arc { sweep, .. } => *sweep,
        _ => 0.0,
    };
    if (sweep(a) - sweep(b)).abs() > 1e-3 {
        return None;
    }
    let ((a, feed), (b, other)) = (end(a)?, end(b)?);
    let whole = |value: f64| (value * 1e6).round() as i64;
    let way = a.0.iter().zip(b.0).map(|(a, b)| whole(b - a)).collect();
    // Moves at the same two feeds differ by one change of it; a rapid move has none.
    Some((way, if feed == other { [0; 2] } else { [feed, other].map(whole) }))
}

/// The work offset and the tool length in force at each event.
fn frames(run: &Run) -> HashMap<*const Event, (u32, u32)> {
    let mut in_force = (1, 0);
    let all = run.events.iter().map(|event| {
        match event.what {
            EventKind::WorkOffset { number } => in_force.0 = number,
            EventKind::ToolLength { offset, .. } => in_force.1 = offset,
            _ => {}
        }
        (std::ptr::from_ref(event), in_force)
    });
    all.collect()
}

/// The same circumstances on a machine whose zero is the part's, and whose tools have no size.
pub(super) fn without_sizes(scenario: &Scenario) -> Scenario {
    let mut plain = scenario.clone();
    (plain.work_offsets, plain.tools) = Default::default();
    plain.external_shift = Default::default();
    plain
}
