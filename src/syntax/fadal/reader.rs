//! Reads ordinary macro lines, and words with parametric variables, without the grammar: `#V1=V2*2`, `G1 X+R3`.
//!
//! The grammar stays the definition: what this accepts, it reads to the same block, which tests hold it to. Whatever is
//! rare, or may be a fault, is declined: comments, statements but assignments, IF and GOTO, and variables but `V` and `R`.

use super::check;
use crate::canon::Func;
use crate::syntax::support::number;
use crate::syntax::{
    BinaryOp, Block, CallForm, Expr, ExprKind, Index, Item, ItemKind, Label, Target, Token, TokenKind,
    VarRef, Word,
};
use crate::text::Span;
use std::borrow::Cow;
use thin_vec::ThinVec;

/// Brackets inside one another, and IFs, before a line is declined.
const DEEPEST: u32 = 16;

/// The block of an ordinary line; its tokens too where they are to be kept.
pub(super) fn read(source: &[u8], line: Span, tokens: bool) -> Option<Block> {
    let kept = tokens.then(|| Vec::with_capacity(16));
    let mut reader =
        Reader { line: line.of(source), start: line.start, at: 0, tokens: kept, items: Vec::new(), depth: 0 };
    reader.blanks();
    if matches!(reader.byte(), b'N' | b'n') {
        let (number, span) = reader.sequence()?;
        reader.items.push(Item { kind: ItemKind::Sequence { number, inserted: false }, span });
        reader.blanks();
    }
    if reader.byte() == b'#' {
        reader.macro_line()?
    } else {
        reader.words()?
    }
    if reader.at < reader.line.len() {
        return None;
    }
    let mut items = reader.items;
    items.shrink_to_fit();
    Some(Block { span: line, tokens: reader.tokens.unwrap_or_default(), items, errors: ThinVec::new() })
}

struct Reader<'s> {
    line: &'s [u8],
    /// Where the line starts in its file.
    start: u32,
    at: usize,
    tokens: Option<Vec<Token>>,
    items: Vec<Item>,
    depth: u32,
}

impl<'s> Reader<'s> {
    /// The next byte; a zero at the end, which nothing begins with.
    fn byte(&self) -> u8 {
        self.line.get(self.at).copied().unwrap_or(0)
    }

