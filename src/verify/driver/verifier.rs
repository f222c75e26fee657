//! One program while it is verified: what was found of it so far.

use super::steered::Way;
use super::stuck::Calls;
use crate::assume::Predicate;
use crate::canon::Op;
use crate::control::{ProgramRef, Run, Scenario};
use crate::dialect::Units;
use crate::verify::certificate::{Edit, OpenFact, Why, Witness};
use crate::verify::compare::{Tolerance, is_cut};
use crate::verify::entry::given;
use crate::verify::explore::{Coverage, Given, asked, on_target, set_by_hand};
use crate::verify::sides::{Arguments, Clock, Effort, EntryState, Job, of_target};
use crate::verify::triage::Shown;
use std::collections::{BTreeMap, BTreeSet};

/// Blocks that the target may run besides those of a source that comes to no end.
const MARGIN: u64 = 100;

/// A run of the source and one of the target.
#[derive(Clone, Copy)]
pub(super) struct Pair<'p> {
    /// What the source met.
    pub scenario: &'p Scenario,
    /// What it did.
    pub run: &'p Run,
    /// The program of the target.
    pub there: ProgramRef,
    /// What the target met.
    pub circumstances: &'p Scenario,
    /// What it did.
    pub other: &'p Run,
}

/// One program while it is verified.
pub(super) struct Verifier<'v, 'j> {
    pub(super) job: &'v Job<'j>,
    pub(super) clock: Clock,
    pub(super) program: ProgramRef,
    /// The program whose assumptions are counted: itself, unless it is run for one that it calls.
    pub(super) counted: ProgramRef,
    /// True where other programs of the library call it.
    pub(super) called: bool,
    /// Where its arguments stand on a target whose calls give none, while it is given some by itself.
    pub(super) arguments: Option<Arguments>,
    /// What all its callers give it.
    pub(super) given: EntryState,
    /// What is in force at the start on the target, where that is not the same as on the source.
    pub(super) target_given: Option<EntryState>,
    pub(super) coverage: Coverage,
    /// Where runs went that the source's control did not stop, and in which both sides did the same.
    pub(super) sound: Coverage,
    /// The alarms by which the source's control stopped a run where the target went on.
    pub(super) source_stops: BTreeSet<String>,
    /// The branches of the conversion, those of programs that the source has not among them.
    pub(super) target_coverage: Coverage,
    /// What is in registers that the target alone has, in the scenario at hand.
    pub(super) theirs: BTreeMap<String, f64>,
    pub(super) reasons: BTreeMap<Why, BTreeSet<String>>,
    /// Unconfirmed facts that mattered; with where they did, those that nobody reported.
    pub(super) unconfirmed: BTreeMap<String, Vec<OpenFact>>,
    pub(super) texts: BTreeSet<(String, String)>,
    pub(super) tolerance: Tolerance,
    pub(super) largest: f64,
    pub(super) compared: usize,
    pub(super) tried: usize,
    pub(super) steps: u64,
    /// Constants that were edited on both sides to go a way that they decide.
    pub(super) edits: Vec<Edit>,
    /// Ways that edited texts went and did not do the same after.
    pub(super) apart: BTreeSet<Way>,
    /// What came to no end on both sides, the same as far as it went.
    pub(super) endless: BTreeSet<String>,
    /// The first alarm by which the control itself stopped a run of the source.
    pub(super) stopped: Option<String>,
    /// How many runs came to an alarm that stands for a code, and what it stands for.
    pub(super) cut_short: (usize, Option<String>),
    /// Which calls runs came back from.
    pub(super) calls: Calls,
    pub(super) sensitive: Option<bool>,
    pub(super) witness: Option<Witness>,
    /// Where the witness was.
    pub(super) shown: Shown,
    /// The programs that runs of the source came through.
    pub(super) entered: BTreeSet<ProgramRef>,
    /// How many runs kept each of its assumptions, and how many broke it.
    pub(super) assumed: BTreeMap<usize, (usize, usize)>,
    /// Scenarios that went new ways to an end of the program's own, with what was in registers of the target alone.
    pub(super) telling: Vec<(Scenario, BTreeMap<String, f64>)>,
    /// True where it returns, so that others may call it.
    pub(super) returns: bool,
    /// The settings of the switches that skip blocks.
    pub(super) skips: Vec<u32>,
    /// True where its circumstances are ones that its library never shows.
    pub(super) is_unusual: bool,
    /// The states that it was started in besides that of power-on.
    pub(super) started: Vec<&'static str>,
}

