//! Finds and reads the programs that a command was given.

use super::unread::{InputError, LeftOut, WhyNot};
use super::walk::{Walked, walk};
use crate::text::MAX_FILE;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

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

/// Bytes that are looked at to tell a binary file from a program.
const HEAD: usize = 64 * 1024;

/// What was found under the paths of a command.
#[derive(Debug)]
pub struct Found<T> {
    /// The programs.
    pub programs: Vec<T>,
    /// What was left out of folders.
    pub left_out: Vec<LeftOut>,
    /// Paths and files that could not be read.
    pub errors: Vec<InputError>,
}

/// Reads every program under the paths. Faults of single files come back beside what could be read.
pub fn gather(paths: &[PathBuf], endings: &[String]) -> Found<Input> {
    let Found { programs: sources, left_out, mut errors } = sources(paths, endings);
    let mut programs = Vec::new();
    for source in sources {
        match source.read() {
            Ok(input) => programs.push(input),
            Err(error) => errors.push(error),
        }
    }
    Found { programs, left_out, errors }
}

/// Finds every program under the paths: a file whatever its ending, in a folder those whose ending programs have.
pub fn sources(paths: &[PathBuf], endings: &[String]) -> Found<Source> {
    let mut sources = BTreeMap::new();
    let mut all = Found { programs: Vec::new(), left_out: Vec::new(), errors: Vec::new() };
    for path in paths {
        match find(path, endings) {
            Ok(found) => {
                all.left_out.extend(found.left_out);
                for (path, name) in found.programs {
                    add(&mut sources, Source { path, name, start: Vec::new() }, &mut all.errors);
                }
            }
            Err(error) => all.errors.push(error),
        }
    }
    // What is named by hand besides is not left out.
    let read = Files::of(sources.values().map(|source| source.path.as_path()));
    all.left_out.retain(|left| left.why == WhyNot::Link || !read.holds(&left.path));
    all.programs = sources.into_values().collect();
    all
}

fn add(sources: &mut BTreeMap<String, Source>, source: Source, errors: &mut Vec<InputError>) {
    match sources.get(&source.name) {
        // The same file named twice is one file.
        Some(other) if same_file(&other.path, &source.path) => {}
        Some(other) => errors.push(InputError::Twice(other.path.clone(), source.path, source.name)),
        None => drop(sources.insert(source.name.clone(), source)),
    }
}

/// True if both paths lead to one file.
pub fn same_file(a: &Path, b: &Path) -> bool {
    a == b || identity(a).is_some_and(|file| identity(b) == Some(file))
}

/// Files by what they are, whatever their paths say: links of both kinds lead to the same file.
#[derive(Debug, Default)]
pub struct Files(BTreeSet<Identity>);

/// What tells a file from every other: its device and number there.
#[cfg(unix)]
type Identity = (u64, u64);

/// What tells a file from every other: where it really is.
#[cfg(not(unix))]
type Identity = PathBuf;

#[cfg(unix)]
fn identity(path: &Path) -> Option<Identity> {
    use std::os::unix::fs::MetadataExt;
    fs::metadata(path).ok().map(|facts| (facts.dev(), facts.ino()))
}

#[cfg(not(unix))]
fn identity(path: &Path) -> Option<Identity> {
    fs::canonicalize(path).ok()
}

impl Files {
    /// The files of these paths.
    pub fn of<'p>(paths: impl Iterator<Item = &'p Path>) -> Self {
        Self(paths.filter_map(identity).collect())
    }

    /// True if the path leads to one of them.
    pub fn holds(&self, path: &Path) -> bool {
        identity(path).is_some_and(|file| self.0.contains(&file))
    }
}

fn find(path: &Path, endings: &[String]) -> Result<Walked, InputError> {
    let one = |name: String| Walked { programs: vec![(path.to_owned(), name)], left_out: Vec::new() };
    if path == Path::new("-") {
        return Ok(one("stdin.nc".into()));
    }
    let facts = fs::metadata(path).map_err(|error| match error.kind() {
        io::ErrorKind::NotFound => InputError::Missing(path.to_owned()),
        _ => InputError::Unreadable(path.to_owned(), error),
    })?;
    if facts.is_dir() {
        return walk(path, endings);
    }
    Ok(one(path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned())))
}

/// A program file that is not read yet.
#[derive(Clone, Debug)]
pub struct Source {
    /// Where it is; `-` for standard input.
    pub path: PathBuf,
    /// As in [`Input`].
    pub name: String,
    /// What was read of standard input already.
    start: Vec<u8>,
}

impl Source {
    /// The same in another place of the output.
    #[must_use]
    pub fn named(self, name: String) -> Self {
        Self { name, ..self }
    }

    /// Its place under the folder that was named.
    pub fn name(&self) -> &str {
        &self.name
    }

