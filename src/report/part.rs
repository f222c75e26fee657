//! What every renderer renders: libraries, and what became of them.

use crate::diag::Diagnostic;
use crate::library::{Conversion, Input, LeftOut, Told};
use crate::text::LineIndex;
use std::path::PathBuf;

/// A library and its conversion.
#[derive(Clone, Copy, Debug)]
pub struct Part<'a> {
    /// The dialect of its programs.
    pub from: &'a str,
    /// The dialect they were converted to.
    pub to: &'a str,
    /// Its files.
    pub inputs: &'a [Input],
    /// What became of its programs.
    pub conversion: &'a Conversion,
    /// Where the conversion of each file was written, if it was.
    pub targets: &'a [Option<PathBuf>],
    /// What is to be said of the programs as a whole.
    pub notes: &'a [String],
    /// What a person is told of the output folder.
    pub folder: &'a Told,
    /// What was left out of the folders that were named.
    pub left_out: &'a [LeftOut],
    /// True if each of those is named, and not counted alone.
    pub verbose: bool,
}

/// How much of a line is shown before a place in it, and after it: bytes. A line may have as many places as bytes.
const ABOUT: usize = 200;

/// A place in a file, as people and their editors count: from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place<'a> {
    /// The line.
    pub line: u32,
    /// The column, in bytes.
    pub column: u32,
    /// The line's bytes, without its end; of a long line those about the place.
    pub text: &'a [u8],
}

impl<'a> Part<'a> {
    /// The lines of each file.
    pub fn indexes(&self) -> Vec<LineIndex> {
        self.inputs.iter().map(|input| LineIndex::new(&input.bytes)).collect()
    }

    /// Where a finding of a file begins.
    pub fn place(&self, file: usize, index: &LineIndex, finding: &Diagnostic) -> Place<'a> {
        let (line, column) = index.place(finding.span.start);
        let bytes: &[u8] = self.inputs.get(file).map_or(&[], |input| &input.bytes);
        let at = (finding.span.start as usize).min(bytes.len());
        let ends = |byte: &u8| matches!(byte, b'\n' | b'\r');
        let start = bytes[..at].iter().rposition(ends).map_or(0, |end| end + 1);
        let stop = bytes[at..].iter().position(ends).map_or(bytes.len(), |end| at + end);
        let (start, stop) = (start.max(at.saturating_sub(ABOUT)), stop.min(at.saturating_add(ABOUT)));
        Place { line, column, text: &bytes[start..stop] }
    }
}
