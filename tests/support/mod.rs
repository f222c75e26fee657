//! What several tests share.
#![allow(dead_code)] // each test uses its part

use macroglot::dialect::Question;
use std::path::{Path, PathBuf};

/// The folder of the repository.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// A text file of the repository.
pub fn text(path: &str) -> String {
    std::fs::read_to_string(root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// Compares a file of the repository with what it is generated to be; with UPDATE=1 writes it.
pub fn assert_fresh(path: &str, fresh: &str) {
    if std::env::var_os("UPDATE").is_some_and(|value| value == "1") {
        std::fs::write(root().join(path), fresh).unwrap();
        return;
    }
    let kept = std::fs::read_to_string(root().join(path)).unwrap_or_default();
    if kept == fresh {
        return;
    }
    let diff = similar::TextDiff::from_lines(&kept, fresh);
    let diff = diff.unified_diff().context_radius(1).header("kept", "now").to_string();
    panic!("{path} is stale: read the difference, then write it with UPDATE=1\n{diff}");
}

/// True where a source names the question.
pub fn asks(source: &str, question: Question) -> bool {
    let name = format!("Question::{question:?}");
    source.split(&name).skip(1).any(|rest| !rest.starts_with(|c: char| c.is_alphanumeric()))
}

/// The Rust files under a folder of the repository, with their paths from its root, in order.
pub fn rust_files(folder: &str) -> Vec<(String, String)> {
    let mut files = Vec::new();
    let mut folders: Vec<PathBuf> = vec![root().join(folder)];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "rs") {
                let name = path.strip_prefix(root()).unwrap().to_string_lossy().replace('\\', "/");
                files.push((name, std::fs::read_to_string(&path).unwrap()));
            }
        }
    }
    files.sort();
    files
}
