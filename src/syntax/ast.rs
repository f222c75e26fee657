//! The typed blocks that all dialects share.
//!
//! The dialects differ in spelling and in meaning, less in shape, so one tree
//! serves them all; a dialect's parser fills in what its control has. The tree
//! says what is written, never what it means: `R0+.1` is an assignment to the
//! variable `R0` because it is spelled as one, and whether it sets a
//! retract plane is for `lower` and `control` to know.

use super::{BinaryOp, Expr, VarRef, Word};
use crate::diag::Diagnostic;
use crate::text::Span;
use std::borrow::Cow;
use thin_vec::ThinVec;

/// One block (what the control executes at once), with everything on it.
///
/// Tokens tile [`Block::span`]: every byte stands in exactly one of them, so
/// that concatenating them prints the block as it was read.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    /// The bytes of the block, its end-of-block sign `;` included, its line end not.
    pub span: Span,
    /// The tokens, in order.
    pub tokens: Vec<Token>,
    /// What the tokens spell, in order.
    pub items: Vec<Item>,
    /// What is wrong with the block. A block that the grammar cannot read at
    /// all holds one [`ItemKind::Unparsed`] and its error here.
    pub errors: ThinVec<SyntaxError>,
}

/// A lexeme of a block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Token {
    /// What kind of lexeme.
    pub kind: TokenKind,
    /// Where it was read.
    pub span: Span,
}

/// Kinds of lexemes, as an editor would colour them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs)]
pub enum TokenKind {
    Space,
    Skip,
    Comment,
    Letter,
    Number,
    Keyword,
    Variable,
    Operator,
    Bracket,
    Text,
    Mark,
    EndOfBlock,
    Other,
}

/// A fault found while reading a block.
#[derive(Clone, Debug, PartialEq)]
pub struct SyntaxError {
    /// Its code in the catalogue.
    pub code: crate::diag::Code,
    /// Where, precisely.
    pub span: Span,
    /// What is wrong and what to do, in one sentence.
    pub message: String,
}

impl From<SyntaxError> for Diagnostic {
    fn from(fault: SyntaxError) -> Self {
        Self::new(fault.code, fault.span, fault.message)
    }
}

/// One thing that a block says.
#[derive(Clone, Debug, PartialEq)]
pub struct Item {
    /// What it is.
    pub kind: ItemKind,
    /// Its bytes.
    pub span: Span,
}

