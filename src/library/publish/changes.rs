//! What a run replaces in a folder, what it takes away, and what it leaves.
//!
//! What stands in an output folder is run on a machine. So a program that is refused now goes, though it was converted before;
//! a certificate goes with the text that it is about; and what a person changed is kept under another name, never lost.

use super::manifest::{Entry, Kind, Made, Manifest, seen_from};
use super::{Change, OutputError};
use crate::library::inputs::same_file;
use crate::library::outputs::{SIDECARS, leads_out, read_file};
use crate::library::places::Spots;
use crate::verify::sha256;
use serde::Serialize;
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// A file that a run wants in a folder.
#[derive(Clone, Debug)]
pub struct Wanted<'b> {
    /// Its name in the folder, with `/` between parts.
    pub name: String,
    /// What it is.
    pub kind: Kind,
    /// Its source's name among the inputs.
    pub source: &'b str,
    /// What is to stand there.
    pub bytes: Cow<'b, [u8]>,
    /// Of a certificate: the names of the other conversions that it rests on, and the hashes of their texts. They may be of
    /// another run.
    pub rests_on: Vec<(String, String)>,
}

/// What a person is told of a folder.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Told {
    /// Conversions of earlier runs that were taken away, as their programs have none now.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub removed: Vec<String>,
    /// Files that are not what macroglot wrote there, and the names under which they are kept.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub kept: BTreeMap<String, String>,
    /// Conversions that went for this run's, and where their sources stand, seen from the folder: other ones, that are still
    /// there.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub replaced: BTreeMap<String, String>,
    /// Conversions whose certificates were taken away, and the files that they call, or are called by, and that are
    /// others now.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub uncertified: BTreeMap<String, Vec<String>>,
    /// Conversions whose sources are gone.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub gone: Vec<String>,
    /// Such conversions that were removed, as was asked for.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub pruned: Vec<String>,
}

impl Told {
    /// True if there is nothing to tell.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

/// The changes that bring a folder to what a run wants of it, the manifest first.
///
/// `sources` are the run's files: their names among the inputs, and where they stand; `made` says what they hold. `prune`
/// removes the conversions whose sources are gone.
///
/// # Errors
/// Files in the folder that cannot be read.
pub fn changes<'b>(
    folder: &Path,
    manifest: &Manifest,
    wanted: Vec<Wanted<'b>>,
    sources: &BTreeMap<&str, &Path>,
    made: BTreeMap<String, Made>,
    prune: bool,
) -> Result<(Vec<Change<'b>>, Told), OutputError> {
    let names: BTreeSet<String> = wanted.iter().map(|wanted| wanted.name.clone()).collect();
    let mut plan = Plan { folder, manifest, names: &names, changes: Vec::new(), told: Told::default() };
    let mut next = manifest.clone();
    for files in manifest.gone(folder, |source| sources.contains_key(source)).into_values() {
        // The program comes before what stands beside it.
        let mut first = None;
        for file in files {
            let is_there = if prune { plan.take_away(file)? } else { folder.join(file).exists() };
            first = first.or(is_there.then_some(file));
        }
        let told = if prune { &mut plan.told.pruned } else { &mut plan.told.gone };
        told.extend(first.map(str::to_owned));
    }
    for source in sources.keys().filter(|source| !names.contains(**source)) {
        // A file of that name that macroglot did not write is none of its business.
        if manifest.files.contains_key(*source) && plan.take_away(source)? {
            plan.told.removed.push((*source).to_owned());
        }
    }
    for source in sources.keys() {
        // Nor is what somebody put beside such a file.
        let is_ours = |name: &str| names.contains(name) || manifest.files.contains_key(name);
        for beside in SIDECARS.iter().map(|ending| format!("{source}{ending}")) {
            if !names.contains(&beside) && (is_ours(source) || is_ours(&beside)) {
                plan.take_away(&beside)?;
            }
        }
    }
    let hashes: BTreeMap<String, String> =
        wanted.iter().map(|wanted| (wanted.name.clone(), sha256(&wanted.bytes))).collect();
    plan.uncertify(sources, &hashes)?;
    next.files.retain(|name, entry| {
        let is_ours = entry.source.as_deref().is_some_and(|source| sources.contains_key(source));
        let is_taken = plan.changes.iter().any(|change| change.place == Path::new(name));
        !is_ours && !is_taken && folder.join(name).exists()
    });
    let named: BTreeSet<String> = next.files.values().filter_map(|entry| entry.rests_on.clone()).collect();
    next.together.retain(|number, _| named.contains(number));
    let mut sets = next.together.iter().map(|(number, set)| (set.clone(), number.clone())).collect();
    for wanted in wanted {
        let at = sources.get(wanted.source).and_then(|source| seen_from(folder, source));
        let entry = Entry {
            kind: wanted.kind,
            source: Some(wanted.source.to_owned()),
            at,
            sha256: hashes.get(&wanted.name).cloned().unwrap_or_default(),
            rests_on: (!wanted.rests_on.is_empty()).then(|| {
                let own = hashes.get(wanted.source).map(|hash| (wanted.source.to_owned(), hash.clone()));
                next.together(&mut sets, wanted.rests_on.iter().cloned().chain(own).collect())
            }),
        };
        next.files.insert(wanted.name.clone(), entry);
        plan.put(wanted)?;
    }
    // Of a source that is gone nothing is kept but what its files say.
    let of_files: BTreeSet<&String> = next.files.values().filter_map(|entry| entry.source.as_ref()).collect();
    next.sources.retain(|name, _| of_files.contains(name) || !prune);
    next.sources.extend(made);
    plan.tell_replaced(sources);
    plan.apart(&next)?;
    let text = next.print();
    if plan.read(Manifest::NAME)?.is_none_or(|now| now != text.as_bytes()) {
        let place = PathBuf::from(Manifest::NAME);
        plan.changes.insert(0, Change { place, bytes: Some(text.into_bytes().into()), aside: None });
    }
    Ok((plan.changes, plan.told))
}

