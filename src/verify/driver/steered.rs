//! Scenarios for ways that a branch has left after the search: solved for their inputs.

use super::verifier::Verifier;
use crate::control::scenario::Probe;
use crate::control::trace::{EventKind, Place};
use crate::control::{ProgramRef, Run, Scenario};
use crate::text::Span;
use crate::verify::compare::is_cut;
use crate::verify::explore::{Attempt, Circumstances, Input, Inputs, Steer, hangs_on, in_order, inputs_of};
use crate::verify::sides::class_of;
use std::cell::Cell;
use std::collections::BTreeMap;

/// Runs for one way, and for all ways of a program.
const FOR_ONE: usize = 120;
const FOR_ALL: usize = 1000;
/// The same for ways of the target alone, each of which takes a run of both sides: most are what a conversion writes to be
/// safe, and nothing reaches them.
const FOR_ONE_THERE: usize = 40;
const FOR_ALL_THERE: usize = 80;
/// Probe moves that touch something.
const TOUCHES: usize = 8;
/// Inputs that are steered for one way, at the most.
const MOST_STEERED: usize = 40;
/// A way that a branch has left: the branch by its file and place, and the way.
pub(super) type Way = ((usize, Span), i64);

/// Searches for one way, each from another start: where numbers meet because they are all 0 no small step leads elsewhere.
const SEARCHES: usize = 3;
/// How far from a way the searches for it began.
type Searched = BTreeMap<Way, Vec<f64>>;

/// Where searches may begin: circumstances, and how near the source and the target came to ways in them.
struct Start {
    circumstances: Circumstances,
    near: [Option<Vec<(Way, f64)>>; 2],
    /// What the source came to by computed numbers.
    reached: Vec<Input>,
}

impl Start {
    fn new(circumstances: Circumstances) -> Self {
        Self { circumstances, near: [None, None], reached: Vec::new() }
    }
}

impl Verifier<'_, '_> {
    /// Looks for circumstances in which branches go the ways that they have left. Yields those that it began in, and those
    /// that it came to.
    pub(super) fn steer(
        &mut self,
        there: ProgramRef,
        inputs: &Inputs,
        starts: Vec<Circumstances>,
    ) -> Vec<Circumstances> {
        let mut starts: Vec<Start> = starts
            .into_iter()
            .map(|mut circumstances| {
                circumstances.scenario.nearness = true;
                Start::new(circumstances)
            })
            .collect();
        for (on_target, all, one) in [(false, FOR_ALL, FOR_ONE), (true, FOR_ALL_THERE, FOR_ONE_THERE)] {
            let (mut left, mut searched) = (all, Searched::new());
            while left > 0 && self.witness.is_none() && !self.is_spent() {
                let Some((way, from, distance)) = self.nearest(there, &mut starts, &searched, on_target)
                else {
                    break;
                };
                searched.entry(way).or_default().push(distance);
                let Some(start) = starts.get(from) else { break };
                let (begin, mut came) = (start.circumstances.clone(), Vec::new());
                let touching = self.touching(&begin);
                let order = inputs_of(inputs, &start.reached, &begin.scenario);
                let order = self.in_order(order, Some((way.0, on_target)), &begin.scenario);
                let values = |input: &Input| input.compared_with(inputs);
                let is_reached = Cell::new(false);
                let mut attempt = |circumstances: &Circumstances| {
                    left = left.saturating_sub(1);
                    let (attempt, new) = self.attempt(there, circumstances, way, on_target);
                    is_reached.set(is_reached.get() || attempt == Attempt::Reached);
                    if new || attempt == Attempt::Reached {
                        came.push(circumstances.clone());
                    }
                    attempt
                };
                Steer::new(begin, distance, one.min(all), &mut attempt).run(&order, &values);
                if !is_reached.get()
                    && let Some(begin) = touching
                    && let Attempt::Near(Some(distance)) = attempt(&begin)
                {
                    Steer::new(begin, distance, one.min(all), &mut attempt).run(&order, &values);
                }
                starts.extend(came.into_iter().map(Start::new));
            }
        }
        starts.into_iter().map(|start| start.circumstances).collect()
    }

