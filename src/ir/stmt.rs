//! Statements, terminators and what they are made of.

use super::{BlockId, Class, Cond, Expr, Var};
use crate::canon::{Op, Role, Sys};
use crate::syntax::ProgramName;
use crate::text::Span;
use smallvec::SmallVec;
use thin_vec::ThinVec;

/// The space that a computed variable number counts in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Bank {
    /// The one space of all numbered variables, locals and system variables too: `#[..]`.
    Numbered,
    /// The global variables: `V(..)`.
    Global,
    /// The parametric variables: `R(..)`.
    Parametric,
}

impl Bank {
    /// The class of its variables in the tables of controls, where it has one of its own.
    pub fn class(self) -> Option<&'static str> {
        match self {
            Self::Numbered => None,
            Self::Global => Some("common"),
            Self::Parametric => Some("parametric"),
        }
    }
}

/// Something that can be assigned.
#[derive(Clone, Debug, PartialEq)]
pub enum Place {
    /// A variable.
    Var(Var),
    /// The variable with a computed number.
    Indirect(Bank, Box<Expr>),
    /// State of the machine.
    System(Sys, ThinVec<Expr>),
}

impl Place {
    /// The expression that reads it.
    pub fn read(&self) -> Expr {
        match self {
            Place::Var(var) => Expr::Var(*var),
            Place::Indirect(bank, index) => Expr::Indirect(*bank, index.clone()),
            Place::System(state, subscripts) => Expr::System(*state, subscripts.clone()),
        }
    }
}

/// Where a statement comes from and what people wrote beside it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SourceInfo {
    /// The bytes of the block in its file.
    pub span: Span,
    /// Its sequence number.
    pub sequence: BlockNumber,
    /// Its comments.
    pub comments: ThinVec<Comment>,
    /// Its block-skip level: skipped when that switch is on. A terminator has it only where it is a branch on
    /// that [`Cond::Switch`] round blocks each of which had this block skip by itself: it changes nothing, and lets each have it again.
    pub skip: Option<u8>,
    /// How many lines without anything stood before it.
    pub blanks: u8,
}

/// A sequence number, or none, in no more room than that takes: there are as many as blocks and statements.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
pub struct BlockNumber {
    is_some: bool,
    number: [u8; 4],
}

impl BlockNumber {
    /// The number.
    pub fn get(self) -> Option<u32> {
        self.is_some.then_some(u32::from_ne_bytes(self.number))
    }

    /// True where there is one.
    pub fn is_some(self) -> bool {
        self.is_some
    }

    /// True where there is none.
    pub fn is_none(self) -> bool {
        !self.is_some
    }

    /// The number, which is none from here on.
    pub fn take(&mut self) -> Option<u32> {
        std::mem::take(self).get()
    }
}

impl From<Option<u32>> for BlockNumber {
    fn from(number: Option<u32>) -> Self {
        Self { is_some: number.is_some(), number: number.unwrap_or_default().to_ne_bytes() }
    }
}

impl std::fmt::Debug for BlockNumber {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.get().fmt(f)
    }
}

/// A comment.
#[derive(Clone, Debug, PartialEq)]
pub struct Comment {
    /// Its text, without its fence.
    pub text: String,
    /// True where it stood before the words of its block.
    pub leading: bool,
}

/// A statement.
#[derive(Clone, Debug, PartialEq)]
pub struct Stmt {
    /// What it does.
    pub kind: StmtKind,
    /// Where it comes from.
    pub site: SourceInfo,
}

/// What a statement does.
#[derive(Clone, Debug, PartialEq)]
pub enum StmtKind {
    /// Nothing; carries comments, or is an empty block.
    Comment,
    /// Writes a place.
    Assign {
        /// What is written.
        target: Place,
        /// The value.
        value: Expr,
    },
    /// A block of NC words.
    Nc(Nc),
    /// From here on, each block that moves an axis calls `call` when its move is done.
    ModalCall(Box<Call>),
    /// Ends the innermost modal call.
    ModalCallOff,
    /// Stops the machine for good with a number and a message.
    Alarm {
        /// The number, as the source writes it.
        number: Box<Expr>,
        /// The message.
        text: Box<str>,
    },
    /// Stops until cycle start and shows a message.
    StopMessage {
        /// The number, as the source writes it.
        number: Box<Expr>,
        /// The message.
        text: Box<str>,
    },
    /// Formatted output to a port, one line.
    Output(Vec<OutputPart>),
    /// Opens the output port.
    OpenPort,
    /// Closes the output port.
    ClosePort,
    /// Prints to the screen or a port, with no stated number format.
    Print {
        /// True for the port.
        serial: bool,
        /// What is printed.
        parts: ThinVec<PrintPart>,
        /// True where the next print goes on in the same line.
        stay: bool,
    },
    /// Waits for the operator (or the port) to give a number.
    Input {
        /// True for the port.
        serial: bool,
        /// Where it goes.
        target: Place,
    },
    /// Sets every variable of the class to 0: all that any program of the library names.
    ClearAll(Class),
    /// Waits until all moves are done before anything after it is read.
    Sync,
    /// Limits how many blocks are read ahead; 0 for no limit.
    LimitLookahead(Expr),
    /// Gives names to variables from a number on.
    SetNames {
        /// The first.
        first: Var,
        /// The names.
        names: ThinVec<String>,
    },
}

/// A block of NC words.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Nc {
    /// Its operations and words, in the order they were written in.
    pub items: Vec<NcItem>,
}

