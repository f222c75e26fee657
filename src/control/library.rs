//! The programs of several files, as calls find them.

use super::by_need::{ByNeed, Stretch};
use super::kept::{EditedShelf, Shelf};
use super::machine::Rules;
use super::outside::Outside;
use super::trace::{Event, Program};
use crate::dialect::Control;
use crate::syntax::{Block, ItemKind, ParsedFile, Parser, ProgramName};
use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;
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
    pub sections: Arc<Sections>,
    /// Who is told of a run's events while it goes on; else its [`super::Run`] has them all.
    pub listener: Option<&'f SyncSender<Heard>>,
    /// How blocks are read where a run comes to them; none where the files have them.
    by_need: Option<Arc<ByNeed>>,
    bound: Option<Arc<Bound<'f>>>,
    edited: Option<Edited<'f>>,
    /// The programs that stand in the machine and are no part of it.
    pub outside: Arc<Outside>,
}

/// A program whose text was edited: its place, its blocks, and the bytes that these are read from.
#[derive(Clone, Debug)]
struct Edited<'f> {
    place: usize,
    blocks: &'f [Block],
    source: &'f [u8],
    shelf: EditedShelf,
}

/// The control that runs the programs, and what is kept for it from run to run.
#[derive(Debug)]
struct Bound<'f> {
    control: &'f Control,
    rules: Arc<Rules>,
    shelf: Shelf,
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
        let sections = Arc::new(Sections::new(files));
        Self {
            files,
            sections,
            listener: None,
            by_need: None,
            bound: None,
            edited: None,
            outside: Arc::default(),
        }
    }

    /// The same of files whose blocks are not held, but read `size` bytes at a time where a run comes to them. Only an
    /// interpreter that prepares programs can run them.
    pub fn read_by_need(files: &'f [LoadedFile<'f>], parser: Parser, size: usize) -> Self {
        let (by_need, sections) = ByNeed::new(files, parser, size);
        let (sections, by_need) = (Arc::new(sections), Some(Arc::new(by_need)));
        Self { files, sections, listener: None, by_need, bound: None, edited: None, outside: Arc::default() }
    }

    /// The stretches in which the blocks of the program at a place are read.
    pub(super) fn stretches(&self, place: usize) -> Vec<Stretch> {
        let section = self.sections.all().get(place);
        match (&self.by_need, section) {
            (Some(by_need), Some(section)) => by_need.stretches(section),
            _ => vec![Stretch::held(self.blocks(place).len())],
        }
    }

    /// Calls somebody with the blocks of such a stretch.
    pub(super) fn with_stretch<T>(
        &self,
        place: usize,
        stretch: &Stretch,
        take: impl FnOnce(&[Block]) -> T,
    ) -> T {
        match &self.by_need {
            Some(by_need) => by_need.with_stretch(self.source(place), stretch, take),
            None => take(self.blocks(place)),
        }
    }

    /// The same, to be run on one control again and again: what its interpreter makes of programs is kept.
    pub fn bound_to(self, control: &'f Control) -> Self {
        let bound = Bound { control, rules: Arc::new(Rules::new(control)), shelf: Shelf::default() };
        Self { bound: Some(Arc::new(bound)), ..self }
    }

    /// The same beside programs that stand in the machine.
    pub fn beside(self, outside: Outside) -> Self {
        Self { outside: Arc::new(outside), ..self }
    }

    fn bound(&self, control: &Control) -> Option<&Bound<'f>> {
        self.bound.as_deref().filter(|bound| std::ptr::eq(bound.control, control))
    }

    /// What is kept for a control, where the library is bound to it.
    pub(super) fn shelf(&self, control: &Control) -> Option<&Shelf> {
        self.bound(control).map(|bound| &bound.shelf)
    }

    /// The same of the program that was edited, and its place.
    pub(super) fn edited_shelf(&self) -> Option<(usize, &EditedShelf)> {
        self.edited.as_ref().map(|edited| (edited.place, &edited.shelf))
    }

    /// The facts that the machine of a control acts by.
    pub(super) fn rules(&self, control: &Control) -> Arc<Rules> {
        let kept = self.bound(control).map(|bound| Arc::clone(&bound.rules));
        kept.unwrap_or_else(|| Arc::new(Rules::new(control)))
    }

    /// The same with other blocks in one program, read from these bytes. None where they are no such program any more.
    pub fn edited<'e>(
        &'e self,
        program: ProgramRef,
        blocks: &'e [Block],
        source: &'e [u8],
    ) -> Option<Library<'e>> {
        let place = self.sections.place(program)?;
        let (before, mut cuts) = (self.sections.all.get(place)?, Vec::new());
        cut(before.file, blocks, &mut cuts);
        let [Section { name, blocks: range, .. }] = cuts.as_slice() else { return None };
        let same = (name, range.start, range.end) == (&before.name, 0, before.blocks.len());
        let edited = Edited { place, blocks, source, shelf: EditedShelf::default() };
        same.then(|| Library { edited: Some(edited), ..self.clone() })
    }

    /// The blocks of the program at a place.
    pub fn blocks(&self, place: usize) -> &'f [Block] {
        if let Some(edited) = self.edited.as_ref().filter(|edited| edited.place == place) {
            return edited.blocks;
        }
        let found = self.sections.all().get(place);
        let blocks =
            found.and_then(|section| self.files.get(section.file)?.parsed.blocks.get(section.blocks.clone()));
        blocks.unwrap_or_default()
    }

    /// The bytes that they are read from.
    pub fn source(&self, place: usize) -> &'f [u8] {
        if let Some(edited) = self.edited.as_ref().filter(|edited| edited.place == place) {
            return edited.source;
        }
        let file = self.sections.all().get(place).and_then(|section| self.files.get(section.file));
        file.map_or(&[], |file| file.parsed.source)
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

