//! The emulated controls from outside: what they may import, and their speed.

use std::path::{Path, PathBuf};

/// The files under a folder.
fn sources(folder: &Path, out: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a folder").flatten() {
        let path = entry.path();
        if path.is_dir() { sources(&path, out) } else { out.push(path) }
    }
}

#[test]
fn controls_share_no_code_with_the_compiler() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/control");
    let mut files = Vec::new();
    sources(&root, &mut files);
    assert!(files.len() > 20, "the controls were looked through");
    for file in files {
        let text = std::fs::read_to_string(&file).expect("a text");
        for module in ["lower", "ir", "opt", "legalize", "emit", "verify", "library", "diff", "report", "cli"]
        {
            let import = format!("crate::{module}");
            let used = text.match_indices(&import).any(|(at, found)| {
                !text[at + found.len()..].starts_with(|next: char| next.is_alphanumeric() || next == '_')
            });
            assert!(!used, "{} imports {import}", file.display());
        }
    }
}
