//! Ways that several literals decide together, or that one decides by what is computed from it: they are solved for as the
//! inputs of a run are.

use super::edited::{Aim, Change, Left, values};
use super::steered::{Way, all_near, least};
use super::twins::Twins;
use super::verifier::Verifier;
use crate::control::{ProgramRef, Scenario};
use crate::verify::explore::{Attempt, Circumstances, Input, Inputs, Steer, hangs_on, in_order, inputs_of};
use std::collections::BTreeMap;

/// Edited texts for one way, and for all ways of a side.
const FOR_ONE: usize = 90;
const FOR_ALL: usize = 360;

/// Searches for one way, each from another start.
const SEARCHES: usize = 2;

/// Edited texts from which searches begin, at the most.
const STARTS: usize = 12;

/// Inputs besides literals that are tried for one way, at the most.
const MOST_INPUTS: usize = 12;

/// Literals from which searches begin, and how near they come to ways.
struct Start {
    from: Circumstances,
    near: Vec<(Way, f64)>,
}

impl Verifier<'_, '_> {
    /// Searches for ways that are left. `began` are edits that went new ways, by their places in `twins`.
    pub(super) fn steer_by_edits(
        &mut self,
        there: ProgramRef,
        (twins, began): (&[Twins], &[(usize, f64)]),
        (scenario, inputs): (&Scenario, &Inputs),
        left: &mut Left,
    ) {
        // One text of the target is edited.
        if twins.is_empty() || !twins.windows(2).all(|two| two[0].part == two[1].part) {
            return;
        }
        let scenario = Scenario { nearness: true, ..scenario.clone() };
        let mut stands = Circumstances::new(scenario, BTreeMap::new());
        stands.literals = twins.iter().map(|twins| twins.ours.value).collect();
        let begun = began.iter().filter_map(|(at, value)| Input::Literal(*at).set(&stands, *value));
        let all: Vec<Circumstances> = [stands.clone()].into_iter().chain(begun).take(STARTS).collect();
        for on_target in [false, true] {
            let (mut runs, mut searched) = (FOR_ALL, BTreeMap::<Way, usize>::new());
            let mut starts: Vec<Start> = Vec::new();
            for from in &all {
                let near = self.near_by_edits(there, twins, (from, on_target), left);
                starts.push(Start { from: from.clone(), near });
            }
            while runs > 0 && left.steps > 0 && !self.clock.is_up() {
                let Some((way, begin, distance)) = self.nearest_edits(&starts, &searched, on_target) else {
                    break;
                };
                *searched.entry(way).or_default() += 1;
                let groups = self.edits_in_order(way, (twins, inputs), &begin, on_target);
                let tried = |input: &Input| match input {
                    Input::Literal(at) => twins
                        .get(*at)
                        .map_or_else(Vec::new, |twins| values(twins.ours.value, &inputs.numbers)),
                    _ => input.compared_with(inputs),
                };
                let mut came = Vec::new();
                let mut attempt = |from: &Circumstances| {
                    if runs == 0 || left.steps == 0 || self.clock.is_up() {
                        return Attempt::Stop;
                    }
                    runs -= 1;
                    let changes = changes(twins, &from.literals);
                    let aim = Some(Aim { way, on_target });
                    let found = self.edit(there, &changes, (&from.scenario, aim), left);
                    if found.is_new {
                        came.push(from.clone());
                    }
                    match (found.went, found.is_new) {
                        (true, true) => Attempt::Reached,
                        // What was run there tells nothing.
                        (true, false) => Attempt::Near(None),
                        _ => Attempt::Near(least(&found.near, way)),
                    }
                };
                Steer::new(begin, distance, FOR_ONE, &mut attempt).run(&groups, &tried);
                for from in came.into_iter().take(STARTS.saturating_sub(starts.len())) {
                    let near = self.near_by_edits(there, twins, (&from, on_target), left);
                    starts.push(Start { from, near });
                }
            }
        }
    }

    /// How near a side comes to the ways that its branches do not go.
    fn near_by_edits(
        &mut self,
        there: ProgramRef,
        twins: &[Twins],
        (from, on_target): (&Circumstances, bool),
        left: &mut Left,
    ) -> Vec<(Way, f64)> {
        let changes = changes(twins, &from.literals);
        if !changes.is_empty() {
            let aim = Some(Aim { way: Aim::NONE, on_target });
            return self.edit(there, &changes, (&from.scenario, aim), left).near;
        }
        let run = self.run_source(&from.scenario);
        match on_target {
            true => all_near(&self.job.target.run(there, &self.circumstances(&from.scenario, &run))),
            false => all_near(&run),
        }
    }

    /// The way left that a start comes nearest to, of those that were searched for least.
    fn nearest_edits(
        &self,
        starts: &[Start],
        searched: &BTreeMap<Way, usize>,
        on_target: bool,
    ) -> Option<(Way, Circumstances, f64)> {
        let times = |way: &Way| searched.get(way).copied().unwrap_or_default();
        let ways = if on_target { self.target_coverage.left() } else { self.coverage.left() };
        let mut ways: Vec<Way> = ways.into_iter().filter(|way| times(way) < SEARCHES).collect();
        ways.sort_by_key(times);
        ways.into_iter().find_map(|way| {
            let near = starts.iter().filter_map(|start| Some((start, least(&start.near, way)?)));
            let mut near: Vec<_> = near.collect();
            near.sort_by(|a, b| a.1.total_cmp(&b.1));
            // The second search begins elsewhere.
            let (start, distance) = near.into_iter().nth(times(&way))?;
            Some((way, start.from.clone(), distance))
        })
    }

    /// The literals and inputs that a way hangs on, and the other literals.
    fn edits_in_order(
        &self,
        ((file, span), _): Way,
        (twins, inputs): (&[Twins], &Inputs),
        begin: &Circumstances,
        on_target: bool,
    ) -> [Vec<Input>; 2] {
        let side = if on_target { self.job.target } else { self.job.source };
        let blocks = side.library.files.get(file).map_or(&[][..], |file| &file.parsed.blocks);
        let hangs = hangs_on(blocks, span);
        let rank = |twins: &Twins| {
            let constant = if on_target { &twins.theirs } else { &twins.ours };
            hangs.iter().position(|(name, number)| constant.name == format!("{name}{number}"))
        };
        let mut near: Vec<(usize, Input)> = Vec::new();
        let mut others = Vec::new();
        for (at, twins) in twins.iter().enumerate() {
            match rank(twins) {
                Some(rank) => near.push((rank, Input::Literal(at))),
                None => others.push(Input::Literal(at)),
            }
        }
        near.sort_by_key(|(rank, _)| *rank);
        let mut near: Vec<Input> = near.into_iter().map(|(_, input)| input).collect();
        let all = inputs_of(inputs, &[], &begin.scenario);
        let [more, _] = in_order(all, &hangs, side.control, &begin.scenario);
        near.extend(more.into_iter().take(MOST_INPUTS));
        [near, others]
    }
}

/// The literals that are other than they stand in the texts.
fn changes<'t>(twins: &'t [Twins], literals: &[f64]) -> Vec<Change<'t>> {
    let other = twins.iter().zip(literals).filter(|(twins, value)| twins.ours.value != **value);
    other.map(|(twins, value)| (twins, *value)).collect()
}
