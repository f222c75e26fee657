//! What was found, at its place, in a form that outlives the texts.

use crate::diag::{Code, Diagnostic, Severity};
use crate::library::{Input, slashed};
use crate::text::{CodePoints, Span};
use crate::verify::sha256;
use serde::Serialize;
use std::cell::OnceCell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Letters of a line that are shown.
const SHOWN: usize = 200;

/// Letters of a fingerprint.
const PRINT: usize = 16;

/// Something that was found in a file.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    /// Its code.
    pub code: Code,
    /// How grave it is.
    pub severity: Severity,
    /// The file.
    pub file: PathBuf,
    /// Where it begins: line and column, from 1, in letters.
    pub start: (u32, u32),
    /// Where it ends.
    pub end: (u32, u32),
    /// The line, without its end and the blanks about it; empty of a finding about the whole file.
    pub line: String,
    /// What is the matter.
    pub message: String,
    /// What to do about it.
    pub help: Option<String>,
    /// What stays the same when other lines change: the code, the file, the line's text, and which one of several.
    pub fingerprint: String,
    /// By whom it was accepted, when and why, if it was.
    #[serde(skip)]
    pub accepted: Option<String>,
}

impl Finding {
    /// A finding about a file as a whole.
    pub fn of_file(code: Code, file: &Path, message: String, help: String) -> Self {
        Self {
            code,
            severity: code.severity(),
            file: file.to_owned(),
            start: (1, 1),
            end: (1, 1),
            line: String::new(),
            message,
            help: Some(help),
            fingerprint: String::new(),
            accepted: None,
        }
    }
}

/// Gives each finding its fingerprint, and puts them in order. Files are known by their places seen from `root`.
pub fn number(found: &mut Vec<Finding>, root: &Path) {
    found.sort_by(|a, b| {
        let key = |f: &Finding| (f.file.clone(), f.start, f.code);
        key(a).cmp(&key(b)).then_with(|| a.message.cmp(&b.message))
    });
    found.dedup_by(|a, b| (a.code, &a.file, a.start, &a.message) == (b.code, &b.file, b.start, &b.message));
    let mut seen: BTreeMap<String, usize> = BTreeMap::new();
    for finding in found {
        // What a finding is about a whole file, its message tells.
        let about = if finding.line.is_empty() { &finding.message } else { &finding.line };
        let file = slashed(&seen_from(&finding.file, root));
        let about = format!("{}\n{file}\n{about}", finding.code.number());
        let again = seen.entry(about.clone()).or_default();
        let mut print = sha256(format!("{about}\n{again}").as_bytes());
        print.truncate(PRINT);
        finding.fingerprint = print;
        *again += 1;
    }
}

/// A file seen from a folder above it; as it is named if that is none.
pub fn seen_from(file: &Path, root: &Path) -> PathBuf {
    let whole = std::path::absolute(file).unwrap_or_else(|_| file.to_owned());
    whole.strip_prefix(root).unwrap_or(file).to_owned()
}

/// The files of a library, with their lines counted when the first place in one is named.
pub struct Pages<'a> {
    inputs: &'a [Input],
    lines: Vec<OnceCell<CodePoints>>,
}

impl<'a> Pages<'a> {
    /// Of these files.
    pub fn new(inputs: &'a [Input]) -> Self {
        Self { inputs, lines: inputs.iter().map(|_| OnceCell::new()).collect() }
    }

    /// A finding at its place.
    pub fn finding(&self, file: usize, diagnostic: &Diagnostic) -> Finding {
        let help = diagnostic.help.as_deref().map(str::to_owned);
        self.at(diagnostic.code, file, diagnostic.span, diagnostic.message.to_string(), help)
    }

    /// A finding at a place of a file.
    pub fn at(&self, code: Code, file: usize, span: Span, message: String, help: Option<String>) -> Finding {
        let input = &self.inputs[file];
        let lines = self.lines[file].get_or_init(|| CodePoints::new(&input.bytes));
        let [start, end] = lines.region(span);
        Finding {
            code,
            severity: code.severity(),
            file: input.path.clone(),
            start,
            end,
            line: line_of(&input.bytes, span.start as usize),
            message,
            help,
            fingerprint: String::new(),
            accepted: None,
        }
    }
}

/// The line that a byte stands in, as far as it is shown.
pub fn line_of(bytes: &[u8], at: usize) -> String {
    let at = at.min(bytes.len());
    let ends = |byte: &u8| matches!(byte, b'\n' | b'\r');
    let start = bytes[..at].iter().rposition(ends).map_or(0, |end| end + 1);
    let stop = bytes[at..].iter().position(ends).map_or(bytes.len(), |end| at + end);
    let line = String::from_utf8_lossy(&bytes[start..stop]);
    line.trim().chars().take(SHOWN).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(text: &str, at: &[u32]) -> Vec<Finding> {
        let inputs = [Input { path: "a.nc".into(), name: "a.nc".into(), bytes: text.into() }];
        let pages = Pages::new(&inputs);
        let at = at.iter().map(|at| pages.at(Code::Unreadable, 0, Span::new(*at, at + 1), "no".into(), None));
        let mut all: Vec<Finding> = at.collect();
        number(&mut all, Path::new("/"));
        all
    }

    #[test]
    fn a_fingerprint_survives_a_moved_line_and_tells_equal_lines_apart() {
        let before = found("O1\n  X?\nX?\n", &[5, 9]);
        let after = found("O1\n(NEW)\nX?\n\tX?\n", &[9, 12]);
        assert_eq!(before[0].start, (2, 3));
        assert_eq!(after[0].start, (3, 1));
        let prints = |all: &[Finding]| all.iter().map(|f| f.fingerprint.clone()).collect::<Vec<_>>();
        assert_eq!(prints(&before), prints(&after));
        assert_ne!(before[0].fingerprint, before[1].fingerprint);
    }

    #[test]
    fn a_line_is_the_one_of_its_byte() {
        assert_eq!(line_of(b"O1\r\n X1. \r\nM30", 5), "X1.");
        assert_eq!(line_of(b"O1\r\nM30", 99), "M30");
        assert_eq!(line_of("Ä\u{ff}".repeat(200).as_bytes(), 0).chars().count(), 200);
    }
}
