//! `macroglot.toml`: a shop's libraries and machines, so that `convert` and `check`
//! need no flags in its repository.

use super::accepted::{Entry, seen_from};
use super::places::slashed;
use super::project_places::ProjectPlaces;
use super::selection::Selection;
use crate::dialect::registry;
use crate::text::LineIndex;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A shop's project file.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Project {
    /// The machines, by name.
    #[serde(default)]
    pub machines: BTreeMap<String, Machine>,
    /// The libraries, by name.
    #[serde(default)]
    pub libraries: BTreeMap<String, Library>,
    /// What `macroglot check` looks at.
    #[serde(default)]
    pub checks: Checks,
    /// Reviews that somebody accepted.
    #[serde(default)]
    pub accepted: Vec<Entry>,
    /// The folder that the file lies in; all its paths count from here.
    #[serde(skip)]
    pub root: PathBuf,
    /// Where its entries stand.
    #[serde(skip)]
    pub places: ProjectPlaces,
}

/// A machine.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Machine {
    /// Its dialect.
    pub dialect: String,
    /// Its profile.
    pub profile: Option<PathBuf>,
}

/// A library of programs.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Library {
    /// Its folder.
    pub path: PathBuf,
    /// The files of the folder that are of the library, as patterns: `*` is any letters but `/`, `**` any. All without it.
    pub only: Option<Vec<String>>,
    /// Files of the folder that are not, as patterns.
    #[serde(default)]
    pub except: Vec<String>,
    /// The machine its programs are written for.
    pub machine: String,
    /// True where each folder in it is a library of its own: copies for several machines, or a folder for each job.
    #[serde(default)]
    pub apart: bool,
    /// Folders and files with programs that those of each folder may call.
    #[serde(default)]
    pub shared: Vec<PathBuf>,
    /// The machines it is converted to, and the folder each conversion goes to.
    #[serde(default)]
    pub targets: BTreeMap<String, PathBuf>,
}

/// What `macroglot check` looks at.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Checks {
    /// Machines that each program is to get to and come back from.
    #[serde(default)]
    pub round_trip: Vec<String>,
    /// Codes that count, or beginnings of some; those that are on by default if it is empty.
    #[serde(default)]
    pub select: Vec<String>,
    /// Codes that count too.
    #[serde(default)]
    pub extend_select: Vec<String>,
    /// Codes that do not count.
    #[serde(default)]
    pub ignore: Vec<String>,
    /// Reports that were signed: what they are about is to stay as it is.
    #[serde(default)]
    pub signed: Vec<PathBuf>,
    /// Findings that somebody has looked at.
    #[serde(default)]
    pub allow: Vec<Allow>,
}

/// Findings that somebody has looked at, and found to be as they should.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Allow {
    /// The code, or the beginning of some.
    pub code: String,
    /// The files, seen from the project's folder: `*` is any letters but `/`, `**` any.
    pub path: String,
    /// Why.
    pub reason: String,
}

/// Why a project file could not be used.
#[derive(Debug, thiserror::Error)]
#[error("{path}{place}: {message}", place = .place.map(|(line, column)| format!(":{line}:{column}")).unwrap_or_default())]
pub struct ProjectError {
    /// The file.
    pub path: PathBuf,
    /// The line and the column, where known.
    pub place: Option<(u32, u32)>,
    /// What is wrong.
    pub message: String,
}

impl Project {
    /// The file's name.
    pub const NAME: &'static str = "macroglot.toml";

    /// The project file in `folder` or the nearest folder above it.
    pub fn find(folder: &Path) -> Result<Option<Self>, ProjectError> {
        let folder = std::fs::canonicalize(folder).unwrap_or_else(|_| folder.to_owned());
        let Some(path) = folder.ancestors().map(|f| f.join(Self::NAME)).find(|path| path.is_file()) else {
            return Ok(None);
        };
        let fault = |place, message: String| ProjectError { path: path.clone(), place, message };
        let text = std::fs::read_to_string(&path).map_err(|error| fault(None, error.to_string()))?;
        let lines = LineIndex::new(text.as_bytes());
        let place = |at: usize| lines.place(u32::try_from(at).unwrap_or(u32::MAX));
        let mut project: Self = toml::from_str(&text).map_err(|error| {
            fault(error.span().map(|span| place(span.start)), error.message().to_string())
        })?;
        if let Some((at, why)) = project.accepted.iter().find_map(Entry::fault) {
            return Err(fault(Some(place(at)), format!("[[accepted]]: {why}")));
        }
        project.places = ProjectPlaces::read(&text);
        if let Some((names, message)) = project.wrong() {
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            return Err(fault(project.places.at(&names), message));
        }
        project.root = path.parent().map(Path::to_owned).unwrap_or_default();
        Ok(Some(project))
    }

