//! Words, numbers, variables and expressions of the typed blocks.

use crate::canon::Func;
use crate::text::Span;
use std::borrow::Cow;
use thin_vec::ThinVec;

/// A word: an address letter and its value.
#[derive(Clone, Debug, PartialEq)]
pub struct Word {
    /// The letter, upper case.
    pub letter: char,
    /// True for a comma word: `,R10`, `,C2`.
    pub comma: bool,
    /// The value; absent where nothing follows the letter.
    pub value: Option<Expr>,
    /// True for `X=V1`.
    pub equals: bool,
}

/// A number as it is written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Number {
    /// Its value. A sign stands outside, as a [`ExprKind::Negate`].
    pub value: f64,
    /// True where a decimal point is written.
    pub point: bool,
    /// How many digits are written, leading and trailing zeros included.
    pub digits: u16,
}

/// An expression.
#[derive(Clone, Debug, PartialEq)]
pub struct Expr {
    /// What it is.
    pub kind: ExprKind,
    /// Its bytes.
    pub span: Span,
}

/// What an expression can be.
#[derive(Clone, Debug, PartialEq)]
pub enum ExprKind {
    /// A constant.
    Number(Number),
    /// A variable.
    Variable(Box<VarRef>),
    /// `-a`.
    Negate(Box<Expr>),
    /// `+a`.
    Plus(Box<Expr>),
    /// `NOT a`.
    Not(Box<Expr>),
    /// `a + b`.
    Binary(BinaryOp, Box<[Expr; 2]>),
    /// `SIN[a]`, `SQR V2`, `ATAN[a]/[b]`.
    Call {
        /// The function.
        function: Func,
        /// Its arguments, without the brackets that hold them.
        arguments: ThinVec<Expr>,
        /// How two arguments are written.
        form: CallForm,
    },
    /// `[a]` or `(a)`.
    Group(Box<Expr>),
}

/// How a function's arguments are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CallForm {
    /// `F[a]`, `F(a)`, `F a`.
    Plain,
    /// `F[a]/[b]`.
    Slash,
    /// `F[a,b]`.
    Comma,
}

/// Operators between two operands. What AND means (bits or truth) is the dialect's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs)]
pub enum BinaryOp {
    Add,
    Subtract,
    Multiply,
    Divide,
    Modulo,
    And,
    Or,
    Xor,
    Equal,
    NotEqual,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
}

/// A variable as it is written: a name and, with most, a subscript.
///
/// `#100` is `#` with 100; `V(V1+2)` is `V` with an expression; `AX` has none;
/// `VX` is `V` with the letter X; `[#ABS]` is `#` with a name.
#[derive(Clone, Debug, PartialEq)]
pub struct VarRef {
    /// The name before the subscript, upper case: `#`, `V`, `R`, `FX`, `AX`, `TN`.
    pub name: Cow<'static, str>,
    /// The subscript.
    pub index: Index,
    /// Its bytes.
    pub span: Span,
}

/// A variable's subscript.
#[derive(Clone, Debug, PartialEq)]
pub enum Index {
    /// None: `AX`, `TN`.
    None,
    /// A number: `#100`, `V5`, `FX1`, `G(1)`.
    Number(u32),
    /// A number with a fraction that selects a bit: `#30057.21`.
    Bit(u32, u32),
    /// A letter: `VX`.
    Letter(char),
    /// A name: `#<NAME>`, `[#TOOL_NO]`, upper case.
    Name(String),
    /// Computed: `#[#1+2]`, `##1`, `V(V1)`.
    Computed(Box<Expr>),
}
