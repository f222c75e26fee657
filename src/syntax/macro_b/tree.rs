//! Builds what a block says from its row of leaves.
//!
//! The grammar has found that the leaves stand in a legal order; the
//! tree gives them their shape. A row that does not fit is a fault, never a panic.

use super::lexeme::{Lex, Lexeme};
use crate::diag::Code;
use crate::syntax::{BinaryOp, Item, Number, SyntaxError};
use crate::text::Span;

/// What a block says, and what is wrong with the numbers it is made of.
#[derive(Debug, Default)]
pub struct Tree {
    pub items: Vec<Item>,
    pub errors: Vec<SyntaxError>,
}

/// Builds the items of a block.
///
/// # Errors
/// The place where a row of leaves makes no sense, or nests too deep.
pub fn build(source: &[u8], row: &[Lexeme], rank: fn(BinaryOp) -> u8) -> Result<Tree, SyntaxError> {
    let mut builder =
        Builder { source, row, rank, at: 0, errors: Vec::new(), within: Vec::new(), operators: 0 };
    // A number and a statement are the most that usual blocks hold.
    let mut items = Vec::with_capacity(2);
    builder.items(&mut items, 0)?;
    // Files are kept whole: room to spare in each block would be most of what they take.
    items.shrink_to_fit();
    Ok(Tree { items, errors: builder.errors })
}

/// Reads the row from left to right.
pub struct Builder<'a> {
    pub source: &'a [u8],
    row: &'a [Lexeme],
    /// How close an operator binds.
    pub rank: fn(BinaryOp) -> u8,
    at: usize,
    pub errors: Vec<SyntaxError>,
    /// Comments inside the brackets of the item that is read.
    pub within: Vec<Item>,
    /// Operators met so far, which bounds how deep the trees can be.
    pub operators: usize,
}

/// Operators that one block may hold: more nest deeper than a walk may go.
pub const MOST_OPERATORS: usize = 300;

impl Builder<'_> {
    /// The kind of the next leaf.
    pub fn kind(&self) -> Lex {
        self.ahead(0)
    }

    /// The kind of a leaf further on.
    pub fn ahead(&self, by: usize) -> Lex {
        self.row.get(self.at + by).map_or(Lex::Nothing, |leaf| leaf.kind)
    }

    /// Where a leaf further on stands.
    pub fn span_ahead(&self, by: usize) -> Span {
        self.row.get(self.at + by).map_or(Span::default(), |leaf| leaf.span)
    }

    /// Where the next leaf stands; the end of the row after the last one.
    pub fn here(&self) -> Span {
        match (self.row.get(self.at), self.row.last()) {
            (Some(leaf), _) => leaf.span,
            (None, Some(last)) => Span::new(last.span.end, last.span.end),
            (None, None) => Span::default(),
        }
    }

    /// Where the last leaf that was taken ends, blanks left out.
    pub fn end(&self) -> u32 {
        let taken = self.row.get(..self.at).unwrap_or_default();
        taken.iter().rev().find(|leaf| leaf.kind != Lex::Space).map_or(0, |leaf| leaf.span.end)
    }

    /// Takes the next leaf.
    pub fn take(&mut self) -> Span {
        let span = self.here();
        self.at += 1;
        span
    }

    /// Takes the next leaf if it is of this kind.
    pub fn take_if(&mut self, kind: Lex) -> Option<Span> {
        (self.kind() == kind).then(|| self.take())
    }

    /// Takes the next leaf, which must be of this kind; blanks before it are passed.
    pub fn need(&mut self, kind: Lex) -> Result<Span, SyntaxError> {
        self.pass_space();
        self.take_if(kind).ok_or_else(|| self.misfit())
    }

    /// Passes blanks.
    pub fn pass_space(&mut self) {
        if self.kind() == Lex::Space {
            self.at += 1;
        }
    }

    /// True, and passes the blanks before it, where a leaf of this kind comes next.
    pub fn meets(&mut self, kind: Lex) -> bool {
        let found = self.kind() == kind || (self.kind() == Lex::Space && self.ahead(1) == kind);
        if found {
            self.pass_space();
        }
        found
    }

    /// A fault at the next leaf.
    pub fn misfit(&self) -> SyntaxError {
        let message = "this does not continue the statement before it".to_owned();
        SyntaxError { code: Code::Unreadable, span: self.here(), message }
    }

    /// A fault where blocks nest deeper than is read.
    pub fn too_deep(&self) -> SyntaxError {
        let message = "the block nests too deep to be read: split it".to_owned();
        SyntaxError { code: Code::TooComplex, span: self.here(), message }
    }

    /// A whole number that is written as digits only.
    pub fn integer(&mut self) -> Result<u32, SyntaxError> {
        let span = self.need(Lex::Integer)?;
        Ok(self.digits(span, span.of(self.source)))
    }

    /// The value of digits; one that is too large is an error and becomes the largest.
    pub fn digits(&mut self, span: Span, digits: &[u8]) -> u32 {
        let value = digits.iter().try_fold(0u32, |value, &digit| {
            value.checked_mul(10)?.checked_add(u32::from(digit.wrapping_sub(b'0')))
        });
        value.unwrap_or_else(|| {
            self.too_many_digits(span);
            u32::MAX
        })
    }

    fn too_many_digits(&mut self, span: Span) {
        let message = "this number has more digits than any control reads".to_owned();
        self.errors.push(SyntaxError { code: Code::TooManyDigits, span, message });
    }

    /// The number that is written in `span`.
    pub fn number(&mut self, span: Span) -> Number {
        let number = read_number(span.of(self.source));
        if number.digits > MOST_DIGITS {
            self.too_many_digits(span);
        }
        number
    }
}

/// Digits beyond which no control's number format reaches.
pub const MOST_DIGITS: u16 = 40;

/// Powers of ten that a double holds exactly, as far as short numbers need them.
pub const TENS: [f64; 16] =
    [1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15];

/// Reads digits with at most one point among them.
pub fn read_number(text: &[u8]) -> Number {
    let (mut mantissa, mut digits, mut places, mut point) = (0u64, 0usize, 0usize, false);
    for &byte in text {
        if byte == b'.' {
            point = true;
        } else {
            mantissa = mantissa.wrapping_mul(10).wrapping_add(u64::from(byte.wrapping_sub(b'0')));
            digits += 1;
            places += usize::from(point);
        }
    }
    // Up to 15 digits both numbers are exact, so their quotient is rounded once, as it must be.
    let value = match TENS.get(places) {
        Some(ten) if digits <= 15 => mantissa as f64 / ten,
        _ => std::str::from_utf8(text).ok().and_then(|text| text.parse().ok()).unwrap_or(f64::NAN),
    };
    Number { value, point, digits: digits.min(usize::from(u16::MAX)) as u16 }
}