impl<'v, 'j> Verifier<'v, 'j> {
    pub(super) fn new(job: &'v Job<'j>, program: ProgramRef) -> Self {
        let called = job.source.links().is_called(program);
        // Worked out for all programs at once, so before the time of this one begins.
        let given = called.then(|| job.source.given.get_or_init(|| given(job)).get(&program).cloned());
        let mut coverage = Coverage::new(job.source, &[program], false);
        if let Some(unit) = unit_of_target(job, program) {
            coverage.given(job.source, program, &Given { locals: &[], unit: Some(unit) });
        }
        let Effort { program_seconds, library_seconds, .. } = job.effort;
        Self {
            job,
            clock: job.spent.clock(program_seconds, library_seconds),
            program,
            counted: program,
            called,
            arguments: None,
            given: given.flatten().unwrap_or_default(),
            target_given: None,
            sound: Coverage::new(job.source, &[program], false),
            source_stops: BTreeSet::new(),
            coverage,
            target_coverage: Coverage::new(job.target, &of_target(job, program), true),
            theirs: BTreeMap::new(),
            reasons: BTreeMap::new(),
            unconfirmed: BTreeMap::new(),
            texts: BTreeSet::new(),
            tolerance: Tolerance::of(job.source, job.target).at_least(job.effort.allowed_mm),
            largest: 0.0,
            compared: 0,
            tried: 0,
            steps: 0,
            edits: Vec::new(),
            apart: BTreeSet::new(),
            endless: BTreeSet::new(),
            stopped: None,
            cut_short: (0, None),
            calls: Calls::default(),
            sensitive: None,
            witness: None,
            shown: Shown::default(),
            entered: BTreeSet::new(),
            assumed: BTreeMap::new(),
            telling: Vec::new(),
            returns: false,
            skips: Vec::new(),
            is_unusual: false,
            started: Vec::new(),
        }
    }

    /// The circumstances of a scenario on the target, whose source ran so.
    pub(super) fn circumstances(&self, scenario: &Scenario, run: &Run) -> Scenario {
        let Job { source, target, names, .. } = self.job;
        let mut out = on_target((scenario, run), names, (source, target), (self.called, &self.theirs));
        if let Some(arguments) = &self.arguments {
            arguments.give(&scenario.variables, &mut out.variables);
        }
        // What is called is in the unit of its caller, on both sides.
        let of_caller = self.given.inch().or(if self.called { scenario.inch } else { None });
        out.inch = set_by_hand(target, run).or(of_caller).or(out.inch);
        if let Some(given) = &self.target_given {
            (out.modes, out.entry) = (given.unlike_power_on(), given.entry.clone());
        }
        out.answers.resize(asked(run).max(scenario.answers.len()), 0.0);
        if is_cut(run) {
            // Only what both did so far is compared.
            out.steps = run.steps.saturating_add(MARGIN).saturating_mul(3);
        }
        out
    }

    pub(super) fn run_source(&self, scenario: &Scenario) -> Run {
        let source = self.job.source;
        if let Some(arguments) = &self.arguments {
            let mut scenario = scenario.clone();
            arguments.complete(&mut scenario.variables);
            return (source.execute)(&source.library, self.program, source.control, &scenario);
        }
        (source.execute)(&source.library, self.program, source.control, scenario)
    }

    pub(super) fn because(&mut self, why: Why, text: &str) {
        let texts = self.reasons.entry(why).or_default();
        if texts.len() < 4 || why == Why::Unconfirmed {
            texts.insert(text.to_owned());
        }
    }
}

/// The code of the source for the unit that the target is in, where no code of its programs changes that.
fn unit_of_target(job: &Job<'_>, program: ProgramRef) -> Option<f64> {
    let assumed = job.assumptions.get(&program).into_iter().flatten();
    if assumed.into_iter().any(|one| matches!(one.predicate, Predicate::SetTo(_))) {
        return None;
    }
    let units = job.target.control.units().filter(|_| !job.target.selects_unit())?;
    let op = if units == Units::Inch { Op::Inch } else { Op::Metric };
    job.source.control.code_for(op, &BTreeMap::new()).and_then(|row| row.code.get(1..)?.parse().ok())
}
