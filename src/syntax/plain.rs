//! Reads blocks of plain words without a grammar: `N10 G1 Y2 F300.`
//!
//! Most lines of most programs are of this kind, and reading them byte by byte is many
//! times as fast. The grammars stay the definition: what this accepts, each grammar
//! reads to the same block (a property test of each dialect says so), and anything else
//! is left to them.

use super::support::number;
use super::{Block, Expr, ExprKind, Item, ItemKind, Token, TokenKind, Word};
use crate::text::Span;
use thin_vec::ThinVec;

/// The block of a line that holds nothing but a block number and words with numbers; with its tokens where they are to
/// be kept.
pub(super) fn plain_block(source: &[u8], line: Span, tokens: bool) -> Option<Block> {
    let mut scan = Scan {
        bytes: line.of(source),
        start: line.start,
        at: 0,
        tokens: tokens.then(|| Vec::with_capacity(12)),
        // Each begins with a letter; files of such blocks are kept whole, so that room to spare would be most of them.
        items: Vec::with_capacity(line.of(source).iter().filter(|byte| byte.is_ascii_alphabetic()).count()),
    };
    scan.blanks();
    if matches!(scan.byte(), Some(b'N' | b'n')) {
        scan.sequence()?;
    }
    while let Some(byte) = scan.byte() {
        match byte {
            b' ' | b'\t' => scan.blanks(),
            // Letters that mean something else somewhere are left to the grammars.
            b'N' | b'n' | b'O' | b'o' | b'V' | b'v' => return None,
            b'A'..=b'Z' | b'a'..=b'z' => scan.word(byte)?,
            _ => return None,
        }
    }
    let Scan { tokens, items, .. } = scan;
    Some(Block { span: line, tokens: tokens.unwrap_or_default(), items, errors: ThinVec::new() })
}

struct Scan<'s> {
    bytes: &'s [u8],
    start: u32,
    at: usize,
    tokens: Option<Vec<Token>>,
    items: Vec<Item>,
}

impl<'s> Scan<'s> {
    fn byte(&self) -> Option<u8> {
        self.bytes.get(self.at).copied()
    }

    fn span(&self, from: usize) -> Span {
        Span::new(self.start + from as u32, self.start + self.at as u32)
    }

    fn token(&mut self, kind: TokenKind, from: usize) -> Span {
        let span = self.span(from);
        if let Some(tokens) = &mut self.tokens {
            tokens.push(Token { kind, span });
        }
        span
    }

    fn pass(&mut self, keep: fn(u8) -> bool) {
        while self.byte().is_some_and(keep) {
            self.at += 1;
        }
    }

    fn blanks(&mut self) {
        let from = self.at;
        self.pass(|byte| matches!(byte, b' ' | b'\t'));
        if self.at > from {
            self.token(TokenKind::Space, from);
        }
    }

    fn letter(&mut self) -> usize {
        let from = self.at;
        self.at += 1;
        self.token(TokenKind::Letter, from);
        from
    }

    /// The text of a number, which stands directly here.
    fn number(&mut self) -> Option<(&'s str, Span)> {
        let from = self.at;
        self.pass(|byte| byte.is_ascii_digit());
        let whole = self.at - from;
        if self.byte() == Some(b'.') {
            self.at += 1;
            self.pass(|byte| byte.is_ascii_digit());
        }
        // A point alone is no number.
        if whole == 0 && self.at - from < 2 {
            return None;
        }
        let text = std::str::from_utf8(self.bytes.get(from..self.at)?).ok()?;
        Some((text, self.token(TokenKind::Number, from)))
    }

    fn sequence(&mut self) -> Option<()> {
        let from = self.letter();
        let (text, _) = self.number()?;
        let number = text.parse().ok()?;
        self.items.push(Item { kind: ItemKind::Sequence { number, inserted: false }, span: self.span(from) });
        Some(())
    }

    fn word(&mut self, letter: u8) -> Option<()> {
        let from = self.letter();
        let sign = self.byte().filter(|byte| matches!(byte, b'+' | b'-'));
        let signed = sign.map(|_| {
            self.at += 1;
            self.token(TokenKind::Operator, self.at - 1)
        });
        let (text, span) = self.number()?;
        let mut value = Expr { kind: ExprKind::Number(number(text)), span };
        if let Some(start) = signed {
            let kind = if sign == Some(b'-') { ExprKind::Negate } else { ExprKind::Plus };
            value = Expr { span: start.to(span), kind: kind(Box::new(value)) };
        }
        let letter = char::from(letter.to_ascii_uppercase());
        let word = Word { letter, comma: false, value: Some(value), equals: false };
        self.items.push(Item { kind: ItemKind::Word(word), span: self.span(from) });
        Some(())
    }
}