    /// What names something that is not there, with the names of the keys that lead to it.
    fn wrong(&self) -> Option<(Vec<String>, String)> {
        let to = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
        let odd = |(name, machine): &(&String, &Machine)| {
            registry::find(&machine.dialect).is_none().then(|| {
                let known: Vec<&str> = registry::all().iter().map(|entry| entry.name).collect();
                let message =
                    format!("no dialect is named '{}': use one of {}", machine.dialect, known.join(", "));
                (to(&["machines", name, "dialect"]), message)
            })
        };
        if let Some(wrong) = self.machines.iter().find_map(|machine| odd(&machine)) {
            return Some(wrong);
        }
        for (name, library) in &self.libraries {
            if let Err((key, why)) = Selection::of(library) {
                return Some((to(&["libraries", name, key]), format!("library '{name}': {why}")));
            }
            let own = (to(&["libraries", name, "machine"]), &library.machine);
            let targets = library.targets.keys().map(|key| (to(&["libraries", name, "targets", key]), key));
            for (names, machine) in std::iter::once(own).chain(targets) {
                if !self.machines.contains_key(machine) {
                    let message = format!(
                        "library '{name}' names machine '{machine}', but [machines] does not have it"
                    );
                    return Some((names, message));
                }
            }
        }
        let mut trips = self.checks.round_trip.iter().enumerate();
        let (at, name) = trips.find(|(_, name)| self.machine_of(name).is_none())?;
        let message = format!(
            "[checks] asks for a round trip to '{name}', which is no machine of [machines] and no dialect"
        );
        Some((to(&["checks", "round_trip", &at.to_string()]), message))
    }

    /// A path of the project file that a machine's profile or a library has, and that is not there: with its place.
    pub fn missing(&self, library: &str) -> Option<String> {
        let own = self.libraries.get(library)?;
        let is_there = |path: &Path| self.root.join(path).exists();
        if !is_there(&own.path) {
            let place = self.places.named(&["libraries", library, "path"]);
            return Some(format!("{place}: there is no such file or folder: {}", own.path.display()));
        }
        if let Some((at, path)) = own.shared.iter().enumerate().find(|(_, path)| !is_there(path)) {
            let place = self.places.named(&["libraries", library, "shared", &at.to_string()]);
            return Some(format!("{place}: there is no such file or folder: {}", path.display()));
        }
        std::iter::once(&own.machine).chain(own.targets.keys()).find_map(|name| {
            let profile = self.machines.get(name)?.profile.as_ref().filter(|path| !is_there(path))?;
            let place = self.places.named(&["machines", name, "profile"]);
            Some(format!("{place}: there is no profile {}", profile.display()))
        })
    }

    /// The libraries that hold all of these files, by name.
    pub fn libraries_of<'p>(
        &'p self,
        files: impl Iterator<Item = &'p Path>,
    ) -> impl Iterator<Item = (&'p String, &'p Library)> {
        let real = |path: &Path| std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        let files: Vec<PathBuf> = files.map(real).collect();
        self.libraries.iter().filter(move |(_, library)| {
            let folder = real(&self.root.join(&library.path));
            let selection = Selection::of(library).unwrap_or_default();
            let is_of = |file: &PathBuf| {
                // A library may be one file.
                let name = file.strip_prefix(&folder).ok();
                name.is_some_and(|name| name.as_os_str().is_empty() || selection.takes(&slashed(name)))
            };
            files.iter().all(is_of)
        })
    }

    /// A file or folder as entries of the project file name it: seen from its folder, with `/` between parts.
    pub fn place_of(&self, path: &Path) -> String {
        seen_from(path, &self.root)
    }

    /// The machine of this name; or, for the name of a dialect, the first one of it that has a profile, a plain one if
    /// there is none.
    pub fn machine_of(&self, name: &str) -> Option<(String, Machine)> {
        if let Some(machine) = self.machines.get(name) {
            return Some((name.to_owned(), machine.clone()));
        }
        let dialect = registry::find(name)?.name;
        let mut own = self.machines.iter().filter(|(_, machine)| machine.dialect == dialect);
        let own = own.find(|(_, machine)| machine.profile.is_some());
        let plain = || (name.to_owned(), Machine { dialect: dialect.to_owned(), profile: None });
        Some(own.map_or_else(plain, |(name, machine)| (name.clone(), machine.clone())))
    }
}
