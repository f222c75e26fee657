//! The verification of one program.

mod assumed;
mod edited;
mod elsewhere;
mod entries;
mod explore;
mod fewer_digits;
mod otherwise;
mod weigh;

use super::assumed::{Assumptions, excuse, facts, tried};
use super::branches::{Coverage, NotReached};
use super::callers::{Shown, implicate, look_at_callers, through};
use super::certificate::{Edit, Moment, ProgramCertificate, Reason, Why, Witness};
use super::clock::{Clock, Spent};
use super::compare::{Difference, Tolerance, compare, is_cut};
use super::entry_state::{EntryState, given};
use super::questions::unconfirmed;
use super::scenarios::{asked, on_target};
use super::side::Side;
use super::symbol_map::SymbolMap;
use super::variables::writes_elsewhere;
use super::{Certificate, Effort, Outcome};
use crate::canon::Op;
use crate::control::trace::EventKind;
use crate::control::{End, ProgramRef, Run, Scenario};
pub(super) use explore::of_target;
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use weigh::{Pair, ROUNDS};

/// What is to be compared.
pub struct Job<'j> {
    /// The source.
    pub source: &'j Side<'j>,
    /// The target.
    pub target: &'j Side<'j>,
    /// What is called what.
    pub names: &'j SymbolMap,
    /// What the conversion supposes: a person looks at that whatever is found here.
    pub assumptions: &'j Assumptions,
    /// How much may be done.
    pub effort: Effort,
    /// What was done for other programs.
    pub spent: &'j Spent,
}

/// Ways not gone that a reason names.
const NAMED: usize = 3;

/// Verifies programs of the source; all of them where none is named.
pub fn verify(job: &Job<'_>, programs: &[ProgramRef]) -> Certificate {
    let all = if programs.is_empty() { job.source.links().programs().to_vec() } else { programs.to_vec() };
    prepare(job, &all);
    let found = all.into_par_iter().map(|program| Verifier::new(job, program).run()).collect();
    let mut certificate = Certificate::new(job.source.control, job.target.control, job.effort, found);
    implicate(std::slice::from_mut(&mut certificate).iter_mut());
    certificate
}

/// Works out on all cores what programs have in common; whoever calls [`verify`] for several files at a time does this
/// before.
pub fn prepare(job: &Job<'_>, programs: &[ProgramRef]) {
    look_at_callers(job, programs);
}

struct Verifier<'v, 'j> {
    job: &'v Job<'j>,
    clock: Clock,
    program: ProgramRef,
    /// True where other programs of the library call it.
    called: bool,
    /// What all its callers give it.
    given: EntryState,
    /// What is in force at the start on the target, where that is not the same as on the source.
    target_given: Option<EntryState>,
    coverage: Coverage,
    /// The branches of the conversion, those of programs that the source has not among them.
    target_coverage: Coverage,
    /// What is in registers that the target alone has, in the scenario at hand.
    theirs: BTreeMap<String, f64>,
    reasons: BTreeMap<Why, BTreeSet<String>>,
    /// Unconfirmed facts that mattered; with where they did, those that nobody reported.
    unconfirmed: BTreeMap<String, Option<String>>,
    texts: BTreeSet<(String, String)>,
    tolerance: Tolerance,
    largest: f64,
    compared: usize,
    tried: usize,
    steps: u64,
    /// Constants that were edited on both sides to go a way that they decide.
    edits: Vec<Edit>,
    /// What came to no end on both sides, the same as far as it went.
    endless: BTreeSet<String>,
    sensitive: Option<bool>,
    witness: Option<Witness>,
    /// Where the witness was.
    shown: Shown,
    /// The programs that runs of the source came through.
    entered: BTreeSet<ProgramRef>,
    /// How many runs kept each of its assumptions, and how many broke it.
    assumed: BTreeMap<usize, (usize, usize)>,
    /// Scenarios that went new ways to an end of the program's own, with what was in registers of the target alone.
    telling: Vec<(Scenario, BTreeMap<String, f64>)>,
    /// True where it returns, so that others may call it.
    returns: bool,
    /// The settings of the switches that skip blocks.
    skips: Vec<u32>,
    /// The states that it was started in besides that of power-on.
    started: Vec<&'static str>,
}

