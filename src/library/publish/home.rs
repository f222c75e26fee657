//! Which output folder a conversion belongs to: it may lie deep in it.

use super::{Manifest, ManifestError, is_pending};
use crate::library::slashed;
use std::fs;
use std::path::{Path, PathBuf};

/// The output folder that files belong to.
#[derive(Debug)]
pub struct Home {
    /// The folder, with the lock in it.
    pub folder: PathBuf,
    /// What macroglot wrote there.
    pub manifest: Manifest,
    /// Where the files lie in it: empty, or with `/` at its end.
    within: String,
}

impl Home {
    /// The home of files that lie in this folder, by their names there: the nearest folder, this one or one above, whose
    /// manifest names one of them or where a run is under way. Where there is none, it is this folder.
    ///
    /// # Errors
    /// A manifest on the way that is none.
    pub fn of(here: &Path, names: &[&str]) -> Result<Self, ManifestError> {
        let home = |folder: &Path, within: String| {
            let manifest = Manifest::load(folder)?;
            Ok(Self { folder: folder.to_owned(), manifest, within })
        };
        let own = home(here, String::new())?;
        if own.is_of(names) {
            return Ok(own);
        }
        // What `..` is above is known of the real folder alone.
        let Ok(real) = fs::canonicalize(if here == Path::new("") { Path::new(".") } else { here }) else {
            return Ok(own);
        };
        for above in real.ancestors().skip(1).filter(|above| above.join(Manifest::NAME).is_file()) {
            let within = slashed(real.strip_prefix(above).unwrap_or(&real)) + "/";
            let found = home(above, within)?;
            if found.is_of(names) {
                return Ok(found);
            }
        }
        Ok(own)
    }

    /// The name in the home of a file here.
    pub fn name(&self, name: &str) -> String {
        format!("{}{name}", self.within)
    }

    fn is_of(&self, names: &[&str]) -> bool {
        is_pending(&self.folder)
            || names.iter().any(|name| self.manifest.files.contains_key(&self.name(name)))
    }
}
