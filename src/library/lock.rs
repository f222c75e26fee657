//! `macroglot.lock`: which register holds which variable, which number a program
//! got. Later runs honour it, so that a library stays one library; a reviewer can read it.

use super::outputs::read_text;
use crate::ir::analysis::Numbers;
use crate::legalize::{Elsewhere, Locked, Registers};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// The choices of earlier runs.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Lock {
    /// Version of this file's shape.
    pub version: u32,
    /// The source's dialect.
    pub from: String,
    /// The target's dialect.
    pub to: String,
    /// Registers of the target for values in between: no program may rely on what they hold.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub scratch: Vec<u32>,
    /// Registers of the target that words take, for values in between, by name.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub of_words: Vec<String>,
    /// Those of them whose values must outlive calls: no program that is converted by itself may use them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub over_calls: Vec<u32>,
    /// The files whose programs rely on what stands here, by their names among the inputs.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub files: Vec<String>,
    /// Variables that programs have under their own number: nothing else goes there.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub own: Vec<u32>,
    /// Runs of numbers that programs reach by computing them: nothing else goes there.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub reached: Vec<(u32, u32)>,
    /// Files of earlier runs that the present run does not convert: what they rely on stays as it is.
    #[serde(skip)]
    pub others: Vec<String>,
    /// What other libraries of this run have on the same machine.
    #[serde(skip)]
    pub elsewhere: Elsewhere,
    /// Register numbers on the target, by the variable's name on the source.
    #[serde(default)]
    pub variables: BTreeMap<String, u32>,
    /// Registers that calls set to what they give, by its name in the program that is called.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub arguments: BTreeMap<String, u32>,
    /// Those of them that every call gives a value.
    #[serde(default, skip_serializing_if = "BTreeSet::is_empty")]
    pub always: BTreeSet<String>,
    /// Program numbers on the target, by what names the program on the source.
    #[serde(default)]
    pub programs: BTreeMap<String, u32>,
    /// Where calls reach no other file: the programs that hold a copy of a program, by its name on the source.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub parts: BTreeMap<String, BTreeSet<String>>,
}

/// Why a lock could not be used.
#[derive(Debug, thiserror::Error)]
pub enum LockError {
    /// It cannot be read or is no lock.
    #[error("{0}: {1}")]
    Unreadable(PathBuf, String),
    /// It is of another conversion.
    #[error(
        "{path}: is the lock of a conversion from {from} to {to}; use another --out, or delete it to choose anew"
    )]
    OtherPair {
        /// The lock.
        path: PathBuf,
        /// Its source.
        from: String,
        /// Its target.
        to: String,
    },
}

/// The version that is written.
const VERSION: u32 = 1;

/// What stands for the files of a lock that does not name them.
const UNNAMED: &str = "programs that were converted before";

const HEAD: &str = "\
# Which register of the target holds which variable of the source, which hold
# values in between (scratch, and of_words on a target whose words take registers
# of their own; over_calls: those that outlive calls), what calls give to programs
# (arguments), and which number each program got that had none there. Nothing goes to the numbers in own and reached: the
# programs of the files use them themselves. Written by macroglot, honoured by its
# next run; keep it with the converted programs.

";

const PARTS: &str = "\
# Calls of the target reach no other file. So each program that is called stands
# in the files of those that call it, after their M30: [parts] says in which. A
# change of such a program must be made in each of them, or here and converted again.

";

impl Lock {
    /// The file's name.
    pub const NAME: &'static str = "macroglot.lock";

    /// An empty lock for a pair of dialects.
    pub fn new(from: &str, to: &str) -> Self {
        Self { version: VERSION, from: from.into(), to: to.into(), ..Self::default() }
    }

