//! An output folder while one run has it for itself.

use super::{OutputError, disk, recover};
use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// An output folder that no other run writes to. The operating system gives it free when this is dropped, or when the
/// process ends in whatever way.
#[derive(Debug)]
pub struct Held {
    folder: PathBuf,
    _lock: Option<File>,
}

/// What was found in an output folder of a run that was interrupted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Recovered {
    /// Nothing: the last run came to its end.
    Nothing,
    /// All that it was to write stood ready; it is in its place now.
    Finished,
    /// Not all of it stood ready; the folder is as it was before.
    TakenBack,
}

/// Folders that this process made; they go again if nothing is written to them. Held while a set is published, so that
/// an interruption waits for the end of that.
static MADE: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// What must come to its end before the process may be ended by the keyboard.
pub(super) fn uninterrupted() -> MutexGuard<'static, Vec<PathBuf>> {
    MADE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Waits for the end of what is being published, and removes what this process leaves otherwise: for the end by the
/// keyboard.
pub fn abandon() -> impl Sized {
    let made = uninterrupted();
    // Refuses if there is anything in it.
    made.iter().for_each(|folder| drop(fs::remove_dir(folder)));
    made
}

impl Held {
    /// Takes a folder; it is made if there is none. While another run has it, `wait` is called, and this waits.
    ///
    /// # Errors
    /// Those of the disk.
    pub fn take(folder: &Path, wait: impl Fn()) -> Result<(Self, Recovered), OutputError> {
        // `out/.` cannot be made where `out` is missing.
        let folder: &Path = &folder.components().collect::<PathBuf>();
        let fault = |error| OutputError::Unwritable(folder.to_owned(), error);
        let lock = loop {
            make(folder).map_err(fault)?;
            let lock = match lock(folder, &wait) {
                // The run before had nothing to write, and took its folder away.
                Err(error) if error.kind() == io::ErrorKind::NotFound => continue,
                lock => lock.map_err(fault)?,
            };
            if lock.as_ref().is_none_or(|file| still_there(folder, file)) {
                break lock;
            }
        };
        let recovered = recover::recover(folder)?;
        Ok((Self { folder: folder.to_owned(), _lock: lock }, recovered))
    }

    /// The folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }
}

fn make(folder: &Path) -> io::Result<()> {
    if folder.is_dir() {
        return Ok(());
    }
    let mut made = uninterrupted();
    // Each folder that is missing on the way, the innermost last.
    let missing: Vec<&Path> =
        folder.ancestors().take_while(|above| !above.as_os_str().is_empty() && !above.exists()).collect();
    disk::make_folder(folder)?;
    made.splice(0..0, missing.into_iter().map(Path::to_owned));
    Ok(())
}

impl Drop for Held {
    fn drop(&mut self) {
        let mut made = uninterrupted();
        made.retain(|folder| {
            !self.folder.starts_with(folder) || fs::remove_dir(folder).is_err() && folder.exists()
        });
    }
}

/// Locks the folder itself, so that no file is left behind; where a system locks files alone, one in it.
fn lock(folder: &Path, wait: &impl Fn()) -> io::Result<Option<File>> {
    let file = open(folder)?;
    match file.try_lock() {
        Ok(()) => Ok(Some(file)),
        Err(TryLockError::WouldBlock) => {
            wait();
            file.lock().map(|()| Some(file))
        }
        // A file system that knows no locks has no other run's either.
        Err(TryLockError::Error(error)) if error.kind() == io::ErrorKind::Unsupported => Ok(None),
        Err(TryLockError::Error(error)) => Err(error),
    }
}

#[cfg(unix)]
fn open(folder: &Path) -> io::Result<File> {
    File::open(folder)
}

/// True if the folder is the one that was locked: the run before may have taken its own away.
#[cfg(unix)]
fn still_there(folder: &Path, file: &File) -> bool {
    use std::os::unix::fs::MetadataExt;
    let same = |a: fs::Metadata, b: fs::Metadata| (a.dev(), a.ino()) == (b.dev(), b.ino());
    fs::metadata(folder).is_ok_and(|now| file.metadata().is_ok_and(|locked| same(now, locked)))
}

#[cfg(not(unix))]
fn open(folder: &Path) -> io::Result<File> {
    File::options().write(true).create(true).truncate(false).open(folder.join(".macroglot.running"))
}

#[cfg(not(unix))]
fn still_there(_: &Path, _: &File) -> bool {
    true
}
