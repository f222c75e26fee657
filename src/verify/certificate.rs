//! The certificate: what was run, and what came of it. `docs/certificate.md` explains its keys.

use super::{Effort, NotReached, Outcome, Side};
use crate::control::trace::Event;
use crate::control::{ProgramRef, Run, Scenario};
use crate::dialect::Control;
use crate::text::json_pretty;
use memchr::{memchr, memrchr};
use serde::Serialize;
use serde_json::Value;
use sha2::{Digest, Sha256};
use std::collections::{BTreeMap, BTreeSet};

/// Version of the certificate's shape.
pub const FORMAT: u32 = 1;

/// What a verification found, for a file or a library.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Certificate {
    /// Version of the shape of this object.
    pub format: u32,
    /// Version of macroglot.
    pub macroglot: &'static str,
    /// The worst outcome of any program.
    pub outcome: Outcome,
    /// The control of the source.
    pub from: Identity,
    /// The control of the target.
    pub to: Identity,
    /// Seed of the scenarios that were drawn.
    pub seed: u64,
    /// Most blocks that a run executed.
    pub steps: u64,
    /// The programs of the source.
    pub programs: Vec<ProgramCertificate>,
}

/// Which control a side ran on.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Identity {
    /// The dialect.
    pub control: String,
    /// Hash of its table and of the machine profile over it.
    pub sha256: String,
}

/// What was found of one program.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ProgramCertificate {
    /// The source's file.
    pub source: String,
    /// Hash of that file.
    pub source_sha256: String,
    /// The program's name there; none for one without.
    pub program: Option<String>,
    /// The target's file.
    pub target: Option<String>,
    /// Hash of that file.
    pub target_sha256: Option<String>,
    /// What it amounts to.
    pub outcome: Outcome,
    /// Why it is undecided.
    pub reasons: Vec<Reason>,
    /// What its callers' runs gave it, which it was run in; empty where they gave nothing, or not all the same.
    pub given: Vec<String>,
    /// True where the library calls it and no run of its callers came to it: `given` is then what was in force where
    /// those runs ended.
    pub never_come_to: bool,
    /// True where it differs by itself, and no run of what calls it could show what it does then.
    pub run_alone: bool,
    /// Scenarios that the source was tried in.
    pub scenarios_tried: usize,
    /// Scenarios in which both sides were compared.
    pub scenarios_compared: usize,
    /// Ways of the source's branches that were gone.
    pub branches_covered: usize,
    /// Ways that there are.
    pub branches_total: usize,
    /// Ways that were never gone.
    pub not_reached: Vec<NotReached>,
    /// Ways of the target's branches that were gone.
    pub target_branches_covered: usize,
    /// Ways that the target has.
    pub target_branches_total: usize,
    /// Ways of the target that were never gone.
    pub target_not_reached: Vec<NotReached>,
    /// Constants that were edited alike in both texts, each to go a way that it decides; those ways were gone.
    pub edits: Vec<Edit>,
    /// Positions count as the same up to here where words round, millimetres.
    pub tolerance_mm: f64,
    /// The largest distance between positions that counted as the same, millimetres.
    pub largest_difference_mm: f64,
    /// True where the path of the target changes when its arithmetic keeps fewer digits; none if that was not tried.
    pub rounding_sensitive: Option<bool>,
    /// What the conversion supposes of the program.
    pub assumptions: Vec<Assumed>,
    /// Facts that mattered in a run and that no source confirms.
    pub unconfirmed: Vec<String>,
    /// Messages, outputs and alarm numbers that read differently: source, target.
    pub texts: Vec<(String, String)>,
    /// The states of the machine that it was started in besides that of power-on, by name.
    pub started: Vec<&'static str>,
    /// Where they differ.
    pub witness: Option<Witness>,
    /// The programs that its runs came through.
    #[serde(skip)]
    pub entered: BTreeSet<ProgramRef>,
}

/// Something that the conversion supposes of the program.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Assumed {
    /// The kind of it.
    pub kind: &'static str,
    /// What a person was told.
    pub text: String,
    /// The line of the source.
    pub line: u32,
    /// The column.
    pub column: u32,
    /// Runs in which both sides did the same and that kept it; none if no run can show it.
    pub kept: Option<usize>,
    /// Runs that broke it.
    pub broken: Option<usize>,
}

/// A literal at the head of both texts, and the one that stood there in a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Edit {
    /// The variable that it is assigned to.
    pub variable: String,
    /// The line of the source.
    pub line: u32,
    /// The register of the target.
    pub register: String,
    /// The line of the target.
    pub target_line: u32,
    /// What stood there instead.
    pub value: f64,
}