    /// The lock for a run that converts the files of these names.
    #[must_use]
    pub fn for_run<'n>(mut self, names: impl Iterator<Item = &'n str>) -> Self {
        let names: BTreeSet<&str> = names.collect();
        let chosen = !self.variables.is_empty() || !self.scratch.is_empty();
        self.others = match self.files.is_empty() && chosen {
            // An older lock does not say which.
            true => vec![UNNAMED.into()],
            false => self.files.iter().filter(|file| !names.contains(file.as_str())).cloned().collect(),
        };
        if self.others.is_empty() {
            (self.own, self.reached, self.over_calls) = Default::default();
            self.parts.clear();
            self.arguments.clear();
            self.always.clear();
        }
        let named = self.others.iter().filter(|file| *file != UNNAMED).cloned();
        self.files = named.chain(names.into_iter().map(str::to_owned)).collect();
        self.files.sort_unstable();
        self
    }

    /// Takes over what a run chose: registers, and numbers of programs.
    pub fn take(&mut self, registers: &Registers, programs: BTreeMap<String, u32>) {
        self.programs.extend(programs);
        let freed = |name: &String, _: &mut u32| !registers.freed.contains(name);
        self.variables.retain(freed);
        self.variables.extend(registers.chosen.clone());
        // What an earlier run chose for the programs of this one counts no more.
        let whose = |name: &str| name.rsplit_once(' ').map(|(_, program)| program.to_owned());
        let again: BTreeSet<String> = registers.arguments.keys().filter_map(|name| whose(name)).collect();
        let stays = |name: &String| whose(name).is_none_or(|program| !again.contains(&program));
        self.arguments.retain(|name, _| stays(name));
        self.always.retain(stays);
        self.arguments.extend(registers.arguments.clone());
        self.always.extend(registers.always.clone());
        let held: BTreeSet<u32> = registers.held().filter(|_| self.others.is_empty()).collect();
        let scratch: BTreeSet<u32> = registers.scratch.iter().chain(&self.scratch).copied().collect();
        self.scratch = scratch.difference(&held).copied().collect();
        let words: BTreeSet<String> = registers.of_words.iter().chain(&self.of_words).cloned().collect();
        self.of_words = words.into_iter().collect();
        let over: BTreeSet<u32> = registers.over_calls.iter().chain(&self.over_calls).copied().collect();
        self.over_calls = over.into_iter().collect();
        let own: BTreeSet<u32> = self.own.iter().copied().chain(registers.own()).collect();
        self.own = own.into_iter().collect();
        let reached = self.reached.iter().chain(registers.reached.runs()).copied();
        self.reached = Numbers::of(reached).runs().to_vec();
    }

    /// True if what stands in this lock has another place in a later one, so that programs which rely on it must be
    /// written again.
    pub fn moves_to(&self, later: &Self) -> bool {
        let stays = |(name, number): (&String, &u32)| later.variables.get(name) == Some(number);
        let kept = self.scratch.iter().all(|number| later.scratch.contains(number));
        !kept || !self.variables.iter().all(stays)
    }

    /// Takes over which programs hold copies of which.
    pub fn hold(&mut self, copies: impl Iterator<Item = (String, String)>) {
        for (part, holder) in copies {
            self.parts.entry(part).or_default().insert(holder);
        }
    }

    /// What a library that was converted with this lock has on its machine, besides the programs of these names.
    pub fn held_there<'n>(&self, names: impl Iterator<Item = &'n str>, into: &mut Elsewhere) {
        let own = names
            .filter_map(|name| name.trim_start_matches(|letter: char| !letter.is_ascii_digit()).parse().ok());
        into.programs.extend(self.programs.values().copied().chain(own));
        into.registers.extend(self.variables.values().chain(&self.own).copied());
    }

    /// What the passes are told of it.
    pub fn locked(&self) -> Locked<'_> {
        Locked {
            variables: &self.variables,
            programs: &self.programs,
            scratch: &self.scratch,
            over_calls: &self.over_calls,
            own: &self.own,
            reached: Numbers::of(self.reached.iter().copied()),
            others: &self.others,
            elsewhere: &self.elsewhere,
        }
    }

    /// The lock at `path`; an empty one where there is none.
    pub fn load(path: &Path, from: &str, to: &str) -> Result<Self, LockError> {
        let text = match read_text(path) {
            Ok(text) => text,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(Self::new(from, to)),
            Err(error) => return Err(LockError::Unreadable(path.to_owned(), error.to_string())),
        };
        let lock: Self = toml::from_str(&text)
            .map_err(|error| LockError::Unreadable(path.to_owned(), error.message().to_string()))?;
        if lock.version != VERSION {
            let why = format!("is of version {}, this macroglot writes version {VERSION}", lock.version);
            return Err(LockError::Unreadable(path.to_owned(), why));
        }
        if lock.from != from || lock.to != to {
            return Err(LockError::OtherPair { path: path.to_owned(), from: lock.from, to: lock.to });
        }
        Ok(lock)
    }

    /// Its text.
    pub fn print(&self) -> String {
        let parts = if self.parts.is_empty() { "" } else { PARTS };
        format!("{HEAD}{parts}{}", toml::to_string(self).unwrap_or_default())
    }
}