impl<'v, 'j> Verifier<'v, 'j> {
    fn new(job: &'v Job<'j>, program: ProgramRef) -> Self {
        let called = job.source.links().is_called(program);
        // Worked out for all programs at once, so before the time of this one begins.
        let given = called.then(|| job.source.given.get_or_init(|| given(job)).get(&program).cloned());
        let Effort { program_seconds, library_seconds, .. } = job.effort;
        Self {
            job,
            clock: job.spent.clock(program_seconds, library_seconds),
            program,
            called,
            given: given.flatten().unwrap_or_default(),
            target_given: None,
            coverage: Coverage::new(job.source, &[program], false),
            target_coverage: Coverage::new(job.target, &of_target(job, program), true),
            theirs: BTreeMap::new(),
            reasons: BTreeMap::new(),
            unconfirmed: BTreeMap::new(),
            texts: BTreeSet::new(),
            tolerance: Tolerance::of(job.source, job.target),
            largest: 0.0,
            compared: 0,
            tried: 0,
            steps: 0,
            edits: Vec::new(),
            endless: BTreeSet::new(),
            sensitive: None,
            witness: None,
            shown: Shown::default(),
            entered: BTreeSet::new(),
            assumed: BTreeMap::new(),
            telling: Vec::new(),
            returns: false,
            skips: Vec::new(),
            started: Vec::new(),
        }
    }

    fn run(mut self) -> ProgramCertificate {
        let Job { source, target, names, .. } = self.job;
        let there = names.program(source, self.program, target);
        match there {
            Some(there) => {
                self.search(there);
                self.otherwise(there);
                self.entries(there);
                self.elsewhere(there);
                self.edited(there);
            }
            None => self.because(Why::NoTarget, "the target has no such program"),
        }
        self.job.spent.add(&self.clock);
        self.certificate(there)
    }

    /// The circumstances of a scenario on the target, whose source ran so.
    fn circumstances(&self, scenario: &Scenario, run: &Run) -> Scenario {
        let Job { source, target, names, .. } = self.job;
        let mut out = on_target(scenario, names, (source, target), (self.called, &self.theirs));
        // What is called is in the unit of its caller, on both sides.
        let of_caller = self.given.inch().or(if self.called { scenario.inch } else { None });
        out.inch = of_caller.or(out.inch);
        if let Some(given) = &self.target_given {
            (out.modes, out.entry) = (given.unlike_power_on(), given.entry.clone());
        }
        out.answers.resize(asked(run).max(scenario.answers.len()), 0.0);
        if is_cut(run) {
            // Only what both did so far is compared.
            out.steps = scenario.steps.saturating_mul(3);
        }
        out
    }

    fn run_source(&self, scenario: &Scenario) -> Run {
        let source = self.job.source;
        (source.execute)(&source.library, self.program, source.control, scenario)
    }

    /// Compares the runs of a scenario. True where the target's went a new way.
    fn compare(&mut self, scenario: &Scenario, run: &Run, there: ProgramRef) -> bool {
        let Job { source, target, names, .. } = self.job;
        let circumstances = self.circumstances(scenario, run);
        let other = (target.execute)(&target.library, there, target.control, &circumstances);
        self.entered.extend(source.links().entered(run));
        let assumed = facts(self.job, run);
        let new_there = self.target_coverage.add(&other);
        for (side, library, library_run) in [("source", source, run), ("target", target, &other)] {
            match &library_run.end {
                End::Error { text, .. } => self.because(Why::CannotRun, &format!("the {side}: {text}")),
                End::StepBudget | End::TimeBudget => {
                    let text = format!("the {side} did not end in {} blocks", library_run.steps);
                    let alone = side == "target" && !is_cut(run);
                    if alone { self.because(Why::Endless, &text) } else { self.endless.extend([text]) }
                }
                End::Ended | End::Alarm { .. } => {}
            }
            for event in &library_run.events {
                if let EventKind::Unsure { fact } = &event.what {
                    let is_new = !assumed.contains(fact.as_str());
                    let kept = self.unconfirmed.entry(fact.clone()).or_default();
                    if is_new && kept.is_none() {
                        *kept = Some(unconfirmed(fact, side, &Moment::of(library, library_run, event)));
                    }
                }
            }
        }
        let found = compare((source, run), (target, &other), names, self.tolerance);
        self.largest = self.largest.max(found.largest);
        self.texts.extend(found.texts);
        for text in found.substituted {
            self.because(Why::Substituted, &text);
        }
        let ended = !is_cut(run) && !is_cut(&other);
        // A hair that the last digit decides is no fault of the conversion; any other is.
        let hair = found.hair;
        let hangs = hair.is_some() && self.wavers((there, &circumstances), &other);
        if let Some(hair) = hair.as_ref().filter(|_| hangs) {
            let text = format!("rounding may decide this: add a tolerance or round first ({})", hair.what);
            self.because(Why::Substituted, &text);
        }
        let difference = hair.filter(|_| !hangs).or(found.difference).or_else(|| {
            let what = writes_elsewhere(source, (target, &other), &circumstances.variables, names)?;
            Some(Difference::new(None, None, what))
        });
        let tried = tried(self.job, run, &other);
        let excuse = difference.as_ref().and_then(|d| excuse(&tried, run, &other, d));
        self.count(&tried, ended && difference.is_none());
        self.compared += usize::from(ended && excuse.is_none());
        let upto = difference.as_ref().map(|difference| difference.target);
        if let Some(difference) = &difference {
            let pair = Pair { scenario, run, there, circumstances: &circumstances, other: &other };
            match self.weigh(&pair, difference, excuse) {
                Some((why, text)) => {
                    if why == Why::Unconfirmed {
                        self.unconfirmed.insert(ROUNDS.into(), None);
                    }
                    self.because(why, &text);
                }
                None => self.witnessed(&pair, difference),
            }
        }
        if self.witness.is_none() && self.sensitive != Some(true) && !is_cut(&other) {
            self.sensitive = Some(self.is_sensitive((there, &circumstances), &other, upto));
        }
        new_there
    }

