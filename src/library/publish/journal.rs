//! How a set of files becomes visible: all of it, or nothing.
//!
//! Everything is written to a folder of its own first, `.macroglot` in the output folder, with a second name for each file that
//! is to be replaced or removed. Then it is put on the disk, and a journal beside it gets its name: from there on the set
//! counts as published. What is left is renaming, and each step of it may be done twice. A run that is ended before the
//! journal has its name has changed nothing; one that is ended after it is finished by the next. A step that fails turns
//! the journal round: what was done is undone, and that too may be done twice.

use super::super::inputs::same_file;
use super::super::outputs::{leads_out, read_file};
use super::{Change, OutputError, disk};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Component, Path, PathBuf};

/// What an output folder holds of a run that is under way.
pub(super) const FOLDER: &str = ".macroglot";
/// The steps of a set that stands ready.
pub(super) const JOURNAL: &str = "journal";
/// The steps of a set that is being undone.
pub(super) const BACK: &str = "back";
/// The steps of a set that is in its place.
pub(super) const DONE: &str = "done";
/// Files that were written elsewhere: reports have their place where the user wants them.
pub(super) const OUTSIDE: &str = "outside";
/// One of these files while it is written.
pub(super) const READY: &str = "ready";
/// How the names begin of new files, and of second names of files that were there.
pub(super) const NUMBERED: [&str; 2] = ["new-", "old-"];
/// How the names begin of files that are written beside their place.
const STAGED: &str = ".macroglot-";

#[derive(Serialize, Deserialize)]
pub(super) struct Journal {
    pub(super) steps: Vec<Step>,
}

/// One step. Paths count from the output folder.
#[derive(Serialize, Deserialize)]
pub(super) struct Step {
    /// Where something changes.
    pub(super) place: PathBuf,
    /// The new file, which goes there; none for one that is removed.
    pub(super) new: Option<PathBuf>,
    /// A second name of the file that was there.
    pub(super) old: Option<PathBuf>,
    /// Where that file goes for good.
    pub(super) aside: Option<PathBuf>,
}

/// Publishes a set.
pub fn publish(folder: &Path, changes: &[Change<'_>]) -> Result<(), OutputError> {
    let work = folder.join(FOLDER);
    let journal = match stage(folder, &work, changes) {
        Ok(journal) => journal,
        Err(error) => {
            let _ = take_back(folder);
            return Err(error);
        }
    };
    let fault = |error| OutputError::Unwritable(folder.to_owned(), error);
    // The moment at which the set is published.
    let text = serde_json::to_vec(&journal).map_err(io::Error::from);
    if let Err(error) = text.and_then(|text| name_whole(&work, JOURNAL, &text)) {
        let _ = take_back(folder);
        return Err(fault(error));
    }
    if let Err((place, error)) = apply(folder, &journal) {
        let undone =
            disk::rename(&work.join(JOURNAL), &work.join(BACK)).and_then(|()| undo(folder, &journal));
        return Err(match undone {
            Ok(()) => OutputError::Unwritable(place, error),
            Err(again) => OutputError::HalfWay(folder.to_owned(), error, again),
        });
    }
    finish(folder, &journal).map_err(fault)
}

/// True if a path, from the folder or whole, is one in it: by its name, and by the links on the way.
pub(super) fn is_inside(folder: &Path, path: &Path) -> bool {
    let place = folder.join(path);
    let is_plain = |path: &Path| path.components().all(|part| matches!(part, Component::Normal(_)));
    place != folder && place.strip_prefix(folder).is_ok_and(is_plain) && !leads_out(folder, &place)
}

/// True if a file has a name that only a new file has which is written beside its place.
pub(super) fn is_staged(path: &Path) -> bool {
    path.file_name().and_then(|name| name.to_str()).is_some_and(|name| name.starts_with(STAGED))
}

/// Why a file cannot have this path, if it cannot: journals are text, and some names are those of a run under way.
pub(super) fn unfit(path: &Path) -> Option<&'static str> {
    if path.to_str().is_none() {
        return Some("its path is not UTF-8");
    }
    let is_own = is_staged(path) || path.components().any(|part| part.as_os_str() == FOLDER);
    is_own.then_some("macroglot uses such names itself while it writes")
}