    /// The inputs that what stands at a place of the source hangs on, or of the target where that is true, and others. What callers
    /// give is not tried otherwise.
    pub(super) fn in_order(
        &self,
        all: Vec<Input>,
        place: Option<((usize, Span), bool)>,
        scenario: &Scenario,
    ) -> [Vec<Input>; 2] {
        let (is_given, held) = (self.given.is_known(), self.held());
        let is_open = |input: &Input| match input {
            Input::Selected => !is_given,
            Input::Variable(name, false) => !held.contains_key(name),
            _ => true,
        };
        let all = all.into_iter().filter(is_open).collect();
        let ((file, span), on_target) = place.unwrap_or_default();
        let side = if on_target { self.job.target } else { self.job.source };
        let texts = &side.library.files;
        let blocks = texts.get(file).filter(|_| place.is_some()).map_or(&[][..], |file| &file.parsed.blocks);
        let [mut near, mut others] = in_order(all, &hangs_on(blocks, span), side.control, scenario);
        near.truncate(MOST_STEERED);
        others.truncate(MOST_STEERED - near.len());
        [near, others]
    }

    /// The same circumstances where each probe move touches something on half of its way; none where one did, or where the
    /// program probes nothing. Where it touches is one thing, where it began is another: both have to change.
    fn touching(&self, begin: &Circumstances) -> Option<Circumstances> {
        let probes = |run: &Run| run.events.iter().any(|event| matches!(event.what, EventKind::Probe { .. }));
        if !begin.scenario.probes.is_empty() || !probes(&self.run_source(&begin.scenario)) {
            return None;
        }
        let mut begin = begin.clone();
        begin.scenario.probes = vec![Probe::Part(0.5); TOUCHES];
        Some(begin)
    }

    /// The ways of the source that are left, and those that only runs went which its control stopped.
    fn ways_left(&self) -> Vec<Way> {
        let unsound =
            if self.source_stops.is_empty() { Vec::new() } else { self.sound.lacks(&self.coverage) };
        self.coverage.left().into_iter().chain(unsound).collect()
    }

    /// True once its time or its steps are used up.
    pub(super) fn is_spent(&mut self) -> bool {
        self.steps >= self.job.effort.all_steps || self.clock.is_up()
    }

    /// The way left that a start comes nearest to, among those that were searched for least; and a start from which none was.
    fn nearest(
        &mut self,
        there: ProgramRef,
        starts: &mut [Start],
        searched: &Searched,
        on_target: bool,
    ) -> Option<(Way, usize, f64)> {
        let ways = if on_target { self.target_coverage.left() } else { self.ways_left() };
        let from = |way: &Way| searched.get(way).map_or(&[][..], Vec::as_slice);
        let mut ways: Vec<Way> = ways.into_iter().filter(|way| from(way).len() < SEARCHES).collect();
        ways.sort_by_key(|way| from(way).len());
        if ways.is_empty() {
            return None;
        }
        for start in starts.iter_mut().filter(|start| start.near[usize::from(on_target)].is_none()) {
            let Circumstances { scenario, theirs, .. } = &start.circumstances;
            let mut run = self.run_source(scenario);
            start.reached = self.reached(&run);
            if on_target {
                self.theirs = theirs.clone();
                run = self.job.target.run(there, &self.circumstances(scenario, &run));
            }
            start.near[usize::from(on_target)] = Some(all_near(&run));
        }
        let near = |way: &Way| {
            let all = starts.iter().enumerate();
            let near = all.filter_map(|(at, start)| {
                let near = start.near[usize::from(on_target)].as_ref()?;
                Some((*way, at, least(near, *way)?))
            });
            let near = near.filter(|(_, _, distance)| !from(way).contains(distance));
            near.min_by(|a, b| a.2.total_cmp(&b.2))
        };
        ways.iter().find_map(near)
    }

