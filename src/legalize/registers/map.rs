//! The register map.

use crate::ir::analysis::Numbers;
use crate::ir::{Class, Var};
use std::collections::{BTreeMap, BTreeSet};

/// A register of the target: its name before the number, and its number.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Register {
    /// Its name before the number.
    pub name: String,
    /// Its number.
    pub number: u32,
}

/// The map, and what the lock is to remember of it.
#[derive(Clone, Debug, Default)]
pub struct Registers {
    /// The register of each variable.
    pub of: BTreeMap<Var, Register>,
    /// What was chosen, by the variable's name on the source.
    pub chosen: BTreeMap<String, u32>,
    /// The registers of what calls give to programs of the library, by name (`#1 of O9010`), on a target without locals.
    pub arguments: BTreeMap<String, u32>,
    /// Those of them that every call gives a value.
    pub always: BTreeSet<String>,
    /// The registers of temporaries.
    pub scratch: BTreeSet<u32>,
    /// Those of classes that words alone take, by name.
    pub of_words: BTreeSet<String>,
    /// Those of them whose values outlive calls.
    pub over_calls: BTreeSet<u32>,
    /// Variables that lose the register of an earlier run, by name.
    pub freed: BTreeSet<String>,
    /// Numbers that programs reach by computing them, or may.
    pub reached: Numbers,
    /// The registers in which programs that stand in the machine put their results, as its profile says.
    pub results: BTreeSet<u32>,
    /// True if a variable of the source may have its own name on the target.
    pub alike: bool,
    /// The names on the source of variables that have another number now.
    pub names: BTreeMap<Var, String>,
}

impl Registers {
    /// The registers that hold something else than the variable of their number.
    pub fn taken(&self) -> impl Iterator<Item = u32> + '_ {
        self.of
            .iter()
            .filter(|(var, register)| !self.is_known(var, register))
            .map(|(_, register)| register.number)
    }

    /// The same in words, as the target names them: `V1-V3, R5`.
    pub fn taken_in_words(&self) -> String {
        let mut by_name: BTreeMap<&str, Vec<(u32, u32)>> = BTreeMap::new();
        for (_, register) in self.of.iter().filter(|(var, register)| !self.is_known(var, register)) {
            by_name.entry(&register.name).or_default().push((register.number, register.number));
        }
        let words = by_name.into_iter().map(|(name, runs)| Numbers::of(runs).in_words(name));
        words.collect::<Vec<_>>().join(", ")
    }

    /// The registers that hold the variable of their number, locals aside.
    pub fn own(&self) -> impl Iterator<Item = u32> + '_ {
        let own =
            self.of.iter().filter(|(var, register)| self.is_own(var, register) && var.class != Class::Local);
        own.map(|(_, register)| register.number)
    }

    /// The registers of variables that a program of the source has.
    pub fn held(&self) -> impl Iterator<Item = u32> + '_ {
        let named = self.of.iter().filter(|(var, _)| !matches!(var.class, Class::Temp | Class::Static));
        named.map(|(_, register)| register.number)
    }

    /// True where nobody need be told that a variable is there: it has its own name, or is a result.
    pub(super) fn is_known(&self, var: &Var, register: &Register) -> bool {
        self.is_own(var, register) || self.results.contains(&register.number)
    }

    /// True where a variable is in the register of its own name.
    pub(super) fn is_own(&self, var: &Var, register: &Register) -> bool {
        self.alike && var.class.nullable() && var.number == register.number
    }
}
