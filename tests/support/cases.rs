//! Programs and what is to come of them: the one form in which tests hold them, `[[case]]` tables in TOML.
//!
//! `name`, `from` (a dialect, or a machine: [`machine`](super::machine)) and `source` say what is given. What is expected
//! is one of these; it comes from manuals, from arithmetic or from another interpreter, never from what macroglot printed:
//!
//! | keys | of | what must be so |
//! |---|---|---|
//! | `to`, `target` or `refused` | `tests/conversions/` | the conversion, without its tape frame |
//! | `ir` | `tests/lowering/` | what the blocks mean |
//! | `reports` | both | the codes that are reported, or facts by name |
//! | `to`, `target`, `lock`, `changes`, `doubts` | `tests/verify/` | a pair that is the same, and not after a change |
//! | `ends`, `moves`, `variables` | `tests/interpreter/` | what a run does |
#![allow(dead_code)] // each test uses its part

use rayon::prelude::*;
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// A program and what is to come of it.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Case {
    pub name: String,
    pub from: String,
    pub to: String,
    pub source: String,
    pub target: String,
    /// True if the program must not be converted.
    pub refused: bool,
    pub ir: String,
    pub reports: BTreeSet<String>,
    /// What the lock says: names and their registers.
    pub lock: BTreeMap<String, u32>,
    /// Changes of the target that must be told apart.
    pub changes: Vec<Change>,
    /// Changes of the target that must not be called the same.
    pub doubts: Vec<Change>,
    /// How the run ends.
    pub ends: String,
    /// Every move, one a line.
    pub moves: String,
    pub variables: BTreeMap<String, f64>,
}

/// One place of a target, changed.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Change {
    /// What stands there once.
    pub of: String,
    /// What stands there instead.
    pub with: String,
    /// What the witness says of it, among other things.
    #[serde(default)]
    pub says: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    case: Vec<Case>,
}

/// The cases of a file, or of all files of a folder, in order.
pub fn cases(path: &str) -> Vec<Case> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    let mut files = vec![path.clone()];
    if path.is_dir() {
        files = std::fs::read_dir(&path).unwrap().map(|entry| entry.unwrap().path()).collect();
        files.retain(|file| file.extension().is_some_and(|ending| ending == "toml"));
        files.sort();
    }
    let read = |file: &Path| {
        let text =
            std::fs::read_to_string(file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
        toml::from_str::<File>(&text).unwrap_or_else(|error| panic!("{}: {error}", file.display())).case
    };
    files.iter().flat_map(|file| read(file)).collect()
}

/// Holds each case to `fault`, which says what is wrong; fails with all faults, or if there are fewer cases than `least`.
pub fn hold(cases: &[Case], least: usize, fault: impl Fn(&Case) -> Option<String> + Sync) {
    let told = |case: &Case| fault(case).map(|fault| format!("{} ({})\n{fault}\n", case.name, case.from));
    let faults: Vec<String> = cases.par_iter().filter_map(told).collect();
    assert!(faults.is_empty(), "{} of {} cases\n\n{}", faults.len(), cases.len(), faults.join("\n"));
    assert!(cases.len() >= least, "only {} cases were found", cases.len());
}