    /// The variables and offsets of the source that a run came to by computed numbers, where its scenario may set them.
    pub(super) fn reached(&self, run: &Run) -> Vec<Input> {
        let control = self.job.source.control;
        let Some(letter) = control.numbered() else { return Vec::new() };
        let input = |number: u32| {
            if let Some((state, subscripts, _)) = control.read_system(letter, Some(number)) {
                return Input::of_cell(state, &subscripts);
            }
            let name = format!("{letter}{number}");
            class_of(control, &name).filter(|class| class.class != "local")?;
            Some(Input::Variable(name, false))
        };
        run.computed_numbers.iter().filter_map(|computed| input(computed.what)).collect()
    }

    /// One run, compared on both sides if it goes a new way. Also true if it does.
    fn attempt(
        &mut self,
        there: ProgramRef,
        circumstances: &Circumstances,
        way: Way,
        on_target: bool,
    ) -> (Attempt, bool) {
        if self.is_spent() || self.witness.is_some() {
            return (Attempt::Stop, false);
        }
        self.theirs = circumstances.theirs.clone();
        let run = self.run_source(&circumstances.scenario);
        self.tried += 1;
        self.steps += run.steps;
        // What is not held against the conversion counts only where both sides do the same.
        let new = match self.is_unusual {
            true => self.coverage.has_new(&run),
            false => self.coverage.add(&run) || self.makes_sound(&run),
        };
        let (near, went) = if on_target {
            let other = self.job.target.run(there, &self.circumstances(&circumstances.scenario, &run));
            self.steps += other.steps;
            (least(&all_near(&other), way), goes(&other, way))
        } else {
            (least(&all_near(&run), way), goes(&run, way))
        };
        if self.is_unusual {
            let counts = (new || went) && self.goes_alike(&circumstances.scenario, &run, there);
            let attempt = if went && counts { Attempt::Reached } else { Attempt::Near(near) };
            return (attempt, new && counts);
        }
        if new || went {
            let new_there = self.compare(&circumstances.scenario, &run, there);
            let scenario = Scenario { nearness: false, ..circumstances.scenario.clone() };
            self.tell(&scenario, &run, new || new_there);
        }
        match went {
            // Another alarm of the control shows nothing.
            true if !on_target && self.ways_left().contains(&way) => (Attempt::Near(None), new),
            true => (Attempt::Reached, new),
            false => (Attempt::Near(near.filter(|_| !is_cut(&run))), new),
        }
    }
}

/// How near a run came to each way that its branches did not go.
pub(super) fn all_near(run: &Run) -> Vec<(Way, f64)> {
    let named =
        |(at, way): &(Place, i64)| Some(((run.programs.get(at.program as usize)?.file, at.span), *way));
    run.nearest.iter().filter_map(|(way, distance)| Some((named(way)?, *distance))).collect()
}

/// The least distance to a way; none if the run did not come to its branch.
pub(super) fn least(near: &[(Way, f64)], way: Way) -> Option<f64> {
    near.iter()
        .filter(|(other, _)| is_same(*other, way))
        .map(|(_, distance)| *distance)
        .min_by(f64::total_cmp)
}

/// True for a run that went a way.
fn goes(run: &Run, way: Way) -> bool {
    gone(run).any(|other| is_same(other, way))
}

/// The ways that a run went.
pub(super) fn gone(run: &Run) -> impl Iterator<Item = Way> {
    run.branches.iter().flat_map(|(branch, ways)| {
        let program = run.programs.get(branch.at.program as usize);
        let place = program.map(|program| (program.file, branch.at.span));
        place.into_iter().flat_map(|place| ways.iter().map(move |way| (place, *way)))
    })
}

/// True for one way of one branch: some controls name it by its condition, others by its block.
pub(super) fn is_same(((file, span), way): Way, ((other_file, other), other_way): Way) -> bool {
    file == other_file && way == other_way && span.start < other.end && other.start < span.end
}
