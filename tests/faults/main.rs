//! Runs that are killed at each change of a disk, whose disk is full from there on, or that are not alone.
//!
//! After each the output folder is as some whole run left it, or says that it is not; the next run ends as one that nothing
//! disturbed; and no temporary file stays. `MACROGLOT_FAULT_POINTS=N` tries N points of random libraries; the seed is
//! printed, and `MACROGLOT_SEED` sets it.
#![allow(missing_docs)]

mod alone;
#[path = "../support/files.rs"]
mod files;
mod library;
mod points;
mod streams;

use assert_cmd::Command;
pub use files::Files;
use std::path::PathBuf;
use tempfile::TempDir;

/// A folder of its own.
pub struct Shop(TempDir);

/// What became of a command.
pub struct Run {
    /// None if it was killed.
    pub code: Option<i32>,
    pub out: String,
    pub err: String,
}

impl Shop {
    pub fn with(files: &Files) -> Self {
        let shop = Self(TempDir::new().unwrap());
        for (name, bytes) in files {
            let path = shop.path(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, bytes).unwrap();
        }
        shop
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn files(&self) -> Files {
        files::files(self.0.path())
    }

    pub fn command(&self, line: &str) -> Command {
        let mut command = Command::cargo_bin("macroglot").unwrap();
        command.args(line.split_whitespace()).current_dir(self.0.path()).env_remove("MACROGLOT_FAULT");
        command.env("RAYON_NUM_THREADS", "1");
        command
    }

    /// Runs a command, with a fault as `src/library/publish/disk.rs` has them; none for an empty one.
    pub fn run(&self, line: &str, fault: &str) -> Run {
        let output = self.command(line).env("MACROGLOT_FAULT", fault).output().unwrap();
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        Run { code: output.status.code(), out: text(output.stdout), err: text(output.stderr) }
    }
}

/// The names that only a run under way may have.
pub fn leavings(files: &Files) -> Vec<&String> {
    files.keys().filter(|name| name.contains(".macroglot")).collect()
}

/// What tells two states apart, for a message.
pub fn parted(a: &Files, b: &Files) -> Vec<String> {
    let names = a.keys().chain(b.keys()).filter(|name| a.get(*name) != b.get(*name));
    let mut names: Vec<String> = names.cloned().collect();
    names.dedup();
    names
}