    fn because(&mut self, why: Why, text: &str) {
        let texts = self.reasons.entry(why).or_default();
        if texts.len() < 4 || why == Why::Unconfirmed {
            texts.insert(text.to_owned());
        }
    }

    fn certificate(mut self, there: Option<ProgramRef>) -> ProgramCertificate {
        let source_file = self.job.source.files.get(self.program.file);
        let target_file = there.and_then(|there| self.job.target.files.get(there.file));
        let ways = |coverage: &Coverage, side| there.map_or(Vec::new(), |_| coverage.not_reached(side));
        let not_reached = ways(&self.coverage, self.job.source);
        let target_not_reached = ways(&self.target_coverage, self.job.target);
        for (missed, whose) in [(&not_reached, ""), (&target_not_reached, " of the target")] {
            if !missed.is_empty() {
                self.because(Why::NotReached, &in_words(missed, whose));
            }
        }
        for text in self.unconfirmed.clone().into_values().flatten() {
            self.because(Why::Unconfirmed, &text);
        }
        let assumptions = self.assumptions();
        let mut outcome = match (&self.witness, self.reasons.is_empty()) {
            (Some(_), _) => Outcome::Different,
            (None, false) => Outcome::Undecided,
            (None, true) => Outcome::Same,
        };
        let mut run_alone = false;
        if let Some(witness) = &self.witness {
            let through = through(self.job, self.program, &self.shown, self.tolerance);
            run_alone = through.is_alone(&self.given);
            if let Some(excuse) = through.excuses() {
                let text = format!("run by itself it differs ({}), but {excuse}", witness.what);
                self.because(Why::NotByItself, &text);
                outcome = Outcome::Undecided;
            }
        }
        let (branches_total, branches_covered) = self.coverage.totals();
        let (target_branches_total, target_branches_covered) = self.target_coverage.totals();
        let reasons = self
            .reasons
            .into_iter()
            .flat_map(|(why, texts)| texts.into_iter().map(move |text| Reason { why, text }));
        ProgramCertificate {
            source: source_file.map_or_else(String::new, |file| file.name.to_owned()),
            source_sha256: self.job.source.sha256(self.program.file).to_owned(),
            program: self.job.source.name(self.program).map(ToString::to_string),
            target: target_file.map(|file| file.name.to_owned()),
            target_sha256: there.map(|there| self.job.target.sha256(there.file).to_owned()),
            outcome,
            reasons: reasons.collect(),
            given: self.given.modes.iter().map(Op::to_string).collect(),
            never_come_to: self.given.never_come_to,
            run_alone,
            scenarios_tried: self.tried,
            scenarios_compared: self.compared,
            branches_covered,
            branches_total,
            not_reached,
            target_branches_covered,
            target_branches_total,
            target_not_reached,
            edits: self.edits,
            tolerance_mm: self.tolerance.rounded,
            largest_difference_mm: self.largest,
            rounding_sensitive: self.sensitive,
            unconfirmed: self.unconfirmed.into_keys().collect(),
            texts: self.texts.into_iter().take(20).collect(),
            witness: self.witness,
            started: self.started,
            entered: self.entered,
            assumptions,
        }
    }
}

/// The ways that were never gone, the first of them by name.
fn in_words(missed: &[NotReached], whose: &str) -> String {
    let named = missed
        .iter()
        .take(NAMED)
        .map(|way| format!("'{}' in line {}{whose} was never {}", way.text.trim(), way.line, way.way));
    let more = missed.len().saturating_sub(NAMED);
    let rest = (more > 0).then(|| format!("and {more} more branches{whose} were not reached"));
    named.chain(rest).collect::<Vec<_>>().join("; ")
}
