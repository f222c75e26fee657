//! Constants at a program's head that decide where it goes, edited alike on both sides.
//!
//! A literal that a main program assigns at its head is what its operator edits. Where it decides a branch, no
//! circumstances go the other way; so both texts are run anew with another literal there. Which literal of the target is
//! the same one is found without the compiler: it is the first thing that the target's program assigns to the register that
//! the lock has for the variable, and it has the same value; of a local, whose register the lock does not name, one of those
//! with that value for which both sides do the same. Ways that the source goes so count where both sides did the
//! same. Where they part, the program is undecided: a person sees whether that literal is the one.

use super::summary::lacks_locals;
use super::verifier::Verifier;
use crate::control::ProgramRef;
use crate::dialect::Control;
use crate::syntax::{Expr, ExprKind, Item, ItemKind, VarRef};
use crate::text::Span;
use crate::verify::certificate::{Edit, Why};
use crate::verify::explore::{Proposals, ends_head, inputs, unit};
use crate::verify::sides::{EditedText, Effort, Job, Side, name_of, of_target};
use crate::verify::triage::moved;
use std::collections::BTreeSet;

/// Constants of a program that are edited, at the most.
const CONSTANTS: usize = 32;

/// Values that each is given, at the most.
const VALUES: usize = 32;

/// Registers that are tried where the lock does not say which holds a constant, at the most.
const TWINS: usize = 4;

/// Edits for ways that the target alone has left.
const FOR_THE_TARGET: usize = 48;

/// Edited texts of which all ways are searched for, at the most, and how much each search may do.
const SEARCHED: usize = 3;
const SEARCH: [usize; 2] = [48, 120];
const SEARCH_STEPS: u64 = 200_000;

/// The first assignment of a variable, where it is a literal.
#[derive(Clone, Debug, PartialEq)]
struct Constant {
    name: String,
    value: f64,
    span: Span,
}

impl Verifier<'_, '_> {
    /// Goes ways that constants decide. What other programs call has no head that an operator edits.
    pub(super) fn edited(&mut self, there: ProgramRef) {
        if self.called || self.witness.is_some() || self.compared == 0 || self.went_every_way() {
            return;
        }
        let Job { source, target, names, .. } = self.job;
        // What the source calls by a block number of its own may be a program of its own there.
        let others = of_target(self.job, self.program).into_iter().filter(|part| *part != there);
        let parts = std::iter::once(there).chain(others);
        let theirs: Vec<(ProgramRef, Constant)> = parts
            .flat_map(|part| constants(target, part, false).into_iter().map(move |twin| (part, twin)))
            .collect();
        let numbers = inputs(source, self.program, target).numbers;
        let mut left = Left { steps: self.job.effort.all_steps, searches: SEARCHED };
        let mut for_target = FOR_THE_TARGET;
        for constant in constants(source, self.program, true).into_iter().take(CONSTANTS) {
            let named = names.variable(&constant.name, source.control, target.control);
            let (is_named, alike) = (named.is_some(), |twin: &Constant| twin.value == constant.value);
            let twins: Vec<_> = match named {
                Some(named) => {
                    let twin = theirs.iter().find(|(_, twin)| twin.name == named);
                    twin.filter(|(_, twin)| alike(twin)).into_iter().collect()
                }
                // The registers of locals have no names in the lock: each that has the value may be it.
                None if lacks_locals(self.job) => {
                    let held = |twin: &Constant| names.of_source(&twin.name, source.control, target.control);
                    let unnamed = theirs.iter().filter(|(_, twin)| alike(twin) && held(twin).is_none());
                    unnamed.take(TWINS).collect()
                }
                None => continue,
            };
            for value in values(constant.value, &numbers) {
                for twin in &twins {
                    if self.went_every_way() || left.steps == 0 || for_target == 0 || self.is_out_of_time() {
                        return;
                    }
                    for_target -= usize::from(self.coverage.is_complete());
                    if self.edit(there, (&constant, twin), (value, is_named), &mut left) {
                        break;
                    }
                }
            }
        }
    }