    fn rest(&self) -> &'s [u8] {
        self.line.get(self.at..).unwrap_or_default()
    }

    fn begins(&self, word: &[u8]) -> bool {
        self.rest().get(..word.len()).is_some_and(|text| text.eq_ignore_ascii_case(word))
    }

    /// Takes so many bytes as a token.
    fn take(&mut self, kind: TokenKind, length: usize) -> Span {
        let from = self.start + self.at as u32;
        self.at += length;
        let span = Span::new(from, from + length as u32);
        if let Some(tokens) = &mut self.tokens {
            tokens.push(Token { kind, span });
        }
        span
    }

    fn blanks(&mut self) {
        let length = self.rest().iter().take_while(|byte| matches!(byte, b' ' | b'\t')).count();
        if length > 0 {
            self.take(TokenKind::Space, length);
        }
    }

    /// Takes a token of this spelling, and blanks after it.
    fn taken(&mut self, kind: TokenKind, text: &[u8]) -> Option<Span> {
        let span = self.begins(text).then(|| self.take(kind, text.len()))?;
        self.blanks();
        Some(span)
    }

    fn digits(&self) -> usize {
        self.rest().iter().take_while(|byte| byte.is_ascii_digit()).count()
    }

    /// A whole number of digits alone.
    fn whole(&mut self) -> Option<(u32, Span)> {
        let length = self.digits();
        let number = std::str::from_utf8(self.rest().get(..length)?).ok()?.parse().ok()?;
        Some((number, self.take(TokenKind::Number, length)))
    }

    fn sequence(&mut self) -> Option<(u32, Span)> {
        let letter = self.take(TokenKind::Letter, 1);
        let (number, digits) = self.whole()?;
        Some((number, letter.to(digits)))
    }

    fn number(&mut self) -> Option<Expr> {
        let whole = self.digits();
        let rest = self.rest();
        let point = rest.get(whole) == Some(&b'.');
        let places = rest.iter().skip(whole + 1).take_while(|byte| byte.is_ascii_digit()).count();
        let length = if point { whole + 1 + places } else { whole };
        if whole == 0 && !(point && places > 0) {
            return None;
        }
        let text = std::str::from_utf8(rest.get(..length)?).ok()?;
        let span = self.take(TokenKind::Number, length);
        Some(Expr { kind: ExprKind::Number(number(text)), span })
    }

    /// Words with numbers, or with a sign and a parametric variable.
    fn words(&mut self) -> Option<()> {
        while self.at < self.line.len() {
            let letter = self.byte();
            // Letters that begin something else are left to the grammar.
            if !letter.is_ascii_alphabetic() || matches!(letter | 0x20, b'n' | b'o' | b'v' | b'r') {
                return None;
            }
            let start = self.take(TokenKind::Letter, 1);
            let value = match self.byte() {
                sign @ (b'+' | b'-') => {
                    let place = self.take(TokenKind::Operator, 1);
                    let inner = if self.byte() | 0x20 == b'r' { self.used()? } else { self.number()? };
                    signed(sign, place, inner)
                }
                _ => self.number()?,
            };
            let span = start.to(value.span);
            let letter = char::from(letter.to_ascii_uppercase());
            let word = Word { letter, comma: false, value: Some(value), equals: false };
            self.items.push(Item { kind: ItemKind::Word(word), span });
            self.blanks();
        }
        Some(())
    }

    /// `R5` in a word.
    fn used(&mut self) -> Option<Expr> {
        let [_, digit, after @ ..] = self.rest() else { return None };
        if !digit.is_ascii_digit() || after.first().is_some_and(|byte| byte.is_ascii_digit() || *byte == b'.')
        {
            return None;
        }
        let index = Index::Number(u32::from(digit - b'0'));
        let span = self.take(TokenKind::Variable, 2);
        let variable = VarRef { name: Cow::Borrowed("R"), index, span };
        Some(Expr { kind: ExprKind::Variable(Box::new(variable)), span })
    }

    /// From the mark to the end of the line.
    fn macro_line(&mut self) -> Option<()> {
        // Longer ones are a fault.
        if self.rest().trim_ascii_end().len() > super::build::MACRO_LINE as usize {
            return None;
        }
        let span = self.take(TokenKind::Mark, 1);
        self.items.push(Item { kind: ItemKind::MacroMark, span });
        self.blanks();
        let item = if self.byte() == b':' {
            let (label, span) = self.label()?;
            Item { kind: ItemKind::Label(label), span }
        } else {
            self.statement()?
        };
        self.items.push(item);
        self.blanks();
        Some(())
    }

    /// `:LOOP`
    fn label(&mut self) -> Option<(Label, Span)> {
        let named = |byte: &u8| byte.is_ascii_alphanumeric() || *byte == b'_';
        let name = self.rest().get(1..)?;
        let length = name.iter().take_while(|byte| named(byte)).count();
        let name = std::str::from_utf8(name.get(..length).filter(|name| !name.is_empty())?).ok()?;
        Some((Label::Name(name.to_ascii_uppercase()), self.take(TokenKind::Mark, 1 + length)))
    }

    fn statement(&mut self) -> Option<Item> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return None;
        }
        let start = self.start + self.at as u32;
        let kind = match self.byte() | 0x20 {
            b'i' => self.conditional()?,
            b'g' => {
                self.taken(TokenKind::Keyword, b"GOTO")?;
                let target = match self.byte() {
                    b':' => Target::Label(self.label()?.0),
                    b'N' | b'n' => Target::Sequence(self.sequence()?.0),
                    _ => return None,
                };
                ItemKind::Goto(target)
            }
            _ => {
                let target = Box::new(self.variable()?);
                self.blanks();
                self.taken(TokenKind::Operator, b"=")?;
                let value = self.expression()?;
                faultless(&value, check::value)?;
                ItemKind::Assign { target, value, by_sign: false }
            }
        };
        self.depth -= 1;
        Some(Item { kind, span: Span::new(start, self.start + self.at as u32) })
    }

    fn conditional(&mut self) -> Option<ItemKind> {
        self.taken(TokenKind::Keyword, b"IF")?;
        let condition = Box::new(self.expression()?);
        faultless(&condition, check::condition)?;
        self.blanks();
        self.taken(TokenKind::Keyword, b"THEN")?;
        let body = vec![self.statement()?];
        Some(ItemKind::If { condition, then: true, bare: false, body })
    }

    fn expression(&mut self) -> Option<Expr> {
        self.ranked(0)
    }

    /// Operands with operators of at least this rank between them, from left to right.
    fn ranked(&mut self, least: u8) -> Option<Expr> {
        let mut left = self.operand()?;
        while let Some((op, rank, blanks, length)) = self.infix() {
            if rank < least {
                break;
            }
            if blanks > 0 {
                self.take(TokenKind::Space, blanks);
            }
            self.take(TokenKind::Operator, length);
            self.blanks();
            let right = self.ranked(rank + 1)?;
            let span = left.span.to(right.span);
            left = Expr { kind: ExprKind::Binary(op, Box::new([left, right])), span };
        }
        Some(left)
    }

    /// The operator that comes next, its rank, the blanks before it, and its length.
    fn infix(&self) -> Option<(BinaryOp, u8, usize, usize)> {
        let rest = self.rest();
        let blanks = rest.iter().take_while(|byte| matches!(byte, b' ' | b'\t')).count();
        let text = rest.get(blanks..).unwrap_or_default();
        let (op, rank, length) = match text {
            [b'+', ..] => (BinaryOp::Add, 4, 1),
            [b'-', ..] => (BinaryOp::Subtract, 4, 1),
            [b'*', ..] => (BinaryOp::Multiply, 5, 1),
            [b'/', ..] => (BinaryOp::Divide, 5, 1),
            [b'<', b'>', ..] => (BinaryOp::NotEqual, 3, 2),
            [b'<', b'=', ..] => (BinaryOp::LessEqual, 3, 2),
            [b'>', b'=', ..] => (BinaryOp::GreaterEqual, 3, 2),
            // Blanks may stand within `< >`.
            [b'<', b' ' | b'\t', ..] => return None,
            [b'<', ..] => (BinaryOp::Less, 3, 1),
            [b'>', ..] => (BinaryOp::Greater, 3, 1),
            [b'=', ..] => (BinaryOp::Equal, 3, 1),
            // Written as words they are few.
            _ => return None,
        };
        Some((op, rank, blanks, length))
    }

    fn operand(&mut self) -> Option<Expr> {
        let sign = self.byte();
        if !matches!(sign, b'-' | b'+') {
            return self.primary();
        }
        let place = self.take(TokenKind::Operator, 1);
        self.blanks();
        Some(signed(sign, place, self.primary()?))
    }

    fn primary(&mut self) -> Option<Expr> {
        match self.byte() {
            b'0'..=b'9' | b'.' => self.number(),
            b'(' => {
                let (inner, span) = self.bracketed()?;
                Some(Expr { kind: ExprKind::Group(Box::new(inner)), span })
            }
            _ if self.names_variable() => {
                let variable = self.variable()?;
                Some(Expr { span: variable.span, kind: ExprKind::Variable(Box::new(variable)) })
            }
            _ => self.call(),
        }
    }

    /// What stands in brackets, and the place of both.
    fn bracketed(&mut self) -> Option<(Expr, Span)> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return None;
        }
        let open = self.taken(TokenKind::Bracket, b"(")?;
        let inner = self.expression()?;
        self.blanks();
        let close = self.begins(b")").then(|| self.take(TokenKind::Bracket, 1))?;
        self.depth -= 1;
        Some((inner, open.to(close)))
    }

    fn call(&mut self) -> Option<Expr> {
        let function = match self.rest().get(..3)?.to_ascii_uppercase().as_slice() {
            b"ABS" => Func::Abs,
            b"ATN" => Func::Atan,
            b"COS" => Func::Cos,
            b"INT" => Func::Fix,
            b"RND" => Func::RoundPlaces,
            b"SGN" => Func::Sign,
            b"SIN" => Func::Sin,
            b"SQR" => Func::Sqrt,
            _ => return None,
        };
        let name = self.take(TokenKind::Keyword, 3);
        self.blanks();
        let (argument, brackets) = self.bracketed()?;
        let call = ExprKind::Call { function, arguments: ThinVec::from([argument]), form: CallForm::Plain };
        Some(Expr { kind: call, span: name.to(brackets) })
    }

    /// True before `V5`, `R5`, `V(` and `R(`.
    fn names_variable(&self) -> bool {
        matches!(self.rest(), [b'V' | b'v' | b'R' | b'r', next, ..] if next.is_ascii_digit() || *next == b'(')
    }

    fn variable(&mut self) -> Option<VarRef> {
        if !self.names_variable() {
            return None;
        }
        let name = Cow::Borrowed(if self.byte() | 0x20 == b'v' { "V" } else { "R" });
        let start = self.take(TokenKind::Variable, 1);
        let (index, end) = if self.byte() == b'(' {
            let (inner, span) = self.bracketed()?;
            match inner.kind {
                // Digits alone are the number itself.
                ExprKind::Number(number) if !number.point => {
                    (Index::Number(Some(number.value).filter(|n| *n <= f64::from(u32::MAX))? as u32), span)
                }
                kind => (Index::Computed(Box::new(Expr { kind, ..inner })), span),
            }
        } else {
            let (number, span) = self.whole()?;
            (Index::Number(number), span)
        };
        Some(VarRef { name, index, span: start.to(end) })
    }
}

fn signed(sign: u8, place: Span, inner: Expr) -> Expr {
    let span = place.to(inner.span);
    let kind = if sign == b'-' { ExprKind::Negate } else { ExprKind::Plus };
    Expr { kind: kind(Box::new(inner)), span }
}

/// None where the check finds a fault, of which the grammar's side tells.
fn faultless(expr: &Expr, check: fn(&Expr, &mut Vec<crate::syntax::SyntaxError>)) -> Option<()> {
    let mut errors = Vec::new();
    check(expr, &mut errors);
    errors.is_empty().then_some(())
}
