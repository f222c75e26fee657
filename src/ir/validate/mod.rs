//! The validator: what it passes keeps the contract of [`crate::ir`].
//!
//! Its product is [`Valid`], which only [`Valid::of`] makes and which emitters take: a program that
//! nobody checked has no type that can be printed in a control's language.

mod block;
mod value;

use super::{BlockId, Class, FLAGS, LAST_NUMBER, LOCAL_FLAGS, Module, Program, Var};
use crate::canon::{Func, Group, Role};
use crate::syntax::ProgramName;

/// A program that keeps the contract.
#[derive(Clone, Copy, Debug)]
pub struct Valid<'p>(&'p Program);

impl<'p> Valid<'p> {
    /// Checks a program that stands at `index` in its module.
    ///
    /// # Errors
    /// All breaches.
    pub fn of(program: &'p Program, index: usize) -> Result<Self, Vec<Invalid>> {
        let found = breaches(program, index);
        if found.is_empty() { Ok(Self(program)) } else { Err(found) }
    }

    /// One that may break the contract: emitters refuse most of it by themselves, too.
    #[cfg(test)]
    pub(crate) fn unchecked(program: &'p Program) -> Self {
        Self(program)
    }

    /// The program.
    pub fn program(self) -> &'p Program {
        self.0
    }
}

/// A breach of the contract, and where. It is a fault of this program, never of the one translated.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("program {program}{}: {problem}", place(*.block, *.statement))]
pub struct Invalid {
    /// Index of the program in the module, and its name.
    pub program: String,
    /// The block.
    pub block: Option<BlockId>,
    /// Index of the statement; absent for the terminator and for what concerns the whole block.
    pub statement: Option<usize>,
    /// What is wrong.
    pub problem: Problem,
}

/// What can be wrong.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Problem {
    /// A program without a block has no entry.
    #[error("has no block")]
    NoEntry,
    /// A block id past the end.
    #[error("{0} does not exist")]
    NoBlock(BlockId),
    /// A label of two blocks of which a computed jump names the wrong one, or names none.
    #[error("computed jump to label {label} goes to {target}, which does not have it")]
    Label {
        /// The label's number.
        label: u32,
        /// Where the jump goes.
        target: BlockId,
    },
    /// A computed jump that leaves a label out.
    #[error("computed jump lacks label {0}")]
    LabelLeftOut(u32),
    /// One label twice among the targets of a computed jump.
    #[error("computed jump has label {0} twice")]
    LabelTwice(u32),
    /// An operation that has to be a terminator or a call.
    #[error("{0} in an NC block")]
    Flow(crate::canon::Op),
    /// Two operations of one modal group.
    #[error("two operations of group {0} in an NC block")]
    Group(Group),
    /// One role twice.
    #[error("{0} twice in an NC block")]
    Role(Role),
    /// A computed code that is neither G nor M.
    #[error("computed code of letter {0:?}")]
    Letter(char),
    /// Increments elsewhere than as the whole value of a word or an argument.
    #[error("increments inside a value")]
    Increments,
    /// A constant that is no number.
    #[error("constant is not finite")]
    NotFinite,
    /// A variable whose number its class does not have.
    #[error("no variable {0}")]
    Variable(Var),
    /// Vacant for a variable that never is.
    #[error("{0} is never vacant")]
    NeverVacant(Var),
    /// A class that cannot be cleared as a whole.
    #[error("clears a class that has vacant variables")]
    Clear,
    /// A function with a wrong number of arguments.
    #[error("{func} with {count} arguments")]
    Arity {
        /// The function.
        func: Func,
        /// How many it has.
        count: usize,
    },
    /// An expression nested too deep.
    #[error("nested deeper than {max}", max = super::eval::MAX_DEPTH)]
    Depth,
    /// A skip level out of 1 to 9, or on a terminator.
    #[error("block-skip level {0} here")]
    Skip(u8),
    /// One local set twice by the arguments of a call.
    #[error("argument local.{0} twice")]
    ArgumentTwice(u32),
    /// Arguments of a call that opens no level.
    #[error("arguments without a level of locals")]
    NoLevel,
}

/// Checks a module.
///
/// # Errors
/// All breaches.
pub fn validate(module: &Module) -> Result<(), Vec<Invalid>> {
    let mut found = Vec::new();
    module.programs.iter().enumerate().for_each(|(at, program)| found.extend(breaches(program, at)));
    if found.is_empty() { Ok(()) } else { Err(found) }
}

/// The breaches of one program, which stands at `index` in its module.
fn breaches(program: &Program, index: usize) -> Vec<Invalid> {
    let mut found = Vec::new();
    let mut check = Check { program, index, block: None, statement: None, found: &mut found };
    if program.blocks.is_empty() {
        check.add(Problem::NoEntry);
    }
    check.blocks();
    found
}

/// Checks one program.
struct Check<'c> {
    program: &'c Program,
    index: usize,
    block: Option<BlockId>,
    statement: Option<usize>,
    found: &'c mut Vec<Invalid>,
}

impl Check<'_> {
    fn add(&mut self, problem: Problem) {
        let name = match &self.program.name {
            Some(ProgramName::Number(number)) => format!("O{number}"),
            Some(ProgramName::Name(name)) => name.clone(),
            None => "unnamed".into(),
        };
        let program = format!("{} ({name})", self.index);
        self.found.push(Invalid { program, block: self.block, statement: self.statement, problem });
    }
}

/// True for a variable that its class can have.
fn exists(var: Var) -> bool {
    let unflagged = |first| var.number.checked_sub(first).unwrap_or(var.number);
    match var.class {
        Class::Local => (1..=33).contains(&unflagged(LOCAL_FLAGS)),
        Class::Common | Class::Retained => (1..=LAST_NUMBER).contains(&unflagged(FLAGS)),
        Class::Global => (1..=LAST_NUMBER).contains(&var.number),
        Class::Parametric | Class::Register => var.number <= 99,
        Class::Temp | Class::Static => true,
    }
}

fn place(block: Option<BlockId>, statement: Option<usize>) -> String {
    let block = block.map(|id| format!(", {id}")).unwrap_or_default();
    block + &statement.map(|at| format!(", statement {at}")).unwrap_or_default()
}

#[cfg(test)]
mod tests;
