//! Scenarios for ways that a branch has left after the search: solved for their inputs.

use super::verifier::Verifier;
use crate::control::trace::Place;
use crate::control::{ProgramRef, Run, Scenario};
use crate::text::Span;
use crate::verify::compare::is_cut;
use crate::verify::explore::{Attempt, Circumstances, Input, Inputs, Steer, hangs_on, in_order, inputs_of};
use crate::verify::sides::class_of;
use std::collections::BTreeSet;

/// Runs for one way, and for all ways of a program.
const FOR_ONE: usize = 120;
const FOR_ALL: usize = 1000;
/// The same for ways of the target alone, each of which takes a run of both sides: most are what a conversion writes to be
/// safe, and nothing reaches them.
const FOR_ONE_THERE: usize = 40;
const FOR_ALL_THERE: usize = 80;
/// A way that a branch has left: the branch by its file and place, and the way.
type Way = ((usize, Span), i64);

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
            let (mut left, mut given_up) = (all, BTreeSet::new());
            while left > 0 && self.witness.is_none() && !self.is_spent() {
                let Some((way, from, distance)) = self.nearest(there, &mut starts, &given_up, on_target)
                else {
                    break;
                };
                given_up.insert(way);
                let Some(start) = starts.get(from) else { break };
                let (begin, mut came) = (start.circumstances.clone(), Vec::new());
                let order = inputs_of(inputs, &start.reached, &begin.scenario);
                let place = Some(way.0).filter(|_| !on_target);
                let order = self.in_order(order, place, &begin.scenario);
                let mut attempt = |circumstances: &Circumstances| {
                    left = left.saturating_sub(1);
                    let (attempt, new) = self.attempt(there, circumstances, way, on_target);
                    if new || attempt == Attempt::Reached {
                        came.push(circumstances.clone());
                    }
                    attempt
                };
                Steer::new(begin, distance, one.min(all), &mut attempt).run(&order);
                starts.extend(came.into_iter().map(Start::new));
            }
        }
        starts.into_iter().map(|start| start.circumstances).collect()
    }

    /// The inputs, those first that what stands at a place of the source hangs on. What callers give is not tried otherwise.
    pub(super) fn in_order(
        &self,
        all: Vec<Input>,
        place: Option<(usize, Span)>,
        scenario: &Scenario,
    ) -> Vec<Input> {
        let is_given = self.given.is_known();
        let all = all.into_iter().filter(|input| *input != Input::Selected || !is_given).collect();
        let Some((file, span)) = place else { return all };
        let texts = &self.job.source.library.files;
        let blocks = texts.get(file).map_or(&[][..], |file| &file.parsed.blocks);
        in_order(all, &hangs_on(blocks, span), self.job.source.control, scenario)
    }

    /// True once its time or its steps are used up.
    pub(super) fn is_spent(&mut self) -> bool {
        self.steps >= self.job.effort.all_steps || self.clock.is_up()
    }

    /// The way left that a start comes nearest to, among those that were not tried.
    fn nearest(
        &mut self,
        there: ProgramRef,
        starts: &mut [Start],
        given_up: &BTreeSet<Way>,
        on_target: bool,
    ) -> Option<(Way, usize, f64)> {
        let ways = if on_target { self.target_coverage.left() } else { self.coverage.left() };
        let ways: Vec<Way> = ways.into_iter().filter(|way| !given_up.contains(way)).collect();
        if ways.is_empty() {
            return None;
        }
        for start in starts.iter_mut().filter(|start| start.near[usize::from(on_target)].is_none()) {
            let Circumstances { scenario, theirs } = &start.circumstances;
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
        let new = self.coverage.add(&run);
        let (near, went) = if on_target {
            let other = self.job.target.run(there, &self.circumstances(&circumstances.scenario, &run));
            self.steps += other.steps;
            (least(&all_near(&other), way), goes(&other, way))
        } else {
            (least(&all_near(&run), way), goes(&run, way))
        };
        if new || went {
            let new_there = self.compare(&circumstances.scenario, &run, there);
            let scenario = Scenario { nearness: false, ..circumstances.scenario.clone() };
            self.tell(&scenario, &run, new || new_there);
        }
        match went {
            true => (Attempt::Reached, new),
            false => (Attempt::Near(near.filter(|_| !is_cut(&run))), new),
        }
    }
}

/// How near a run came to each way that its branches did not go.
fn all_near(run: &Run) -> Vec<(Way, f64)> {
    let named =
        |(at, way): &(Place, i64)| Some(((run.programs.get(at.program as usize)?.file, at.span), *way));
    run.nearest.iter().filter_map(|(way, distance)| Some((named(way)?, *distance))).collect()
}

/// The least distance to a way; none if the run did not come to its branch.
fn least(near: &[(Way, f64)], way: Way) -> Option<f64> {
    near.iter()
        .filter(|(other, _)| is_same(*other, way))
        .map(|(_, distance)| *distance)
        .min_by(f64::total_cmp)
}

/// True for a run that went a way.
fn goes(run: &Run, way: Way) -> bool {
    run.branches.iter().any(|(branch, ways)| {
        let Some(program) = run.programs.get(branch.at.program as usize) else { return false };
        ways.iter().any(|other| is_same(((program.file, branch.at.span), *other), way))
    })
}

/// True for one way of one branch: some controls name it by its condition, others by its block.
fn is_same(((file, span), way): Way, ((other_file, other), other_way): Way) -> bool {
    file == other_file && way == other_way && span.start < other.end && other.start < span.end
}
