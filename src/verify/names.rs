//! The two sides, and what is called what on each.

use super::given::Given;
use crate::control::{Execute, Library, LoadedFile, ProgramRef};
use crate::dialect::{Control, VariableClass};
use crate::syntax::{Block, ProgramName};
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
    /// Of the target: the programs that those of the source became, where anybody asked.
    pub(super) became: OnceLock<BTreeSet<ProgramRef>>,
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
            became: OnceLock::new(),
        }
    }

    /// Its programs, in the order of files and places.
    pub fn programs(&self) -> Vec<ProgramRef> {
        let of = |file| {
            let all = (0..).map(move |program| ProgramRef { file, program });
            all.take_while(|program| self.library.sections.place(*program).is_some())
        };
        (0..self.files.len()).flat_map(of).collect()
    }

    /// The name of a program, as written; none for one without.
    pub fn name(&self, program: ProgramRef) -> Option<&ProgramName> {
        self.library.sections.all().get(self.library.sections.place(program)?)?.name.as_ref()
    }

    /// The program with this number.
    pub fn numbered(&self, number: u32) -> Option<ProgramRef> {
        self.library.sections.program(self.library.sections.numbered(number)?)
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
}

/// What a conversion named: registers and program numbers of the target, by their names on the source.
///
/// A variable that is not here has its own name on the target, if the target has that.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Names {
    /// Register numbers: `V12` to 512; `V(..)` to what is added to every number.
    pub variables: BTreeMap<String, u32>,
    /// Registers of the target that hold values in between and that nobody may rely on.
    pub scratch: BTreeSet<u32>,
    /// Program numbers, by `O1234` or the program's name.
    pub programs: BTreeMap<String, u32>,
}

/// The class of a variable by its whole name, `#100` or `VX`.
pub(super) fn class_of<'c>(control: &'c Control, variable: &str) -> Option<&'c VariableClass> {
    let digits = variable.find(|sign: char| sign.is_ascii_digit());
    match digits {
        Some(at) => {
            let (name, number) = variable.split_at_checked(at)?;
            control.variable_class(name, number.parse().ok()?)
        }
        None => {
            let letter = variable.chars().last()?;
            control.letter_class(variable.strip_suffix(letter)?, letter)
        }
    }
}

impl Names {
    /// The name on the target of a variable of the source; none where it has no place there.
    pub(super) fn variable(&self, name: &str, source: &Control, target: &Control) -> Option<String> {
        let prefix = target.classes().iter().find(|row| row.class != "letter")?.name.clone();
        if let Some(number) = self.variables.get(name) {
            return Some(format!("{prefix}{number}"));
        }
        let digits = name.find(|sign: char| sign.is_ascii_digit());
        if let Some((letter, number)) = digits.and_then(|at| name.split_at_checked(at))
            && let Some(base) = self.variables.get(&format!("{letter}(..)"))
            && let Ok(number) = number.parse::<u32>()
        {
            return Some(format!("{prefix}{}", base.checked_add(number)?));
        }
        let (from, to) = (class_of(source, name)?, class_of(target, name)?);
        let mut others = self.variables.values().chain(&self.scratch);
        let taken = others.any(|number| name == format!("{prefix}{number}"));
        ((from.class == "local") == (to.class == "local") && !taken).then(|| name.to_owned())
    }

    /// The variable of the source that a register of the target holds; none where it holds none.
    pub(super) fn of_source(&self, register: &str, source: &Control, target: &Control) -> Option<String> {
        let number = register.find(|sign: char| sign.is_ascii_digit()).and_then(|at| register.get(at..));
        let number: Option<u32> = number.and_then(|number| number.parse().ok());
        let mapped =
            self.variables.iter().filter(|(_, to)| Some(**to) == number).map(|(name, _)| name.clone());
        let banked = self.variables.iter().filter_map(|(name, base)| {
            Some(format!("{}{}", name.strip_suffix("(..)")?, number?.checked_sub(*base)?))
        });
        let mut all = mapped.chain(banked).chain([register.to_owned()]);
        all.find(|name| {
            class_of(source, name).is_some()
                && self.variable(name, source, target).as_deref() == Some(register)
        })
    }

    /// True for a register of the target that holds what the conversion named: an argument, or whether something is vacant.
    pub(super) fn is_named(&self, register: &str, target: &Control) -> bool {
        let is =
            |number: &u32| target.classes().iter().any(|row| register == format!("{}{number}", row.name));
        self.variables.values().any(is)
    }

    /// The program of the target that a program of the source became.
    pub(super) fn program(&self, source: &Side<'_>, of: ProgramRef, target: &Side<'_>) -> Option<ProgramRef> {
        // The file of the same name; of two single files the other one, whatever its name.
        let name = source.files.get(of.file)?.name;
        let same = target.files.iter().position(|file| file.name == name);
        let single = (source.files.len() == 1 && target.files.len() == 1).then_some(0);
        let file = same.or(single);
        let all = target.programs();
        let here = |program: &&ProgramRef| Some(program.file) == file;
        let Some(name) = source.name(of) else {
            // A program without a name is known by its file.
            let number = self.programs.get(name).map(|number| ProgramName::Number(*number));
            let is = |program: &&ProgramRef| target.name(**program) == number.as_ref();
            // Of several the one at the same place among them.
            let mut before = source.programs().into_iter().filter(|program| program.file == of.file);
            let nth = before
                .by_ref()
                .take_while(|program| *program != of)
                .filter(|p| source.name(*p).is_none())
                .count();
            let mut found = all.iter().filter(here);
            return found.clone().filter(is).nth(nth).or_else(|| found.nth(nth)).copied();
        };
        let wanted = match (self.programs.get(&name.to_string()), name) {
            (Some(number), _) | (None, ProgramName::Number(number)) => ProgramName::Number(*number),
            (None, name) => name.clone(),
        };
        let is = |program: &&ProgramRef| target.name(**program) == Some(&wanted);
        let found = all.iter().filter(here).find(is).or_else(|| all.iter().find(is)).copied();
        // A program whose number both sides leave out of the file is alone in it.
        let alone = || all.iter().filter(here).find(|program| target.name(**program).is_none()).copied();
        found.or_else(alone)
    }
}
