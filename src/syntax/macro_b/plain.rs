//! What becomes of the parts of a block of plain words: leaves, items, or nothing but the news that it has no fault.
//!
//! The items are the same as [`super::tree`] would build, which tests hold it to; nothing need be asked of
//! what may come next, since the scanner meets words, comments and sequence numbers only.

use super::lexeme::{Lex, Lexeme, Lexemes};
use super::scanner::{Scanned, Take};
use crate::syntax::{Comment, Expr, ExprKind, Fence, Item, ItemKind, Word};
use crate::text::Span;

/// What a block of plain words says.
pub struct Plain {
    items: Vec<Item>,
    /// True where a word stands that can be wrong.
    pub needs_check: bool,
}

impl Plain {
    /// Of a block that is the whole of `text` or less.
    pub fn within(text: &[u8]) -> Self {
        let starts = |byte: &&u8| byte.is_ascii_alphabetic() || matches!(byte, b'(' | b';');
        Self { items: Vec::with_capacity(text.iter().filter(starts).count()), needs_check: false }
    }

    /// What it says, in order.
    pub fn into_items(mut self) -> Vec<Item> {
        // Files are kept whole: room to spare in each block would be most of what they take.
        self.items.shrink_to_fit();
        self.items
    }
}

impl Take for Plain {
    fn sequence(&mut self, letter: Span, digits: Span, number: u32) {
        let kind = ItemKind::Sequence { number, inserted: false };
        self.items.push(Item { kind, span: letter.to(digits) });
    }

    #[inline]
    fn word(&mut self, scanned: Scanned) {
        self.needs_check |= scanned.can_be_wrong();
        let Scanned { letter, start, sign, digits, .. } = scanned;
        let constant = Expr { kind: ExprKind::Number(scanned.number()), span: digits };
        let value = match sign {
            None => constant,
            Some(sign) => {
                let inner = Box::new(constant);
                let kind = if sign == b'-' { ExprKind::Negate(inner) } else { ExprKind::Plus(inner) };
                Expr { kind, span: Span::new(digits.start - 1, digits.end) }
            }
        };
        let letter = char::from(letter.to_ascii_uppercase());
        let kind = ItemKind::Word(Word { letter, comma: false, value: Some(value), equals: false });
        self.items.push(Item { kind, span: Span::new(start, digits.end) });
    }

    fn comment(&mut self, span: Span) {
        let text = Span::new(span.start + 1, span.end - 1);
        self.items.push(Item { kind: ItemKind::Comment(Comment { text, fence: Fence::Closed }), span });
    }

    fn end(&mut self, span: Span) {
        self.items.push(Item { kind: ItemKind::EndOfBlock, span });
    }
}

/// The leaves.
impl Take for Lexemes {
    fn space(&mut self, span: Span) {
        self.push(Lexeme { kind: Lex::Space, span });
    }

    fn sequence(&mut self, letter: Span, digits: Span, _: u32) {
        self.push(Lexeme { kind: Lex::SequenceLetter, span: letter });
        self.push(Lexeme { kind: Lex::Integer, span: digits });
    }

    fn word(&mut self, word: Scanned) {
        self.push(Lexeme { kind: Lex::Letter, span: Span::new(word.start, word.start + 1) });
        if word.sign.is_some() {
            self.push(Lexeme { kind: Lex::Sign, span: Span::new(word.start + 1, word.digits.start) });
        }
        self.push(Lexeme { kind: Lex::Number, span: word.digits });
    }

    fn comment(&mut self, span: Span) {
        self.push(Lexeme { kind: Lex::Comment, span });
    }

    fn end(&mut self, span: Span) {
        self.push(Lexeme { kind: Lex::EndOfBlock, span });
    }
}

/// Whether a word stands that can be wrong.
#[derive(Default)]
pub struct NeedsCheck(pub bool);

impl Take for NeedsCheck {
    const NUMBERS: bool = false;

    fn word(&mut self, word: Scanned) {
        self.0 |= word.can_be_wrong();
    }

    fn sequence(&mut self, _: Span, _: Span, _: u32) {}
    fn comment(&mut self, _: Span) {}
    fn end(&mut self, _: Span) {}
}

/// Both at once.
impl<A: Take, B: Take> Take for (A, B) {
    fn space(&mut self, span: Span) {
        self.0.space(span);
        self.1.space(span);
    }

    fn sequence(&mut self, letter: Span, digits: Span, number: u32) {
        self.0.sequence(letter, digits, number);
        self.1.sequence(letter, digits, number);
    }

    fn word(&mut self, word: Scanned) {
        self.0.word(word);
        self.1.word(word);
    }

    fn comment(&mut self, span: Span) {
        self.0.comment(span);
        self.1.comment(span);
    }

    fn end(&mut self, span: Span) {
        self.0.end(span);
        self.1.end(span);
    }
}
