//! Scenarios for conditions of the conversion that no run has kept: solved for their inputs, as ways of branches are.

use super::verifier::Verifier;
use crate::control::{ProgramRef, Scenario};
use crate::text::Span;
use crate::verify::compare::is_cut;
use crate::verify::explore::{Attempt, Circumstances, Input, Inputs, Steer, inputs_of};
use crate::verify::triage::off;

/// Runs for one condition, and for all of a program.
const FOR_ONE: usize = 120;
const FOR_ALL: usize = 400;

/// The start that comes nearest to a condition.
struct Nearest<'s> {
    /// The condition, by its place among those of the program.
    at: usize,
    /// How far its run is from it.
    distance: f64,
    start: &'s Circumstances,
    /// What the run came to by computed numbers.
    reached: Vec<Input>,
}

impl Verifier<'_, '_> {
    /// Looks for circumstances in which what the program computes stays in what its conversion holds for. Yields those that
    /// it came to.
    pub(super) fn steer_to_conditions(
        &mut self,
        there: ProgramRef,
        inputs: &Inputs,
        starts: &[Circumstances],
    ) -> Vec<Circumstances> {
        let (mut left, mut came) = (FOR_ALL, Vec::new());
        for nearest in self.nearest_conditions(starts) {
            if self.is_kept(nearest.at) || self.witness.is_some() || self.is_spent() {
                continue;
            }
            let at = nearest.at;
            if nearest.distance == 0.0 {
                if self.attempt_condition(there, nearest.start, at) == Attempt::Reached {
                    came.push(nearest.start.clone());
                }
                continue;
            }
            let order = inputs_of(inputs, &nearest.reached, &nearest.start.scenario);
            let order =
                self.in_order(order, self.place_of(at).map(|place| (place, false)), &nearest.start.scenario);
            let mut attempt = |circumstances: &Circumstances| {
                left = left.saturating_sub(1);
                if left == 0 {
                    return Attempt::Stop;
                }
                let attempt = self.attempt_condition(there, circumstances, at);
                if attempt == Attempt::Reached {
                    came.push(circumstances.clone());
                }
                attempt
            };
            Steer::new(nearest.start.clone(), nearest.distance, FOR_ONE, &mut attempt)
                .run(&order, &|input| input.compared_with(inputs));
        }
        self.theirs.clear();
        came
    }

    /// The file, and the first block in it that a condition is about.
    fn place_of(&self, at: usize) -> Option<(usize, Span)> {
        let assumed = self.job.assumptions.get(&self.counted)?.get(at)?;
        let mut predicate = assumed.predicate.clone();
        let place = predicate.places_mut().and_then(|places| places.first().copied());
        Some((self.counted.file, place.unwrap_or(assumed.place)))
    }

    /// True for a condition that a run kept.
    fn is_kept(&self, at: usize) -> bool {
        self.assumed.get(&at).is_some_and(|(kept, _)| *kept > 0)
    }

    /// The conditions that no run kept, as far as the run of a start comes to them, each with the start that comes nearest.
    fn nearest_conditions<'s>(&mut self, starts: &'s [Circumstances]) -> Vec<Nearest<'s>> {
        let job = self.job;
        let all = job.assumptions.get(&self.counted).into_iter().flatten().enumerate();
        let open = all.filter(|(at, one)| one.predicate.is_computed() && !self.is_kept(*at));
        let open: Vec<usize> = open.map(|(at, _)| at).collect();
        let mut nearest: Vec<Nearest<'s>> = Vec::new();
        for start in starts.iter().filter(|_| !open.is_empty()) {
            let run = self.run_source(&start.scenario);
            for at in &open {
                let Some(distance) = off(job, (self.counted, *at), &run) else {
                    continue;
                };
                let known = nearest.iter_mut().find(|nearest| nearest.at == *at);
                if known.as_ref().is_some_and(|known| known.distance <= distance) {
                    continue;
                }
                let found = Nearest { at: *at, distance, start, reached: self.reached(&run) };
                match known {
                    Some(known) => *known = found,
                    None => nearest.push(found),
                }
            }
        }
        nearest
    }

    /// One run, compared on both sides if it keeps the condition or goes a new way.
    fn attempt_condition(&mut self, there: ProgramRef, circumstances: &Circumstances, at: usize) -> Attempt {
        if self.is_spent() || self.witness.is_some() {
            return Attempt::Stop;
        }
        let job = self.job;
        self.theirs = circumstances.theirs.clone();
        let run = self.run_source(&circumstances.scenario);
        self.tried += 1;
        self.steps += run.steps;
        let distance = off(job, (self.counted, at), &run);
        let new = self.coverage.add(&run);
        if new || distance == Some(0.0) {
            let new_there = self.compare(&circumstances.scenario, &run, there);
            let scenario = Scenario { nearness: false, ..circumstances.scenario.clone() };
            self.tell(&scenario, &run, new || new_there);
        }
        match self.is_kept(at) {
            true => Attempt::Reached,
            false => Attempt::Near(distance.filter(|_| !is_cut(&run))),
        }
    }
}