fn is_program(kind: Kind) -> bool {
    matches!(kind, Kind::Program | Kind::Draft)
}

struct Plan<'p, 'b> {
    folder: &'p Path,
    manifest: &'p Manifest,
    /// What the run puts there.
    names: &'p BTreeSet<String>,
    changes: Vec<Change<'b>>,
    told: Told,
}

impl<'b> Plan<'_, 'b> {
    /// Notes the sources of what is changed or taken away here, where they are others than those of this run.
    fn tell_replaced(&mut self, sources: &BTreeMap<&str, &Path>) {
        let changed = self.changes.iter().filter_map(|change| change.place.to_str());
        let other = |name: &str| {
            let (entry, source) = (self.manifest.files.get(name)?, sources.get(name)?);
            let at = entry.at.as_ref()?;
            let before = self.folder.join(at);
            let is_other = before.exists() && !same_file(&before, source);
            is_other.then(|| (name.to_owned(), at.clone()))
        };
        self.told.replaced = changed.filter_map(other).collect();
    }

    /// Finds what an earlier run left under a name that is this run's on some file system.
    fn apart(&self, next: &Manifest) -> Result<(), OutputError> {
        let (mut spots, mut taken) = (Spots::default(), BTreeMap::new());
        let programs = next.files.iter().filter(|(_, entry)| is_program(entry.kind));
        for (name, _) in programs {
            let Some(other) = taken.insert(spots.of(&self.folder.join(name)), name) else { continue };
            let [ours, theirs] = if self.names.contains(name) { [name, other] } else { [other, name] };
            // What earlier runs left together is no matter of this one.
            if self.names.contains(ours) {
                return Err(OutputError::Twin(ours.clone(), theirs.clone()));
            }
        }
        Ok(())
    }

    /// Takes away certificates of programs that are none of this run, where what they call, or are called by, is another
    /// text after it, or none.
    fn uncertify(
        &mut self,
        sources: &BTreeMap<&str, &Path>,
        hashes: &BTreeMap<String, String>,
    ) -> Result<(), OutputError> {
        let gone: BTreeSet<PathBuf> = self.changes.iter().map(|change| change.place.clone()).collect();
        let outdated = self.manifest.outdated(|name, before| match hashes.get(name) {
            Some(now) => now != before,
            None => gone.contains(Path::new(name)),
        });
        for (program, outdated) in outdated {
            let is_taken = gone.contains(Path::new(&outdated.certificate));
            if !sources.contains_key(program.as_str())
                && !is_taken
                && self.take_away(&outdated.certificate)?
            {
                self.told.uncertified.insert(program, outdated.others);
            }
        }
        Ok(())
    }

    /// Removes what stands there; true if anything does.
    fn take_away(&mut self, name: &str) -> Result<bool, OutputError> {
        let place = self.folder.join(name);
        if place.parent().is_some_and(|above| above != self.folder && leads_out(self.folder, above)) {
            return Err(OutputError::Outside(place.display().to_string()));
        }
        let Some(now) = self.read(name)? else { return Ok(false) };
        let aside = self.aside(name, &now, false);
        self.changes.push(Change { place: name.into(), bytes: None, aside });
        Ok(true)
    }

    /// Puts a file there, unless the same stands there already.
    fn put(&mut self, wanted: Wanted<'b>) -> Result<(), OutputError> {
        let now = self.read(&wanted.name)?;
        if now.as_deref() == Some(&*wanted.bytes) {
            return Ok(());
        }
        let is_program = is_program(wanted.kind);
        let aside = now.and_then(|now| self.aside(&wanted.name, &now, is_program));
        self.changes.push(Change { place: wanted.name.into(), bytes: Some(wanted.bytes), aside });
        Ok(())
    }

    fn read(&self, name: &str) -> Result<Option<Vec<u8>>, OutputError> {
        let path = self.folder.join(name);
        match read_file(&path) {
            Ok(bytes) => Ok(Some(bytes)),
            Err(error) if matches!(error.kind(), io::ErrorKind::NotFound) => Ok(None),
            Err(error) => Err(OutputError::Unwritable(path, error)),
        }
    }

    /// Where a program is kept that stands there otherwise than macroglot wrote it, or where a program of this run goes
    /// and macroglot wrote nothing.
    fn aside(&mut self, name: &str, now: &[u8], for_program: bool) -> Option<PathBuf> {
        let is_foreign = match self.manifest.files.get(name) {
            Some(entry) => is_program(entry.kind) && entry.sha256 != sha256(now),
            None => for_program,
        };
        if !is_foreign {
            return None;
        }
        let mut names =
            (1_u32..).map(|n| if n == 1 { format!("{name}.kept") } else { format!("{name}.kept-{n}") });
        let free = |kept: &String| {
            !self.names.contains(kept) && fs::symlink_metadata(self.folder.join(kept)).is_err()
        };
        let kept = names.find(free)?;
        self.told.kept.insert(name.to_owned(), kept.clone());
        Some(kept.into())
    }
}
