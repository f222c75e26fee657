//! Where conversions go, and what goes beside them.

use super::places::Spots;
use super::{Files, Input, Lock, Manifest, OutputError};
use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Checks that every name has a place of its own under `folder`, none of them an
/// input's, and yields the places in order. Names and links that are one place on some
/// file system of a shop are one here.
pub fn plan(folder: &Path, names: &[&str], inputs: &[Input]) -> Result<Vec<PathBuf>, OutputError> {
    let sources = Files::of(inputs.iter().map(|input| input.path.as_path()));
    let places: Vec<PathBuf> =
        names.iter().map(|name| place_of(folder, name)).collect::<Result<_, OutputError>>()?;
    let (mut spots, mut taken) = (Spots::default(), BTreeMap::new());
    let mut take = |place: &Path, what: String| {
        if sources.holds(place) {
            return Err(OutputError::OverInput(place.to_owned()));
        }
        match taken.insert(spots.of(place), what.clone()) {
            Some(other) => Err(OutputError::Collision(other, what, place.to_owned())),
            None => Ok(()),
        }
    };
    for own in [Lock::NAME, Manifest::NAME] {
        take(&folder.join(own), own.into())?;
    }
    names.iter().zip(&places).try_for_each(|(name, place)| take(place, (*name).into()))?;
    for (name, place) in names.iter().zip(&places) {
        for ending in SIDECARS {
            take(&beside(place, ending), format!("the certificate of {name}"))?;
        }
    }
    for (name, place) in names.iter().zip(&places) {
        // A file has no others in it.
        let above = |spot: PathBuf| spot.ancestors().skip(1).find_map(|above| taken.get(above)).cloned();
        if let Some(other) = above(spots.of(place)) {
            return Err(OutputError::Collision(other, (*name).into(), place.clone()));
        }
    }
    match places.iter().find(|place| leads_out(folder, place)) {
        Some(place) => Err(OutputError::Outside(place.display().to_string())),
        None => Ok(places),
    }
}

fn place_of(folder: &Path, name: &str) -> Result<PathBuf, OutputError> {
    let parts: Vec<&str> = name.split(['/', '\\']).collect();
    if parts.iter().any(|part| matches!(*part, "" | "." | "..")) {
        return Err(OutputError::Outside(name.into()));
    }
    if parts.iter().any(|part| part.contains(':')) {
        let why = "some file systems read the part before a colon as a drive, or as another file";
        return Err(OutputError::Unfit(name.into(), why));
    }
    Ok(parts.iter().fold(folder.to_owned(), |path, part| path.join(part)))
}

/// True if a place in a folder is not there in truth: a link on the way may lead out of it.
pub(super) fn leads_out(folder: &Path, place: &Path) -> bool {
    let there =
        place.ancestors().take_while(|above| *above != folder).find_map(|above| fs::canonicalize(above).ok());
    there.is_some_and(|there| fs::canonicalize(folder).is_ok_and(|base| !there.starts_with(base)))
}

/// What stands in a file of an output folder. A pipe in its place would never come to an end.
pub(super) fn read_file(path: &Path) -> io::Result<Vec<u8>> {
    if fs::metadata(path)?.is_file() { fs::read(path) } else { Err(io::Error::other("it is not a file")) }
}

/// The same, as text.
pub(super) fn read_text(path: &Path) -> io::Result<String> {
    String::from_utf8(read_file(path)?).map_err(|_| io::ErrorKind::InvalidData.into())
}

/// What a certificate's name has after that of its program's file.
const CERTIFICATE: &str = ".certificate.json";

/// What the name of a certificate has there whose programs are not written: no text is taken for theirs.
const WITHHELD: &str = ".not-written.json";

/// What macroglot writes beside a conversion, by what the names have after that of the conversion.
pub const SIDECARS: [&str; 2] = [CERTIFICATE, WITHHELD];

/// Where the certificate of a conversion goes.
pub fn certificate_of(name: &str) -> String {
    format!("{name}{CERTIFICATE}")
}

/// Where the certificate of programs goes that were converted and are not written.
pub fn withheld_of(name: &str) -> String {
    format!("{name}{WITHHELD}")
}

fn beside(place: &Path, ending: &str) -> PathBuf {
    let mut path = place.as_os_str().to_owned();
    path.push(ending);
    path.into()
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
        let there = tempfile::tempdir().unwrap();
        let path = there.path().join("a.nc");
        fs::write(&path, "M30").unwrap();
        let input = Input { path, name: "a.nc".into(), bytes: vec![] };
        assert!(matches!(plan(there.path(), &["a.nc"], &[input]), Err(OutputError::OverInput(_))));
        let own = plan(folder, &["macroglot.manifest"], &[]);
        assert!(matches!(own, Err(OutputError::Collision(..))));
        for names in [
            ["a\\b.nc", "a/b.nc"],
            ["a.nc", "A.nc."],
            ["a.nc", "a.nc/b.nc"],
            ["a.nc", "a.nc.certificate.json/b"],
        ] {
            assert!(matches!(plan(folder, &names, &[]), Err(OutputError::Collision(..))), "{names:?}");
        }
        assert!(matches!(plan(folder, &["c:a.nc"], &[]), Err(OutputError::Unfit(..))));
        assert_eq!(plan(folder, &["x/a.nc"], &[]).ok(), Some(vec![PathBuf::from("out/x/a.nc")]));
    }
}
