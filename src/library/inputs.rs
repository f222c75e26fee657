//! Finds and reads the programs that a command was given.

use crate::text::MAX_FILE;
use std::collections::BTreeMap;
use std::fs;
use std::io::{self, Read};
use std::path::{Component, Path, PathBuf};

/// A program file.
#[derive(Clone, Debug, PartialEq)]
pub struct Input {
    /// Where it was read; `-` for standard input.
    pub path: PathBuf,
    /// Its place under the folder that was named, with `/` between parts: where its
    /// conversion goes under the output folder.
    pub name: String,
    /// Its bytes.
    pub bytes: Vec<u8>,
}

/// Why the programs could not be read.
#[derive(Debug, thiserror::Error)]
pub enum InputError {
    /// A path that does not exist.
    #[error("{0}: there is no such file or folder")]
    Missing(PathBuf),
    /// A path that cannot be read.
    #[error("{0}: cannot be read: {1}")]
    Unreadable(PathBuf, io::Error),
    /// A folder in which nothing looks like a program.
    #[error(
        "{0}: the folder has no program files (looked for {1}); name a file itself to read it whatever its ending"
    )]
    NoPrograms(PathBuf, String),
    /// A file of no bytes.
    #[error("{0}: the file is empty")]
    Empty(PathBuf),
    /// A file that is no text.
    #[error("{0}: is a binary file, not a program (byte {1} is {2:#04x})")]
    Binary(PathBuf, usize, u8),
    /// A file that is too long.
    #[error("{0}: is longer than 4 GB")]
    TooLong(PathBuf),
    /// Two files whose conversions would be one.
    #[error(
        "{0} and {1} are both '{2}' under the folders named: their conversions would overwrite each other"
    )]
    Twice(PathBuf, PathBuf, String),
}

/// Endings that program files have, over and above those of the dialects' tables.
const ENDINGS: &[&str] = &[
    "nc", "cnc", "ngc", "tap", "eia", "iso", "prg", "pgm", "mpf", "spf", "min", "txt", "prog", "gcode", "g",
    "ncf", "fnc", "h",
];

/// Bytes that are looked at to tell a binary file from a program.
const HEAD: usize = 64 * 1024;

/// Reads every program under the paths: a file whatever its ending, in a folder
/// those whose ending programs have (or that have none). Ignore files are honoured.
/// Faults of single files come back beside what could be read.
pub fn gather(paths: &[PathBuf], endings: &[String]) -> (Vec<Input>, Vec<InputError>) {
    let mut inputs: BTreeMap<String, Input> = BTreeMap::new();
    let mut errors = Vec::new();
    for path in paths {
        match find(path, endings) {
            Ok(found) => {
                for (path, name) in found {
                    match read(path, name) {
                        Ok(input) => add(&mut inputs, input, &mut errors),
                        Err(error) => errors.push(error),
                    }
                }
            }
            Err(error) => errors.push(error),
        }
    }
    (inputs.into_values().collect(), errors)
}

fn add(inputs: &mut BTreeMap<String, Input>, input: Input, errors: &mut Vec<InputError>) {
    match inputs.get(&input.name) {
        // The same file named twice is one file.
        Some(other) if same_file(&other.path, &input.path) => {}
        Some(other) => errors.push(InputError::Twice(other.path.clone(), input.path, input.name)),
        None => drop(inputs.insert(input.name.clone(), input)),
    }
}

/// True where both paths lead to one file.
pub fn same_file(a: &Path, b: &Path) -> bool {
    a == b || fs::canonicalize(a).ok().zip(fs::canonicalize(b).ok()).is_some_and(|(a, b)| a == b)
}