/// Writes everything aside.
fn stage(folder: &Path, work: &Path, changes: &[Change<'_>]) -> Result<Journal, OutputError> {
    let fault = |place: &Path, error| OutputError::Unwritable(place.to_owned(), error);
    disk::make_folder(work).map_err(|error| fault(folder, error))?;
    let outside = outside(folder, changes);
    if !outside.is_empty() {
        let names = serde_json::to_vec(&outside).map_err(|error| fault(folder, error.into()))?;
        name_whole(work, OUTSIDE, &names).map_err(|error| fault(folder, error))?;
    }
    let (mut steps, mut files) = (Vec::with_capacity(changes.len()), Vec::new());
    for (at, change) in changes.iter().enumerate() {
        let place = folder.join(&change.place);
        let fault = |error| fault(&place, error);
        let new = match &change.bytes {
            None => None,
            Some(bytes) => {
                let new = staged(folder, &place, at);
                if let Some(above) = place.parent().filter(|_| is_staged(&new)) {
                    disk::make_folder(above).map_err(fault)?;
                }
                disk::create(&new, bytes).map_err(fault)?;
                files.push((new.clone(), place.clone()));
                Some(new)
            }
        };
        let mut old = None;
        if fs::symlink_metadata(&place).is_ok() {
            let beside = work.join(format!("{}{at}", NUMBERED[1]));
            disk::keep(&place, &beside).map_err(fault)?;
            old = Some(beside);
        }
        let named = |path: PathBuf| from(folder, path);
        let aside = change.aside.clone();
        steps.push(Step { place: named(place), new: new.map(named), old: old.map(named), aside });
    }
    super::sync::sync(&files)?;
    Ok(Journal { steps })
}

/// A path as it counts from a folder, if it is one in it: the next run may spell the folder otherwise.
fn from(folder: &Path, path: PathBuf) -> PathBuf {
    path.strip_prefix(folder).map(Path::to_owned).unwrap_or(path)
}

/// Where a new file is written first: in the output folder, or beside a place that lies elsewhere.
fn staged(folder: &Path, place: &Path, at: usize) -> PathBuf {
    match is_inside(folder, place) {
        true => folder.join(FOLDER).join(format!("{}{at}", NUMBERED[0])),
        false => place.with_file_name(format!("{STAGED}{}-{at}", std::process::id())),
    }
}

fn outside(folder: &Path, changes: &[Change<'_>]) -> Vec<PathBuf> {
    let places = changes.iter().enumerate().filter(|(_, change)| change.bytes.is_some());
    let staged = places.map(|(at, change)| staged(folder, &folder.join(&change.place), at));
    staged.filter(|path| is_staged(path)).map(|path| from(folder, path)).collect()
}

/// Writes a file under another name, and gives it its own when it is whole and on the disk.
fn name_whole(work: &Path, name: &str, bytes: &[u8]) -> io::Result<()> {
    let ready = work.join(READY);
    disk::create(&ready, bytes)?.sync_all()?;
    disk::rename(&ready, &work.join(name))?;
    disk::sync_names(work)
}

/// Does every step that is not done.
pub(super) fn apply(folder: &Path, journal: &Journal) -> Result<(), (PathBuf, io::Error)> {
    for step in &journal.steps {
        let place = folder.join(&step.place);
        step_forward(folder, step, &place).map_err(|error| (place, error))?;
    }
    Ok(())
}

fn step_forward(folder: &Path, step: &Step, place: &Path) -> io::Result<()> {
    if let (Some(aside), Some(old)) = (&step.aside, &step.old) {
        let (aside, old) = (folder.join(aside), folder.join(old));
        if !aside.exists() {
            disk::keep(&old, &aside)?;
        }
    }
    match &step.new {
        None => disk::remove(place),
        Some(new) => {
            let new = folder.join(new);
            if !new.exists() {
                return Ok(());
            }
            if let Some(above) = place.parent() {
                disk::make_folder(above)?;
            }
            disk::rename(&new, place)
        }
    }
}

/// Undoes every step: what was there is there again.
pub(super) fn undo(folder: &Path, journal: &Journal) -> io::Result<()> {
    for step in &journal.steps {
        let place = folder.join(&step.place);
        match step.old.as_ref().map(|old| folder.join(old)) {
            // What never went needs no way back: where another's file cannot be replaced there is none.
            Some(old) if is_same(&old, &place) => {}
            // Without its second name it is back already.
            Some(old) if old.exists() => disk::rename(&old, &place)?,
            Some(_) => {}
            None => disk::remove(&place)?,
        }
        if let Some(aside) = &step.aside {
            disk::remove(&folder.join(aside))?;
        }
    }
    sync_places(folder, journal)?;
    take_back(folder)
}

/// True if the same file stands in both places, and no link.
fn is_same(old: &Path, place: &Path) -> bool {
    let is_link = old.is_symlink() || place.is_symlink();
    !is_link
        && (same_file(old, place)
            || read_file(old).is_ok_and(|old| read_file(place).is_ok_and(|now| now == old)))
}

/// Puts the new names on the disk, and forgets how they came there.
pub(super) fn finish(folder: &Path, journal: &Journal) -> io::Result<()> {
    sync_places(folder, journal)?;
    let work = folder.join(FOLDER);
    // From here on the rest is rubbish.
    disk::rename(&work.join(JOURNAL), &work.join(DONE))?;
    disk::remove_folder(&work, DONE)
}

fn sync_places(folder: &Path, journal: &Journal) -> io::Result<()> {
    let places = journal.steps.iter().map(|step| folder.join(&step.place));
    let folders: BTreeSet<PathBuf> = places.filter_map(|place| Some(place.parent()?.to_owned())).collect();
    folders.iter().filter(|folder| folder.is_dir()).try_for_each(|folder| disk::sync_names(folder))
}

/// Removes what was written aside.
pub(super) fn take_back(folder: &Path) -> io::Result<()> {
    let work = folder.join(FOLDER);
    if let Ok(bytes) = read_file(&work.join(OUTSIDE)) {
        let outside: Vec<PathBuf> = serde_json::from_slice(&bytes).unwrap_or_default();
        // A list that somebody else wrote removes nothing of theirs.
        outside
            .iter()
            .filter(|path| is_staged(path))
            .try_for_each(|path| disk::remove(&folder.join(path)))?;
    }
    disk::remove_folder(&work, DONE)
}
