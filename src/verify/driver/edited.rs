//! Constants at a program's head that decide where it goes, edited alike on both sides.
//!
//! A literal that a main program assigns at its head is what its operator edits. Where it decides a branch, no
//! circumstances go the other way; so both texts are run anew with another literal there. Which literal of the target is
//! the same one is found without the compiler: it is the first thing that the target's program assigns to the register that
//! the lock has for the variable, and it has the same value; of a local, whose register the lock does not name, one of those
//! with that value for which both sides do the same. Ways that the source goes so count where both sides did the
//! same. Where they part, the program is undecided: a person sees whether that literal is the one.

use super::steered::{Way, all_near, gone, is_same};
use super::twins::{Constant, Twins, constants};
use super::verifier::Verifier;
use crate::control::{ProgramRef, Run, Scenario};
use crate::text::Span;
use crate::verify::certificate::{Edit, Why, differ};
use crate::verify::explore::{Inputs, Proposals, inputs, unit};
use crate::verify::sides::{EditedText, Effort, Job};
use crate::verify::triage::moved;
use std::collections::BTreeSet;

/// Values that each is given, at the most.
const VALUES: usize = 32;

/// Edits for ways that the target alone has left.
const FOR_THE_TARGET: usize = 48;

/// Edited texts of which all ways are searched for, at the most, and how much each search may do.
const SEARCHED: usize = 3;
const SEARCH: [usize; 2] = [48, 120];
const SEARCH_STEPS: u64 = 200_000;

/// A literal, and what is to stand in its place.
pub(super) type Change<'c> = (&'c Twins, f64);

/// A way that is looked for with edited texts.
#[derive(Clone, Copy)]
pub(super) struct Aim {
    pub(super) way: Way,
    /// True for a way of the target.
    pub(super) on_target: bool,
}

impl Aim {
    /// No way: only how near the others are is wanted.
    pub(super) const NONE: Way = ((usize::MAX, Span::new(0, 0)), 0);

    /// How near a run came to it, and whether it went there; `back` says where its places stood before the edits.
    fn seen(&self, run: &Run, back: &dyn Fn(usize, Span) -> Span) -> Edited {
        let near = all_near(run).into_iter().map(|(way, distance)| (moved_back(way, back), distance));
        let near: Vec<(Way, f64)> = near.collect();
        let went = gone(run).any(|way| is_same(moved_back(way, back), self.way));
        Edited { is_new: false, near, went }
    }
}

fn moved_back(((file, span), way): Way, back: &dyn Fn(usize, Span) -> Span) -> Way {
    ((file, back(file, span)), way)
}

/// What both sides did with edited texts.
#[derive(Clone, Debug, Default)]
pub(super) struct Edited {
    /// They did the same, and one of them went a new way.
    pub(super) is_new: bool,
    /// How near the side that has the aim came to the ways that it did not go.
    pub(super) near: Vec<(Way, f64)>,
    /// It went there.
    pub(super) went: bool,
}