fn find(path: &Path, endings: &[String]) -> Result<Vec<(PathBuf, String)>, InputError> {
    if path == Path::new("-") {
        return Ok(vec![(path.to_owned(), "stdin.nc".into())]);
    }
    let facts = fs::metadata(path).map_err(|error| match error.kind() {
        io::ErrorKind::NotFound => InputError::Missing(path.to_owned()),
        _ => InputError::Unreadable(path.to_owned(), error),
    })?;
    if !facts.is_dir() {
        let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        return Ok(vec![(path.to_owned(), name)]);
    }
    let mut found = Vec::new();
    let walk = ignore::WalkBuilder::new(path).require_git(false).sort_by_file_path(Path::cmp).build();
    for entry in walk {
        let entry =
            entry.map_err(|error| InputError::Unreadable(path.to_owned(), io::Error::other(error)))?;
        if entry.file_type().is_some_and(|kind| kind.is_file()) && is_program(entry.path(), endings) {
            let name = entry.path().strip_prefix(path).map(slashed).unwrap_or_default();
            found.push((entry.into_path(), name));
        }
    }
    if found.is_empty() {
        let endings = ENDINGS.iter().map(|e| format!(".{e}")).collect::<Vec<_>>().join(" ");
        return Err(InputError::NoPrograms(path.to_owned(), endings));
    }
    Ok(found)
}

fn is_program(path: &Path, endings: &[String]) -> bool {
    match path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()) {
        Some(ending) => ENDINGS.contains(&ending.as_str()) || endings.contains(&ending),
        // Controls write O1234 and the like; build files and licences have no ending either.
        None => path.file_name().is_some_and(|name| {
            let name = name.to_string_lossy().to_ascii_uppercase();
            name.strip_prefix('O').unwrap_or(&name).bytes().all(|b| b.is_ascii_digit())
        }),
    }
}

fn slashed(path: &Path) -> String {
    let parts = path.components().filter_map(|part| match part {
        Component::Normal(part) => Some(part.to_string_lossy().into_owned()),
        _ => None,
    });
    parts.collect::<Vec<_>>().join("/")
}

fn read(path: PathBuf, name: String) -> Result<Input, InputError> {
    let bytes = if path == Path::new("-") {
        let mut bytes = Vec::new();
        io::stdin().lock().take(MAX_FILE as u64 + 1).read_to_end(&mut bytes).map(|_| bytes)
    } else {
        fs::read(&path)
    };
    let bytes = bytes.map_err(|error| InputError::Unreadable(path.clone(), error))?;
    if bytes.is_empty() {
        return Err(InputError::Empty(path));
    }
    if bytes.len() > MAX_FILE {
        return Err(InputError::TooLong(path));
    }
    match binary_byte(&bytes) {
        Some(at) => Err(InputError::Binary(path, at, bytes[at])),
        None => Ok(Input { path, name, bytes }),
    }
}

/// The first byte that no program has: a control character that is no white space
/// and none of those that tapes have. NUL may lead and trail a tape, not stand among text.
fn binary_byte(bytes: &[u8]) -> Option<usize> {
    let text = bytes.iter().position(|&b| b != 0).unwrap_or(bytes.len());
    let end = bytes.iter().rposition(|&b| b != 0).map_or(0, |at| at + 1);
    if text >= end {
        return Some(0);
    }
    // DC1 to DC4, SUB (end of file on old systems) and DEL are tape and serial-line characters.
    let tape = |b: u8| matches!(b, 0x11..=0x14 | 0x1a | 0x7f);
    let wrong =
        |b: u8| (b < 0x20 && !b.is_ascii_whitespace() && b != 0x0b && b != 0x08 && !tape(b)) || b == 0;
    let head = &bytes[text..end.min(text + HEAD)];
    // One stray byte is a damaged program, many are no program.
    let count = head.iter().filter(|b| wrong(**b)).count();
    (count * 50 > head.len()).then(|| text + head.iter().position(|b| wrong(*b)).unwrap_or(0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tells_programs_from_binaries() {
        assert_eq!(binary_byte(b"\0\0\0%\nO1\n\0"), None);
        assert_eq!(
            binary_byte(b"G0 X1\x00\n Y1 (a comment that is long enough to hold one stray byte)"),
            None
        );
        assert_eq!(binary_byte(b"\x7fELF\x02\x01\x01\0\0\0\0\0\0\0\0\0\x03"), Some(4));
        assert_eq!(binary_byte(b"\0\0\0"), Some(0));
    }

    #[test]
    fn files_without_ending_are_programs_by_their_number() {
        for (name, program) in
            [("O1234", true), ("8010", true), ("README", false), ("a.NC", true), ("a.tsv", false)]
        {
            assert_eq!(is_program(Path::new(name), &[]), program, "{name}");
        }
    }
}
