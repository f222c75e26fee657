//! Runs `filetests/**/*.ir`: small IR programs with what is to come of them.
//!
//! A file starts with `; test <command> [options]`. Behind `; expect:` stands, line by line behind
//! a `;`, what the command must yield. Claims of execution, `; run: global.1 = 2 => global.2 = 4`,
//! are checked for every program of every command that yields one: first what is set, then what must
//! hold at the end (a variable's value, `alarm`, or `event <line>`). Expectations are written by hand.

mod claims;
#[path = "../support/domain.rs"]
mod domain;
mod legalize;
#[path = "../support/machine.rs"]
mod machine;
mod opt;
mod roundtrip;
mod run;
mod validate;

use std::path::{Path, PathBuf};

/// A file, taken apart.
pub struct Case {
    /// Words behind the command.
    pub options: Vec<String>,
    /// The whole text.
    pub text: String,
    /// What is expected, if anything.
    pub expect: Option<String>,
}

/// Yields what is compared with the expectation; none where the command judges by itself.
type Driver = fn(&Case) -> Result<Option<String>, String>;

/// One driver a command.
const DRIVERS: &[(&str, Driver)] = &[
    ("roundtrip", roundtrip::drive),
    ("validate", validate::drive),
    ("opt", opt::drive),
    ("legalize", legalize::drive),
    ("run", run::drive),
];

#[test]
fn filetests() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("filetests");
    let mut files = Vec::new();
    gather(&root, &mut files);
    assert!(files.len() >= 10, "only {} files found below {}", files.len(), root.display());
    let failed: Vec<String> = files
        .iter()
        .filter_map(|file| check(file).err().map(|why| format!("--- {}\n{why}", file.display())))
        .collect();
    assert!(failed.is_empty(), "{} of {} failed\n{}", failed.len(), files.len(), failed.join("\n"));
}

#[test]
fn every_pass_has_a_file_that_it_acts_on_and_one_that_it_leaves() {
    let mut files = Vec::new();
    gather(&Path::new(env!("CARGO_MANIFEST_DIR")).join("filetests/legalize"), &mut files);
    let mut seen = std::collections::BTreeSet::new();
    for file in &files {
        let (_, case) = read(file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
        seen.extend(legalize::acts(&case).unwrap_or_else(|error| panic!("{}: {error}", file.display())));
    }
    for pass in legalize::of_groups(legalize::LEGALIZE) {
        assert!(
            seen.contains(&(pass.name, true)),
            "no filetest gives the pass '{}' anything to do",
            pass.name
        );
        assert!(seen.contains(&(pass.name, false)), "no filetest shows what the pass '{}' leaves", pass.name);
    }
}

fn gather(folder: &Path, files: &mut Vec<PathBuf>) {
    let mut entries: Vec<PathBuf> =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    entries.sort();
    for path in entries {
        if path.is_dir() {
            gather(&path, files);
        } else if path.extension().is_some_and(|ending| ending == "ir") {
            files.push(path);
        }
    }
}

/// The command of a file, and the file taken apart.
fn read(file: &Path) -> Result<(String, Case), String> {
    let text = std::fs::read_to_string(file).map_err(|e| e.to_string())?;
    let head = text.lines().next().and_then(|line| line.strip_prefix("; test ")).unwrap_or_default();
    let mut words = head.split_whitespace().map(str::to_owned);
    let command = words.next().ok_or("the first line is not '; test <command>'")?;
    Ok((command, Case { options: words.collect(), expect: expectation(&text), text }))
}

fn check(file: &Path) -> Result<(), String> {
    let (command, case) = read(file)?;
    let known = || DRIVERS.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ");
    let driver = DRIVERS.iter().find(|(name, _)| *name == command);
    let (_, driver) = driver.ok_or_else(|| format!("no command '{command}'; there are {}", known()))?;
    match (driver(&case)?, &case.expect) {
        (None, None) => Ok(()),
        (Some(_), None) => Err("lacks '; expect:'".into()),
        (None, Some(_)) => Err(format!("'{command}' expects nothing")),
        (Some(found), Some(wanted)) if found.trim_end() == wanted.trim_end() => Ok(()),
        (Some(found), Some(wanted)) => Err(similar::TextDiff::from_lines(wanted, &found)
            .unified_diff()
            .header("expected", "found")
            .to_string()),
    }
}

/// What stands behind `; expect:`, without its comment signs.
fn expectation(text: &str) -> Option<String> {
    let lines = text.lines().skip_while(|line| *line != "; expect:");
    let mut lines = lines.peekable();
    lines.next()?;
    let strip =
        |line: &str| line.strip_prefix("; ").or(line.strip_prefix(';')).unwrap_or(line).to_owned() + "\n";
    Some(lines.map(strip).collect())
}
