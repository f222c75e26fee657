//! What is called what on the two sides.

use super::names::{class_of, numbered};
use super::side::Side;
use crate::control::ProgramRef;
use crate::dialect::{Control, Question};
use crate::syntax::ProgramName;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Bound;

/// What a conversion named: registers and program numbers of the target, by their names on the source.
///
/// A variable that is not here has its own name on the target, if the target has that.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SymbolMap {
    /// Register numbers: `V12` to 512; `V(..)` to what is added to every number.
    pub variables: BTreeMap<String, u32>,
    /// Registers that callers set on a target whose calls give no arguments, by the argument and its program: `#1 of O9010`.
    pub arguments: BTreeMap<String, u32>,
    /// Those of them that every call gives a value.
    pub always: BTreeSet<String>,
    /// Registers of the target that hold values in between and that nobody may rely on.
    pub scratch: BTreeSet<u32>,
    /// Those of classes that words alone take, by name.
    pub of_words: BTreeSet<String>,
    /// Program numbers, by `O1234` or the program's name.
    pub programs: BTreeMap<String, u32>,
}

impl SymbolMap {
    /// The name on the target of a variable of the source; none if it has no place there.
    pub(in crate::verify) fn variable(
        &self,
        name: &str,
        source: &Control,
        target: &Control,
    ) -> Option<String> {
        let prefix = &target.classes().iter().find(|row| row.class != "letter")?.name;
        if let Some(number) = self.variables.get(name) {
            return Some(format!("{prefix}{number}"));
        }
        let digits = name.find(|sign: char| sign.is_ascii_digit());
        if let Some((letter, number)) = digits.and_then(|at| name.split_at_checked(at))
            && let Some(base) = self.base(letter)
            && let Ok(number) = number.parse::<u32>()
        {
            return Some(format!("{prefix}{}", base.checked_add(number)?));
        }
        // Where nothing is vacant, numbers are not kept from another control.
        if !target.is(Question::Vacancy) && source.name() != target.name() {
            return None;
        }
        let (from, to) = (class_of(source, name)?, class_of(target, name)?);
        let taken =
            || numbered(name, prefix).is_some_and(|own| self.holds(own) || self.scratch.contains(&own));
        ((from.class == "local") == (to.class == "local") && !taken()).then(|| name.to_owned())
    }

    /// What is added to every number of a letter's variables, where computed numbers may reach all of them.
    fn base(&self, letter: &str) -> Option<u32> {
        // A bracket comes before every digit.
        let mut from = self.variables.range::<str, _>((Bound::Included(letter), Bound::Unbounded));
        let is_all = |name: &str| name.strip_prefix(letter) == Some("(..)");
        from.find(|(name, _)| name.as_str() != letter).filter(|(name, _)| is_all(name)).map(|(_, base)| *base)
    }

    /// The variable of the source that a register of the target holds; none if it holds none.
    pub(in crate::verify) fn of_source(
        &self,
        register: &str,
        source: &Control,
        target: &Control,
    ) -> Option<String> {
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

    /// The variables of the source that these registers of the target hold, as the conversion named them one by one.
    pub(in crate::verify) fn holding<'n, 'r>(
        &'n self,
        registers: impl Iterator<Item = &'r String>,
        target: &Control,
    ) -> impl Iterator<Item = &'n str> {
        let prefix = target.classes().iter().find(|row| row.class != "letter").map_or("", |row| &row.name);
        let numbers: BTreeSet<u32> = registers.filter_map(|name| numbered(name, prefix)).collect();
        let held = self.variables.iter().filter(move |(_, number)| numbers.contains(number));
        held.map(|(name, _)| name.as_str())
    }

    /// True for a register of the target that holds what the conversion named: an argument, or whether something is vacant.
    pub(in crate::verify) fn is_named(&self, register: &str, target: &Control) -> bool {
        let mut numbers = target.classes().iter().filter_map(|row| numbered(register, &row.name));
        numbers.any(|own| self.holds(own))
    }

    /// True for the number of a register that holds a variable of the source.
    fn holds(&self, register: u32) -> bool {
        self.variables.values().any(|number| *number == register)
    }

    /// The same for who is no part of the verifier.
    pub fn counterpart(&self, source: &Side<'_>, of: ProgramRef, target: &Side<'_>) -> Option<ProgramRef> {
        self.program(source, of, target)
    }

    /// The program of the target that a program of the source became.
    pub(in crate::verify) fn program(
        &self,
        source: &Side<'_>,
        of: ProgramRef,
        target: &Side<'_>,
    ) -> Option<ProgramRef> {
        // The file of the same name; of two single files the other one, whatever its name.
        let name = source.files.get(of.file)?.name;
        let single = (source.files.len() == 1 && target.files.len() == 1).then_some(0);
        let file = target.links().file(name).or(single);
        let here = |name: Option<&ProgramName>| file.map_or(&[][..], |file| target.links().named(file, name));
        let Some(word) = source.name(of) else {
            // A program without a name is known by its file; of several the one at the same place among them.
            let number = self.programs.get(name).map(|number| ProgramName::Number(*number));
            let nth = source.links().named(of.file, None).iter().position(|program| *program == of)?;
            let at_its_place = || Some(ProgramRef { file: file?, program: nth }).filter(|p| target.has(*p));
            return here(number.as_ref()).get(nth).copied().or_else(at_its_place);
        };
        let wanted = match (self.programs.get(&word.to_string()), word) {
            (Some(number), _) | (None, ProgramName::Number(number)) => ProgramName::Number(*number),
            (None, name) => name.clone(),
        };
        // Of several of one number in a file the one at the same place among them.
        let alike = source.links().named(of.file, Some(word));
        let nth = alike.iter().position(|program| *program == of).unwrap_or(0);
        let theirs = here(Some(&wanted));
        let found = theirs.get(nth).or(theirs.first()).copied().or_else(|| target.called(&wanted));
        // A program whose number the target leaves out of the file is alone in it: the first one of the source's file.
        found.or_else(|| here(None).first().copied().filter(|_| of.program == 0))
    }
}
