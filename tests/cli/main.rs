//! The command line, as a user meets it: one module a matter.
#![allow(missing_docs)]

mod accepting;
mod accepting_once;
mod browser;
mod builders;
mod callees;
mod check;
mod commands;
mod diff;
#[path = "../support/files.rs"]
mod files;
#[cfg(unix)]
mod git;
mod help;
mod hostile;
mod inputs;
mod interrupted;
mod ir;
mod lathes;
mod locks;
mod mills;
mod outputs;
#[cfg(unix)]
mod pre_commit;
mod profiles;
mod project;
mod python;
#[cfg(unix)]
mod readme;
mod reports;
mod sarif;
mod shown;
mod stale;
#[path = "../support/mod.rs"]
mod support;
mod survey;

use assert_cmd::Command;
use files::Files;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// A program that every control of its family reads, and that has nothing to look at.
pub const CLEAN: &str = "%\nO1234\nG20 G17 G90 G40 G80 G94\nG0 X1.\nG1 X2. F10.\nM30\n%\n";

/// A program with a code that no table has.
pub const REFUSED: &str = "%\nO1235\nG20 G17 G90 G40 G80 G94\nG0 X1.\nM38\nG1 X2. F10.\nM30\n%\n";

/// A folder of its own for a test, in which its commands run.
pub struct Shop(TempDir);

/// What a command did.
pub struct Run {
    pub code: i32,
    pub out: String,
    pub err: String,
}

impl Shop {
    pub fn empty() -> Self {
        Self(TempDir::new().unwrap())
    }

    /// A folder with these files.
    pub fn with(files: &[(&str, &str)]) -> Self {
        let shop = Self::empty();
        files.iter().for_each(|(name, text)| shop.write(name, text.as_bytes()));
        shop
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn write(&self, name: &str, bytes: &[u8]) {
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, bytes).unwrap();
    }

    pub fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    /// All files, with their bytes.
    pub fn files(&self) -> Files {
        files::files(self.0.path())
    }

    /// Runs a command whose words stand between blanks.
    pub fn run(&self, line: &str) -> Run {
        self.run_on(line, "")
    }

    /// Runs a command with this on its standard input.
    pub fn run_on(&self, line: &str, input: &str) -> Run {
        let mut command = Command::cargo_bin("macroglot").unwrap();
        command.args(line.split_whitespace()).current_dir(self.0.path()).env_remove("NO_COLOR");
        let output = command.write_stdin(input).output().unwrap();
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        let (out, err) = (text(output.stdout), text(output.stderr));
        assert!(!err.contains("panicked"), "{line}: {err}");
        Run { code: output.status.code().expect("no signal"), out, err }
    }

    /// A command that cannot be done: exit code 2, a reason that has these words, nothing on standard
    /// output, and not a byte of any file changed.
    pub fn fails(&self, line: &str, words: &[&str]) {
        let before = self.files();
        let run = self.run(line);
        assert_eq!(run.code, 2, "{line}: {}{}", run.out, run.err);
        for word in words {
            assert!(run.err.contains(word), "{line}: no '{word}' in: {}", run.err);
        }
        assert_eq!(run.out, "", "{line}");
        assert!(self.files() == before, "{line} changed files: {:?}", names(&self.files()));
    }
}

/// A conversion without the lines that say what it was made of.
pub fn unmarked(text: &str) -> String {
    text.split_inclusive('\n').filter(|line| !line.starts_with("(MACROGLOT ")).collect()
}

pub fn names(files: &Files) -> Vec<&str> {
    files.keys().map(String::as_str).collect()
}

/// A path of the repository, for a command line.
pub fn repository(path: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path).display().to_string()
}