impl Verifier<'_, '_> {
    /// Goes ways that constants decide. What other programs call has no head that an operator edits.
    pub(super) fn edited(&mut self, there: ProgramRef) {
        if self.called || self.witness.is_some() || self.compared == 0 || self.went_every_way() {
            return;
        }
        let Job { source, target, effort, .. } = *self.job;
        let found = inputs(source, self.program, target);
        let Some(scenario) = self.usual(&found) else { return };
        let mut left = Left { steps: effort.all_steps, searches: SEARCHED };
        let (mut for_target, mut twins, mut starts) = (FOR_THE_TARGET, Vec::new(), Vec::new());
        'all: for (constant, may_be) in self.all_twins(there) {
            let mut is_it = may_be.first().filter(|_| may_be.len() == 1).cloned();
            for value in values(constant.value, &found.numbers) {
                for twin in &may_be {
                    if self.went_every_way() || left.steps == 0 || for_target == 0 || self.is_out_of_time() {
                        break 'all;
                    }
                    for_target -= usize::from(self.coverage.is_complete());
                    if self.edit(there, &[(twin, value)], (&scenario, None), &mut left).is_new {
                        is_it = Some(twin.clone());
                        starts.push((twins.len(), value));
                        break;
                    }
                }
            }
            twins.extend(is_it);
        }
        self.steer_by_edits(there, (&twins, &starts), (&scenario, &found), &mut left);
    }

    /// The first scenario of a program with these inputs.
    fn usual(&self, found: &Inputs) -> Option<Scenario> {
        let Job { source, target, effort, .. } = *self.job;
        let inch = unit(source, target).or(found.inch);
        let mut scenario = Proposals::new(found, effort).next()?;
        scenario.inch = inch;
        self.given.start(&mut scenario);
        self.supposed().of_machine(&mut scenario);
        Some(scenario)
    }

    /// Runs both sides with other literals, and compares them if the source goes a new way by that, or one of them the way that
    /// is aimed at. A difference counts where the lock has named the registers; else one of them is another one.
    pub(super) fn edit(
        &mut self,
        there: ProgramRef,
        changes: &[Change<'_>],
        (scenario, aim): (&Scenario, Option<Aim>),
        left: &mut Left,
    ) -> Edited {
        self.edited_pair(there, changes, (scenario, aim), left).unwrap_or_default()
    }

    fn edited_pair(
        &mut self,
        there: ProgramRef,
        changes: &[Change<'_>],
        (scenario, aim): (&Scenario, Option<Aim>),
        left: &mut Left,
    ) -> Option<Edited> {
        let Job { source, target, names, assumptions, effort, spent } = *self.job;
        let part = changes.first()?.0.part;
        let literals = |of: fn(&Twins) -> &Constant| -> Vec<(Span, f64)> {
            changes.iter().map(|(twins, value)| (of(twins).span, *value)).collect()
        };
        let text = EditedText::new(&source.texts(), self.program, &literals(|twins| &twins.ours))?;
        let blocks = text.parse(&source.texts());
        let new_source = source.edited(self.program, &text, text.own(&blocks))?;
        let stands = |all: &[Constant], of: fn(&Twins) -> &Constant| {
            let told = |(twins, value): &Change<'_>| {
                all.iter().any(|found| (&found.name, found.value) == (&of(twins).name, *value))
            };
            changes.iter().all(told)
        };
        if !stands(&constants(&new_source, self.program, true), |twins| &twins.ours) {
            return None;
        }
        let run = (source.execute)(&new_source.library, self.program, source.control, scenario);
        left.steps = left.steps.saturating_sub(run.steps);
        let ours_back = back(&text, self.program.file);
        let mut coverage = self.coverage.clone();
        let new = coverage.add_moved(&run, &ours_back);
        let of_source = aim.filter(|aim| !aim.on_target);
        let mut found = of_source.map_or_else(Edited::default, |aim| aim.seen(&run, &ours_back));
        let on_target = aim.filter(|aim| aim.on_target);
        let wanted = aim.is_none() && !self.target_coverage.is_complete();
        if !new && !found.went && on_target.is_none() && !wanted {
            return Some(found);
        }
        let other = EditedText::new(&target.texts(), part, &literals(|twins| &twins.theirs))?;
        let blocks = other.parse(&target.texts());
        let new_target = target.edited(part, &other, other.own(&blocks))?;
        new_target.take_over(target, new_source.stands_as(source));
        if !stands(&constants(&new_target, part, false), |twins| &twins.theirs) {
            return None;
        }
        let theirs_back = back(&other, part.file);
        let entered = new_source.links().entered(&run).chain([self.program]);
        let assumptions = moved(assumptions, entered, self.program, |place| text.now(place));
        let job =
            Job { source: &new_source, target: &new_target, names, assumptions: &assumptions, effort, spent };
        let mut pair = Verifier { given: self.given.clone(), ..Verifier::new(&job, self.program) };
        if let Some(aim) = on_target {
            let run_there = new_target.run(there, &pair.circumstances(scenario, &run));
            found = aim.seen(&run_there, &theirs_back);
            if !found.went && !new {
                return Some(found);
            }
        }
        pair.compare(scenario, &run, there);
        let mut target_coverage = self.target_coverage.clone();
        let new_there = target_coverage.add_gone(&pair.target_coverage, &theirs_back);
        if !new_there && !new && pair.witness.is_none() {
            return Some(found);
        }
        let edits = self.as_edits(changes);
        let is_named = changes.iter().all(|(twins, _)| twins.is_named);
        if let Some(witness) = pair.witness.as_ref() {
            self.apart.extend(gone(&run).map(|way| moved_back(way, &ours_back)));
            if is_named {
                self.because(Why::Edited, &differ(&edits, &witness.what));
            }
            return Some(found);
        }
        // What comes to no end on both sides, as a stop that is jumped back to, is compared as far as it went.
        if (pair.compared == 0 && pair.endless.is_empty()) || !pair.reasons.is_empty() {
            return Some(found);
        }
        self.coverage = coverage;
        self.target_coverage = target_coverage;
        if new && left.searches > 0 && !self.went_every_way() {
            left.searches -= 1;
            let job = Job { effort: narrow(effort), ..job };
            let mut wide = Verifier { given: self.given.clone(), ..Verifier::new(&job, self.program) };
            wide.search(there);
            match &wide.witness {
                Some(witness) if is_named => self.because(Why::Edited, &differ(&edits, &witness.what)),
                None if wide.compared > 0 && wide.reasons.is_empty() => {
                    self.coverage.add_gone(&wide.coverage, &ours_back);
                    self.target_coverage.add_gone(&wide.target_coverage, &theirs_back);
                    self.take_in(wide);
                }
                _ => {}
            }
        }
        self.tried += 1;
        self.compared += pair.compared;
        self.largest = self.largest.max(pair.largest);
        self.texts.extend(pair.texts);
        for (fact, text) in pair.unconfirmed {
            self.unconfirmed.entry(fact).or_insert(text);
        }
        self.edits.extend(edits);
        found.is_new = true;
        Some(found)
    }

    /// Changes as a certificate has them.
    fn as_edits(&self, changes: &[Change<'_>]) -> Vec<Edit> {
        let Job { source, target, .. } = self.job;
        let together = self.edits.last().map_or(0, |last| last.together) + 1;
        let edit = |(Twins { ours, part, theirs, .. }, value): &Change<'_>| Edit {
            variable: ours.name.clone(),
            line: source.line_of(self.program.file, ours.span.start).0,
            register: theirs.name.clone(),
            target_line: target.line_of(part.file, theirs.span.start).0,
            value: *value,
            together,
        };
        changes.iter().map(edit).collect()
    }
}

