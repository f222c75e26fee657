//! Where reading is, and what was gathered on the way.

use super::super::rules::Rules;
use crate::syntax::{Item, ItemKind, Token, TokenKind};
use crate::text::Span;

/// Reads a block from left to right; a method that gives nothing declines the block.
///
/// Without `ITEMS` no item is kept: of an expression only its constant is known, and a line that the checks might find
/// fault with is declined.
pub struct Reader<'a, const ITEMS: bool, const TOKENS: bool> {
    pub rules: &'a Rules,
    /// The file, up to the end of the line.
    pub line: &'a [u8],
    pub at: usize,
    /// Where the last token but blanks ends.
    pub end_of_last: usize,
    pub items: &'a mut Vec<Item>,
    tokens: &'a mut Vec<Token>,
    /// How many brackets are open.
    pub brackets: usize,
    /// How many operators were met.
    pub operators: usize,
    /// True where something stands that may be wrong though the grammar lets it pass.
    pub in_doubt: bool,
    /// How many items, comments aside, were met, if no items are kept.
    pub met: usize,
    /// True where a call of ATAN was met.
    pub met_atan: bool,
}

impl<'a, const ITEMS: bool, const TOKENS: bool> Reader<'a, ITEMS, TOKENS> {
    pub fn new(
        rules: &'a Rules,
        source: &'a [u8],
        rest: Span,
        items: &'a mut Vec<Item>,
        tokens: &'a mut Vec<Token>,
    ) -> Option<Self> {
        let line = source.get(..rest.end as usize)?;
        let at = rest.start as usize;
        Some(Self {
            rules,
            line,
            at,
            end_of_last: at,
            items,
            tokens,
            brackets: 0,
            operators: 0,
            in_doubt: false,
            met: 0,
            met_atan: false,
        })
    }

    /// The next byte; at the end of the line a zero, which nothing begins with.
    #[inline(always)]
    pub fn byte(&self) -> u8 {
        self.byte_after(0)
    }

    /// The byte after so many.
    #[inline(always)]
    pub fn byte_after(&self, passed: usize) -> u8 {
        self.line.get(self.at + passed).copied().unwrap_or(0)
    }

    /// What is left of the line.
    #[inline(always)]
    pub fn rest(&self) -> &'a [u8] {
        self.line.get(self.at..).unwrap_or_default()
    }

    /// Takes a token of so many bytes, and the blanks after it.
    #[inline(always)]
    pub fn take(&mut self, kind: TokenKind, length: usize) -> Span {
        let span = self.take_close(kind, length);
        if is_blank(self.byte()) {
            self.blanks();
        }
        span
    }

    /// Takes a token of so many bytes, after which no blanks may stand.
    #[inline(always)]
    pub fn take_close(&mut self, kind: TokenKind, length: usize) -> Span {
        let span = Span::new(self.at as u32, (self.at + length) as u32);
        self.at += length;
        self.end_of_last = self.at;
        self.token(kind, span);
        span
    }

    /// Takes a token of one byte, which must be this one.
    pub fn take_sign(&mut self, byte: u8, kind: TokenKind) -> Option<Span> {
        (self.byte() == byte).then(|| self.take(kind, 1))
    }

    /// Takes a keyword, in letters of any case.
    pub fn take_keyword(&mut self, name: &[u8]) -> Option<Span> {
        let text = self.rest().get(..name.len())?;
        text.eq_ignore_ascii_case(name).then(|| self.take(TokenKind::Keyword, name.len()))
    }

    /// Takes blanks, of which there is one at least.
    pub fn blanks(&mut self) {
        let start = self.at as u32;
        while is_blank(self.byte()) {
            self.at += 1;
        }
        self.token(TokenKind::Space, Span::new(start, self.at as u32));
    }

    #[inline(always)]
    fn token(&mut self, kind: TokenKind, span: Span) {
        if TOKENS {
            self.tokens.push(Token { kind, span });
        }
    }

    /// From a place to the end of the last token.
    #[inline(always)]
    pub fn since(&self, start: u32) -> Span {
        Span::new(start, self.end_of_last as u32)
    }

    /// Adds an item that reaches to the end of the last token.
    #[inline(always)]
    pub fn item(&mut self, start: u32, kind: ItemKind) {
        if ITEMS {
            let span = self.since(start);
            self.items.push(Item { kind, span });
        } else if !matches!(kind, ItemKind::Comment(_)) {
            self.met += 1;
        }
    }

    /// Leaves it to the checks whether something is wrong.
    #[inline(always)]
    pub fn doubt(&mut self) {
        self.in_doubt = true;
    }

    /// Leaves it to the checks whether something is wrong; without items, declines it where it may be.
    #[inline(always)]
    pub fn doubt_if(&mut self, may_be_wrong: bool) -> Option<()> {
        self.in_doubt |= may_be_wrong;
        (ITEMS || !may_be_wrong).then_some(())
    }
}

/// The items from one on, in no more room than they need: files are kept whole.
pub fn taken(items: &mut Vec<Item>, from: usize) -> Vec<Item> {
    let mut out = Vec::with_capacity(items.len() - from);
    if from == 0 {
        out.append(items);
    } else {
        out.extend(items.drain(from..));
    }
    out
}

pub fn is_blank(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t')
}
