//! What a folder holds.

use std::collections::BTreeMap;
use std::path::Path;

/// Files by their names, which are paths from a folder with `/` in them.
pub type Files = BTreeMap<String, Vec<u8>>;

/// All files of a folder, and of those in it.
pub fn files(root: &Path) -> Files {
    let mut files = Files::new();
    collect(root, root, &mut files);
    files
}

fn collect(root: &Path, folder: &Path, files: &mut Files) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            collect(root, &path, files);
        } else {
            let name = path.strip_prefix(root).unwrap().to_string_lossy().replace('\\', "/");
            files.insert(name, std::fs::read(&path).unwrap());
        }
    }
}
