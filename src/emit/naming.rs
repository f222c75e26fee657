//! What things are called on the target: registers, programs, sequence numbers.

use crate::ir::analysis::{Numbers, Summaries};
use crate::ir::{Block, Program, Var};
use crate::syntax::{Label, ProgramName};
use foldhash::HashMap;

/// Sequence numbers that lie above all others start at a multiple of this.
const ROUND: u32 = 1000;

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
    returned_to: Numbers,
    summaries: Option<Summaries>,
    last_sequence: u32,
    guard: Option<u32>,
    marks: Vec<String>,
    /// True where a program without a name goes on with what stands before it.
    continues: bool,
}

impl Naming {
    /// A naming that knows nothing yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Gives the programs of each file the line that says what they were made of.
    pub fn set_marks(&mut self, marks: &[String], continues: bool) {
        (self.marks, self.continues) = (marks.to_vec(), continues);
    }

    /// The line that says what a program was made of, if it gets one.
    pub fn mark(&self, program: &Program) -> Option<&str> {
        let has_head = program.name.is_some() || !self.continues;
        self.marks.get(program.file).filter(|_| has_head).map(String::as_str)
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

    /// Notes that some program of the library returns to one of these sequence numbers of its
    /// caller: every block that has one must keep it.
    pub fn keep_sequences(&mut self, numbers: &Numbers) {
        self.returned_to.join(numbers);
    }

    /// True where a program of the library returns, or may return, to this sequence number.
    pub fn is_returned_to(&self, number: u32) -> bool {
        self.returned_to.contains(number)
    }

    /// The sequence numbers that programs of the library return to, or may return to.
    pub fn returned_to(&self) -> &Numbers {
        &self.returned_to
    }

    /// Lets writers ask which numbers computed jumps look for; `last_sequence` is the largest that the library has.
    pub fn set_summaries(&mut self, summaries: Summaries, last_sequence: u32) {
        (self.summaries, self.last_sequence) = (Some(summaries), last_sequence);
    }

    /// What the programs of the library write, where that is known.
    pub fn summaries(&self) -> Option<&Summaries> {
        self.summaries.as_ref()
    }

    /// Where sequence numbers that are invented start, if nothing bounds what the library's programs return to;
    /// `most` is the largest number.
    pub fn returns_floor(&self, most: u32) -> Option<u32> {
        self.returned_to.last().filter(|last| *last >= most).map(|_| above(self.last_sequence))
    }

    /// Notes that returns to a computed number stop with an alarm from this number on: a caller may have invented
    /// ones there.
    pub fn set_guard(&mut self, floor: u32) {
        self.guard = Some(floor);
    }

    /// The number from which on returns to a computed number stop with an alarm.
    pub fn guard(&self) -> Option<u32> {
        self.guard
    }
}

/// Where numbers begin that lie above this one, and not next to it.
pub(super) fn above(number: u32) -> u32 {
    (number.saturating_add(1) / ROUND).saturating_add(1).saturating_mul(ROUND)
}

/// The largest sequence number of a program: a label, or one that nothing looks for.
pub fn last_sequence(program: &Program) -> u32 {
    let of_block = |block: &Block| {
        let labels = block.labels.iter().filter_map(|label| match label {
            Label::Number(number) => Some(*number),
            Label::Name(_) => None,
        });
        let sites = block.stmts.iter().map(|stmt| &stmt.site).chain([&block.term.site]);
        labels.chain(sites.filter_map(|site| site.sequence.get())).max()
    };
    program.blocks.iter().filter_map(of_block).max().unwrap_or(0)
}
