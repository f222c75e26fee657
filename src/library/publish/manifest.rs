//! `macroglot.manifest`: what macroglot wrote into a folder, with hashes.
//!
//! From it a later run knows which files are stale, which a person changed since, and whose source is gone.

use crate::dialect::{Control, Machine};
use crate::library::inputs::same_file;
use crate::library::outputs::{read_file, read_text};
use crate::library::places::slashed;
use crate::verify::sha256;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io;
use std::path::{Component, Path, PathBuf};

/// What a file is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// A conversion.
    Program,
    /// A conversion with alarms at its holes.
    Draft,
    /// What was verified of the program beside it.
    Certificate,
    /// What was found of a program that is not written.
    Withheld,
}

/// The files that macroglot wrote into a folder.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Manifest {
    /// Version of this file's shape.
    pub version: u32,
    /// The files, by their names in the folder.
    #[serde(default)]
    pub files: BTreeMap<String, Entry>,
    /// Conversions that call one another, with their SHA-256 when they were verified, by a number that entries name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub together: BTreeMap<String, BTreeMap<String, String>>,
    /// The sources that conversions were made of, by their names among the inputs; those too that have none. What earlier
    /// versions wrote does not say so.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub sources: BTreeMap<String, Made>,
}

/// What a conversion was made of.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Made {
    /// SHA-256 of the source.
    pub sha256: String,
    /// What [`profiles_of`] told of the machines.
    pub profiles: String,
}

/// SHA-256 of the profiles of both machines, as they stand in their files, with those that they extend.
pub fn profiles_of(source: &Control, target: &Control) -> String {
    let text = |control: &Control| {
        let files = control.profile().files().map(|path| fs::read(path).unwrap_or_default());
        let files: Vec<Vec<u8>> = files.collect();
        // A lathe's programs may show the kind of machine that no profile says.
        let kind: &[u8] = if control.machine() == Machine::Lathe { b" lathe" } else { b"" };
        [control.name().as_bytes(), kind, &[0], &files.join(&0)].concat()
    };
    sha256(format!("{} {}", sha256(&text(source)), sha256(&text(target))).as_bytes())
}

/// A file of a manifest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Entry {
    /// What it is.
    pub kind: Kind,
    /// The source's name among the inputs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub source: Option<String>,
    /// Where the source stood, seen from the folder; standard input stands nowhere.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<String>,
    /// SHA-256 of the file.
    pub sha256: String,
    /// Of a certificate: the conversions that it rests on, as they stand in `together`. What earlier versions wrote does
    /// not say so.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rests_on: Option<String>,
}

/// A certificate that is of other texts than those that stand in the folder.
#[derive(Clone, Debug, PartialEq)]
pub struct Outdated {
    /// Its name.
    pub certificate: String,
    /// The files that were otherwise when it was made.
    pub others: Vec<String>,
}

/// Why a manifest could not be used.
#[derive(Debug, thiserror::Error)]
#[error(
    "{0}: {1}. Correct it, or delete it: then macroglot no longer knows which files of the folder it \
         wrote"
)]
pub struct ManifestError(PathBuf, String);

const VERSION: u32 = 1;

const HEAD: &str = "\
# What macroglot wrote into this folder, with the SHA-256 of each file, and the source that each comes from.
# Its next run knows from this what is stale and what was changed by hand. Keep it with the programs.

";

impl Manifest {
    /// The file's name.
    pub const NAME: &'static str = "macroglot.manifest";

    /// The manifest of a folder; an empty one if it has none.
    ///
    /// # Errors
    /// A file that is no manifest.
    pub fn load(folder: &Path) -> Result<Self, ManifestError> {
        let path = folder.join(Self::NAME);
        let text = match read_text(&path) {
            Ok(text) => text,
            Err(error) if matches!(error.kind(), io::ErrorKind::NotFound | io::ErrorKind::NotADirectory) => {
                return Ok(Self::default());
            }
            Err(error) => return Err(ManifestError(path, error.to_string())),
        };
        let manifest: Self = toml::from_str(&text)
            .map_err(|error| ManifestError(path.clone(), error.message().to_string()))?;
        let is_plain = |name: &str| {
            !name.is_empty() && Path::new(name).components().all(|part| matches!(part, Component::Normal(_)))
        };
        if let Some(name) = manifest.files.keys().find(|name| !is_plain(name)) {
            return Err(ManifestError(path, format!("names '{name}', which is not a file of the folder")));
        }
        if manifest.version != VERSION {
            let why = format!("is of version {}, this macroglot writes version {VERSION}", manifest.version);
            return Err(ManifestError(path, why));
        }
        Ok(manifest)
    }

    /// Its text.
    pub fn print(&self) -> String {
        let this = Self { version: VERSION, ..self.clone() };
        format!("{HEAD}{}", toml::to_string(&this).unwrap_or_default())
    }

