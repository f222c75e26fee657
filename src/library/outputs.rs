//! Where conversions go, and how they are written: aside first, then renamed.

use super::{Files, Input};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// A file to write.
#[derive(Clone, Debug, PartialEq)]
pub struct Output<'b> {
    /// Where.
    pub path: PathBuf,
    /// What.
    pub bytes: Cow<'b, [u8]>,
}

/// Why nothing was written.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// Two files for one place.
    #[error("{0} and {1} would both be written to {2}; nothing was written")]
    Collision(String, String, PathBuf),
    /// A file that would overwrite an input.
    #[error("{0} is an input and would be overwritten; nothing was written. Name another folder with --out")]
    OverInput(PathBuf),
    /// A place outside the output folder.
    #[error("'{0}' would be written outside the output folder; nothing was written")]
    Outside(String),
    /// A place that cannot be written.
    #[error("{0}: cannot be written: {1}")]
    Unwritable(PathBuf, io::Error),
}

/// Checks that every name has a place of its own under `folder`, none of them an
/// input's, and yields the places in order. Case is ignored where names collide,
/// because file systems of shop computers ignore it.
pub fn plan(folder: &Path, names: &[&str], inputs: &[Input]) -> Result<Vec<PathBuf>, OutputError> {
    let mut taken: BTreeMap<String, &str> = BTreeMap::new();
    let mut places = Vec::with_capacity(names.len());
    let real = |path: &Path| fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let sources = Files::of(inputs.iter().map(|input| input.path.as_path()));
    for &name in names {
        let parts: Vec<&str> = name.split(['/', '\\']).collect();
        if parts.iter().any(|part| matches!(*part, "" | "." | "..") || part.contains(':')) {
            return Err(OutputError::Outside(name.into()));
        }
        let place = parts.iter().fold(folder.to_owned(), |path, part| path.join(part));
        if let Some(other) = taken.insert(name.to_lowercase(), name) {
            return Err(OutputError::Collision(other.into(), name.into(), place));
        }
        if sources.holds(&place) {
            return Err(OutputError::OverInput(place));
        }
        places.push(place);
    }
    for (name, place) in names.iter().zip(&places) {
        for ending in [CERTIFICATE, WITHHELD] {
            let beside = beside(place, ending);
            if let Some(other) = taken.get(&format!("{name}{ending}").to_lowercase()) {
                let certificate = format!("the certificate of {name}");
                return Err(OutputError::Collision(certificate, (*other).into(), beside));
            }
            if sources.holds(&beside) {
                return Err(OutputError::OverInput(beside));
            }
        }
    }
    let base = real(folder);
    // A link inside the output folder may lead out of it.
    match places.iter().find(|place| place.exists() && !real(place).starts_with(&base)) {
        Some(place) => Err(OutputError::Outside(place.display().to_string())),
        None => Ok(places),
    }
}

/// What a certificate's name has behind that of its program's file.
const CERTIFICATE: &str = ".certificate.json";

/// What the name of a certificate has there whose programs are not written: no text is taken for theirs.
const WITHHELD: &str = ".not-written.json";

/// Where the certificate of a conversion goes.
pub fn certificate_of(place: &Path) -> PathBuf {
    beside(place, CERTIFICATE)
}

/// Where the certificate of programs goes that were converted and are not written.
pub fn withheld_of(place: &Path) -> PathBuf {
    beside(place, WITHHELD)
}

fn beside(place: &Path, ending: &str) -> PathBuf {
    let mut path = place.as_os_str().to_owned();
    path.push(ending);
    path.into()
}

/// Writes all files: each beside its place first, then all are renamed. A fault
/// before the renaming leaves everything as it was.
pub fn write_all(outputs: &[Output<'_>]) -> Result<(), OutputError> {
    let mut ready = Vec::with_capacity(outputs.len());
    for output in outputs {
        let fault = |error| OutputError::Unwritable(output.path.clone(), error);
        // Renaming onto a folder fails, when others are renamed already.
        if output.path.is_dir() {
            return Err(fault(io::ErrorKind::IsADirectory.into()));
        }
        let folder = output.path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        fs::create_dir_all(folder).map_err(fault)?;
        let mut file = tempfile::Builder::new().prefix(".macroglot-").tempfile_in(folder).map_err(fault)?;
        file.write_all(&output.bytes).map_err(fault)?;
        ready.push((file, output));
    }
    sync(&ready)?;
    for (file, output) in ready {
        readable(&file).map_err(|error| OutputError::Unwritable(output.path.clone(), error))?;
        file.persist(&output.path)
            .map_err(|error| OutputError::Unwritable(output.path.clone(), error.error))?;
    }
    Ok(())
}

type Ready<'o> = (tempfile::NamedTempFile, &'o Output<'o>);

/// Files from which on a whole file system is synchronized and not each of them.
#[cfg(target_os = "linux")]
const MANY: usize = 16;

/// Puts the files on the disk before any has its name: a program that is cut off where the power failed looks like a
/// program. One by one that takes longer than converting them.
#[cfg(target_os = "linux")]
fn sync(ready: &[Ready<'_>]) -> Result<(), OutputError> {
    use std::os::unix::fs::MetadataExt;
    if ready.len() < MANY {
        return sync_each(ready);
    }
    let mut done = std::collections::BTreeSet::new();
    ready.iter().try_for_each(|(file, output)| {
        let file = file.as_file();
        let synced = file.metadata().and_then(|data| match done.insert(data.dev()) {
            true => rustix::fs::syncfs(file).map_err(io::Error::from),
            false => Ok(()),
        });
        synced.map_err(|error| OutputError::Unwritable(output.path.clone(), error))
    })
}

#[cfg(not(target_os = "linux"))]
fn sync(ready: &[Ready<'_>]) -> Result<(), OutputError> {
    sync_each(ready)
}

fn sync_each(ready: &[Ready<'_>]) -> Result<(), OutputError> {
    ready.iter().try_for_each(|(file, output)| {
        let synced = file.as_file().sync_data();
        synced.map_err(|error| OutputError::Unwritable(output.path.clone(), error))
    })
}

/// Temporary files are private; a program is for everyone.
#[cfg(unix)]
fn readable(file: &tempfile::NamedTempFile) -> io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    file.as_file().set_permissions(fs::Permissions::from_mode(0o644))
}

#[cfg(not(unix))]
fn readable(_: &tempfile::NamedTempFile) -> io::Result<()> {
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_stay_inside_and_apart() {
        let folder = Path::new("out");
        assert!(matches!(plan(folder, &["a/../../b.nc"], &[]), Err(OutputError::Outside(_))));
        assert!(matches!(plan(folder, &["/etc/x.nc"], &[]), Err(OutputError::Outside(_))));
        assert!(matches!(plan(folder, &["a.nc", "A.NC"], &[]), Err(OutputError::Collision(..))));
        let input = Input { path: "out/a.nc".into(), name: "a.nc".into(), bytes: vec![] };
        assert!(matches!(plan(folder, &["a.nc"], &[input]), Err(OutputError::OverInput(_))));
        assert_eq!(plan(folder, &["x/a.nc"], &[]).ok(), Some(vec![PathBuf::from("out/x/a.nc")]));
    }
}
