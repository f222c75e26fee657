//! Which paths are one place, whatever they say.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::path::{Component, Path, PathBuf};
use unicode_normalization::UnicodeNormalization;

/// Where a path really is, whether anything stands there already or not.
pub fn real_place(path: &Path) -> PathBuf {
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let there = path.ancestors().find_map(|above| Some((above, std::fs::canonicalize(above).ok()?)));
    let Some((above, mut real)) = there else { return path };
    for part in path.strip_prefix(above).unwrap_or(&path).components() {
        // What is not there is no link that leads elsewhere.
        match part {
            Component::ParentDir => drop(real.pop()),
            part => real.push(part),
        }
    }
    real
}

/// Tells places apart as the coarsest file system does that a shop may copy them to: without case, without dots and
/// blanks at the end of a name, and whether `ü` is written as one character or as two.
#[derive(Debug, Default)]
pub struct Spots {
    /// Folders that were looked for, and where they really are.
    folders: BTreeMap<PathBuf, PathBuf>,
}

impl Spots {
    /// What a place has in common with all others that are the same. A link at its end is no other place: it is replaced,
    /// not followed.
    pub fn of(&mut self, place: &Path) -> PathBuf {
        let folder = place.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."));
        if !self.folders.contains_key(folder) {
            self.folders.insert(folder.to_owned(), real_place(folder).components().map(folded).collect());
        }
        let folder = self.folders.get(folder).cloned().unwrap_or_default();
        folder.join(place.components().next_back().map(folded).unwrap_or_default())
    }
}

fn folded(part: Component<'_>) -> OsString {
    match (part, part.as_os_str().to_str()) {
        (Component::Normal(_), Some(name)) => {
            // By way of capitals: these are the same for `ß` and `ss`, and for both small sigmas.
            let capitals = name.nfd().collect::<String>().to_uppercase();
            let folded: String = capitals.to_lowercase().nfd().collect();
            folded.trim_end_matches(['.', ' ']).into()
        }
        _ => part.as_os_str().to_owned(),
    }
}

/// A path with `/` between its parts, wherever it is written down.
pub fn slashed(path: &Path) -> String {
    let parts = path.components().filter_map(|part| match part {
        Component::Normal(part) => Some(part.to_string_lossy().into_owned()),
        _ => None,
    });
    parts.collect::<Vec<_>>().join("/")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_place_has_many_names() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| Spots::default().of(&folder.path().join(name));
        assert_eq!(at("A.NC"), at("a.nc"));
        assert_eq!(at("Sub/a.nc. "), at("sub/a.nc"));
        assert_ne!(at("a.nc"), at("sub/a.nc"));
        // The Unicode Standard, annex 15 (canonical equivalence), and its table CaseFolding.txt.
        let one = [
            ("f\u{fc}r.nc", "fu\u{308}r.nc"),
            ("f\u{fc}r.nc", "FU\u{308}R.NC"),
            ("\u{1e69}", "s\u{307}\u{323}"),
            ("stra\u{df}e", "STRASSE"),
            ("\u{3c2}", "\u{3c3}"),
            ("\u{212b}", "\u{e5}"),
        ];
        one.iter().for_each(|(a, b)| assert_eq!(at(a), at(b)));
        assert_ne!(at("fur.nc"), at("f\u{fc}r.nc"));
        assert_eq!(at("none/../a.nc"), at("a.nc"));
        #[cfg(unix)]
        {
            std::fs::create_dir(folder.path().join("sub")).unwrap();
            std::os::unix::fs::symlink("sub", folder.path().join("link")).unwrap();
            std::os::unix::fs::symlink("sub/a.nc", folder.path().join("a.nc")).unwrap();
            assert_eq!(at("link/new/a.nc"), at("sub/new/a.nc"));
            assert_ne!(at("a.nc"), at("sub/a.nc"), "a link there is replaced");
        }
    }
}