    fn open(&self) -> Result<Box<dyn Read + '_>, InputError> {
        if self.path == Path::new("-") {
            return Ok(Box::new(self.start.chain(io::stdin())));
        }
        let file = fs::File::open(&self.path).map_err(|error| self.unreadable(error))?;
        Ok(Box::new(file))
    }

    fn unreadable(&self, error: io::Error) -> InputError {
        InputError::Unreadable(self.path.clone(), error)
    }

    /// Reads it whole.
    pub fn read(self) -> Result<Input, InputError> {
        let most = MAX_FILE as u64 + 1;
        // Room for all of it at once: growing would copy it, and take half as much again.
        let length = fs::metadata(&self.path).map_or(0, |data| data.len().min(most));
        let mut bytes = Vec::new();
        let _ = bytes.try_reserve_exact(length as usize);
        self.open()?.take(most).read_to_end(&mut bytes).map_err(|error| self.unreadable(error))?;
        self.check(&bytes, true)?;
        if bytes.len() > MAX_FILE {
            return Err(InputError::TooLong(self.path));
        }
        Ok(Input { path: self.path, name: self.name, bytes })
    }

    /// Reads its start only.
    pub fn head(&mut self) -> Result<Input, InputError> {
        let mut bytes = Vec::new();
        self.open()?.take(HEAD as u64).read_to_end(&mut bytes).map_err(|error| self.unreadable(error))?;
        if self.path == Path::new("-") {
            self.start.clone_from(&bytes);
        }
        Ok(Input { path: self.path.clone(), name: self.name.clone(), bytes })
    }

    /// Reads it in pieces of whole lines, so that memory grows with the longest line only.
    /// Yields how many bytes it has.
    pub fn pieces(&self, f: &mut dyn FnMut(&[u8])) -> Result<usize, InputError> {
        let (mut file, mut held, mut total) = (self.open()?, Vec::new(), 0);
        let mut want = PIECE;
        loop {
            let missing = want.saturating_sub(held.len()) as u64;
            file.by_ref().take(missing).read_to_end(&mut held).map_err(|error| self.unreadable(error))?;
            let whole = held.len() < want;
            if held.len() > MAX_FILE {
                return Err(InputError::TooLong(self.path.clone()));
            }
            if total == 0 {
                self.check(&held, whole)?;
            }
            let cut = if whole { held.len() } else { behind_last_line(&held) };
            f(&held[..cut]);
            total += cut;
            if whole {
                return Ok(total);
            }
            held.drain(..cut);
            // A line that does not fit makes the piece longer.
            want = PIECE.max(2 * held.len());
        }
    }

    /// Refuses what is no program, by its start.
    fn check(&self, bytes: &[u8], whole: bool) -> Result<(), InputError> {
        match bytes {
            [] => Err(InputError::Empty(self.path.clone())),
            bytes => match binary_byte(bytes, whole) {
                Some(at) => Err(InputError::Binary(self.path.clone(), at, bytes[at])),
                None => Ok(()),
            },
        }
    }
}

/// Bytes that are read at a time.
const PIECE: usize = 2 * 1024 * 1024;

/// Where the last whole line ends; 0 where none does. A CR at the very end may be half of a line end.
fn behind_last_line(bytes: &[u8]) -> usize {
    let sure = bytes.strip_suffix(b"\r").unwrap_or(bytes);
    memchr::memrchr2(b'\n', b'\r', sure).map_or(0, |at| at + 1)
}

/// The first byte that no program has: a control character that is no white space
/// and none of those that tapes have. NUL may lead and trail a tape, not stand among text.
fn binary_byte(bytes: &[u8], whole: bool) -> Option<usize> {
    let text = bytes.iter().position(|&b| b != 0).unwrap_or(bytes.len());
    let last = bytes.iter().rposition(|&b| b != 0).map_or(0, |at| at + 1);
    let end = if whole { last } else { bytes.len() };
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
        assert_eq!(binary_byte(b"\0\0\0%\nO1\n\0", true), None);
        assert_eq!(
            binary_byte(b"G0 X1\x00\n Y1 (a comment that is long enough to hold one stray byte)", true),
            None
        );
        assert_eq!(binary_byte(b"\x7fELF\x02\x01\x01\0\0\0\0\0\0\0\0\0\x03", true), Some(4));
        assert_eq!(binary_byte(b"\0\0\0", true), Some(0));
    }

    #[test]
    fn pieces_are_whole_lines_and_all_of_the_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.nc");
        // Line ends of all kinds, at all distances from the edges of pieces, and a line longer than a piece.
        let mut text = String::new();
        for n in 0..600_000 {
            text += &"X1".repeat(n % 7);
            text += ["\n", "\r\n", "\r", "\n\r"][n % 4];
        }
        let long = text.clone() + &"(".repeat(3 * PIECE) + "\r\n" + &text;
        for whole in [long.as_str(), "G0", "\r", &"\r".repeat(PIECE), &("A".repeat(PIECE - 1) + "\r\nB")] {
            fs::write(&path, whole).unwrap();
            let source = Source { path: path.clone(), name: "a.nc".into(), start: Vec::new() };
            let (mut all, mut cuts) = (Vec::new(), Vec::new());
            let total = source.pieces(&mut |piece| {
                all.extend_from_slice(piece);
                cuts.push(all.len());
            });
            assert_eq!(total.unwrap(), whole.len());
            assert!(all == whole.as_bytes());
            for cut in cuts.into_iter().filter(|cut| *cut > 0 && *cut < whole.len()) {
                assert!(matches!(all[cut - 1], b'\n' | b'\r') && &all[cut - 1..=cut] != b"\r\n");
            }
        }
    }
}
