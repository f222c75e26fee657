//! What a run does first where the one before it was interrupted.
//!
//! What lies in an output folder may come from elsewhere, or be damaged. So nothing of it is believed that no run of
//! macroglot leaves: the file is named, and nothing is changed.

use super::super::outputs::read_file;
use super::journal::{
    BACK, DONE, FOLDER, JOURNAL, Journal, NUMBERED, OUTSIDE, READY, Step, apply, finish, is_inside,
    is_staged, take_back, undo,
};
use super::{OutputError, Recovered};
use serde::de::DeserializeOwned;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// True if a run into this folder did not come to its end.
pub fn is_pending(folder: &Path) -> bool {
    fs::symlink_metadata(folder.join(FOLDER)).is_ok()
}

/// Brings a folder to the end of the last run into it, or to its beginning.
pub fn recover(folder: &Path) -> Result<Recovered, OutputError> {
    let work = folder.join(FOLDER);
    match fs::symlink_metadata(&work) {
        Err(_) => return Ok(Recovered::Nothing),
        Ok(facts) if facts.is_dir() => {}
        Ok(_) => {
            let what = "it is not a folder, and macroglot needs that name: rename it";
            return Err(OutputError::Unwritable(work, io::Error::other(what)));
        }
    }
    let fault = |error| OutputError::Unwritable(folder.to_owned(), error);
    is_all_ours(&work)?;
    // Read before anything is done: a part of it that is damaged may be the part that counts.
    let back = journal(folder, BACK)?;
    let ready = journal(folder, JOURNAL)?;
    let done = journal(folder, DONE)?;
    let outside: Vec<PathBuf> = read(&work, OUTSIDE)?.unwrap_or_default();
    if let Some(path) = outside.iter().find(|path| !is_staged(path)) {
        return Err(foreign(&work, OUTSIDE, path));
    }
    if let Some(mut journal) = back {
        // Nothing shows that an old text belongs to a place elsewhere, so only this folder is brought back.
        journal.steps.retain(|step| is_inside(folder, &step.place));
        undo(folder, &journal).map_err(fault)?;
        return Ok(Recovered::TakenBack);
    }
    if let Some(journal) = ready {
        apply(folder, &journal).map_err(|(place, error)| OutputError::Unwritable(place, error))?;
        finish(folder, &journal).map_err(fault)?;
        return Ok(Recovered::Finished);
    }
    take_back(folder).map_err(fault)?;
    Ok(if done.is_some() { Recovered::Finished } else { Recovered::TakenBack })
}

/// Says so where the folder holds what no run leaves there: it would be removed with the rest.
fn is_all_ours(work: &Path) -> Result<(), OutputError> {
    let is_known = |name: &str| {
        let number = NUMBERED.iter().find_map(|start| name.strip_prefix(start));
        [READY, JOURNAL, BACK, DONE, OUTSIDE].contains(&name)
            || number.is_some_and(|number| !number.is_empty() && number.bytes().all(|b| b.is_ascii_digit()))
    };
    let fault = |error| OutputError::Unwritable(work.to_owned(), error);
    for entry in fs::read_dir(work).map_err(fault)? {
        let entry = entry.map_err(fault)?;
        let is_folder = entry.file_type().map_err(fault)?.is_dir();
        if is_folder || !entry.file_name().to_str().is_some_and(is_known) {
            let what = "is not something that a run of macroglot leaves there".into();
            return Err(OutputError::Unrecovered(entry.path(), what, work.to_owned()));
        }
    }
    Ok(())
}

/// A journal of this name, if there is one.
fn journal(folder: &Path, name: &str) -> Result<Option<Journal>, OutputError> {
    let work = folder.join(FOLDER);
    let journal: Option<Journal> = read(&work, name)?;
    match journal.iter().flat_map(|journal| &journal.steps).find(|step| !is_ours(folder, step)) {
        Some(step) => Err(foreign(&work, name, &step.place)),
        None => Ok(journal),
    }
}

fn read<T: DeserializeOwned>(work: &Path, name: &str) -> Result<Option<T>, OutputError> {
    let path = work.join(name);
    let found = match read_file(&path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        Err(error) => Err(format!("cannot be read: {error}")),
        Ok(bytes) => serde_json::from_slice(&bytes).map_err(|error| format!("cannot be understood: {error}")),
    };
    found.map(Some).map_err(|what| OutputError::Unrecovered(path, what, work.to_owned()))
}

fn foreign(work: &Path, name: &str, named: &Path) -> OutputError {
    let what = format!("names {}, and no run of macroglot does that", named.display());
    OutputError::Unrecovered(work.join(name), what, work.to_owned())
}

/// True for a step that a run of macroglot writes down: one that somebody else wrote, or brought here with the folder,
/// changes nothing elsewhere, and nothing here that is not in the step's own place.
fn is_ours(folder: &Path, step: &Step) -> bool {
    let is_aside = |path: &PathBuf| is_inside(folder, path) && !is_work(path);
    let is_kept = |path: &PathBuf| is_inside(folder, path) && is_work(path);
    let at = |path: &Path| folder.join(path).parent().map(Path::to_owned);
    let is_beside = |new: &PathBuf| is_staged(new) && at(new) == at(&step.place);
    let is_here = is_aside(&step.place);
    let is_new = match &step.new {
        Some(new) => is_here && is_kept(new) || is_beside(new),
        // A report elsewhere is written, never removed.
        None => is_here,
    };
    is_new && step.old.iter().all(is_kept) && step.aside.iter().all(is_aside)
}

/// True for a path in the folder of a run that is under way.
fn is_work(path: &Path) -> bool {
    path.starts_with(FOLDER)
}
