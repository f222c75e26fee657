//! What things are called on the target: registers, programs, sequence numbers.

use crate::ir::Var;
use crate::syntax::ProgramName;
use foldhash::HashMap;
use std::collections::BTreeSet;

/// A variable of the target.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Register {
    /// Its name before the number or letter: `#`, `V`, `R`.
    pub name: Box<str>,
    /// Which of them.
    pub index: Index,
    /// The name that people know it by, where it has one.
    pub label: Option<String>,
}

/// Which variable of a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Index {
    /// `V30`.
    Number(u32),
    /// `VA`.
    Letter(char),
}

impl Register {
    /// A numbered variable without a name of its own.
    pub fn number(name: &str, number: u32) -> Self {
        Self { name: name.into(), index: Index::Number(number), label: None }
    }

    /// A letter variable without a name of its own.
    pub fn letter(name: &str, letter: char) -> Self {
        Self { name: name.into(), index: Index::Letter(letter), label: None }
    }
}

/// The names of a library on the target. Variables and programs mean the same
/// in all of its programs, so one `Naming` serves them all.
#[derive(Clone, Debug, Default)]
pub struct Naming {
    variables: HashMap<Var, Register>,
    programs: HashMap<ProgramName, u32>,
    returned_to: BTreeSet<u32>,
    returned_anywhere: bool,
}

impl Naming {
    /// A naming that knows nothing yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Gives a variable its register.
    pub fn set_variable(&mut self, var: Var, register: Register) {
        self.variables.insert(var, register);
    }

    /// The register of a variable.
    pub fn variable(&self, var: Var) -> Option<&Register> {
        self.variables.get(&var)
    }

    /// Gives a program its number.
    pub fn set_program(&mut self, name: ProgramName, number: u32) {
        self.programs.insert(name, number);
    }

    /// The number of a program; one that is named by a number keeps it unless told otherwise.
    pub fn program(&self, name: &ProgramName) -> Option<u32> {
        match (self.programs.get(name), name) {
            (Some(number), _) => Some(*number),
            (None, ProgramName::Number(number)) => Some(*number),
            (None, ProgramName::Name(_)) => None,
        }
    }

    /// Notes that some program of the library returns to this sequence number of its
    /// caller: every block that has it must keep it.
    pub fn keep_sequence(&mut self, number: u32) {
        self.returned_to.insert(number);
    }

    /// Notes that some program returns to a computed sequence number: every block keeps its own.
    pub fn keep_every_sequence(&mut self) {
        self.returned_anywhere = true;
    }

    /// True where a program of the library returns, or may return, to this sequence number.
    pub fn is_returned_to(&self, number: u32) -> bool {
        self.returned_anywhere || self.returned_to.contains(&number)
    }
}
