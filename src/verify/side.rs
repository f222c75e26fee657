//! One side of a comparison: a library on its control, and what is known of all of it.

use super::certificate::sha256;
use super::given::Given;
use super::links::Links;
use crate::control::{Execute, Library, LoadedFile, ProgramRef};
use crate::dialect::Control;
use crate::syntax::{Block, ProgramName};
use crate::text::LineIndex;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::OnceLock;

/// One side of a comparison: a library and the control that runs it.
pub struct Side<'a> {
    /// The control.
    pub control: &'a Control,
    /// Its interpreter.
    pub execute: Execute,
    /// The files.
    pub files: &'a [LoadedFile<'a>],
    /// Their programs.
    pub library: Library<'a>,
    /// What callers give its programs, where anybody asked.
    pub(super) given: OnceLock<BTreeMap<ProgramRef, Given>>,
    /// The programs that runs of other programs came through, where anybody asked.
    pub(super) entered: OnceLock<BTreeSet<ProgramRef>>,
    /// How its programs stand to each other, where anybody asked.
    links: OnceLock<Links>,
    /// Of the target: the programs that those of the source became, where anybody asked.
    pub(super) became: OnceLock<BTreeSet<ProgramRef>>,
    /// Of each file what reports say of it, where anybody asked.
    reported: Vec<Reported>,
}

impl<'a> Side<'a> {
    /// A library on a control.
    pub fn new(control: &'a Control, execute: Execute, files: &'a [LoadedFile<'a>]) -> Self {
        Self {
            control,
            execute,
            files,
            library: Library::new(files),
            given: OnceLock::new(),
            entered: OnceLock::new(),
            links: OnceLock::new(),
            became: OnceLock::new(),
            reported: files.iter().map(|_| Reported::default()).collect(),
        }
    }

    /// Its programs, in the order of files and places.
    pub fn programs(&self) -> &[ProgramRef] {
        self.links().programs()
    }

    /// How its programs stand to each other.
    pub(super) fn links(&self) -> &Links {
        self.links.get_or_init(|| Links::new(self))
    }

    /// The name of a program, as written; none for one without.
    pub fn name(&self, program: ProgramRef) -> Option<&ProgramName> {
        self.library.sections.all().get(self.library.sections.place(program)?)?.name.as_ref()
    }

    /// The program with this number.
    pub fn numbered(&self, number: u32) -> Option<ProgramRef> {
        self.library.sections.program(self.library.sections.numbered(number)?)
    }

    /// The program with this name.
    pub(super) fn called(&self, name: &ProgramName) -> Option<ProgramRef> {
        self.library.sections.program(self.library.sections.named(name)?)
    }

    /// True for a program that is there.
    pub(super) fn has(&self, program: ProgramRef) -> bool {
        self.library.sections.place(program).is_some()
    }

    /// The blocks of a program.
    pub fn text(&self, program: ProgramRef) -> &[Block] {
        let file = self.files.get(program.file);
        file.and_then(|file| file.parsed.blocks.get(self.blocks(program))).unwrap_or_default()
    }

    /// The blocks of a program, as a range of its file's.
    pub fn blocks(&self, program: ProgramRef) -> std::ops::Range<usize> {
        let section = self.library.sections.place(program).and_then(|at| self.library.sections.all().get(at));
        section.map_or(0..0, |section| section.blocks.clone())
    }

    /// The line and column of a place in a file; the first ones where there is no such file.
    pub(super) fn line_of(&self, file: usize, place: u32) -> (u32, u32) {
        let (Some(reported), Some(loaded)) = (self.reported.get(file), self.files.get(file)) else {
            return (1, 1);
        };
        reported.lines.get_or_init(|| LineIndex::new(loaded.parsed.source)).place(place)
    }

    /// The hash of a file's bytes; empty where there is no such file.
    pub(super) fn sha256(&self, file: usize) -> &str {
        let hash = || self.files.get(file).map_or_else(String::new, |file| sha256(file.parsed.source));
        self.reported.get(file).map_or("", |reported| reported.sha256.get_or_init(hash))
    }
}

/// What reports say of a file.
#[derive(Debug, Default)]
struct Reported {
    lines: OnceLock<LineIndex>,
    sha256: OnceLock<String>,
}
