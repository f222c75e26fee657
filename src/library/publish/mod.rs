//! What a run leaves in a folder: whole, current, and nobody else's.
//!
//! - `held`: one run at a time.
//! - `journal`: a set of files becomes visible together, or not at all.
//! - `recover`: what an interrupted run left is finished or taken back.
//! - `manifest`: which files macroglot wrote, so that a later run knows what is stale and what a person changed.
//! - `changes`: what a run replaces, takes away and leaves.
//! - `home`: which output folder a conversion belongs to.

mod changes;
mod disk;
mod held;
mod home;
mod journal;
mod manifest;
mod recover;
mod sync;

pub use changes::{Told, Wanted, changes};
pub use held::{Held, Recovered, abandon};
pub use home::Home;
pub use manifest::{Kind, Made, Manifest, ManifestError, Outdated, profiles_of};
pub use recover::is_pending;

use std::borrow::Cow;
use std::fmt;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use unicode_normalization::UnicodeNormalization;

/// A change of a folder.
#[derive(Clone, Debug, PartialEq)]
pub struct Change<'b> {
    /// Where, from the output folder.
    pub place: PathBuf,
    /// What is to stand there; none for a file that is taken away.
    pub bytes: Option<Cow<'b, [u8]>>,
    /// Where what stands there now is kept, from the output folder.
    pub aside: Option<PathBuf>,
}

/// Why nothing was written.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// Two files for one place.
    #[error("{}", Collided(.0, .1, .2))]
    Collision(String, String, PathBuf),
    /// A file that is to stand beside one of an earlier run, which would be the same on some file systems.
    #[error(
        "{}: an earlier run wrote {}, and some file systems do not tell the two apart; nothing was \
         written. Remove that file first; if its source is gone, --prune does it", spelled(.0), spelled(.1)
    )]
    Twin(String, String),
    /// A file that would overwrite an input.
    #[error("{0} is an input and would be overwritten; nothing was written. Name another place for it")]
    OverInput(PathBuf),
    /// A name that a conversion cannot have.
    #[error("'{0}' cannot be the name of a conversion: {1}; nothing was written. Rename its source")]
    Unfit(String, &'static str),
    /// A place outside the output folder.
    #[error("'{0}' would be outside the output folder; nothing was written")]
    Outside(String),
    /// A place that cannot be written.
    #[error("{0}: cannot be written: {1}; nothing was written")]
    Unwritable(PathBuf, io::Error),
    /// A file that nobody may change.
    #[error("{0}: is read-only; nothing was written. Use --force to replace it")]
    ReadOnly(PathBuf),
    /// What an interrupted run left, and what is wrong with it; the folder of that run.
    #[error(
        "{0}: {1}; nothing was written. A run was interrupted here, so the files beside {2} may be partly new and partly old, and what it is to mend them by is damaged. Move {2} elsewhere (its files old-0, old-1 and so on are texts that were there before) and run the same again"
    )]
    Unrecovered(PathBuf, String, PathBuf),
    /// A set that is half in its place, and could not be taken back.
    #[error(
        "{0}: could not be written ({1}), nor restored ({2}). Correct the cause and run the same command \
         again: it starts with restoring the file"
    )]
    HalfWay(PathBuf, io::Error, io::Error),
}

/// Two names for one place, in words.
struct Collided<'a>(&'a str, &'a str, &'a Path);

impl fmt::Display for Collided<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(one, other, place) = self;
        // Names that look alike are told apart by their characters.
        let alike = one != other && one.nfc().eq(other.nfc());
        let name = |name: &str| if alike { spelled(name) } else { name.to_owned() };
        let place = place.display();
        write!(f, "{} and {} would both be written to {place}; nothing was written", name(one), name(other))?;
        if alike {
            write!(f, ". They look alike, and some file systems do not tell them apart: rename one")?;
        }
        Ok(())
    }
}

/// A name in which every character shows: `fu\u{308}r.nc`.
fn spelled(name: &str) -> String {
    let shown = |c: char| match c.is_ascii() {
        true => c.to_string(),
        false => c.escape_unicode().to_string(),
    };
    name.chars().map(shown).collect()
}

/// Finds what can be found that is wrong with changes before any is made.
///
/// # Errors
/// As of [`publish`].
pub fn check(held: &Held, changes: &[Change<'_>], force: bool) -> Result<(), OutputError> {
    changes.iter().try_for_each(|change| fits(held.folder(), change, force))
}

/// Publishes changes in a folder: all of them, or none.
///
/// # Errors
/// Those of the disk; what can be found before anything is written is. Read-only files are replaced by `force` alone.
pub fn publish(held: &Held, changes: &[Change<'_>], force: bool) -> Result<(), OutputError> {
    let folder = held.folder();
    check(held, changes, force)?;
    if changes.is_empty() {
        return Ok(());
    }
    let _uninterrupted = held::uninterrupted();
    journal::publish(folder, changes)
}

/// Writes one file in whatever folder.
///
/// # Errors
/// As of [`publish`].
pub fn write_file(path: &Path, bytes: &[u8], force: bool) -> Result<(), OutputError> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let (held, _) = Held::take(folder, || ())?;
    let place = path.file_name().map(PathBuf::from).unwrap_or_default();
    publish(&held, &[Change { place, bytes: Some(bytes.into()), aside: None }], force)
}

/// Looks whether a change can be made, before any is.
fn fits(folder: &Path, change: &Change<'_>, force: bool) -> Result<(), OutputError> {
    let places = [Some(&change.place), change.aside.as_ref()];
    for place in places.into_iter().flatten().map(|place| folder.join(place)) {
        let fault = |error| Err(OutputError::Unwritable(place.clone(), error));
        if let Some(what) = journal::unfit(place.strip_prefix(folder).unwrap_or(&place)) {
            return fault(io::Error::other(what));
        }
        match fs::symlink_metadata(&place) {
            Ok(facts) if facts.is_dir() => return fault(io::ErrorKind::IsADirectory.into()),
            Ok(facts) if facts.permissions().readonly() && !facts.is_symlink() && !force => {
                return Err(OutputError::ReadOnly(place));
            }
            // A name that is too long shows here, and so does a file in the place of a folder.
            Err(error) if error.kind() != io::ErrorKind::NotFound => return fault(error),
            _ => {}
        }
        if place.starts_with(folder) && !on_one_file_system(folder, &place) {
            return fault(io::ErrorKind::CrossesDevices.into());
        }
    }
    Ok(())
}

/// True if a file can be renamed from the folder to this place in it.
#[cfg(unix)]
fn on_one_file_system(folder: &Path, place: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let device = |path: &Path| fs::metadata(path).map(|facts| facts.dev()).ok();
    let above = place.ancestors().skip(1).find_map(device);
    above.is_none() || above == device(folder)
}

#[cfg(not(unix))]
fn on_one_file_system(_: &Path, _: &Path) -> bool {
    true
}