    /// Runs both sides with another literal, where the source goes a new way by it. A difference counts where the lock has named the
    /// register; else it is another one. True where both did the same.
    fn edit(
        &mut self,
        there: ProgramRef,
        (ours, (part, theirs)): (&Constant, &(ProgramRef, Constant)),
        (value, is_named): (f64, bool),
        left: &mut Left,
    ) -> bool {
        let Job { source, target, names, assumptions, effort, spent } = *self.job;
        let Some(text) = EditedText::new(&source.texts(), self.program, ours.span, value) else {
            return false;
        };
        let blocks = text.parse(&source.texts());
        let Some(new_source) = source.edited(self.program, &text, text.own(&blocks)) else { return false };
        let told = Constant { value, ..ours.clone() };
        if !constants(&new_source, self.program, true)
            .iter()
            .any(|c| (&c.name, c.value) == (&told.name, value))
        {
            return false;
        }
        let found = inputs(&new_source, self.program, target);
        let inch = unit(source, target).or(found.inch);
        let Some(mut scenario) = Proposals::new(&found, effort).next() else { return false };
        scenario.inch = inch;
        self.given.start(&mut scenario);
        let run = (source.execute)(&new_source.library, self.program, source.control, &scenario);
        left.steps = left.steps.saturating_sub(run.steps);
        let mut coverage = self.coverage.clone();
        let new = coverage.add_moved(&run, &back(&text, self.program.file));
        if !new && self.target_coverage.is_complete() {
            return false;
        }
        let Some(other) = EditedText::new(&target.texts(), *part, theirs.span, value) else { return false };
        let blocks = other.parse(&target.texts());
        let Some(new_target) = target.edited(*part, &other, other.own(&blocks)) else { return false };
        new_target.take_over(target, new_source.stands_as(source));
        if !constants(&new_target, *part, false).iter().any(|c| c.name == theirs.name && c.value == value) {
            return false;
        }
        let entered = new_source.links().entered(&run).chain([self.program]);
        let assumptions = moved(assumptions, entered, self.program, |place| text.now(place));
        let job =
            Job { source: &new_source, target: &new_target, names, assumptions: &assumptions, effort, spent };
        let mut pair = Verifier { given: self.given.clone(), ..Verifier::new(&job, self.program) };
        pair.compare(&scenario, &run, there);
        let mut target_coverage = self.target_coverage.clone();
        let new_there = target_coverage.add_gone(&pair.target_coverage, &back(&other, part.file));
        if !new_there && !new && pair.witness.is_none() {
            return false;
        }
        let edit = Edit {
            variable: ours.name.clone(),
            line: source.line_of(self.program.file, ours.span.start).0,
            register: theirs.name.clone(),
            target_line: target.line_of(part.file, theirs.span.start).0,
            value,
        };
        if let Some(witness) = &pair.witness {
            if is_named {
                self.because(Why::Edited, &edit.differs(&witness.what));
            }
            return false;
        }
        // What comes to no end on both sides, as a stop that is jumped back to, is compared as far as it went.
        if (pair.compared == 0 && pair.endless.is_empty()) || !pair.reasons.is_empty() {
            return false;
        }
        self.coverage = coverage;
        self.target_coverage = target_coverage;
        if new && left.searches > 0 && !self.went_every_way() {
            left.searches -= 1;
            let job = Job { effort: narrow(effort), ..job };
            let mut wide = Verifier { given: self.given.clone(), ..Verifier::new(&job, self.program) };
            wide.search(there);
            match &wide.witness {
                Some(witness) if is_named => self.because(Why::Edited, &edit.differs(&witness.what)),
                None if wide.compared > 0 && wide.reasons.is_empty() => {
                    self.coverage.add_gone(&wide.coverage, &back(&text, self.program.file));
                    self.target_coverage.add_gone(&wide.target_coverage, &back(&other, part.file));
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
        self.edits.push(edit);
        true
    }
}

/// What edits may still do.
struct Left {
    /// Blocks that runs of the source may execute.
    steps: u64,
    /// Edited texts of which all ways may be searched for.
    searches: usize,
}

/// The effort of a search in an edited text.
fn narrow(effort: Effort) -> Effort {
    let [scenarios, tries] = SEARCH;
    let all_steps = effort.all_steps.min(SEARCH_STEPS);
    Effort { scenarios: effort.scenarios.min(scenarios), tries: effort.tries.min(tries), all_steps, ..effort }
}

/// The variables whose first assignment in a program's text is a literal; of a head, those before anything can branch.
fn constants(side: &Side<'_>, program: ProgramRef, head: bool) -> Vec<Constant> {
    let (mut written, mut found) = (BTreeSet::new(), Vec::new());
    for block in side.text(program) {
        let skipped = block.items.iter().any(|item| matches!(item.kind, ItemKind::Skip(_)));
        for item in &block.items {
            if head && ends_head(item) {
                return found;
            }
            for (name, value) in writes(item, side.control) {
                // What may be anything may be this variable.
                let Some(name) = name else { return found };
                let first = written.insert(name.clone());
                if let Some(value) = value.filter(|_| first && !skipped)
                    && let Some(number) = literal(value)
                {
                    found.push(Constant { name, value: number, span: value.span });
                }
            }
        }
    }
    found
}

/// What an item writes: the variable's name where that is written, and the value where it is an assignment for sure.
fn writes<'t>(item: &'t Item, control: &Control) -> Vec<(Option<String>, Option<&'t Expr>)> {
    let name_of = |variable: &VarRef| name_of(variable, control);
    match &item.kind {
        ItemKind::Assign { target, value, by_sign: false } => vec![(name_of(target), Some(value))],
        ItemKind::Assign { target, .. } | ItemKind::Step { target, .. } | ItemKind::Timer(target) => {
            vec![(name_of(target), None)]
        }
        ItemKind::Input { targets, .. } => targets.iter().map(|target| (name_of(target), None)).collect(),
        ItemKind::Transfer { cells, .. } => {
            cells.iter().filter(|cell| !cell.store).map(|cell| (name_of(&cell.variable), None)).collect()
        }
        ItemKind::If { body, .. } => {
            body.iter().flat_map(|item| writes(item, control)).map(|(name, _)| (name, None)).collect()
        }
        _ => Vec::new(),
    }
}

fn literal(e: &Expr) -> Option<f64> {
    match &e.kind {
        ExprKind::Number(number) => Some(number.value),
        ExprKind::Negate(inner) => match &inner.kind {
            ExprKind::Number(number) => Some(-number.value),
            _ => None,
        },
        _ => None,
    }
}

/// Values worth a try: what conditions name, and what lies about the constant.
fn values(constant: f64, numbers: &[f64]) -> Vec<f64> {
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
fn back(text: &EditedText, edited: usize) -> impl Fn(usize, Span) -> Span {
    move |file, span| match file == edited {
        true => Span::new(text.before(span.start), text.before(span.end)),
        false => span,
    }
}
