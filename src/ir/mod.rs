//! The common form of programs.
//!
//! # The contract
//!
//! **A module** is a library: every program of every file that was read
//! together. Programs call one another by name; variables other than locals
//! and temporaries mean the same thing in all of them.
//!
//! **A program** is basic blocks in source order. Block 0 is the entry. Source
//! order is kept because people read it: the emitter lays the program out in
//! it. A call may enter at any block ([`Callee::Block`]); what is reachable
//! from there is that subroutine's body, shared with others or not.
//!
//! **A basic block** is statements and one terminator. Statements run in
//! order. A terminator is reached when all of them have run; only it leaves
//! the block. Control never enters but at the top.
//!
//! **A value** is vacant or a number (binary64). Arithmetic and functions
//! treat vacant as 0 and never yield it. `Equal` and `NotEqual` tell vacant
//! from 0 (vacant equals vacant only); the other relations treat it as 0.
//! Assigning a variable, or [`Expr::Vacant`], to another copies vacancy. A
//! word whose value is vacant is as if it were not written. Variables of the
//! classes [`Class::Global`], [`Class::Parametric`], [`Class::Register`],
//! [`Class::Temp`] and [`Class::Static`] are never vacant; where the target's registers may be, it is
//! legalization's duty to keep them from it.
//!
//! **Evaluation.** Operands are evaluated left to right; reading never changes
//! anything. Angles are degrees. [`BinOp::Mod`] rounds both operands to whole
//! numbers and takes the dividend's sign. Functions are those of
//! [`crate::canon::Func`]; one whose argument lies outside its domain stops
//! the machine with an alarm, so an evaluation is never dropped for being unused
//! unless it cannot do that.
//!
//! **Time.** All values of a block's words are evaluated before the block acts.
//! An assignment acts when it is reached; reading a position means the end of
//! the moves before it (the look-ahead of a control that would read it sooner
//! is stopped by [`StmtKind::Sync`]).
//!
//! **An NC block** ([`Nc`]) is a set of canonical operations and words that act
//! together, kept in the order they were written in. Words without an operation of
//! their group act under the one in force: modal state is not spelled out.
//! Operations of [`crate::canon::Op::is_flow`] never stand in it.
//!
//! **Calls.** [`Call::level`] opens a new set of locals, all vacant but for the
//! arguments; without it the callee sees the caller's. Locals of a level end
//! with it. A [`TermKind::Return`] of a program that nobody called starts it again.
//!
//! **What is observable**: machine motion and the order of all operations,
//! offsets and positions set, messages, alarms, output, what the operator is
//! asked, and the final values of variables other than locals, temporaries and statics.
//! Common variables end at power-off, retained ones do not.
//!
//! **Sites.** Every statement and terminator keeps the span it came from, its
//! sequence number and its comments. Statements with one site came from one
//! block; the emitter puts them on one block again where the target allows it.

pub mod analysis;
mod build;
pub mod eval;
mod expr;
mod stmt;
mod sum;
pub mod text;
pub mod validate;
mod var;
mod walk;

pub use build::Builder;
pub use expr::{BinOp, Cond, Expr, Relation, is_finer_than_words};
pub use stmt::{
    Argument, Bank, BlockNumber, Call, Callee, Comment, Nc, NcItem, OutputPart, Place, PrintPart, SourceInfo,
    Stmt, StmtKind, TermKind, Terminator,
};
pub use sum::{constant_part, shifted};
pub use validate::{Valid, validate};
pub use var::{Class, FLAGS, LAST_NUMBER, LOCAL_FLAGS, OF_NO_LEVEL, Var, flag_of, statics_of};

use crate::syntax::{Label, ProgramName};
use std::collections::BTreeMap;
use thin_vec::ThinVec;

/// A library of programs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Module {
    /// All programs, in the order of their files and of their places in them.
    pub programs: Vec<Program>,
    /// Names that people know variables by: from SETVN, and of sources whose
    /// variables are not plain numbers (`VA`).
    pub names: BTreeMap<Var, String>,
}

/// A program.
#[derive(Clone, Debug, PartialEq)]
pub struct Program {
    /// Its name; none for one that starts without an O word.
    pub name: Option<ProgramName>,
    /// Which file of the library it stands in.
    pub file: usize,
    /// The block that names it: comments, span.
    pub site: SourceInfo,
    /// What people call the values that its statics hold: on a target without locals, the locals of the source (`#4`).
    pub held: Vec<(Var, String)>,
    /// Its blocks, in source order. Block 0 is the entry.
    pub blocks: Vec<Block>,
}

/// Index of a block in its program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct BlockId(pub u32);

impl BlockId {
    /// As an index.
    pub const fn index(self) -> usize {
        self.0 as usize
    }
}

/// The statements of a block: most blocks have few, and many have none.
pub type Stmts = ThinVec<Stmt>;

/// A basic block.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    /// The labels it has in the source: sequence numbers and names. Targets of computed
    /// jumps and of returns to a sequence number find the block by them.
    pub labels: ThinVec<Label>,
    /// Its statements.
    pub stmts: Stmts,
    /// How it ends.
    pub term: Terminator,
}

// Passes walk all of them many times over: a block is as long as a line of the cache.
const _: () = assert!(size_of::<Block>() <= 64 && size_of::<Stmt>() <= 56);

impl Program {
    /// The block with this id.
    pub fn block(&self, id: BlockId) -> Option<&Block> {
        self.blocks.get(id.index())
    }

    /// All block ids, in order.
    pub fn ids(&self) -> impl DoubleEndedIterator<Item = BlockId> + use<> {
        (0..self.blocks.len() as u32).map(BlockId)
    }

    /// True when the program has a way to return to a caller.
    pub fn returns(&self) -> bool {
        self.blocks.iter().any(|b| matches!(b.term.kind, TermKind::Return { .. }))
    }

    /// True when the program has a way to end the run.
    pub fn ends(&self) -> bool {
        self.blocks.iter().any(|b| matches!(b.term.kind, TermKind::End { .. } | TermKind::Stray))
    }
}
