//! One side of a comparison: a library on its control, and what is known of all of it.

use super::edited_text::EditedText;
use super::entry_state::EntryState;
use super::hash::sha256;
use super::links::Links;
use super::numbers::Numbers;
use super::program_texts::ProgramTexts;
use super::stands::stands;
use crate::canon::Op;
use crate::control::outside::Outside;
use crate::control::{Execute, Library, LoadedFile, ProgramRef, Run, Scenario};
use crate::dialect::Control;
use crate::syntax::{Block, ProgramName};
use crate::text::LineIndex;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, OnceLock};

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
    pub(in crate::verify) given: OnceLock<BTreeMap<ProgramRef, EntryState>>,
    /// The programs that runs of other programs came through, where anybody asked.
    pub(in crate::verify) entered: OnceLock<BTreeSet<ProgramRef>>,
    /// How its programs stand to each other, where anybody asked.
    links: OnceLock<Arc<Links>>,
    /// Of the target: the programs that those of the source became, where anybody asked.
    pub(in crate::verify) became: OnceLock<Arc<BTreeSet<ProgramRef>>>,
    /// The numbers in its texts, where anybody asked.
    numbers: OnceLock<Numbers>,
    /// Of each file what reports say of it, where anybody asked.
    reported: Arc<Vec<Reported>>,
    /// The text of a program that was edited since, and its file.
    edited: Option<(usize, &'a EditedText)>,
}

impl<'a> Side<'a> {
    /// True if calls have variables of their own.
    pub fn has_locals(&self) -> bool {
        self.control.classes().iter().any(|row| row.class == "local")
    }

    /// True if programs can select the unit.
    pub fn selects_unit(&self) -> bool {
        self.control.code_for(Op::Inch, &BTreeMap::new()).is_some()
    }

    /// A library on a control.
    pub fn new(control: &'a Control, execute: Execute, files: &'a [LoadedFile<'a>]) -> Self {
        let reported = files.iter().map(|_| Reported::default()).collect();
        Self::over(control, execute, Library::new(files).bound_to(control), Arc::new(reported))
    }

    /// The same beside programs that stand in the machine.
    pub(super) fn with(self, outside: Outside) -> Self {
        Self { library: self.library.beside(outside), ..self }
    }

    fn over(
        control: &'a Control,
        execute: Execute,
        library: Library<'a>,
        reported: Arc<Vec<Reported>>,
    ) -> Self {
        Self {
            control,
            execute,
            files: library.files,
            library,
            given: OnceLock::new(),
            entered: OnceLock::new(),
            links: OnceLock::new(),
            became: OnceLock::new(),
            numbers: OnceLock::new(),
            reported,
            edited: None,
        }
    }

    /// Runs a program of a conversion: a stop that stands for an alarm is read as one.
    pub(in crate::verify) fn run(&self, program: ProgramRef, scenario: &Scenario) -> Run {
        stands(self.control, (self.execute)(&self.library, program, self.control, scenario))
    }

    /// The same side with another text of one program. How the programs stand to each other is worked out anew only where
    /// that text makes it another. None where it is no such program any more.
    pub(in crate::verify) fn edited<'e>(
        &'e self,
        program: ProgramRef,
        text: &'e EditedText,
        blocks: &'e [Block],
    ) -> Option<Side<'e>> {
        let library = self.library.edited(program, blocks, &text.bytes)?;
        let mut side = Side::over(self.control, self.execute, library, Arc::clone(&self.reported));
        side.edited = Some((program.file, text));
        if self.links().hold_in((&self.texts(), &side.texts()), program) {
            let _ = side.links.set(Arc::clone(self.all_links()));
        }
        Some(side)
    }

    /// Of an edited target: the programs that those of the source became are the same if both sides stand as before.
    pub(in crate::verify) fn take_over(&self, before: &Side<'_>, source_stands: bool) {
        if let Some(became) = before.became.get().filter(|_| source_stands && self.stands_as(before)) {
            let _ = self.became.set(Arc::clone(became));
        }
    }

    /// True for an edited side whose programs stand to each other as before.
    pub(in crate::verify) fn stands_as(&self, before: &Side<'_>) -> bool {
        match (self.links.get(), before.links.get()) {
            (Some(now), Some(before)) => Arc::ptr_eq(now, before),
            _ => false,
        }
    }

    /// Its programs, in the order of files and places.
    pub fn programs(&self) -> &[ProgramRef] {
        self.links().programs()
    }

    /// A program and all that its text calls by their numbers, however far down.
    pub fn reached(&self, program: ProgramRef) -> Vec<ProgramRef> {
        self.links().called_from(program, |_| true)
    }

    /// How its programs stand to each other.
    pub(in crate::verify) fn links(&self) -> &Links {
        self.all_links()
    }

    fn all_links(&self) -> &Arc<Links> {
        self.links.get_or_init(|| Arc::new(Links::new(&self.texts())))
    }

    /// The numbers that stand in its texts.
    pub(in crate::verify) fn numbers(&self) -> &Numbers {
        self.numbers.get_or_init(|| Numbers::of(self.control, self.files))
    }

    /// The texts of its programs.
    pub(in crate::verify) fn texts(&self) -> ProgramTexts<'_> {
        ProgramTexts { control: self.control, library: &self.library }
    }

    /// The name of a program, as written; none for one without.
    pub fn name(&self, program: ProgramRef) -> Option<&ProgramName> {
        self.texts().name(program)
    }

    /// The program with this number.
    pub fn numbered(&self, number: u32) -> Option<ProgramRef> {
        self.texts().numbered(number)
    }

    /// The program with this name.
    pub(in crate::verify) fn called(&self, name: &ProgramName) -> Option<ProgramRef> {
        self.library.sections.program(self.library.sections.named(name)?)
    }

    /// True for a program that is there.
    pub(in crate::verify) fn has(&self, program: ProgramRef) -> bool {
        self.texts().has(program)
    }

    /// The blocks of a program.
    pub fn text(&self, program: ProgramRef) -> &[Block] {
        self.texts().text(program)
    }

    /// The blocks of a program, as a range of its file's.
    pub fn blocks(&self, program: ProgramRef) -> std::ops::Range<usize> {
        self.texts().blocks(program)
    }

    /// The line and column of a place in a file; the first ones where there is no such file.
    pub(in crate::verify) fn line_of(&self, file: usize, place: u32) -> (u32, u32) {
        let (Some(reported), Some(loaded)) = (self.reported.get(file), self.files.get(file)) else {
            return (1, 1);
        };
        let edited = self.edited.filter(|(edited, _)| *edited == file);
        let place = edited.map_or(place, |(_, text)| text.before(place));
        reported.lines.get_or_init(|| LineIndex::new(loaded.parsed.source)).place(place)
    }

    /// The bytes of a file, with those of an edited program after them; none if there is no such file.
    pub(in crate::verify) fn source(&self, file: usize) -> Option<&[u8]> {
        let edited = self.edited.filter(|(edited, _)| *edited == file).map(|(_, text)| text.bytes.as_slice());
        edited.or_else(|| self.files.get(file).map(|file| file.parsed.source))
    }

    /// The hash of a file's bytes; empty where there is no such file.
    pub(in crate::verify) fn sha256(&self, file: usize) -> &str {
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
