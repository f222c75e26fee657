//! Every change that a run makes to a disk goes through here.
//!
//! So tests can stop a run at each of them, or let the disk be full from there on: checked builds read `MACROGLOT_FAULT`,
//! `kill:N` or `full:N`, and count. Release builds have nothing of that. A full disk still removes.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::Path;

/// Makes a folder, and those above it.
pub fn make_folder(path: &Path) -> io::Result<()> {
    if path.is_dir() {
        return Ok(());
    }
    change(Takes::Room)?;
    fs::create_dir_all(path)
}

/// Writes a new file, whole.
pub fn create(path: &Path, bytes: &[u8]) -> io::Result<File> {
    change(Takes::Room)?;
    let mut file = File::create_new(path)?;
    // A full disk takes a part before it takes no more.
    let (first, rest) = bytes.split_at(bytes.len() / 2);
    file.write_all(first)?;
    change(Takes::Room)?;
    file.write_all(rest)?;
    Ok(file)
}

/// Gives a file another name; one that has that name is gone.
pub fn rename(from: &Path, to: &Path) -> io::Result<()> {
    change(Takes::Room)?;
    fs::rename(from, to)
}

/// Gives a file a second name, or a copy of it where the file system has no links.
pub fn keep(path: &Path, beside: &Path) -> io::Result<()> {
    change(Takes::Room)?;
    fs::hard_link(path, beside).or_else(|_| fs::copy(path, beside).map(drop))
}

/// Removes a file; one that is not there is removed already.
pub fn remove(path: &Path) -> io::Result<()> {
    change(Takes::None)?;
    match fs::remove_file(path) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
        _ => Ok(()),
    }
}

/// Removes a folder and the files in it, `last` after the others; one that is not there is removed already.
pub fn remove_folder(path: &Path, last: &str) -> io::Result<()> {
    change(Takes::None)?;
    let is_gone = |error: &io::Error| error.kind() == io::ErrorKind::NotFound;
    let found = match fs::read_dir(path) {
        Err(error) if is_gone(&error) => return Ok(()),
        found => found?.collect::<io::Result<Vec<_>>>()?,
    };
    let others = found.iter().filter(|file| file.file_name() != last).map(fs::DirEntry::path);
    for file in others.chain([path.join(last)]) {
        fs::remove_file(file).or_else(|error| if is_gone(&error) { Ok(()) } else { Err(error) })?;
    }
    fs::remove_dir(path)
}

/// Puts what a folder holds on the disk: the names, not the files.
#[cfg(unix)]
pub fn sync_names(folder: &Path) -> io::Result<()> {
    change(Takes::None)?;
    match File::open(folder)?.sync_all() {
        // Some file systems cannot do this for a folder.
        Err(error) if error.kind() == io::ErrorKind::InvalidInput => Ok(()),
        done => done,
    }
}

/// Other systems have no such call.
#[cfg(not(unix))]
pub fn sync_names(_: &Path) -> io::Result<()> {
    change(Takes::None)
}

/// Whether a change needs room on the disk.
#[derive(Clone, Copy, PartialEq)]
enum Takes {
    Room,
    None,
}

/// Counts a change, and fails where a test asks for it.
#[cfg(any(debug_assertions, checked))]
fn change(takes: Takes) -> io::Result<()> {
    use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
    static DONE: AtomicU64 = AtomicU64::new(0);
    let done = DONE.fetch_add(1, Relaxed) + 1;
    let Ok(fault) = std::env::var("MACROGLOT_FAULT") else { return Ok(()) };
    match fault.split_once(':').map(|(kind, at)| (kind, at.parse::<u64>())) {
        Some(("kill", Ok(at))) if done == at => std::process::abort(),
        Some(("full", Ok(at))) if done >= at && takes == Takes::Room => {
            Err(io::ErrorKind::StorageFull.into())
        }
        _ => Ok(()),
    }
}

#[cfg(not(any(debug_assertions, checked)))]
fn change(_: Takes) -> io::Result<()> {
    Ok(())
}