/// One thing in an NC block.
#[derive(Clone, Debug, PartialEq)]
pub enum NcItem {
    /// An operation.
    Op(Op),
    /// A word's value in its role.
    Word(Role, Expr),
    /// A G or M code computed at run time, in the numbering of the source's control: `G#10`.
    Code(char, Expr),
}

/// A piece of formatted output.
#[derive(Clone, Debug, PartialEq)]
pub enum OutputPart {
    /// Text; a space is a space.
    Text(String),
    /// A value with so many digits before and after the point.
    Value {
        /// What is printed.
        value: Expr,
        /// Digits before the point.
        whole: u32,
        /// Digits after it.
        fraction: u32,
    },
}

/// A piece of unformatted output.
#[derive(Clone, Debug, PartialEq)]
pub enum PrintPart {
    /// Text.
    Text(String),
    /// A value.
    Value(Expr),
}

/// A terminator.
#[derive(Clone, Debug, PartialEq)]
pub struct Terminator {
    /// How the block ends.
    pub kind: TermKind,
    /// Where it comes from; default for a mere fall-through.
    pub site: SourceInfo,
}

/// How a block ends.
#[derive(Clone, Debug, PartialEq)]
pub enum TermKind {
    /// Goes on at a block.
    Jump(BlockId),
    /// Goes on at one of two.
    Branch {
        /// Which.
        cond: Box<Cond>,
        /// Where it holds.
        then: BlockId,
        /// Where it does not.
        otherwise: BlockId,
    },
    /// Goes on at the block whose label is the value, rounded to nearest; stops with an
    /// alarm where none is.
    Computed {
        /// The label's number.
        value: Box<Expr>,
        /// Every block that has a number for a label.
        targets: ThinVec<(u32, BlockId)>,
    },
    /// Calls, then goes on.
    Call {
        /// The call.
        call: Box<Call>,
        /// Where it goes on.
        next: BlockId,
    },
    /// Returns to the caller: after the call, or at a sequence number of the caller.
    Return {
        /// The sequence number.
        to: Option<Expr>,
    },
    /// Goes to another program for good.
    Chain(ProgramName),
    /// Ends the run.
    End {
        /// True where the program is rewound.
        rewind: bool,
    },
    /// The text of the program ends here without a word that ends it.
    Stray,
}

/// A call.
#[derive(Clone, Debug, PartialEq)]
pub struct Call {
    /// What is called.
    pub callee: Callee,
    /// True where a new level of locals is opened.
    pub level: bool,
    /// Values of the new level's locals, in the order written.
    pub arguments: Vec<Argument>,
    /// How often it runs, in all; once where absent.
    pub count: Option<Expr>,
}

/// An argument of a call.
#[derive(Clone, Debug, PartialEq)]
pub struct Argument {
    /// The local it sets.
    pub local: u32,
    /// Its value.
    pub value: Expr,
}

/// What a call goes to.
#[derive(Clone, Debug, PartialEq)]
pub enum Callee {
    /// A program.
    Program(ProgramName),
    /// A block of this program.
    Block(BlockId),
    /// The program with a computed number.
    Computed(Expr),
    /// A cycle that the machine's maker keeps outside the library, by its number.
    Cycle(u32),
}

impl TermKind {
    /// The blocks that the terminator can go on at, callees aside.
    pub fn successors(&self) -> SmallVec<[BlockId; 2]> {
        match self {
            TermKind::Jump(to) | TermKind::Call { next: to, .. } => SmallVec::from_buf_and_len([*to; 2], 1),
            TermKind::Branch { then, otherwise, .. } => SmallVec::from_buf([*then, *otherwise]),
            TermKind::Computed { targets, .. } => targets.iter().map(|(_, to)| *to).collect(),
            TermKind::Return { .. } | TermKind::Chain(_) | TermKind::End { .. } | TermKind::Stray => {
                SmallVec::new()
            }
        }
    }

    /// Calls `f` on every block id that the terminator names, callees included.
    pub fn for_each_target(&mut self, f: &mut dyn FnMut(&mut BlockId)) {
        match self {
            TermKind::Jump(to) => f(to),
            TermKind::Branch { then, otherwise, .. } => {
                f(then);
                f(otherwise);
            }
            TermKind::Computed { targets, .. } => targets.iter_mut().for_each(|(_, to)| f(to)),
            TermKind::Call { call, next } => {
                if let Callee::Block(entry) = &mut call.callee {
                    f(entry);
                }
                f(next);
            }
            TermKind::Return { .. } | TermKind::Chain(_) | TermKind::End { .. } | TermKind::Stray => {}
        }
    }
}

impl Nc {
    /// True where it has no code, only words.
    pub fn is_words(&self) -> bool {
        self.items.iter().all(|item| matches!(item, NcItem::Word(..)))
    }

    /// True when the block has this operation.
    pub fn has(&self, op: Op) -> bool {
        self.ops().any(|o| o == op)
    }

    /// The value of the word in this role.
    pub fn word(&self, role: Role) -> Option<&Expr> {
        self.items.iter().find_map(|item| match item {
            NcItem::Word(r, value) if *r == role => Some(value),
            _ => None,
        })
    }

    /// The operations, in order.
    pub fn ops(&self) -> impl Iterator<Item = Op> + '_ {
        self.items.iter().filter_map(|item| match item {
            NcItem::Op(op) => Some(*op),
            _ => None,
        })
    }

    /// True when an axis word makes the block a move.
    pub fn moves(&self) -> bool {
        self.names_axis() && !self.ops().any(Op::takes_axes)
    }

    /// True when the block has an axis word, for whatever it stands.
    pub fn names_axis(&self) -> bool {
        self.items.iter().any(|item| matches!(item, NcItem::Word(role, _) if role.is_axis()))
    }
}