/// What edits may still do.
pub(super) struct Left {
    /// Blocks that runs of the source may execute.
    pub(super) steps: u64,
    /// Edited texts of which all ways may be searched for.
    searches: usize,
}

/// The effort of a search in an edited text.
fn narrow(effort: Effort) -> Effort {
    let [scenarios, tries] = SEARCH;
    let all_steps = effort.all_steps.min(SEARCH_STEPS);
    Effort { scenarios: effort.scenarios.min(scenarios), tries: effort.tries.min(tries), all_steps, ..effort }
}

/// Values worth a try: what conditions name, and what lies about the constant.
pub(super) fn values(constant: f64, numbers: &[f64]) -> Vec<f64> {
    // A step that is no part of its way goes beyond the end of it.
    let uneven = [0.7, 1.3].map(|by| (constant * by * 1e4).round() / 1e4);
    let about =
        [0.0, 1.0, constant - 1.0, constant + 1.0, constant + 0.5, -constant, constant * 2.0, constant / 2.0];
    let mut seen = BTreeSet::from([(constant + 0.0).to_bits()]);
    // 1.1 less 1 has digits that nobody writes, and that a control may have an alarm for.
    let written = |value: f64| if value.abs() < 1e6 { (value * 1e7).round() / 1e7 } else { value };
    let about = about.map(written);
    let all = about.into_iter().chain(uneven).chain(numbers.iter().copied()).map(|value| value + 0.0);
    all.filter(|value| seen.insert(value.to_bits())).take(VALUES).collect()
}

/// Where the places of an edited program stood before, by the file that it stands in.
pub(super) fn back(text: &EditedText, edited: usize) -> impl Fn(usize, Span) -> Span {
    move |file, span| match file == edited {
        true => Span::new(text.before(span.start), text.before(span.end)),
        false => span,
    }
}