    /// The programs among these that stand otherwise than macroglot wrote them: a certificate is not about them.
    pub fn changed<'f>(&self, files: impl Iterator<Item = (&'f str, &'f [u8])>) -> Vec<&'f str> {
        let changed = |(name, bytes): &(&str, &[u8])| {
            self.files.get(*name).is_some_and(|entry| entry.sha256 != sha256(bytes))
        };
        files.filter(changed).map(|(name, _)| name).collect()
    }

    /// The certificates that rest on another text than stands in the folder, by the names of their programs, and the files
    /// that are others. `differs` says so of a file and the SHA-256 that it had.
    pub fn outdated(&self, differs: impl Fn(&str, &str) -> bool) -> BTreeMap<String, Outdated> {
        let mut outdated = BTreeMap::new();
        for (certificate, entry) in &self.files {
            let together = entry.rests_on.as_ref().and_then(|number| self.together.get(number));
            let others = together.into_iter().flatten();
            let others =
                others.filter(|(name, sha256)| entry.source.as_ref() != Some(*name) && differs(name, sha256));
            let others: Vec<String> = others.map(|(name, _)| name.clone()).collect();
            if let Some(source) = entry.source.as_ref().filter(|_| !others.is_empty()) {
                outdated.insert(source.clone(), Outdated { certificate: certificate.clone(), others });
            }
        }
        outdated
    }

    /// The certificates that rest on another text than stands in the folder now.
    pub fn outdated_in(&self, folder: &Path) -> BTreeMap<String, Outdated> {
        let now = |name: &str| read_file(&folder.join(name)).ok().map(|bytes| sha256(&bytes));
        self.outdated(|name, before| now(name).is_none_or(|now| now != before))
    }

    /// The sources that have a conversion in the folder, whole or as a draft.
    pub fn converted(&self) -> BTreeSet<&str> {
        let is_program = |kind| matches!(kind, Kind::Program | Kind::Draft);
        let programs = self.files.values().filter(|entry| is_program(entry.kind));
        programs.filter_map(|entry| entry.source.as_deref()).collect()
    }

    /// True if something in the folder comes from the source of this name that stands at `path`.
    pub fn comes_from(&self, folder: &Path, source: &str, path: &Path) -> bool {
        self.files.values().any(|entry| {
            let at = entry.at.as_ref().filter(|_| entry.source.as_deref() == Some(source));
            at.is_some_and(|at| same_file(&folder.join(at), path))
        })
    }

    /// The number of conversions that call one another: those of one library mostly have one set of them. `sets` has the
    /// numbers so far.
    pub fn together(
        &mut self,
        sets: &mut BTreeMap<BTreeMap<String, String>, String>,
        set: BTreeMap<String, String>,
    ) -> String {
        if let Some(number) = sets.get(&set) {
            return number.clone();
        }
        let mut numbers = (self.together.len() + 1..).map(|number| number.to_string());
        let number = numbers.find(|number| !self.together.contains_key(number)).unwrap_or_default();
        self.together.insert(number.clone(), set.clone());
        sets.insert(set, number.clone());
        number
    }

    /// The files whose source is gone, by its name: it is none of this run, and does not stand where it stood.
    pub fn gone(&self, folder: &Path, is_of_run: impl Fn(&str) -> bool) -> BTreeMap<&str, Vec<&str>> {
        let mut gone: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
        for (name, entry) in &self.files {
            let (Some(source), Some(at)) = (entry.source.as_deref(), &entry.at) else { continue };
            if !is_of_run(source) && !folder.join(at).exists() {
                gone.entry(source).or_default().push(name);
            }
        }
        gone
    }
}

/// Where a source stands, seen from a folder; none for standard input, for what shares no root with it, and for a path
/// that is no text.
pub fn seen_from(folder: &Path, source: &Path) -> Option<String> {
    let (folder, source) = (fs::canonicalize(folder).ok()?, fs::canonicalize(source).ok()?);
    source.to_str()?;
    let shared = folder.components().zip(source.components()).take_while(|(a, b)| a == b).count();
    if shared == 0 {
        return None;
    }
    let up = std::iter::repeat_n("..", folder.components().count() - shared);
    let down: PathBuf = source.components().skip(shared).collect();
    Some(up.map(str::to_owned).chain([slashed(&down)]).collect::<Vec<_>>().join("/"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_source_is_seen_from_its_conversion() {
        let shop = tempfile::tempdir().unwrap();
        let (out, program) = (shop.path().join("a/out"), shop.path().join("in/b/x.nc"));
        fs::create_dir_all(&out).unwrap();
        fs::create_dir_all(program.parent().unwrap()).unwrap();
        fs::write(&program, "M30").unwrap();
        assert_eq!(seen_from(&out, &program).as_deref(), Some("../../in/b/x.nc"));
        assert_eq!(seen_from(&out, Path::new("-")), None);
        #[cfg(target_os = "linux")]
        {
            use std::os::unix::ffi::OsStrExt;
            let odd = shop.path().join(std::ffi::OsStr::from_bytes(b"in/\xff.nc"));
            fs::write(&odd, "M30").unwrap();
            assert_eq!(seen_from(&out, &odd), None);
        }
    }
}