/// What a block can say.
#[derive(Clone, Debug, PartialEq)]
pub enum ItemKind {
    /// `/` or `/2`: what follows on the block is skipped when the switch is on.
    Skip(Option<u8>),
    /// `%`: start or end of the tape.
    Tape,
    /// `;`: end of block.
    EndOfBlock,
    /// `O1234`, `:1234`, `O<NAME>` or `<NAME>`: a program begins.
    Program(ProgramName),
    /// `N10`: the block's sequence number. `N+5`, an inserted block of some
    /// controls, has `inserted` set.
    Sequence {
        /// The number, without leading zeros.
        number: u32,
        /// True for `N+5`.
        inserted: bool,
    },
    /// A label on a block of its own: `#:LOOP`, `$1`.
    Label(Label),
    /// `#` at the head of a macro line.
    MacroMark,
    /// A comment.
    Comment(Comment),
    /// A letter and its value: `X1.5`, `G#10`, `X-[#1+#2]`, `Y+R2`, `X=V1`, `,R10`.
    Word(Word),
    /// `#1=2`, `V1=V2+V3`, `R3+7.5`.
    Assign {
        /// What is written.
        target: Box<VarRef>,
        /// The value; for `R3-7.5` it holds the sign.
        value: Expr,
        /// True for a sign in place of `=`, outside a macro line: `R3+7.5`.
        by_sign: bool,
    },
    /// `IF[..]` and, after it, what happens when it is true (the rest of the
    /// block). With `bare` the word IF is missing: `[#1000] GOTO10`.
    If {
        /// The condition.
        condition: Box<Expr>,
        /// True where THEN is written.
        then: bool,
        /// True where IF is not written.
        bare: bool,
        /// What is done when the condition holds.
        body: Vec<Item>,
    },
    /// `WHILE[..]DO1`; without a condition `DO1`.
    Do {
        /// The condition, absent in an endless loop.
        condition: Option<Expr>,
        /// The loop number.
        number: u32,
    },
    /// `END1`.
    End {
        /// The loop number.
        number: u32,
    },
    /// `GOTO 10`, `GOTO#1`, `GOTO :LOOP`, `GOTO N45`. `G24 P2` stays two words.
    Goto(Target),
    /// `BEQ P5`, `BNE V1`: a jump on the state of the condition register.
    Branch {
        /// The comparison of the register with zero: one of the six relations.
        relation: BinaryOp,
        /// Where to.
        target: Target,
    },
    /// `TST V1`, `TST G1`, `TST QX`: sets the condition register.
    Test(TestSubject),
    /// `INC V1`, `DEC V1`.
    Step {
        /// The variable.
        target: Box<VarRef>,
        /// True for DEC.
        down: bool,
    },
    /// `TIM V1`: seconds since cycle start into a variable.
    Timer(Box<VarRef>),
    /// `COR=T10 R=V1`, `TRF=G54 V1=X`: a transfer between variables and a table.
    Transfer {
        /// The table and its row.
        table: Box<Table>,
        /// The cells that are moved.
        cells: Vec<Cell>,
    },
    /// `SETVN 510[NAME,NAME]`: names for variables from `first` on.
    SetNames {
        /// The first variable's number.
        first: u32,
        /// The names, in order.
        names: Vec<String>,
    },
    /// `DPRNT[..]`, `BPRNT[..]`.
    Output {
        /// True for BPRNT.
        binary: bool,
        /// What is put out.
        parts: Vec<OutputPart>,
    },
    /// `POPEN`.
    OpenPort,
    /// `PCLOS`.
    ClosePort,
    /// `PRINT "A",V1,`, `SPRINT ..`.
    Print {
        /// True for the serial line (SPRINT).
        serial: bool,
        /// The things printed.
        parts: Vec<PrintPart>,
        /// True where a comma ends the list: the cursor stays on the line.
        stay: bool,
    },
    /// `INPUT V1`, `SINPUT V1`.
    Input {
        /// True for the serial line.
        serial: bool,
        /// The variables asked for.
        targets: Vec<VarRef>,
    },
    /// `CLEAR`, `CLEAR V1`, `CLEAR V3-V7,V15`: empty for all.
    Clear(Vec<(VarRef, Option<VarRef>)>),
    /// `SET RND4`, `SET DEGREES`; empty for a bare SET.
    Set(Vec<SetOption>),
    /// `WAIT`.
    Wait,
    /// `START 7`.
    Start(Expr),
    /// `INDEX "M1 A90."`.
    Index(String),
    /// Text that the grammar cannot read. The block's errors say why.
    Unparsed,
}

/// How a program is named.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum ProgramName {
    /// `O1234`.
    Number(u32),
    /// `O<NAME>`, `<NAME>`.
    Name(String),
}

impl ProgramName {
    /// As short as people write it: `O12`, or the name itself.
    pub fn short(&self) -> Cow<'_, str> {
        match self {
            ProgramName::Number(number) => format!("O{number}").into(),
            ProgramName::Name(name) => name.into(),
        }
    }

    /// The name of the part of a numbered program that begins at one of its sequence numbers: no program in any source has it.
    pub fn part(program: u32, sequence: u32) -> Self {
        ProgramName::Name(format!("O{program}/N{sequence}"))
    }

    /// The program and the sequence number of such a part.
    pub fn as_part(&self) -> Option<(u32, u32)> {
        let ProgramName::Name(name) = self else { return None };
        let (program, sequence) = name.strip_prefix('O')?.split_once("/N")?;
        let part = (program.parse().ok()?, sequence.parse().ok()?);
        (*self == Self::part(part.0, part.1)).then_some(part)
    }

    /// What is left of a name as people write it without what stands before a number: `12` of `O0012`.
    pub fn digits(shown: &str) -> &str {
        shown.trim_start_matches(['O', '0'])
    }
}

