//! Takes the text of single programs out of the files that they stand in.
//!
//! A program's text is a run of bytes of its file, so that what is left is the same text as before, and what was found
//! of it still holds.

use super::callees::Withdrawn;
use super::{Conversion, Input};
use crate::verify::{Certificate, ProgramCertificate, sha256};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// The certificates of a conversion, by file.
#[derive(Clone, Debug, Default)]
pub struct Certificates {
    /// Of the programs that are written: each is of the text that stands in the file.
    pub written: Vec<Option<Certificate>>,
    /// Of the programs that were converted and are not written: they differ, or call one that does.
    pub withheld: Vec<Option<Certificate>>,
    /// The other files that the runs of a file's programs, and of what calls them, may have come through: were they another
    /// text, so might be what was found.
    pub rest_on: Vec<BTreeSet<usize>>,
    /// Where the certificate of each program stands, by its index: its file, whether it is withheld, its place there.
    pub(super) places: BTreeMap<usize, (usize, bool, usize)>,
}

impl Certificates {
    /// Of as many files, none yet.
    pub(super) fn none(files: usize) -> Self {
        Self {
            written: vec![None; files],
            withheld: vec![None; files],
            rest_on: vec![BTreeSet::new(); files],
            places: BTreeMap::new(),
        }
    }

    /// What was found of a program, by its index among the reports.
    pub fn of_program(&self, at: usize) -> Option<&ProgramCertificate> {
        let (file, is_withheld, place) = *self.places.get(&at)?;
        let all = if is_withheld { &self.withheld } else { &self.written };
        all.get(file)?.as_ref()?.programs.get(place)
    }
}

/// What separates a program without a name from what stands before it.
const FRAME: &str = "%\n";

/// The text of a file without some of its programs; none if nothing is left.
pub fn cut(conversion: &Conversion, file: usize, without: &BTreeSet<usize>) -> Option<String> {
    let text = conversion.texts.get(file)?.as_ref()?;
    let kept = kept(conversion, file, without);
    if kept.iter().all(|(_, range)| range.is_empty()) {
        return None;
    }
    let mut left = text.get(..head(conversion, file))?.to_owned();
    kept.iter().filter_map(|(_, range)| text.get(range.clone())).for_each(|part| left.push_str(part));
    left.push_str(text.get(tail(conversion, file)..)?);
    Some(left)
}

/// The programs of a file that stay, with the bytes that stay of each.
fn kept(conversion: &Conversion, file: usize, without: &BTreeSet<usize>) -> Vec<(usize, Range<usize>)> {
    let text = conversion.texts.get(file).and_then(Option::as_deref).unwrap_or_default();
    let here = conversion.programs.iter().enumerate().filter(|(_, program)| program.file == file);
    let mut kept: Vec<(usize, Range<usize>)> = here
        .filter(|(at, _)| !without.contains(at))
        .map(|(at, program)| (at, program.range.clone()))
        .collect();
    let head = head(conversion, file);
    let first = kept.iter_mut().map(|(_, range)| range).find(|range| range.start < range.end);
    // What comes first needs nothing that shows where it begins.
    if let Some(range) = first.filter(|range| range.start != head && text[range.start..].starts_with(FRAME)) {
        range.start += FRAME.len();
    }
    kept
}

/// Where the first program of a file begins.
fn head(conversion: &Conversion, file: usize) -> usize {
    let here = conversion.programs.iter().filter(|program| program.file == file);
    here.map(|program| &program.range)
        .filter(|range| !range.is_empty())
        .map(|range| range.start)
        .min()
        .unwrap_or(0)
}

/// Where the last one ends.
fn tail(conversion: &Conversion, file: usize) -> usize {
    let here = conversion.programs.iter().filter(|program| program.file == file);
    here.map(|program| program.range.end).max().unwrap_or(0)
}

/// Takes programs out of their files; what stays keeps its blocks, whose places move.
pub fn withdraw(conversion: &mut Conversion, withdrawn: &BTreeMap<usize, Withdrawn>) {
    let without: BTreeSet<usize> = withdrawn.keys().copied().collect();
    let files: BTreeSet<usize> = without.iter().map(|at| conversion.programs[*at].file).collect();
    for file in files {
        let text = cut(conversion, file, &without);
        let mut to = head(conversion, file);
        for (at, range) in kept(conversion, file, &without) {
            let program = &mut conversion.programs[at];
            let moved = |place: usize| place.saturating_sub(range.start) + to;
            program.map.iter_mut().for_each(|(_, place)| *place = moved(place.start)..moved(place.end));
            program.range = to..to + range.len();
            to += range.len();
        }
        conversion.texts[file] = text;
    }
    for at in without {
        let program = &mut conversion.programs[at];
        (program.map, program.range) = (Vec::new(), 0..0);
    }
}

/// The certificates of what is written, and of what is not.
pub fn written(
    conversion: &Conversion,
    inputs: &[Input],
    files: Vec<Option<Certificate>>,
    found: BTreeMap<usize, ProgramCertificate>,
    withheld: &BTreeSet<usize>,
) -> Certificates {
    let mut all = Certificates { written: files.clone(), withheld: files, ..Certificates::default() };
    for (at, mut program) in found {
        let file = conversion.programs[at].file;
        let is_withheld = withheld.contains(&at);
        let text = conversion.texts.get(file).and_then(Option::as_ref).filter(|_| !is_withheld);
        let there = program.target.take().and_then(|_| Some((inputs.get(file)?.name.clone(), text?)));
        program.target_sha256 = there.as_ref().map(|(_, text)| sha256(text.as_bytes()));
        program.target = there.map(|(name, _)| name);
        let into = if is_withheld { &mut all.withheld } else { &mut all.written };
        if let Some(Some(certificate)) = into.get_mut(file) {
            all.places.insert(at, (file, is_withheld, certificate.programs.len()));
            certificate.programs.push(program);
        }
    }
    for certificate in all.written.iter_mut().chain(&mut all.withheld) {
        *certificate = certificate.take().filter(|certificate| !certificate.programs.is_empty());
        certificate.iter_mut().for_each(Certificate::sum_up);
    }
    all
}
