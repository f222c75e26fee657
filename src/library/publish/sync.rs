//! Puts files on the disk before any has its name: a program that is cut off where the power failed looks like a program.

use super::OutputError;
#[cfg(target_os = "linux")]
use std::fs;
use std::fs::File;
use std::io;
use std::path::PathBuf;

/// A file that was written, and where it will stand. A library has more files than a process may hold open.
type Written = (PathBuf, PathBuf);

/// Files from which on a whole file system is synchronized and not each of them: one by one takes longer than converting
/// them.
#[cfg(target_os = "linux")]
const MANY: usize = 16;

#[cfg(target_os = "linux")]
pub fn sync(files: &[Written]) -> Result<(), OutputError> {
    use std::os::unix::fs::MetadataExt;
    if files.len() < MANY {
        return sync_each(files);
    }
    let mut done = std::collections::BTreeSet::new();
    files.iter().try_for_each(|(file, place)| {
        let synced = fs::metadata(file).and_then(|data| match done.insert(data.dev()) {
            true => rustix::fs::syncfs(&File::open(file)?).map_err(io::Error::from),
            false => Ok(()),
        });
        synced.map_err(|error| OutputError::Unwritable(place.clone(), error))
    })
}

#[cfg(not(target_os = "linux"))]
pub fn sync(files: &[Written]) -> Result<(), OutputError> {
    sync_each(files)
}

fn sync_each(files: &[Written]) -> Result<(), OutputError> {
    files.iter().try_for_each(|(file, place)| {
        let synced = File::options().write(true).open(file).and_then(|file| file.sync_data());
        synced.map_err(|error: io::Error| OutputError::Unwritable(place.clone(), error))
    })
}
