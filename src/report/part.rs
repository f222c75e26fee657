//! What every renderer renders: libraries, and what became of them.

use crate::diag::Diagnostic;
use crate::dialect::Control;
use crate::library::{Certificates, Conversion, Input, LeftOut, Outcome, ProgramReport, Told};
use crate::text::LineIndex;
use std::path::PathBuf;

/// A library and its conversion.
#[derive(Clone, Copy, Debug)]
pub struct Part<'a> {
    /// The dialect of its programs.
    pub from: &'a str,
    /// The dialect they were converted to.
    pub to: &'a str,
    /// The machines that they were written for, and converted for.
    pub controls: [&'a Control; 2],
    /// Its files.
    pub inputs: &'a [Input],
    /// By file: true if it is told of. The others were read because these call them, or they call these.
    pub named: &'a [bool],
    /// What became of its programs.
    pub conversion: &'a Conversion,
    /// What the verifier found; none if it was not asked.
    pub certificates: Option<&'a Certificates>,
    /// Where the conversion of each file was written, if it was.
    pub targets: &'a [Option<PathBuf>],
    /// What is to be said of the programs as a whole.
    pub notes: &'a [String],
    /// What a person must know before the first run of any program of the target's control.
    pub advice: Option<&'a str>,
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
    /// The programs that are told of, with their indexes.
    pub fn programs(&self) -> impl Iterator<Item = (usize, &'a ProgramReport)> + use<'a> {
        let (named, programs) = (self.named, &self.conversion.programs);
        programs.iter().enumerate().filter(|(_, program)| named.get(program.file).is_none_or(|named| *named))
    }

    /// The files that are told of.
    pub fn files(&self) -> usize {
        (0..self.inputs.len()).filter(|at| self.named.get(*at).is_none_or(|named| *named)).count()
    }

    /// The advice, if any program can be run.
    pub fn advised(&self) -> Option<&'a str> {
        let runs = |(_, program): (usize, &ProgramReport)| program.outcome != Outcome::Refused;
        self.advice.filter(|_| self.programs().any(runs))
    }

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
        // No farther than is shown: as many places on one line would be looked for as many times along it.
        let (from, to) = (at.saturating_sub(ABOUT), at.saturating_add(ABOUT).min(bytes.len()));
        let start = bytes[from..at].iter().rposition(ends).map_or(from, |end| from + end + 1);
        let stop = bytes[at..to].iter().position(ends).map_or(to, |end| at + end);
        Place { line, column, text: &bytes[start..stop] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diag::Code;
    use crate::text::Span;

    /// Of a long line what stands about the place is shown, of a short one all.
    #[test]
    fn a_place_shows_its_line() {
        let bytes = format!("O1\r\nM38\r\n{}M38 {}\nM30", "X1.".repeat(100), "Y2.".repeat(100)).into_bytes();
        let inputs = [Input { path: "a.nc".into(), name: "a.nc".into(), bytes }];
        let conversion = Conversion {
            programs: Vec::new(),
            texts: Vec::new(),
            lock: crate::library::Lock::new("fanuc", "haas"),
            taken: Default::default(),
            states_reserved: false,
            links: Vec::new(),
        };
        let control = Control::plain("fanuc").unwrap();
        let part = Part {
            controls: [&control, &control],
            from: "fanuc",
            to: "haas",
            inputs: &inputs,
            named: &[],
            conversion: &conversion,
            certificates: None,
            targets: &[],
            notes: &[],
            advice: None,
            folder: &Told::default(),
            left_out: &[],
            verbose: false,
        };
        let index = &part.indexes()[0];
        let shown = |at| {
            let place = part.place(0, index, &Diagnostic::new(Code::Unmapped, Span::new(at, at + 3), ""));
            (place.line, place.column, String::from_utf8_lossy(place.text).into_owned())
        };
        assert_eq!(shown(4), (2, 1, "M38".into()));
        assert_eq!(shown(9), (3, 1, "X1.".repeat(67)[..200].into()));
        let about = format!("1.{}M38 {}", "X1.".repeat(66), &"Y2.".repeat(66)[..196]);
        assert_eq!(shown(309), (3, 301, about));
        assert_eq!(shown(4000), (4, 4000 - 613, "M30".into()));
    }
}
