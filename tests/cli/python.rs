//! Python with what the tests need of its registry: pre-commit, maturin, and a validator of JSON schemas.

use crate::support::{root, text};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;

/// The folder of the installed programs. They are installed once for all tests.
pub fn tools() -> &'static Path {
    static TOOLS: OnceLock<PathBuf> = OnceLock::new();
    TOOLS.get_or_init(|| {
        let wanted = text("tests/support/python.txt");
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("python-tools");
        let programs = folder.join(if cfg!(windows) { "Scripts" } else { "bin" });
        let done = folder.join("installed.txt");
        if std::fs::read_to_string(&done).is_ok_and(|installed| installed == wanted) {
            return programs;
        }
        let python = if cfg!(windows) { "python" } else { "python3" };
        let made = Command::new(python).args(["-m", "venv", "--clear"]).arg(&folder).output();
        let why = "this test needs Python 3.9 or later with venv: install it";
        assert!(made.is_ok_and(|made| made.status.success()), "{why}");
        let pip = Command::new(programs.join("pip"))
            .args(["install", "--quiet", "--disable-pip-version-check", "-r"])
            .arg(root().join("tests/support/python.txt"))
            .output();
        said(&pip.unwrap(), "pip install");
        std::fs::write(&done, wanted).unwrap();
        programs
    })
}

/// What a program wrote; one that failed fails the test.
pub fn said(output: &Output, what: &str) -> String {
    let all = [&output.stdout[..], &output.stderr].concat();
    let all = String::from_utf8_lossy(&all).into_owned();
    assert!(output.status.success(), "{what}: {:?}\n{all}", output.status);
    all
}