impl std::fmt::Display for ProgramName {
    /// As people write it: `O0012`, or the name itself.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            ProgramName::Number(number) => write!(f, "O{number:04}"),
            ProgramName::Name(name) => f.write_str(name),
        }
    }
}

/// A label's name.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Label {
    /// `$1`.
    Number(u32),
    /// `:LOOP`, upper case.
    Name(String),
}

/// Where a jump goes.
#[derive(Clone, Debug, PartialEq)]
pub enum Target {
    /// A sequence number: `GOTO10`, `GOTO N45`.
    Sequence(u32),
    /// A label: `GOTO :LOOP`, `BEQ P5`.
    Label(Label),
    /// A number computed at run time: `GOTO#1`, `GOTO[#1+10]`, `BEQ V1`.
    Computed(Expr),
}

/// A comment's text and how it is fenced.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Comment {
    /// The bytes inside the fence.
    pub text: Span,
    /// The fence.
    pub fence: Fence,
}

/// How a comment is fenced.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Fence {
    /// `(text)`.
    Closed,
    /// The same, inside the brackets of an expression: `[#1 (text)]`. It follows the item that it stands in.
    Within,
    /// `(text` to the end of the line.
    Open,
    /// `*text` to the end of the line.
    Star,
    /// `'text` to the end of the line.
    Apostrophe,
    /// Text outside the program: before the first `%`, a header line of a memory dump.
    Outside,
}

/// What TST looks at.
#[derive(Clone, Debug, PartialEq)]
pub enum TestSubject {
    /// A variable's sign.
    Variable(Box<VarRef>),
    /// Whether a G code is active.
    Code(u32),
    /// `QX`, `QM`: whether an axis is mirrored, whether dimensions are metric.
    Flag(char),
}

/// The tables that [`ItemKind::Transfer`] reaches.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// `COR` or `TRF`, upper case.
    pub name: String,
    /// The row: a word (`T10`, `G54`) or a variable.
    pub row: TableRow,
}

/// A row of a table.
#[derive(Clone, Debug, PartialEq)]
pub enum TableRow {
    /// `T10`, `G54`, `G92`, `G20`.
    Word(char, u32),
    /// `V3`.
    Variable(VarRef),
}

/// One cell of a transfer: which address, which variable, which way.
#[derive(Clone, Debug, PartialEq)]
pub struct Cell {
    /// The table's column: `R`, `L`, `X`, `Y`, `Z`.
    pub letter: char,
    /// The variable.
    pub variable: VarRef,
    /// True for `R=V1` (into the table), false for `V1=R` (out of it).
    pub store: bool,
}

/// A piece of DPRNT output.
#[derive(Clone, Debug, PartialEq)]
pub enum OutputPart {
    /// Text as written; `*` prints a space.
    Text(Span),
    /// `#1[53]`: the value with so many digits before and after the point.
    Value {
        /// What is printed.
        value: Expr,
        /// Digits before the point.
        whole: u32,
        /// Digits after the point.
        fraction: u32,
    },
}

/// A piece of PRINT output.
#[derive(Clone, Debug, PartialEq)]
pub enum PrintPart {
    /// The bytes between the quotes.
    Text(Span),
    /// A value.
    Value(Expr),
}

/// An option of SET.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum SetOption {
    Degrees,
    Radians,
    Debug,
    Run,
    /// `RND4`: places kept by RND.
    Round(u8),
}