/// The number of the cycle that a file holds: 20 for `cycle20-auto-offset.nc`, `zyk20.nc`, `Zyklus 20.nc` and `g820.nc`.
pub(super) fn cycle_number(file: &str) -> Option<u32> {
    let name = file.rsplit(['/', '\\']).next()?.to_ascii_lowercase();
    let at = name.find(|sign: char| sign.is_ascii_digit())?;
    let (word, rest) = name.split_at_checked(at)?;
    let end = rest.find(|sign: char| !sign.is_ascii_digit()).unwrap_or(rest.len());
    let (digits, rest) = rest.split_at_checked(end)?;
    let letter_follows = rest.starts_with(char::is_alphanumeric);
    match word.trim_end_matches([' ', '_', '-']) {
        "cycle" => digits.parse().ok(),
        "zyklus" | "zyk" | "cyc" if !letter_follows => digits.parse().ok(),
        // By its code.
        "g" if word == "g" && !letter_follows && digits.len() == 3 => digits.strip_prefix('8')?.parse().ok(),
        _ => None,
    }
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
        let files = library.len();
        Self::by(files, |file, out| {
            let blocks = library.get(file).map(|loaded| loaded.parsed.blocks.as_slice());
            cut(file, blocks.unwrap_or_default(), out);
        })
    }

    /// Those of files that are read by `read`, which is called for each.
    pub(super) fn by(files: usize, mut read: impl FnMut(usize, &mut Vec<Section>)) -> Self {
        let mut sections = Sections::default();
        for file in 0..files {
            let first = sections.all.len();
            read(file, &mut sections.all);
            sections.end_file(first);
        }
        sections
    }

    /// Notes the programs of a file, which are those from `first` on.
    fn end_file(&mut self, first: usize) {
        for (at, section) in self.all.iter().enumerate().skip(first) {
            if let Some(name) = &section.name {
                self.names.entry(name.clone()).or_insert(at);
            }
        }
        self.files.push(first..self.all.len());
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
    let mut cutter = Cutter { file, at: 0, open: None };
    cutter.cut(blocks, out);
    cutter.end(out);
}

/// Cuts a file into programs, some blocks after the others.
pub(super) struct Cutter {
    pub file: usize,
    /// How many blocks were seen.
    pub at: usize,
    pub open: Option<Section>,
}

impl Cutter {
    /// Takes the next blocks.
    pub fn cut(&mut self, blocks: &[Block], out: &mut Vec<Section>) {
        for block in blocks {
            self.take(block, out);
            self.at += 1;
        }
    }

    /// After the last block.
    pub fn end(self, out: &mut Vec<Section>) {
        out.extend(self.open);
    }

    fn take(&mut self, block: &Block, out: &mut Vec<Section>) {
        let (file, at) = (self.file, self.at);
        let name = block.items.iter().find_map(|item| match &item.kind {
            ItemKind::Program(name) => Some(name.clone()),
            _ => None,
        });
        let tape = block.items.iter().any(|item| item.kind == ItemKind::Tape);
        if name.is_some() || tape {
            out.extend(self.open.take());
        }
        let code = block
            .items
            .iter()
            .any(|item| !matches!(item.kind, ItemKind::Comment(_) | ItemKind::EndOfBlock | ItemKind::Tape));
        match &mut self.open {
            Some(section) => section.blocks.end = at + 1,
            None if code => self.open = Some(Section { file, name, blocks: at..at + 1 }),
            None => {}
        }
    }
}