/// Why a program is undecided.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Reason {
    /// The kind of reason.
    pub why: Why,
    /// In words.
    pub text: String,
}

/// Kinds of reasons for being undecided.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Why {
    /// The target has no such program.
    NoTarget,
    /// No scenario could be compared to its end.
    NothingCompared,
    /// A control could not run it.
    CannotRun,
    /// A run did not come to its end.
    Endless,
    /// Its verification took the processor time that it may.
    OutOfTime,
    /// The source stops with an alarm of its control where the target goes on, or stops elsewhere.
    SourceAlarms,
    /// The target cannot do what the source does, and does something else or nothing in its place.
    Substituted,
    /// A run breaks what the conversion supposes, and what comes then was not compared.
    Condition,
    /// No run kept something that the conversion supposes.
    NoRunKept,
    /// It calls a program that is not written.
    Callee,
    /// It does the same as its library calls it, but something else where it is run by itself.
    NotByItself,
    /// With another literal at the head of both texts they do different things.
    Edited,
    /// What the source does rests on a state that it finds on the machine, and from another one they do different things.
    EntryState,
    /// A branch went one way only.
    NotReached,
    /// Something rests on a fact that no source confirms.
    Unconfirmed,
}

/// Where two programs differ.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Witness {
    /// What differs.
    pub what: String,
    /// The circumstances, as the source's names have them.
    pub scenario: Scenario,
    /// The states of the machine that the runs were started in, in words; none if it was that of power-on.
    pub started: Vec<&'static str>,
    /// What stood in registers that the target alone has, by its own names.
    pub target_variables: BTreeMap<String, f64>,
    /// Where the source was; none if it did nothing more.
    pub source: Option<Moment>,
    /// Where the target was.
    pub target: Option<Moment>,
}

/// A moment of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Moment {
    /// The file.
    pub file: String,
    /// The program of it that ran, as its control names it.
    pub program: String,
    /// The line.
    pub line: u32,
    /// The block.
    pub block: String,
    /// What happened.
    pub event: Value,
}

impl Certificate {
    /// A certificate of programs.
    pub fn new(from: &Control, to: &Control, effort: Effort, programs: Vec<ProgramCertificate>) -> Self {
        Self {
            format: FORMAT,
            macroglot: env!("CARGO_PKG_VERSION"),
            // Of nothing nothing was shown.
            outcome: programs.iter().map(|program| program.outcome).max().unwrap_or(Outcome::Undecided),
            from: Identity::of(from),
            to: Identity::of(to),
            seed: effort.seed,
            steps: effort.steps,
            programs,
        }
    }

    /// Takes the worst outcome of its programs anew.
    pub fn sum_up(&mut self) {
        self.outcome = self.programs.iter().map(|program| program.outcome).max().unwrap_or(self.outcome);
    }

    /// As JSON text.
    pub fn print(&self) -> String {
        json_pretty(self) + "\n"
    }
}

impl Identity {
    /// Of a control.
    pub fn of(control: &Control) -> Self {
        let mut hash = Sha256::new();
        for (_, text) in control.entry().files() {
            hash.update(text.as_bytes());
        }
        hash.update(format!("{:?}", control.profile()).as_bytes());
        Self { control: control.name().into(), sha256: hex(&hash.finalize()) }
    }
}

/// The hash of a file's bytes.
pub fn sha256(bytes: &[u8]) -> String {
    hex(&Sha256::digest(bytes))
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

impl Moment {
    /// Where an event happened.
    pub(super) fn of(side: &Side<'_>, run: &Run, event: &Event) -> Self {
        let ran = run.programs.get(event.at.program as usize);
        let program = ran.map_or_else(String::new, |program| program.name.clone());
        let Some(file) = ran.and_then(|program| side.files.get(program.file)) else {
            let event = serde_json::to_value(&event.what).unwrap_or_default();
            return Self { file: String::new(), program, line: 0, block: String::new(), event };
        };
        let source = ran.and_then(|program| side.source(program.file)).unwrap_or_default();
        let place = event.at.span.start;
        let (line, _) = ran.map_or((1, 1), |ran| side.line_of(ran.file, place));
        let (before, behind) = source.split_at_checked(place as usize).unwrap_or((source, &[]));
        let start = memrchr(b'\n', before).map_or(0, |at| at + 1);
        let end = memchr(b'\n', behind).map_or(source.len(), |at| before.len() + at);
        let block = source.get(start..end).unwrap_or_default();
        Self {
            file: file.name.to_owned(),
            program,
            line,
            block: String::from_utf8_lossy(block).trim_end().to_owned(),
            event: serde_json::to_value(&event.what).unwrap_or_default(),
        }
    }
}
