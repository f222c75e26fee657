//! The programs of several files, as calls find them.

use super::trace::{Event, Program};
use crate::syntax::{Block, ItemKind, ParsedFile, ProgramName};
use std::collections::HashMap;
use std::ops::Range;
use std::sync::mpsc::SyncSender;

/// A file that was read.
#[derive(Clone, Copy, Debug)]
pub struct LoadedFile<'f> {
    /// Its name, for reports.
    pub name: &'f str,
    /// Its blocks.
    pub parsed: &'f ParsedFile<'f>,
}

/// Files that call each other, and the programs in them.
#[derive(Clone, Debug)]
pub struct Library<'f> {
    /// The files.
    pub files: &'f [LoadedFile<'f>],
    /// Their programs.
    pub sections: Sections,
    /// Who is told of a run's events while it goes on; else its [`super::Run`] has them all.
    pub listener: Option<&'f SyncSender<Heard>>,
}

/// Events of a run that goes on, in their order; the run keeps them no longer.
#[derive(Clone, Debug)]
pub struct Heard {
    /// What happened since this was told last.
    pub events: Vec<Event>,
    /// The programs that ran for the first time since then.
    pub programs: Vec<Program>,
}

impl<'f> Library<'f> {
    /// Finds the programs of files.
    pub fn new(files: &'f [LoadedFile<'f>]) -> Self {
        Self { files, sections: Sections::new(files), listener: None }
    }

    /// The same, with somebody who is told of events while a program runs. One who is gone is no fault.
    pub fn heard_by(self, listener: &'f SyncSender<Heard>) -> Self {
        Self { listener: Some(listener), ..self }
    }

    /// The cycle with this number, which is a file's first program.
    pub fn cycle(&self, number: u32) -> Option<ProgramRef> {
        let file = self.files.iter().position(|file| cycle_number(file.name) == Some(number))?;
        Some(ProgramRef { file, program: 0 })
    }
}

/// The number of the cycle that a file holds: 20 for `cycle20-auto-offset.nc`.
pub(super) fn cycle_number(file: &str) -> Option<u32> {
    let name = file.rsplit(['/', '\\']).next()?.to_ascii_lowercase();
    let rest = name.strip_prefix("cycle")?;
    let end = rest.find(|sign: char| !sign.is_ascii_digit()).unwrap_or(rest.len());
    rest.get(..end)?.parse().ok()
}

/// A program of a library.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ProgramRef {
    /// The file, counted from 0.
    pub file: usize,
    /// The program in the file, counted from 0.
    pub program: usize,
}

impl ProgramRef {
    /// The first program of the first file.
    pub const FIRST: ProgramRef = ProgramRef { file: 0, program: 0 };
}

/// A program's blocks.
#[derive(Clone, Debug)]
pub struct Section {
    /// The file that holds it.
    pub file: usize,
    /// Its name; none for blocks that no program word precedes.
    pub name: Option<ProgramName>,
    /// Its blocks in [`ParsedFile::blocks`], its program word included.
    pub blocks: Range<usize>,
}

/// Where each program of a library stands.
#[derive(Clone, Debug, Default)]
pub struct Sections {
    all: Vec<Section>,
    files: Vec<Range<usize>>,
    names: HashMap<ProgramName, usize>,
}

impl Sections {
    /// Cuts the files at their program words and at `%`. Blocks without any code (comments,
    /// empty lines) before the first program word belong to no program; a file without a
    /// program word is one program. Of two programs with one name the first counts.
    pub fn new(library: &[LoadedFile<'_>]) -> Self {
        let mut sections = Sections::default();
        for (file, loaded) in library.iter().enumerate() {
            let first = sections.all.len();
            cut(file, &loaded.parsed.blocks, &mut sections.all);
            for (at, section) in sections.all.iter().enumerate().skip(first) {
                if let Some(name) = &section.name {
                    sections.names.entry(name.clone()).or_insert(at);
                }
            }
            sections.files.push(first..sections.all.len());
        }
        sections
    }

    /// All programs; what finds one gives its place in here.
    pub fn all(&self) -> &[Section] {
        &self.all
    }

    /// The program at a place.
    pub fn program(&self, place: usize) -> Option<ProgramRef> {
        let file = self.all.get(place)?.file;
        Some(ProgramRef { file, program: place.checked_sub(self.files.get(file)?.start)? })
    }

    /// The place of a program.
    pub fn place(&self, program: ProgramRef) -> Option<usize> {
        let range = self.files.get(program.file)?;
        range.clone().nth(program.program)
    }

    /// The program with this number.
    pub fn numbered(&self, number: u32) -> Option<usize> {
        self.names.get(&ProgramName::Number(number)).copied()
    }

    /// The program with this name.
    pub fn named(&self, name: &ProgramName) -> Option<usize> {
        self.names.get(name).copied()
    }
}

fn cut(file: usize, blocks: &[Block], out: &mut Vec<Section>) {
    let mut open: Option<Section> = None;
    for (at, block) in blocks.iter().enumerate() {
        let name = block.items.iter().find_map(|item| match &item.kind {
            ItemKind::Program(name) => Some(name.clone()),
            _ => None,
        });
        let tape = block.items.iter().any(|item| item.kind == ItemKind::Tape);
        if name.is_some() || tape {
            out.extend(open.take());
        }
        let code = block
            .items
            .iter()
            .any(|item| !matches!(item.kind, ItemKind::Comment(_) | ItemKind::EndOfBlock | ItemKind::Tape));
        match &mut open {
            Some(section) => section.blocks.end = at + 1,
            None if code => open = Some(Section { file, name, blocks: at..at + 1 }),
            None => {}
        }
    }
    out.extend(open);
}
