//! What was found of one program. `docs/certificate.md` explains its keys.

use super::moment::Moment;
use super::outcome::{Outcome, Reason};
use super::unconfirmed::OpenFact;
use crate::control::{ProgramRef, Scenario};
use crate::verify::explore::NotReached;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

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
    /// Ways of the source that only raise an alarm and that no run went: both texts say the same there.
    pub by_text: Vec<NotReached>,
    /// Alarms by which the source's control stopped runs of a called program where the target went on; other runs went every way
    /// of these to their own ends.
    pub source_stops: Vec<String>,
    /// Ways of the source that no run of it can go, whatever it finds: only other numbers in its text would. Nobody ran them.
    pub by_own_numbers: Vec<NotReached>,
    /// The same of the target.
    pub target_by_own_numbers: Vec<NotReached>,
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
    /// Those of the unconfirmed facts that the conversion did not report.
    #[serde(skip)]
    pub open_facts: Vec<OpenFact>,
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
    /// Edits that were made together have one number, counted from 1.
    pub together: usize,
}

/// That the two texts differ with these edits.
pub fn differ(edits: &[Edit], what: &str) -> String {
    let each = edits.iter().map(|Edit { variable, line, register, target_line, value, .. }| {
        format!("{value} for {variable} in line {line} and for {register} in line {target_line}")
    });
    format!("with {} they differ: {what}", each.collect::<Vec<_>>().join(", with "))
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
