//! Where conversions go, and what goes beside them.

use super::{Files, Input, Lock, Manifest, OutputError};
use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Checks that every name has a place of its own under `folder`, none of them an
/// input's, and yields the places in order. Case is ignored where names collide,
/// because file systems of shop computers ignore it.
pub fn plan(folder: &Path, names: &[&str], inputs: &[Input]) -> Result<Vec<PathBuf>, OutputError> {
    let mut taken: BTreeMap<String, &str> = BTreeMap::new();
    let mut places = Vec::with_capacity(names.len());
    let sources = Files::of(inputs.iter().map(|input| input.path.as_path()));
    for own in [Lock::NAME, Manifest::NAME] {
        taken.insert(own.into(), own);
    }
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
        for ending in SIDECARS {
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
    match places.iter().find(|place| leads_out(folder, place)) {
        Some(place) => Err(OutputError::Outside(place.display().to_string())),
        None => Ok(places),
    }
}

/// True if a place in a folder is not there in truth: a link on the way may lead out of it.
pub(super) fn leads_out(folder: &Path, place: &Path) -> bool {
    let there =
        place.ancestors().take_while(|above| *above != folder).find_map(|above| fs::canonicalize(above).ok());
    there.is_some_and(|there| fs::canonicalize(folder).is_ok_and(|base| !there.starts_with(base)))
}

/// What stands in a file of an output folder. A pipe in its place would never come to an end.
pub(super) fn read_file(path: &Path) -> io::Result<Vec<u8>> {
    if fs::metadata(path)?.is_file() { fs::read(path) } else { Err(io::Error::other("it is no file")) }
}

/// The same, as text.
pub(super) fn read_text(path: &Path) -> io::Result<String> {
    String::from_utf8(read_file(path)?).map_err(|_| io::ErrorKind::InvalidData.into())
}

/// What a certificate's name has behind that of its program's file.
const CERTIFICATE: &str = ".certificate.json";

/// What the name of a certificate has there whose programs are not written: no text is taken for theirs.
const WITHHELD: &str = ".not-written.json";

/// What macroglot writes beside a conversion, by what the names have behind that of the conversion.
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
        assert_eq!(plan(folder, &["x/a.nc"], &[]).ok(), Some(vec![PathBuf::from("out/x/a.nc")]));
    }
}
